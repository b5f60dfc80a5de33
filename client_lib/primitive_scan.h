// SPDX-License-Identifier: MIT
// A packed primitive taken apart: its vertices with their attributes, in window coordinates, and how they make points,
// lines, triangles or quads. Pure.
#pragma once

#include <optional>
#include <vector>

#include "client_lib/packer.h"
#include "client_lib/router.h"

namespace wall::client {

inline constexpr std::size_t kMostVertices = 4;  ///< of a primitive

/// How the vertices of a mode make primitives: primitive k uses vertices [k * step, k * step + size).
struct Topology {
    unsigned size, step;
    bool independent;        ///< no vertices shared, so a run may just leave some out
    bool fan;                ///< every primitive also uses vertex 0
    unsigned alignment = 1;  ///< a run must start at a multiple of this many vertices
};

/// Nothing for loops and polygons: their edges depend on all vertices, so they stay whole.
std::optional<Topology> topology_of(std::uint32_t mode);

struct PackedVertex {
    wire::PackMark lead, end;  ///< its attributes begin at lead; its own command ends at end
    AttributePlaces before;    ///< attributes in effect at lead
    AttributePlaces at;        ///< in effect at the vertex itself
    WindowVertex window;
};

std::vector<PackedVertex> scan_vertices(const Packer& packer, const Primitive& primitive, const Projection& projection);

/// Where the point, line, triangle or quad that starts at vertex `first` may be drawn; nothing if that is unknown.
std::optional<PixelRect> window_rect(const Topology& topology, const std::vector<PackedVertex>& vertices,
                                     std::size_t first, const Projection& projection);

}  // namespace wall::client
