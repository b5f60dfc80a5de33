// SPDX-License-Identifier: MIT
#include "client_lib/geometry/primitive_scan.h"

#include <algorithm>
#include <cmath>

#include "common/glapi/gl_types.h"

namespace wall::client {

std::optional<Topology> topology_of(std::uint32_t mode) {
    switch (mode) {
        case GL_POINTS: return Topology{1, 1, true, false};
        case GL_LINES: return Topology{2, 2, true, false};
        case GL_TRIANGLES: return Topology{3, 3, true, false};
        case GL_QUADS: return Topology{4, 4, true, false};
        case GL_LINE_STRIP: return Topology{2, 1, false, false};
        case GL_TRIANGLE_STRIP: return Topology{3, 1, false, false, 2};  // an odd start would turn the winding
        case GL_QUAD_STRIP: return Topology{4, 2, false, false, 2};
        case GL_TRIANGLE_FAN: return Topology{2, 1, false, true};
        default: return std::nullopt;
    }
}

void VertexScan::scan(const Packer& packer, const Primitive& primitive, const AttributePlaces& before,
                      const glstate::Projection& projection) {
    packer_ = &packer;
    leads_.clear();
    windows_.clear();
    snapshots_.clear();
    BlockWalk walk(packer, primitive.first, primitive.last, before);
    walk.next();  // Begin
    const auto note_lead = [&] {
        if (leads_.size() % kSnapshotEvery == 0) snapshots_.push_back(walk.places());
        leads_.push_back({static_cast<std::uint32_t>(walk.position().commands),
                          static_cast<std::uint32_t>(walk.position().operand_bytes)});
    };
    note_lead();
    while (walk.next()) {
        if (!walk.is_vertex()) continue;
        const auto v = walk.vertex();
        windows_.push_back(project(projection, v[0], v[1], v[2], v[3]));
        note_lead();
    }
}

AttributePlaces VertexScan::attributes(std::size_t v) const {
    const std::size_t snapshot = v / kSnapshotEvery;
    BlockWalk walk(*packer_, lead(snapshot * kSnapshotEvery), lead(v), snapshots_[snapshot]);
    while (walk.next()) continue;
    return walk.places();
}

std::size_t corners_of(const Topology& topology, const VertexScan& vertices, std::size_t first,
                       std::array<glstate::WindowVertex, kMostVertices>& out) {
    std::size_t count = 0;
    if (topology.fan) out[count++] = vertices.window(0);
    for (std::size_t i = first; i < first + topology.size; ++i) out[count++] = vertices.window(i);
    return count;
}

std::optional<geom::PixelRect> window_rect(const Topology& topology, const VertexScan& vertices, std::size_t first,
                                           const glstate::Projection& projection) {
    std::array<glstate::WindowVertex, kMostVertices> corners;
    const std::size_t count = corners_of(topology, vertices, first, corners);
    return hull_rect(projection, {corners.data(), count});
}

}  // namespace wall::client
