// SPDX-License-Identifier: MIT
#include "client_lib/context/copied_texels.h"

#include <gtest/gtest.h>

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr GLsizei kSize = 64;

/// Reads from a framebuffer object with a texture of kSize; another texture is bound.
class CopiedTexels : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        drawn_ = make_texture(GL_RGBA8);
        GLuint framebuffer = 0;
        gl().GenFramebuffers(c, 1, &framebuffer);
        gl().BindFramebuffer(c, GL_FRAMEBUFFER, framebuffer);
        gl().FramebufferTexture2D(c, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, drawn_, 0);
        make_texture(GL_RGBA8);
        ASSERT_EQ(error(), GLenum{GL_NO_ERROR});
    }
    GLuint make_texture(GLint internal_format) {
        GLuint name = 0;
        gl().GenTextures(c, 1, &name);
        gl().BindTexture(c, GL_TEXTURE_2D, name);
        gl().TexImage2D(c, GL_TEXTURE_2D, 0, internal_format, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        return name;
    }
    bool can_copy(GLint internal_format, GLint x = 0, GLint y = 0) {
        ImageCall call;
        call.target = GL_TEXTURE_2D;
        call.width = call.height = kSize / 2;
        call.format = GL_RGBA;
        call.type = GL_UNSIGNED_BYTE;
        const TextureFormat& to = *find_texture_format(internal_format);
        return can_copy_on_nodes(c, call, to, stored_bits(to, call.format, call.type), x, y);
    }

    GLuint drawn_ = 0;
};

TEST_F(CopiedTexels, OfTheSameKindAreCopiedByNodes) {
    EXPECT_TRUE(can_copy(GL_RGBA8));
    EXPECT_TRUE(can_copy(GL_RGBA)) << "as eight bits each";
    EXPECT_TRUE(can_copy(GL_RGBA8, kSize / 2, kSize / 2));
}

TEST_F(CopiedTexels, OfAnotherKindAreNot) {
    EXPECT_FALSE(can_copy(GL_RGB5));
    EXPECT_FALSE(can_copy(GL_RED));
    EXPECT_FALSE(can_copy(GL_RGBA16F));
    EXPECT_FALSE(can_copy(GL_SRGB8_ALPHA8));
    EXPECT_FALSE(can_copy(GL_LUMINANCE8));
    EXPECT_FALSE(can_copy(GL_DEPTH_COMPONENT24));
}

TEST_F(CopiedTexels, LeaveAlphaAwayOrHaveNone) {
    EXPECT_TRUE(can_copy(GL_RGB8));
    gl().BindTexture(c, GL_TEXTURE_2D, drawn_);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGB8, kSize, kSize, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
    gl().BindTexture(c, GL_TEXTURE_2D, 0);
    EXPECT_TRUE(can_copy(GL_RGBA8));
    EXPECT_TRUE(can_copy(GL_RGB8));
}

TEST_F(CopiedTexels, OutsideOfTheImageAreNot) {
    EXPECT_FALSE(can_copy(GL_RGBA8, kSize / 2 + 1, 0));
    EXPECT_FALSE(can_copy(GL_RGBA8, 0, -1));
}

TEST_F(CopiedTexels, OfAWindowAreNot) {
    gl().BindFramebuffer(c, GL_FRAMEBUFFER, 0);
    EXPECT_FALSE(can_copy(GL_RGBA8));
}

TEST_F(CopiedTexels, ThatPixelTransferChangesAreNot) {
    gl().PixelTransferf(c, GL_RED_SCALE, 2);
    EXPECT_FALSE(can_copy(GL_RGBA8));
}

TEST_F(CopiedTexels, WhileNothingIsDrawnAreNot) {
    c.set<glstate::el::render_mode>(0, GL_SELECT);
    EXPECT_FALSE(can_copy(GL_RGBA8));
}

TEST_F(CopiedTexels, OntoThemselvesAreNot) {
    gl().BindTexture(c, GL_TEXTURE_2D, drawn_);
    EXPECT_FALSE(can_copy(GL_RGBA8));
}

}  // namespace
}  // namespace wall::client
