// SPDX-License-Identifier: MIT
// Contexts of OpenGL ES 3.1 and 3.2: what they have beyond 3.0, and where they are stricter than OpenGL.
#include <algorithm>
#include <vector>

#include "client_lib/context/es_version.h"
#include "client_lib/context/es_words.h"
#include "client_lib/objects/texture.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class Es32Context : public testing::Test {
protected:
    void SetUp() override { tls_context = &c; }
    void TearDown() override { tls_context = nullptr; }
    const GlTable& gl() const { return *c.table; }
    GLenum error() { return c.take_error(); }
    GLint value(GLenum word) {
        GLint out = -1;
        gl().GetIntegerv(c, word, &out);
        return out;
    }
    GLint samples_of(GLenum target, GLenum format) {
        GLint count = -1;
        gl().GetInternalformativ(c, target, format, GL_NUM_SAMPLE_COUNTS, 1, &count);
        return count;
    }

    Context c{std::make_shared<ShareGroup>(), {.es = 32}};
};

constexpr GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE,
                 kOperation = GL_INVALID_OPERATION;

TEST(Es32Versions, AreOfferedAsFarAsNodesGo) {
    EXPECT_EQ(implemented_es_version(), 32u);
    EXPECT_EQ(es_version_for(3, 1), 32u) << "the latest";
    EXPECT_EQ(es_version_for(3, 3), 0u);
    Caps caps;
    caps.extensions = "GL_ARB_ES2_compatibility GL_ARB_ES3_compatibility GL_ARB_ES3_1_compatibility";
    const ContextProfile profile{.es = 32};
    EXPECT_EQ(shading_language_in(profile, caps), "OpenGL ES GLSL ES 3.10");
    caps.extensions += " GL_ARB_ES3_2_compatibility";
    EXPECT_EQ(shading_language_in(profile, caps), "OpenGL ES GLSL ES 3.10") << "3.2 has blocks of ASTC";
    caps.extensions += " GL_KHR_texture_compression_astc_ldr";
    EXPECT_EQ(shading_language_in(profile, caps), "OpenGL ES GLSL ES 3.20");
    EXPECT_TRUE(version_text_in(profile, caps).starts_with("OpenGL ES 3.2 "));
    EXPECT_EQ(shading_languages_in(profile, caps), (std::vector<std::string>{"100", "300 es", "310 es", "320 es"}));
    EXPECT_TRUE(std::ranges::count(extensions_in(profile, caps), "GL_EXT_geometry_shader"));
}

TEST(Es32Words, AreOfTheirVersions) {
    EXPECT_FALSE(is_es_word(30, GL_SHADER_STORAGE_BUFFER));
    EXPECT_TRUE(is_es_word(31, GL_SHADER_STORAGE_BUFFER));
    EXPECT_TRUE(is_es_word(32, GL_TESS_CONTROL_SHADER));
    EXPECT_FALSE(is_es_word(32, GL_QUADS + 0x10000));
    EXPECT_FALSE(is_es_word(32, GL_TEXTURE_1D));
}

TEST_F(Es32Context, SaysWhatWasAskedFor) {
    EXPECT_EQ(value(GL_CONTEXT_ROBUST_ACCESS), 0);
    EXPECT_EQ(value(GL_RESET_NOTIFICATION_STRATEGY), GL_NO_RESET_NOTIFICATION);
    EXPECT_EQ(value(GL_CONTEXT_FLAGS), 0);
    EXPECT_EQ(error(), kNone);
    const Context robust(std::make_shared<ShareGroup>(), {.robust = true, .notifies_of_resets = true, .es = 32});
    EXPECT_EQ(robust.profile.flags(), GLbitfield{GL_CONTEXT_FLAG_ROBUST_ACCESS_BIT});
}

TEST_F(Es32Context, ShadersTakeImagesOfLastingStorageOnly) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl().BindImageTexture(c, 0, 1, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA8);
    EXPECT_EQ(error(), kOperation);
    gl().BindTexture(c, GL_TEXTURE_2D, 2);
    gl().TexStorage2D(c, GL_TEXTURE_2D, 1, GL_RGBA8, 4, 4);
    gl().BindImageTexture(c, 0, 2, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA8);
    EXPECT_EQ(error(), kNone);
}

TEST_F(Es32Context, SamplesAreOfTexturesAndWholeNumbersToo) {
    EXPECT_EQ(samples_of(GL_RENDERBUFFER, GL_RGBA8UI), 1);
    EXPECT_EQ(samples_of(GL_TEXTURE_2D_MULTISAMPLE, GL_RGBA8), 1);
    EXPECT_EQ(samples_of(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_DEPTH_COMPONENT24), 1);
    EXPECT_EQ(error(), kNone);
    samples_of(GL_TEXTURE_2D, GL_RGBA8);
    EXPECT_EQ(error(), kEnum);
    gl().BindRenderbuffer(c, GL_RENDERBUFFER, 1);
    gl().RenderbufferStorageMultisample(c, GL_RENDERBUFFER, 4, GL_RGBA8UI, 4, 4);
    EXPECT_EQ(error(), kNone);
    gl().BindTexture(c, GL_TEXTURE_2D_MULTISAMPLE, 1);
    gl().TexStorage2DMultisample(c, GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGB9_E5, 4, 4, GL_TRUE);
    EXPECT_EQ(error(), kEnum) << "nothing is drawn to it";
    gl().TexStorage2DMultisample(c, GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, 4, 4, GL_TRUE);
    EXPECT_EQ(error(), kNone);
}

