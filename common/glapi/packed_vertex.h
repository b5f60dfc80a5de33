// SPDX-License-Identifier: MIT
// Attributes of vertices in small: 2_10_10_10 (GL_ARB_vertex_type_2_10_10_10_rev) and half floats
// (GL_ARB_half_float_vertex), as Mesa makes floats of them. Pure.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

/// What integers stand for.
enum class Fraction : std::uint8_t {
    none,     ///< themselves
    command,  ///< of glColorP3ui and the like: signed ones are (2c + 1) / (2^b - 1), up to OpenGL 4.1
    fetch,    ///< of an array that a driver reads: signed ones are c / (2^(b-1) - 1), cut at -1
};

/// The first `components`, 1 to 4, of a word of this type: x in the lowest bits, w in the highest two. False: no such
/// type.
constexpr bool unpack_2_10_10_10(GLenum type, GLuint word, Fraction fraction, unsigned components, GLfloat* out) {
    if (type != GL_INT_2_10_10_10_REV && type != GL_UNSIGNED_INT_2_10_10_10_REV) return false;
    const bool is_signed = type == GL_INT_2_10_10_10_REV;
    for (unsigned i = 0; i < components; ++i) {
        const unsigned bits = i < 3 ? 10 : 2;
        const GLuint field = word >> (10 * i) & ((1u << bits) - 1);
        const bool negative = is_signed && (field >> (bits - 1) & 1) != 0;
        const auto number = static_cast<GLfloat>(static_cast<GLint>(field) - (negative ? GLint{1} << bits : 0));
        const auto all = static_cast<GLfloat>((1u << bits) - 1), half = static_cast<GLfloat>((1u << (bits - 1)) - 1);
        if (fraction == Fraction::none) out[i] = number;
        else if (!is_signed) out[i] = number / all;
        else if (fraction == Fraction::command) out[i] = (2.0f * number + 1.0f) * (1.0f / all);
        else out[i] = std::max(number / half, -1.0f);
    }
    return true;
}

/// Exact.
constexpr GLfloat half_to_float(std::uint16_t half) {
    const std::uint32_t sign = static_cast<std::uint32_t>(half >> 15) << 31;
    const std::uint32_t exponent = half >> 10 & 0x1f, mantissa = half & 0x3ff;
    if (exponent == 0) {  // 0 and what is smaller than the least normal half
        const GLfloat value = static_cast<GLfloat>(mantissa) * (1.0f / 16777216.0f);
        return sign != 0 ? -value : value;
    }
    if (exponent == 0x1f) return std::bit_cast<GLfloat>(sign | 0x7f800000u | mantissa << 13);
    return std::bit_cast<GLfloat>(sign | (exponent + 112) << 23 | mantissa << 13);
}

}  // namespace wall::glapi
