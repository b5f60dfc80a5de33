// SPDX-License-Identifier: MIT
// Vertices on a grid that is as coarse as a bound in pixels allows, so that their last bits are 0 and cost nothing once
// they are coded (A5.3 quantizes vertices; T6.2 asks for a bound by the projection; docs/lossy-geometry.md). Pure.
//
// The step of the grid is a power of two and depends on the vertex and its transformation alone: a vertex that two
// primitives share is put on the same place in both, and no cracks open. At distance w from the eye a step of object
// space is w times smaller in pixels, so the grid is coarser there.
//
// That would not do where an edge reaches behind the eye: what is seen of it may be much nearer than its ends, and
// their errors would be much larger there. Vertices that such a primitive can have therefore get a grid that is fine
// enough for what is nearest in the picture. `reach` says up to which w they lie.
#pragma once

#include <xmmintrin.h>

#include <array>
#include <cstddef>
#include <optional>

#include "client_lib/geometry/packer.h"
#include "common/glstate/projection.h"

namespace wall::client {

class SnapGrid {
public:
    /// `pixels`: how far from where it belongs anything may be seen. `scale`: how many pixels of the wall a pixel of
    /// the window covers, in x and y. Nothing: vertices must stay where they are, since a shader places them, nothing
    /// is cut off in front of the eye, or the transformation makes no picture.
    static std::optional<SnapGrid> make(const glstate::Projection& projection, std::array<float, 2> scale,
                                        float pixels);

    /// A position, (x, y, z, 1). Where coordinates are so large that they are multiples of the step they stay.
    __m128 snapped(__m128 vertex, float reach) const;
    /// How far apart two vertices are seen, pixels of the wall. Nothing: one of them is not in the picture.
    std::optional<double> distance(__m128 a, __m128 b) const;
    /// The least and the greatest w in a box, as its vertices' may have been rounded.
    std::array<float, 2> w_of(const geom::Box& box) const;

private:
    SnapGrid() = default;
    float w_at(__m128 vertex) const;

    glstate::Mat4 clip_{};
    __m128 w_row_{};                     ///< of it: what w is made of
    float step_ = 0;                     ///< of the grid, object space, for a w of 1
    float nearest_w_ = 0;                ///< of what can be seen
    std::array<double, 2> half_size_{};  ///< of the viewport, pixels of the wall
};

/// Up to which w vertices of a block lie that have primitives with what is behind the eye; 0: none has.
float reach_behind(const Packer& packer, const SnapGrid& grid);

/// What snap() has done.
struct Snapped {
    std::size_t vertices = 0;
    double farthest = 0;  ///< that a vertex was moved, pixels of the wall; if that was asked for
};
/// Puts the vertices among some commands of geometry on the grid, and the normals on one of about 1/512 of their
/// lengths, but for the last: that is current behind them. There are no positions with a w.
Snapped snap(wire::PackBuffer& buffer, wire::PackMark first, wire::PackMark last, const SnapGrid& grid, float reach,
             bool measure);

}  // namespace wall::client
