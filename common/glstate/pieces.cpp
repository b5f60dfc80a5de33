// SPDX-License-Identifier: MIT
#include "common/glstate/pieces.h"

namespace wall::glstate {
namespace {

/// Elements that the next primitive shares with the one before; nothing: it cannot be begun anew there. kPieceElements
/// is a multiple of what any mode takes for a primitive, and even, as strips want it.
std::optional<std::uint32_t> overlap_of(GLenum mode) {
    switch (mode) {
        case GL_POINTS:
        case GL_LINES:
        case GL_TRIANGLES:
        case GL_QUADS: return 0;
        case GL_LINE_STRIP: return 1;
        case GL_TRIANGLE_STRIP:
        case GL_QUAD_STRIP: return 2;
        default: return std::nullopt;
    }
}
static_assert(kPieceElements % 12 == 0);

}  // namespace

std::optional<Cut> cut_of(GLenum mode, std::uint32_t elements) {
    const auto overlap = overlap_of(mode);
    if (!overlap || elements < 2 * kPieceElements) return std::nullopt;
    std::uint32_t step = kPieceElements;
    while (elements / step >= kMostPieces) step *= 2;
    return Cut{step, *overlap};
}

PieceBox piece_box(const geom::Box& box) {
    alignas(16) float low[4], high[4];
    _mm_store_ps(low, box.min);
    _mm_store_ps(high, box.max);
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

}  // namespace wall::glstate
