// SPDX-License-Identifier: MIT
// Attributes of vertices in small: 2_10_10_10 (GL_ARB_vertex_type_2_10_10_10_rev) and half floats
// (GL_ARB_half_float_vertex), as Mesa makes floats of them. Pure.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

/// The first `components`, 1 to 4, of a word of this type: x in the lowest bits, w in the highest two. Normalized,
/// signed ones are c / 511 and w, cut at -1 (OpenGL 4.2, equation 2.2), others c / 1023 and w / 3. False: no such type.
constexpr bool unpack_2_10_10_10(GLenum type, GLuint word, bool normalized, unsigned components, GLfloat* out) {
    if (type != GL_INT_2_10_10_10_REV && type != GL_UNSIGNED_INT_2_10_10_10_REV) return false;
    const bool is_signed = type == GL_INT_2_10_10_10_REV;
    for (unsigned i = 0; i < components; ++i) {
        const unsigned bits = i < 3 ? 10 : 2;
        const GLuint field = word >> (10 * i) & ((1u << bits) - 1);
        const bool negative = is_signed && (field >> (bits - 1) & 1) != 0;
        const GLint number = static_cast<GLint>(field) - (negative ? GLint{1} << bits : 0);
        const auto largest = static_cast<GLfloat>((1u << (is_signed ? bits - 1 : bits)) - 1);
        out[i] = static_cast<GLfloat>(number);
        if (normalized) out[i] = std::max(out[i] / largest, -1.0f);
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
