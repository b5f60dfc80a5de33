// SPDX-License-Identifier: MIT
// Contexts of OpenGL ES: what they say of themselves, and that they have neither desktop's commands nor its words.
#include <algorithm>

#include "client_lib/context/es_version.h"
#include "client_lib/context/es_words.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class EsContext : public testing::Test {
protected:
    void SetUp() override { tls_context = &c; }
    void TearDown() override { tls_context = nullptr; }
    const GlTable& gl() const { return *c.table; }
    GLenum error() { return c.take_error(); }
    /// The error of an image of 1x1 texels.
    GLenum image_error(GLint internal, GLenum format, GLenum type) {
        gl().TexImage2D(c, GL_TEXTURE_2D, 0, internal, 1, 1, 0, format, type, nullptr);
        return error();
    }

    Context c{std::make_shared<ShareGroup>(), {.es = 20}};
};

constexpr GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE,
                 kOperation = GL_INVALID_OPERATION;

std::string text(const GLubyte* given) { return given ? reinterpret_cast<const char*>(given) : ""; }

TEST_F(EsContext, SaysWhatItIs) {
    EXPECT_TRUE(text(gl().GetString(c, GL_VERSION)).starts_with("OpenGL ES 2.0 "));
    EXPECT_EQ(text(gl().GetString(c, GL_SHADING_LANGUAGE_VERSION)), "OpenGL ES GLSL ES 1.00");
    const std::string words = text(gl().GetString(c, GL_EXTENSIONS));
    EXPECT_NE(words.find("GL_OES_element_index_uint"), words.npos);
    EXPECT_EQ(words.find("GL_ARB_"), words.npos);
    EXPECT_EQ(words.find("GL_EXT_texture_compression_s3tc"), words.npos) << "no node has it";
}

TEST_F(EsContext, HasNoDesktopCommands) {
    gl().Begin(c, GL_TRIANGLES);
    EXPECT_EQ(error(), kOperation);
    gl().Color4f(c, 1, 0, 0, 1);
    EXPECT_EQ(error(), kOperation);
    gl().PolygonMode(c, GL_FRONT_AND_BACK, GL_LINE);
    EXPECT_EQ(error(), kOperation);
    gl().MatrixMode(c, GL_PROJECTION);
    EXPECT_EQ(error(), kOperation);
    gl().DepthFunc(c, GL_LESS);
    EXPECT_EQ(error(), kNone);
}

TEST_F(EsContext, HasNoDesktopWords) {
    for (const GLenum word : {GL_LIGHTING, GL_POINT_SPRITE, GL_PROGRAM_POINT_SIZE, GL_TEXTURE_2D, GL_MULTISAMPLE,
                              GL_LINE_SMOOTH, GL_VERTEX_ARRAY}) {
        gl().Enable(c, word);
        EXPECT_EQ(error(), kEnum) << std::hex << word;
        gl().IsEnabled(c, word);
        EXPECT_EQ(error(), kEnum) << std::hex << word;
    }
    GLint value = 0;
    gl().GetIntegerv(c, GL_MAX_TEXTURE_UNITS, &value);
    EXPECT_EQ(error(), kEnum);
    gl().GetIntegerv(c, GL_MAX_VERTEX_ATTRIBS, &value);
    EXPECT_EQ(error(), kNone);
    gl().DrawArrays(c, GL_QUADS, 0, 4);
    EXPECT_EQ(error(), kEnum);
    gl().BindBuffer(c, GL_UNIFORM_BUFFER, 1);
    EXPECT_EQ(error(), kEnum);
    gl().ActiveTexture(c, GL_TEXTURE0 + 40);
    EXPECT_EQ(error(), kNone) << "more than GL_TEXTURE31";
}

TEST_F(EsContext, DrawsPointSpritesOfTheirProgramsSize) {
    EXPECT_TRUE(c.state.line_point.point_sprite);
    EXPECT_TRUE(c.state.line_point.program_point_size);
}

TEST_F(EsContext, HasAnAttributeOfNumberZero) {
    const GLfloat given[4] = {1, 2, 3, 4};
    gl().VertexAttrib4f(c, 0, given[0], given[1], given[2], given[3]);
    GLfloat value[4] = {};
    gl().GetVertexAttribfv(c, 0, GL_CURRENT_VERTEX_ATTRIB, value);
    EXPECT_EQ(error(), kNone);
    EXPECT_TRUE(std::ranges::equal(value, given));
}

TEST_F(EsContext, TakesArraysOfItsTypes) {
    gl().VertexAttribPointer(c, 0, 3, GL_DOUBLE, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), kEnum);
    gl().VertexAttribPointer(c, 0, 3, GL_INT, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), kEnum);
    gl().VertexAttribPointer(c, 0, GL_BGRA, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
    EXPECT_EQ(error(), kValue);
    gl().VertexAttribPointer(c, 0, 3, GL_FIXED, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), kNone);
    constexpr GLenum kHalfFloat = 0x8D61;  // of OES_vertex_half_float
    gl().VertexAttribPointer(c, 0, 3, kHalfFloat, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), kNone);
}

