// SPDX-License-Identifier: MIT
// A large draw in pieces, each with the box around its vertices: a node draws only those that may touch its tile, so
// that four nodes together process a mesh about once (DESIGN, section 4, "Vertex data stays on the nodes"). The client
// makes them when a range is drawn first or its data have changed; the node looks at them for every tile. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geom/box.h"
#include "common/glapi/gl_types.h"

namespace wall::glstate {

/// How elements of a primitive mode are cut: piece i begins with element i * step, and takes `overlap` elements of the
/// next one along.
struct Cut {
    std::uint32_t step = 0;  ///< elements; whole primitives
    std::uint32_t overlap = 0;
};

/// Elements of a piece where there are not too many pieces: small enough that a row of a mesh of a thousand columns is
/// several of them, large enough that looking at one costs nothing beside drawing it.
inline constexpr std::uint32_t kPieceElements = 768;
inline constexpr std::uint32_t kMostPieces = 1 << 13;

/// Nothing: primitives of that mode hang together, or it would be too few pieces to be worth while.
std::optional<Cut> cut_of(GLenum mode, std::uint32_t elements);

/// As it travels.
struct PieceBox {
    float min[3], max[3];
    geom::Box box() const { return {_mm_setr_ps(min[0], min[1], min[2], 1), _mm_setr_ps(max[0], max[1], max[2], 1)}; }
};
PieceBox piece_box(const geom::Box& box);

/// Calls draw(first, count) for each run of pieces that `wanted(box)` says yes to; elements within a draw of
/// `elements`.
template <class Wanted, class Draw>
void for_each_run(const Cut& cut, std::span<const PieceBox> pieces, std::uint32_t elements, Wanted&& wanted,
                  Draw&& draw) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (!wanted(pieces[i].box())) continue;
        const std::size_t first = i;
        while (i + 1 < pieces.size() && wanted(pieces[i + 1].box())) ++i;
        const auto begin = static_cast<std::uint32_t>(first * cut.step);
        const auto end = static_cast<std::uint32_t>(std::min<std::size_t>((i + 1) * cut.step + cut.overlap, elements));
        draw(begin, end - begin);
    }
}

}  // namespace wall::glstate