TEST_F(Es32Context, DrawsIndirectlyFromObjectsOnly) {
    const auto draw_error = [&] {
        gl().MultiDrawArraysIndirect(c, GL_TRIANGLES, nullptr, 1, 0);
        return error();
    };
    GLuint buffer = 0, object = 0;
    gl().GenBuffers(c, 1, &buffer);
    gl().GenVertexArrays(c, 1, &object);
    gl().BindBuffer(c, GL_DRAW_INDIRECT_BUFFER, buffer);
    gl().BufferData(c, GL_DRAW_INDIRECT_BUFFER, 16, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(draw_error(), kOperation) << "no object";
    gl().BindVertexArray(c, object);
    EXPECT_EQ(draw_error(), kNone);
    gl().EnableVertexAttribArray(c, 1);
    EXPECT_EQ(draw_error(), kOperation) << "no buffer";
    gl().DisableVertexAttribArray(c, 1);
    gl().BindBuffer(c, GL_DRAW_INDIRECT_BUFFER, 0);
    EXPECT_EQ(draw_error(), kOperation);
    gl().BindVertexArray(c, 0);
    gl().VertexAttribFormat(c, 0, 4, GL_FLOAT, GL_FALSE, 0);
    EXPECT_EQ(error(), kOperation) << "no vertex array object is bound";
}

TEST_F(Es32Context, KeepsBlocksOfAstc) {
    const std::vector<std::byte> blocks(16 * 3 * 2);
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    const auto define = [&](GLenum format, GLsizei width, GLsizei height, GLsizei bytes) {
        gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, format, width, height, 0, bytes, blocks.data());
        return error();
    };
    EXPECT_EQ(define(GL_COMPRESSED_RGBA_ASTC_10x5_KHR, 21, 6, 96), kNone) << "3 x 2 blocks";
    EXPECT_EQ(define(GL_COMPRESSED_RGBA_ASTC_12x12_KHR, 21, 6, 32), kNone);
    EXPECT_EQ(define(GL_COMPRESSED_RGBA_ASTC_12x12_KHR, 21, 6, 96), kValue);
    EXPECT_EQ(define(GL_COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR, 24, 12, 96), kNone);
    const auto change = [&](GLint x, GLsizei width) {
        gl().CompressedTexSubImage2D(c, GL_TEXTURE_2D, 0, x, 6, width, 6, GL_COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR, 16,
                                     blocks.data());
        return error();
    };
    EXPECT_EQ(change(8, 8), kNone);
    EXPECT_EQ(change(4, 8), kOperation);
    EXPECT_EQ(change(8, 4), kOperation);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_COMPRESSED_RGBA_ASTC_4x4_KHR, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), kOperation) << "nodes do not compress";
    gl().GenerateMipmap(c, GL_TEXTURE_2D);
    EXPECT_EQ(error(), kOperation);
    gl().BindTexture(c, GL_TEXTURE_CUBE_MAP_ARRAY, 2);
    gl().TexStorage3D(c, GL_TEXTURE_CUBE_MAP_ARRAY, 1, GL_COMPRESSED_RGBA_ASTC_6x6_KHR, 8, 8, 6);
    EXPECT_EQ(error(), kNone);
}

TEST_F(Es32Context, VolumesHaveNoStencils) {
    gl().BindTexture(c, GL_TEXTURE_3D, 1);
    gl().TexImage3D(c, GL_TEXTURE_3D, 0, GL_STENCIL_INDEX8, 4, 4, 2, 0, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), kOperation);
    gl().TexStorage3D(c, GL_TEXTURE_3D, 1, GL_STENCIL_INDEX8, 4, 4, 2);
    EXPECT_EQ(error(), kOperation);
}

TEST_F(Es32Context, ClearsByTexelsOfAnyFormat) {
    const GLfloat red[] = {1, 0, 0, 1};
    const GLubyte stencil = 5;
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().TexStorage2D(c, GL_TEXTURE_2D, 1, GL_RGBA8, 4, 4);
    gl().ClearTexImage(c, 1, 0, GL_RGBA, GL_FLOAT, red);
    EXPECT_EQ(error(), kNone);
    gl().TexSubImage2D(c, GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_FLOAT, red);
    EXPECT_EQ(error(), kOperation);
    gl().BindTexture(c, GL_TEXTURE_2D, 2);
    gl().TexStorage2D(c, GL_TEXTURE_2D, 1, GL_STENCIL_INDEX8, 4, 4);
    gl().ClearTexImage(c, 2, 0, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, &stencil);
    EXPECT_EQ(error(), kNone);
    gl().ClearTexImage(c, 2, 0, GL_RGBA, GL_FLOAT, red);
    EXPECT_EQ(error(), kOperation);
}

TEST_F(Es32Context, HasImagesOfSixteenBitsAndOfStencils) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGBA16, 4, 4, 0, GL_RGBA, GL_UNSIGNED_SHORT, nullptr);
    EXPECT_EQ(error(), kNone);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_STENCIL_INDEX8, 4, 4, 0, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), kNone);
    const GLfloat stencil = GL_STENCIL_INDEX;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_DEPTH_STENCIL_TEXTURE_MODE, &stencil);
    EXPECT_EQ(error(), kNone);
}

}  // namespace
}  // namespace wall::client
