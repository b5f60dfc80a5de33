// SPDX-License-Identifier: MIT
// Attributes of vertices in small: the numbers that OpenGL says they are.
#include "common/glapi/packed_vertex.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "common/glapi/convert.h"

namespace wall::glapi {
namespace {

std::array<float, 4> unpacked(GLenum type, GLuint word, Fraction fraction, unsigned components = 4) {
    std::array<float, 4> v = {9, 9, 9, 9};
    EXPECT_TRUE(unpack_2_10_10_10(type, word, fraction, components, v.data()));
    return v;
}

constexpr GLuint word_of(GLuint x, GLuint y, GLuint z, GLuint w) {
    return (x & 0x3ff) | (y & 0x3ff) << 10 | (z & 0x3ff) << 20 | w << 30;
}

TEST(PackedVertex, UnsignedComponents) {
    const GLuint word = word_of(1023, 0, 512, 2);
    EXPECT_EQ(unpacked(GL_UNSIGNED_INT_2_10_10_10_REV, word, Fraction::none), (std::array{1023.f, 0.f, 512.f, 2.f}));
    EXPECT_EQ(unpacked(GL_UNSIGNED_INT_2_10_10_10_REV, word, Fraction::command),
              (std::array{1.f, 0.f, 512.f / 1023.f, 2.f / 3.f}));
}

TEST(PackedVertex, SignedComponents) {
    const GLuint word = word_of(static_cast<GLuint>(-512), 511, static_cast<GLuint>(-1), 3);
    EXPECT_EQ(unpacked(GL_INT_2_10_10_10_REV, word, Fraction::none), (std::array{-512.f, 511.f, -1.f, -1.f}));
    EXPECT_EQ(unpacked(GL_INT_2_10_10_10_REV, word, Fraction::command),
              (std::array{-1023.f * (1.f / 1023.f), 1.f, -1.f * (1.f / 1023.f), -1.f * (1.f / 3.f)}));
    EXPECT_EQ(unpacked(GL_INT_2_10_10_10_REV, word, Fraction::fetch), (std::array{-1.f, 1.f, -1.f / 511.f, -1.f}))
        << "the lowest number is cut";
}

TEST(PackedVertex, OnlyWhatIsAskedForIsWritten) {
    EXPECT_EQ(unpacked(GL_UNSIGNED_INT_2_10_10_10_REV, word_of(1, 2, 3, 1), Fraction::none, 2),
              (std::array{1.f, 2.f, 9.f, 9.f}));
}

TEST(PackedVertex, OtherTypesAreNone) {
    float v[4];
    for (const GLenum type : {GL_FLOAT, GL_UNSIGNED_INT, GL_UNSIGNED_INT_10F_11F_11F_REV, GL_UNSIGNED_INT_10_10_10_2})
        EXPECT_FALSE(unpack_2_10_10_10(type, 0, Fraction::none, 4, v)) << type;
}

TEST(PackedVertex, HalfFloats) {
    EXPECT_EQ(half_to_float(0x3c00), 1.0f);
    EXPECT_EQ(half_to_float(0xc000), -2.0f);
    EXPECT_EQ(half_to_float(0x7bff), 65504.0f);
    EXPECT_EQ(half_to_float(0x0400), std::ldexp(1.0f, -14));
    EXPECT_EQ(half_to_float(0x0001), std::ldexp(1.0f, -24));
    EXPECT_EQ(half_to_float(0x7c00), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(half_to_float(0x7e00)));
    EXPECT_TRUE(std::signbit(half_to_float(0x8000)));
}

TEST(PackedVertex, IntegersKeepTheirBits) {
    EXPECT_EQ(std::bit_cast<GLint>(to_bits(GLbyte{-3})), -3);
    EXPECT_EQ(std::bit_cast<GLuint>(to_bits(GLubyte{253})), 253u);
    EXPECT_EQ(std::bit_cast<GLuint>(to_bits(~GLuint{0})), ~GLuint{0});
}

}  // namespace
}  // namespace wall::glapi
