// SPDX-License-Identifier: MIT
#include "client_lib/primitive_scan.h"

#include <algorithm>
#include <cmath>

#include "client_lib/block_walk.h"
#include "client_lib/session.h"
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

std::vector<PackedVertex> scan_vertices(const Packer& packer, const Primitive& primitive,
                                        const Projection& projection) {
    std::vector<PackedVertex> vertices;
    BlockWalk walk(packer, primitive.first, primitive.last, primitive.before);
    walk.next();  // Begin
    wire::PackMark lead = walk.position();
    AttributePlaces before = walk.places();
    while (walk.next()) {
        if (!walk.is_vertex()) continue;
        const auto v = walk.vertex();
        vertices.push_back({lead, walk.position(), before, walk.places(), project(projection, v[0], v[1], v[2], v[3])});
        lead = walk.position();
        before = walk.places();
    }
    return vertices;
}

std::optional<PixelRect> window_rect(const Topology& topology, const std::vector<PackedVertex>& vertices,
                                     std::size_t first, const Projection& projection) {
    std::array<WindowVertex, kMostVertices> corners;
    std::size_t count = 0;
    if (topology.fan) corners[count++] = vertices[0].window;
    for (std::size_t i = first; i < first + topology.size; ++i) corners[count++] = vertices[i].window;
    return hull_rect(projection, {corners.data(), count});
}

}  // namespace wall::client