TEST_F(EsContext, TakesPixelsOfItsFormats) {
    EXPECT_EQ(image_error(GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4), kNone);
    EXPECT_EQ(image_error(GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(image_error(GL_BGRA, GL_BGRA, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(image_error(GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT), kNone);
    EXPECT_EQ(image_error(GL_RGBA, GL_RGB, GL_UNSIGNED_BYTE), kOperation);
    EXPECT_EQ(image_error(GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_5_6_5), kOperation);
    EXPECT_EQ(image_error(GL_RGBA12, GL_RGBA, GL_UNSIGNED_BYTE), kValue);
    EXPECT_EQ(image_error(GL_RGBA, GL_RGBA, GL_DOUBLE), kEnum);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGBA, 3, 3, 1, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), kValue) << "there are no borders";
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGB, 1, 1, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
    gl().TexSubImage2D(c, GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, "abcd");
    EXPECT_EQ(error(), kOperation);
}

TEST_F(EsContext, HasNoClampAndNoBorder) {
    const GLfloat clamp = GL_CLAMP, edge = GL_CLAMP_TO_EDGE;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &clamp);
    EXPECT_EQ(error(), kEnum);
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &edge);
    EXPECT_EQ(error(), kNone);
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_LOD_BIAS, &edge);
    EXPECT_EQ(error(), kEnum);
}

TEST_F(EsContext, DrawsToSizedFormats) {
    gl().BindRenderbuffer(c, GL_RENDERBUFFER, 1);
    for (const GLenum format :
         {GL_RGBA4, GL_RGB565, GL_RGB5_A1, GL_DEPTH_COMPONENT16, GL_STENCIL_INDEX8, GL_RGBA8, GL_DEPTH24_STENCIL8}) {
        gl().RenderbufferStorage(c, GL_RENDERBUFFER, format, 4, 4);
        EXPECT_EQ(error(), kNone) << std::hex << format;
    }
    for (const GLenum format : {GL_RGBA, GL_DEPTH_COMPONENT, GL_LUMINANCE, GL_RGBA16}) {
        gl().RenderbufferStorage(c, GL_RENDERBUFFER, format, 4, 4);
        EXPECT_EQ(error(), kEnum) << std::hex << format;
    }
}

TEST_F(EsContext, DrawsToNoLuminance) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().BindFramebuffer(c, GL_FRAMEBUFFER, 1);
    gl().FramebufferTexture2D(c, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 1, 0);
    EXPECT_EQ(image_error(GL_LUMINANCE, GL_LUMINANCE, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(gl().CheckFramebufferStatus(c, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT});
    EXPECT_EQ(image_error(GL_RGBA, GL_RGBA, GL_FLOAT), kNone);
    EXPECT_EQ(gl().CheckFramebufferStatus(c, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT});
    EXPECT_EQ(image_error(GL_RGB, GL_RGB, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(gl().CheckFramebufferStatus(c, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    const GLenum points[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    gl().DiscardFramebufferEXT(c, GL_FRAMEBUFFER, 2, points);
    EXPECT_EQ(error(), kNone);
    const GLenum wrong = GL_COLOR;
    gl().DiscardFramebufferEXT(c, GL_FRAMEBUFFER, 1, &wrong);
    EXPECT_EQ(error(), kEnum);
}

TEST_F(EsContext, CompilesNoDesktopShader) {
    const GLuint shader = gl().CreateShader(c, GL_VERTEX_SHADER);
    const char* source = "#version 120\nvoid main() { gl_Position = vec4(0); }";
    gl().ShaderSource(c, shader, 1, &source, nullptr);
    gl().CompileShader(c, shader);
    GLint compiled = 1;
    gl().GetShaderiv(c, shader, GL_COMPILE_STATUS, &compiled);
    EXPECT_FALSE(compiled);
    GLchar log[200] = {};
    gl().GetShaderInfoLog(c, shader, sizeof log, nullptr, log);
    EXPECT_NE(std::string(log).find("GLSL 1.20 is not supported"), std::string::npos) << log;
}

TEST_F(EsContext, LinksBothStagesOnly) {
    const GLuint program = gl().CreateProgram(c);
    gl().AttachShader(c, program, gl().CreateShader(c, GL_VERTEX_SHADER));
    gl().LinkProgram(c, program);
    GLint linked = 1;
    gl().GetProgramiv(c, program, GL_LINK_STATUS, &linked);
    EXPECT_FALSE(linked);
    GLchar log[200] = {};
    gl().GetProgramInfoLog(c, program, sizeof log, nullptr, log);
    EXPECT_NE(std::string(log).find("lacks a fragment shader"), std::string::npos) << log;
}

TEST(EsVersions, AreOfferedWithAllTheirCommands) {
    const auto latest = static_cast<int>(implemented_es_version());
    EXPECT_GE(latest, 20);
    EXPECT_EQ(es_version_for(2, 0), static_cast<unsigned>(latest));
    EXPECT_EQ(es_version_for(2, 1), 0u) << "there is none";
    for (const EsVersion& each : kEsVersions) {
        EXPECT_EQ(es_version_for(each.version / 10, each.version % 10) != 0, each.version <= latest);
        EXPECT_FALSE(each.version <= latest && each.missing) << each.missing;
    }
    EXPECT_TRUE(std::ranges::is_sorted(kEsWords, {}, &EsWord::value));
    for (const EsExtension& each : kEsExtensions) EXPECT_TRUE(each.implemented) << each.name;
}

TEST(EsWords, BelongToVersions) {
    EXPECT_TRUE(is_es_word(20, GL_TEXTURE_2D));
    EXPECT_FALSE(is_es_word(20, GL_TEXTURE_2D_ARRAY));
    EXPECT_TRUE(is_es_word(30, GL_TEXTURE_2D_ARRAY));
    EXPECT_FALSE(is_es_word(32, GL_MATRIX_MODE));
    EXPECT_TRUE((are_es_words<0b10>(20, GLenum{GL_MATRIX_MODE}, GLenum{GL_TEXTURE_2D}))) << "the second only";
    EXPECT_FALSE((are_es_words<0b11>(20, GLenum{GL_MATRIX_MODE}, GLenum{GL_TEXTURE_2D})));
}

}  // namespace
}  // namespace wall::client
