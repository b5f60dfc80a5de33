// SPDX-License-Identifier: MIT
// Integers as fractions: the whole range maps to [0, 1] or [-1, 1] (OpenGL 1.2.1 table 2.6), computed as Mesa does, to
// the last bit; numbers with sixteen bits behind the point (OpenGL ES 1.1, 2.3). Pure.
#pragma once

#include <bit>
#include <limits>
#include <type_traits>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

/// An integer attribute as the float of its bits: so it is kept and travels, and so the driver hands it on.
template <class T>
constexpr GLfloat to_bits(T v) {
    static_assert(std::is_integral_v<T> && sizeof(T) <= 4);
    using Word = std::conditional_t<std::is_signed_v<T>, GLint, GLuint>;
    return std::bit_cast<GLfloat>(static_cast<Word>(v));
}

inline GLfloat to_fraction(GLubyte v) { return static_cast<GLfloat>(v) / 255.0f; }
inline GLfloat to_fraction(GLbyte v) { return (2.0f * static_cast<GLfloat>(v) + 1.0f) * (1.0f / 255.0f); }
inline GLfloat to_fraction(GLushort v) { return static_cast<GLfloat>(v) * (1.0f / 65535.0f); }
inline GLfloat to_fraction(GLshort v) { return (2.0f * static_cast<GLfloat>(v) + 1.0f) * (1.0f / 65535.0f); }
inline GLfloat to_fraction(GLuint v) { return static_cast<GLfloat>(static_cast<GLdouble>(v) * (1.0 / 4294967295.0)); }
inline GLfloat to_fraction(GLint v) { return (2.0f * static_cast<GLfloat>(v) + 1.0f) * (1.0f / 4294967295.0f); }
inline GLfloat to_fraction(GLfloat v) { return v; }
inline GLfloat to_fraction(GLdouble v) { return static_cast<GLfloat>(v); }

inline constexpr GLfloat kFixedOne = 65536.0f;

inline GLfloat from_fixed(GLfixed v) { return static_cast<GLfloat>(v) / kFixedOne; }
/// What is behind the last bit is dropped; the nearest that there is of what is too large or too small, 0 of no number.
inline GLfixed to_fixed(GLdouble v) {
    constexpr GLdouble kMost = std::numeric_limits<GLfixed>::max(), kLeast = std::numeric_limits<GLfixed>::min();
    const GLdouble bits = v * static_cast<GLdouble>(kFixedOne);
    if (bits != bits) return 0;
    return static_cast<GLfixed>(bits > kMost ? kMost : bits < kLeast ? kLeast : bits);
}

}  // namespace wall::glapi
