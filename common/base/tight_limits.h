// SPDX-License-Identifier: MIT
// Limits of OpenGL implementations as numbers, for programs without its headers: which of two values promises less.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace wall {

/// Those limits (glGet enums) for which less is not the tighter one.
inline constexpr std::array<std::uint32_t, 8> kLimitsFromBelow{
    0x0B13,  // SMOOTH_POINT_SIZE_GRANULARITY
    0x0B23,  // SMOOTH_LINE_WIDTH_GRANULARITY
    0x8A34,  // UNIFORM_BUFFER_OFFSET_ALIGNMENT
    0x90DF,  // SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT
    0x919F,  // TEXTURE_BUFFER_OFFSET_ALIGNMENT
    0x8904,  // MIN_PROGRAM_TEXEL_OFFSET
    0x8E5E,  // MIN_PROGRAM_TEXTURE_GATHER_OFFSET
    0x8E5B,  // MIN_FRAGMENT_INTERPOLATION_OFFSET
};
/// Those that are the least and the largest of something.
inline constexpr std::array<std::uint32_t, 4> kLimitRanges{
    0x0B12,  // SMOOTH_POINT_SIZE_RANGE
    0x0B22,  // SMOOTH_LINE_WIDTH_RANGE
    0x846D,  // ALIASED_POINT_SIZE_RANGE
    0x846E,  // ALIASED_LINE_WIDTH_RANGE
};

/// Whether the larger of two values at `index` of the limit promises less.
inline bool larger_is_tighter(std::uint32_t limit, std::size_t index) {
    return std::ranges::find(kLimitsFromBelow, limit) != kLimitsFromBelow.end() ||
           (index == 0 && std::ranges::find(kLimitRanges, limit) != kLimitRanges.end());
}

}  // namespace wall
