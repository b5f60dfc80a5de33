// SPDX-License-Identifier: MIT
// A packed primitive taken apart: its vertices with their attributes, in window coordinates, and how they make points,
// lines, triangles or quads. Pure.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "client_lib/geometry/block_walk.h"
#include "client_lib/geometry/packer.h"
#include "common/glstate/projection.h"

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

/// The vertices of one primitive. It keeps its memory from one primitive to the next.
class VertexScan {
public:
    /// `before`: the attributes as they are at glBegin. The packer stays as it is while the vertices are looked at.
    void scan(const Packer& packer, const Primitive& primitive, const AttributePlaces& before,
              const glstate::Projection& projection);

    std::size_t size() const { return windows_.size(); }
    const glstate::WindowVertex& window(std::size_t v) const { return windows_[v]; }
    /// Where vertex v's attributes begin, or what is behind the last vertex.
    wire::PackMark lead(std::size_t v) const { return {leads_[v].commands, leads_[v].operand_bytes}; }
    /// The attributes there. Those that vertex v has itself are at lead v + 1.
    AttributePlaces attributes(std::size_t v) const;

private:
    struct Lead {
        std::uint32_t commands, operand_bytes;
    };
    static constexpr std::size_t kSnapshotEvery = 8;  ///< vertices

    const Packer* packer_ = nullptr;
    std::vector<Lead> leads_;  ///< one more than vertices
    std::vector<glstate::WindowVertex> windows_;
    std::vector<AttributePlaces> snapshots_;  ///< at every kSnapshotEvery-th lead
};

/// The vertices of the point, line, triangle or quad that starts at vertex `first`; how many.
std::size_t corners_of(const Topology& topology, const VertexScan& vertices, std::size_t first,
                       std::array<glstate::WindowVertex, kMostVertices>& out);
/// Where the point, line, triangle or quad that starts at vertex `first` may be drawn; nothing if that is unknown.
std::optional<geom::PixelRect> window_rect(const Topology& topology, const VertexScan& vertices, std::size_t first,
                                           const glstate::Projection& projection);

}  // namespace wall::client
