// SPDX-License-Identifier: MIT
#include "common/config/wall_config.h"

#include <algorithm>
#include <iterator>

namespace wall::config {

const char* name_of(Backend backend) { return backend == Backend::egl ? "egl" : "osmesa"; }

const char* output_name(const TileConfig& tile) {
    if (tile.kms) return "kms";
    return tile.window ? "window" : "headless";
}

bool draws_as(const TileConfig& a, const TileConfig& b) {
    const bool same_window = !a.window || (a.output.width == b.output.width && a.output.height == b.output.height);
    return a.name == b.name && a.rect == b.rect && a.window == b.window && a.kms == b.kms && a.gpu == b.gpu &&
           same_window;
}

bool draws_as(const NodeConfig& a, const NodeConfig& b) {
    return a.name == b.name && a.process == b.process && a.part == b.part && a.backend == b.backend &&
           a.triangle_order == b.triangle_order && a.listen == b.listen &&
           std::ranges::equal(a.tiles, b.tiles, [](const auto& x, const auto& y) { return draws_as(x, y); });
}

geom::Rect WallConfig::canvas() const {
    geom::Rect out;
    for (const auto& node : nodes) {
        for (const auto& tile : node.tiles) {
            out.width = std::max(out.width, tile.rect.right());
            out.height = std::max(out.height, tile.rect.bottom());
        }
    }
    return out;
}

const NodeConfig* WallConfig::find_node(std::string_view node) const {
    const auto found = std::ranges::find(nodes, node, &NodeConfig::name);
    return found == nodes.end() ? nullptr : &*found;
}

std::vector<NodeConfig> WallConfig::nodes_of(std::string_view process) const {
    std::vector<NodeConfig> out;
    std::ranges::copy_if(nodes, std::back_inserter(out), [&](const auto& node) { return node.process == process; });
    return out;
}

}  // namespace wall::config
