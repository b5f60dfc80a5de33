// SPDX-License-Identifier: MIT
// Textures whose texels are a buffer's: errors, what is asked about them, and how long they keep the buffer.
#include "client_lib/context/texture_binding.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class TexBufferTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenBuffers(c, 1, &buffer_);
        gl().BindBuffer(c, GL_TEXTURE_BUFFER, buffer_);
        gl().BufferData(c, GL_TEXTURE_BUFFER, 64, nullptr, GL_STATIC_DRAW);
        gl().GenTextures(c, 1, &texture_);
        gl().BindTexture(c, GL_TEXTURE_BUFFER, texture_);
    }
    GLint level_value(GLenum pname) {
        GLint value = -1;
        gl().GetTexLevelParameteriv(c, GL_TEXTURE_BUFFER, 0, pname, &value);
        return value;
    }
    std::shared_ptr<Texture> texture() { return share->textures.find(texture_); }

    GLuint buffer_ = 0, texture_ = 0;
};

TEST_F(TexBufferTest, OnlyFormatsOfBuffersAreTaken) {
    gl().TexBuffer(c, GL_TEXTURE_2D, GL_RGBA8, buffer_);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().TexBuffer(c, GL_TEXTURE_BUFFER, GL_RGB8, buffer_);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().TexBuffer(c, GL_TEXTURE_BUFFER, GL_RGBA8, buffer_ + 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(texture()->part.buffer, nullptr);
    gl().TexBuffer(c, GL_TEXTURE_BUFFER, GL_RG32F, buffer_);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(texture()->part.internal_format, GLenum{GL_RG32F});
}

TEST_F(TexBufferTest, ItSaysWhatItIsMadeOf) {
    EXPECT_EQ(level_value(GL_TEXTURE_BUFFER_DATA_STORE_BINDING), 0);
    EXPECT_EQ(level_value(GL_TEXTURE_WIDTH), 0);
    gl().TexBufferRange(c, GL_TEXTURE_BUFFER, GL_RG32F, buffer_, 16, 24);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(level_value(GL_TEXTURE_BUFFER_DATA_STORE_BINDING), static_cast<GLint>(buffer_));
    EXPECT_EQ(level_value(GL_TEXTURE_BUFFER_OFFSET), 16);
    EXPECT_EQ(level_value(GL_TEXTURE_BUFFER_SIZE), 24);
    EXPECT_EQ(level_value(GL_TEXTURE_WIDTH), 3);
    EXPECT_EQ(level_value(GL_TEXTURE_INTERNAL_FORMAT), GL_RG32F);
    EXPECT_EQ(level_value(GL_TEXTURE_RED_SIZE), 32);
    GLint bound = 0;
    gl().GetIntegerv(c, GL_TEXTURE_BUFFER, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(buffer_)) << "at the target of buffers";
    for (const auto& [offset, bytes] : {std::pair{-1, 8}, {0, 0}, {60, 8}, {65, 1}}) {
        gl().TexBufferRange(c, GL_TEXTURE_BUFFER, GL_R8, buffer_, offset, bytes);
        EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE}) << offset << ' ' << bytes;
    }
}

TEST_F(TexBufferTest, ItKeepsADeletedBufferUntilItGoesItself) {
    gl().TexBuffer(c, GL_TEXTURE_BUFFER, GL_R8, buffer_);
    const ClientName id = texture()->part.buffer->id;
    gl().DeleteBuffers(c, 1, &buffer_);
    ASSERT_NE(texture()->part.buffer, nullptr);
    EXPECT_EQ(texture()->part.size(), 64u);
    EXPECT_TRUE(share->by_id.contains(id));
    gl().DeleteTextures(c, 1, &texture_);
    EXPECT_FALSE(share->by_id.contains(id));
}

TEST_F(TexBufferTest, AnotherBufferLetsTheDeletedOneGo) {
    gl().TexBuffer(c, GL_TEXTURE_BUFFER, GL_R8, buffer_);
    const ClientName id = texture()->part.buffer->id;
    gl().DeleteBuffers(c, 1, &buffer_);
    gl().TexBuffer(c, GL_TEXTURE_BUFFER, GL_R8, 0);
    EXPECT_FALSE(share->by_id.contains(id));
}

TEST_F(TexBufferTest, TheNodeIsToldOfItsPart) {
    gl().TexBufferRange(c, GL_TEXTURE_BUFFER, GL_R32F, buffer_, 16, 8);
    wire::PackBuffer changes;
    texture()->pack_changes(0, changes, no_limit);
    EXPECT_EQ(changes.commands(), 1u);
}

}  // namespace
}  // namespace wall::client
