// SPDX-License-Identifier: MIT
// Generic attributes that are integers, and arrays of integers and of packed numbers.
#include <cstdint>
#include <limits>

#include "common/glapi/convert.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

using VertexAttributesTest = ContextTest;
using glapi::to_bits;

TEST_F(VertexAttributesTest, IntegersAreAnsweredAsTheyWere) {
    gl().VertexAttrib4f(c, 3, to_bits(-7), to_bits(8u), to_bits(0), to_bits(1));
    GLint got[4] = {};
    gl().GetVertexAttribIiv(c, 3, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(got[0], -7);
    EXPECT_EQ(got[3], 1);
    GLuint unsigned_got[4] = {};
    gl().GetVertexAttribIuiv(c, 3, GL_CURRENT_VERTEX_ATTRIB, unsigned_got);
    EXPECT_EQ(unsigned_got[1], 8u);
    gl().GetVertexAttribIiv(c, 0, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetVertexAttribIiv(c, 16, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(VertexAttributesTest, AnArraySaysWhetherItIsOfIntegers) {
    gl().VertexAttribIPointer(c, 2, 3, GL_UNSIGNED_SHORT, 8, nullptr);
    GLint got = 0;
    gl().GetVertexAttribiv(c, 2, GL_VERTEX_ATTRIB_ARRAY_INTEGER, &got);
    EXPECT_EQ(got, GL_TRUE);
    gl().GetVertexAttribiv(c, 2, GL_VERTEX_ATTRIB_ARRAY_NORMALIZED, &got);
    EXPECT_EQ(got, GL_FALSE);
    gl().VertexAttribPointer(c, 2, 3, GL_UNSIGNED_SHORT, GL_TRUE, 8, nullptr);
    gl().GetVertexAttribiv(c, 2, GL_VERTEX_ATTRIB_ARRAY_INTEGER, &got);
    EXPECT_EQ(got, GL_FALSE);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(VertexAttributesTest, IntegersHaveNoFraction) {
    gl().VertexAttribIPointer(c, 2, 4, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().VertexAttribIPointer(c, 2, 4, GL_INT_2_10_10_10_REV, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().VertexAttribIPointer(c, 2, GL_BGRA, GL_UNSIGNED_BYTE, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().VertexAttribIPointer(c, 16, 4, GL_INT, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(VertexAttributesTest, PackedNumbersAreFour) {
    gl().VertexAttribPointer(c, 1, 4, GL_INT_2_10_10_10_REV, GL_FALSE, 0, nullptr);
    gl().ColorPointer(c, 4, GL_UNSIGNED_INT_2_10_10_10_REV, 0, nullptr);
    gl().NormalPointer(c, GL_INT_2_10_10_10_REV, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().VertexAttribPointer(c, 1, 3, GL_INT_2_10_10_10_REV, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().VertexPointer(c, 3, GL_INT_2_10_10_10_REV, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(VertexAttributesTest, BlueMayComeFirst) {
    gl().ColorPointer(c, GL_BGRA, GL_UNSIGNED_BYTE, 0, nullptr);
    GLint got = 0;
    gl().GetIntegerv(c, GL_COLOR_ARRAY_SIZE, &got);
    EXPECT_EQ(got, GL_BGRA);
    gl().VertexAttribPointer(c, 1, GL_BGRA, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().VertexAttribPointer(c, 1, GL_BGRA, GL_UNSIGNED_BYTE, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().ColorPointer(c, GL_BGRA, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().TexCoordPointer(c, GL_BGRA, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(VertexAttributesTest, ElementsOfAllTypes) {
    const std::uint16_t halves[2] = {0x3c00, 0xc000};
    gl().VertexAttribPointer(c, 1, 2, GL_HALF_FLOAT, GL_FALSE, 0, halves);
    gl().EnableVertexAttribArray(c, 1);
    const GLbyte bytes[4] = {-1, 2, 3, 4};
    gl().VertexAttribIPointer(c, 2, 3, GL_BYTE, 0, bytes);
    gl().EnableVertexAttribArray(c, 2);
    const GLuint word = 1023u | 512u << 10 | 3u << 30;
    gl().VertexAttribPointer(c, 3, 4, GL_UNSIGNED_INT_2_10_10_10_REV, GL_TRUE, 0, &word);
    gl().EnableVertexAttribArray(c, 3);
    const GLubyte bgra[4] = {0, 51, 255, 255};
    gl().VertexAttribPointer(c, 4, GL_BGRA, GL_UNSIGNED_BYTE, GL_TRUE, 0, bgra);
    gl().EnableVertexAttribArray(c, 4);
    gl().ArrayElement(c, 0);
    GLfloat got[4] = {};
    gl().GetVertexAttribfv(c, 1, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(got[0], 1);
    EXPECT_EQ(got[1], -2);
    EXPECT_EQ(got[3], 1);
    GLint integers[4] = {};
    gl().GetVertexAttribIiv(c, 2, GL_CURRENT_VERTEX_ATTRIB, integers);
    EXPECT_EQ(integers[0], -1);
    EXPECT_EQ(integers[2], 3);
    EXPECT_EQ(integers[3], 1);
    gl().GetVertexAttribfv(c, 3, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(got[0], 1);
    EXPECT_EQ(got[1], 512.0f / 1023.0f);
    EXPECT_EQ(got[3], 1);
    gl().GetVertexAttribfv(c, 4, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(got[0], 1);
    EXPECT_EQ(got[2], 0);
}

}  // namespace
}  // namespace wall::client
