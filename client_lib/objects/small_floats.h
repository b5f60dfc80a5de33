// SPDX-License-Identifier: MIT
// Floating point numbers of less than 32 bits (OpenGL 4.6, 2.3.4.2 to 2.3.4.4 and 8.5.2). Pure.
#pragma once

#include <array>
#include <cstdint>

#include "common/glapi/packed_vertex.h"

namespace wall::client {

using Rgb = std::array<float, 3>;

using glapi::half_to_float;
std::uint16_t float_to_half(float value);
/// The same without rounding, as Mesa stores texels.
std::uint16_t float_to_half_cut(float value);

/// GL_UNSIGNED_INT_10F_11F_11F_REV. Negative numbers become 0, numbers too large the largest; the rest is cut off, as
/// Mesa does it.
Rgb from_short_floats(std::uint32_t word);
std::uint32_t to_short_floats(const Rgb& colors);

/// GL_UNSIGNED_INT_5_9_9_9_REV: three mantissas of nine bits with one exponent.
Rgb from_shared_exponent(std::uint32_t word);
std::uint32_t to_shared_exponent(const Rgb& colors);

}  // namespace wall::client
