// SPDX-License-Identifier: MIT
#include "client_lib/follow/ideal.h"

#include <algorithm>
#include <vector>

#include "client_lib/geometry/primitive_scan.h"
#include "client_lib/process/stats.h"

namespace wall::client {
namespace {

constexpr std::size_t kBeginEnd = 6;  // bytes

std::size_t bytes_between(wire::PackMark first, wire::PackMark last) {
    return last.commands - first.commands + last.operand_bytes - first.operand_bytes;
}

/// A primitive that is divided among nodes.
class Division {
public:
    Division(const Packer& packer, const Primitive& primitive, const Topology& topology,
             const glstate::Projection& projection, std::span<const TargetLayer> layers)
        : topology_(topology) {
        vertices_.scan(packer, primitive, {}, projection);
        for (std::size_t v = topology.fan ? 1 : 0; v + topology.size <= vertices_.size(); v += topology.step)
            touched_.push_back(nodes_touched(layers, window_rect(topology, vertices_, v, projection)));
    }
    /// Bytes that this node needs; 0: none of the triangles touches it.
    std::size_t bytes_for(NodeIndex node) const {
        std::vector<bool> needed(vertices_.size());
        std::size_t v = topology_.fan ? 1 : 0;
        for (const auto& nodes : touched_) {
            if (std::any_of(nodes.begin(), nodes.end(), [node](const NodeMask& m) { return m.node == node; })) {
                std::fill_n(needed.begin() + static_cast<std::ptrdiff_t>(v), topology_.size, true);
                if (topology_.fan) needed[0] = true;
            }
            v += topology_.step;
        }
        std::size_t bytes = 0;
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            if (needed[i]) bytes += bytes_between(vertices_.lead(i), vertices_.lead(i + 1));
        return bytes > 0 ? bytes + kBeginEnd : 0;
    }

private:
    const Topology& topology_;
    VertexScan vertices_;
    std::vector<NodeMasks> touched_;  ///< by triangle
};

}  // namespace

IdealBlock ideal_block(const Packer& packer, const glstate::Projection& projection,
                       std::span<const TargetLayer> layers) {
    IdealBlock block;
    const auto add = [&](NodeIndex node, std::size_t bytes) {
        if (bytes == 0) return;
        block.bytes += bytes;
        block.nodes.insert(node);
    };
    for (const Primitive& primitive : packer.primitives()) {
        const auto topology = topology_of(primitive.mode);
        const auto nodes = nodes_touched(layers, project(projection, primitive.box));
        if (!topology || nodes.size() < 2 || !primitive.divisible) {
            for (const NodeMask& node : nodes) add(node.node, bytes_between(primitive.first, primitive.last));
            continue;
        }
        const Division division(packer, primitive, *topology, projection, layers);
        for (const NodeMask& node : nodes) add(node.node, division.bytes_for(node.node));
    }
    return block;
}

void IdealTraffic::count(const DrawSource& source, const Packer& packer, const glstate::Projection& projection) {
    const IdealBlock block = ideal_block(packer, projection, source.draw.layers());
    const std::pair matrices{source.id, source.state.ids[static_cast<std::size_t>(glstate::Category::matrix)]};
    if (matrices != matrices_) nodes_.clear();
    matrices_ = matrices;
    const std::size_t before = nodes_.size();
    nodes_.insert(block.nodes.begin(), block.nodes.end());
    stats().add("ideal_geometry_bytes", block.bytes);
    stats().add("ideal_matrices", nodes_.size() - before);
}

}  // namespace wall::client
