// SPDX-License-Identifier: MIT
// glCopyImageSubData: texels go over as they are stored; what a client keeps it copies itself; errors are Mesa's.
#include <array>
#include <cstring>
#include <vector>

#include "client_lib/objects/texture.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr GLsizei kSize = 8;

struct At {
    GLint x = 0, y = 0, z = 0;
};

class CopyImageTest : public ContextTest {
protected:
    GLuint texture(GLenum target, GLint format, GLsizei levels = 1) {
        GLuint name = 0;
        gl().GenTextures(c, 1, &name);
        gl().BindTexture(c, target, name);
        const auto internal = static_cast<GLenum>(format);
        if (target == GL_TEXTURE_2D_ARRAY || target == GL_TEXTURE_3D)
            gl().TexStorage3D(c, target, levels, internal, kSize, kSize, 4);
        else if (target == GL_TEXTURE_1D) gl().TexStorage1D(c, target, levels, internal, kSize);
        else gl().TexStorage2D(c, target, levels, internal, kSize, kSize);
        EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
        return name;
    }
    GLuint renderbuffer(GLenum format) {
        GLuint name = 0;
        gl().CreateRenderbuffers(c, 1, &name);
        gl().NamedRenderbufferStorage(c, name, format, kSize, kSize);
        return name;
    }
    /// Bytes that differ, of a size.
    static std::vector<GLubyte> bytes(std::size_t count) {
        std::vector<GLubyte> out(count);
        for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<GLubyte>(7 * i + i / 64);
        return out;
    }
    GLenum copy(GLuint from, GLenum from_target, GLuint to, GLenum to_target, At a = {}, At b = {}, GLsizei width = 4,
                GLsizei height = 4, GLsizei depth = 1, GLint from_level = 0, GLint to_level = 0) {
        gl().CopyImageSubData(c, from, from_target, from_level, a.x, a.y, a.z, to, to_target, to_level, b.x, b.y, b.z,
                              width, height, depth);
        return error();
    }
    std::shared_ptr<Texture> object(GLuint name) { return share->textures.find(name); }
};

TEST_F(CopyImageTest, TexelsAreCopiedAsTheyAreStored) {
    const GLuint from = texture(GL_TEXTURE_2D, GL_RGBA8), to = texture(GL_TEXTURE_2D, GL_R32UI);
    const auto pixels = bytes(4 * kSize * kSize);
    gl().TextureSubImage2D(c, from, 0, 0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {1, 2}, {3, 4}, 3, 2), GLenum{GL_NO_ERROR});
    std::array<GLuint, kSize * kSize> words{};
    gl().GetTextureImage(c, to, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof words, words.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    for (std::size_t y = 0; y < kSize; ++y)
        for (std::size_t x = 0; x < kSize; ++x) {
            GLuint expected = 0;
            const bool copied = x >= 3 && x < 6 && y >= 4 && y < 6;
            if (copied) std::memcpy(&expected, &pixels[4 * ((y - 2) * kSize + x - 2)], 4);
            EXPECT_EQ(words[y * kSize + x], expected) << x << " " << y;
        }
}

TEST_F(CopyImageTest, WhatCameInOtherPixelsIsStoredAsTheFormatSays) {
    const GLuint from = texture(GL_TEXTURE_2D, GL_RG16), to = texture(GL_TEXTURE_2D, GL_RGBA8UI);
    const std::array<GLfloat, 4> blue_first{0, 1, 0, 1};  // red 0, green 1
    gl().ClearTexImage(c, from, 0, GL_BGRA, GL_FLOAT, blue_first.data());
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {}, {}, kSize, kSize), GLenum{GL_NO_ERROR});
    std::array<GLubyte, 4 * kSize * kSize> got{};
    gl().GetTextureImage(c, to, 0, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, sizeof got, got.data());
    EXPECT_EQ((std::array<GLubyte, 4>{got[0], got[1], got[2], got[3]}), (std::array<GLubyte, 4>{0, 0, 255, 255}));
}

TEST_F(CopyImageTest, LayersAreSlicesFacesAndRows) {
    const GLuint array = texture(GL_TEXTURE_2D_ARRAY, GL_R8), cube = texture(GL_TEXTURE_CUBE_MAP, GL_R8UI);
    GLuint rows = 0;
    gl().CreateTextures(c, GL_TEXTURE_1D_ARRAY, 1, &rows);
    gl().TextureStorage2D(c, rows, 1, GL_R8I, kSize, 5);
    const auto pixels = bytes(kSize * kSize * 4);
    gl().TextureSubImage3D(c, array, 0, 0, 0, 0, kSize, kSize, 4, GL_RED, GL_UNSIGNED_BYTE, pixels.data());
    EXPECT_EQ(copy(array, GL_TEXTURE_2D_ARRAY, cube, GL_TEXTURE_CUBE_MAP, {0, 0, 1}, {0, 0, 3}, kSize, kSize, 2),
              GLenum{GL_NO_ERROR});
    std::array<GLubyte, 6 * kSize * kSize> faces{};
    gl().GetTextureImage(c, cube, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, sizeof faces, faces.data());
    constexpr std::size_t kFace = kSize * kSize;
    EXPECT_EQ(0, std::memcmp(&faces[3 * kFace], &pixels[kFace], 2 * kFace));
    EXPECT_EQ(faces[2 * kFace + 5], 0);
    EXPECT_EQ(copy(cube, GL_TEXTURE_CUBE_MAP, rows, GL_TEXTURE_1D_ARRAY, {0, 2, 3}, {0, 0, 1}, kSize, 1, 2),
              GLenum{GL_NO_ERROR});
    std::array<GLbyte, kSize * 5> got{};
    gl().GetTextureImage(c, rows, 0, GL_RED_INTEGER, GL_BYTE, sizeof got, got.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(0, std::memcmp(&got[kSize], &pixels[kFace + 2 * kSize], kSize));
    EXPECT_EQ(0, std::memcmp(&got[2 * kSize], &pixels[2 * kFace + 2 * kSize], kSize));
}

TEST_F(CopyImageTest, BlocksStandForTexelsOfTheirSize) {
    const auto given = bytes(4 * 16);
    GLuint loose = 0;
    gl().GenTextures(c, 1, &loose);
    gl().BindTexture(c, GL_TEXTURE_2D, loose);
    gl().TextureParameteri(c, loose, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, kSize, kSize, 0, 4 * 16,
                              given.data());
    const GLuint texels = texture(GL_TEXTURE_2D, GL_RGBA32UI);
    EXPECT_EQ(copy(loose, GL_TEXTURE_2D, texels, GL_TEXTURE_2D, {4, 0}, {1, 1}, 4, 8), GLenum{GL_NO_ERROR});
    std::vector<GLubyte> got(16 * kSize * kSize);
    gl().GetTextureImage(c, texels, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, static_cast<GLsizei>(got.size()), got.data());
    EXPECT_EQ(0, std::memcmp(&got[16 * (kSize + 1)], &given[16], 16));
    EXPECT_EQ(0, std::memcmp(&got[16 * (2 * kSize + 1)], &given[3 * 16], 16));
    EXPECT_EQ(copy(texels, GL_TEXTURE_2D, loose, GL_TEXTURE_2D, {1, 1}, {0, 4}, 1, 1), GLenum{GL_NO_ERROR});
    const TextureLevel& level = *object(loose)->find_level(0, 0);
    EXPECT_EQ(0, std::memcmp(&level.pixels[2 * 16], &given[16], 16));
    EXPECT_EQ(copy(loose, GL_TEXTURE_2D, texels, GL_TEXTURE_2D, {2, 0}, {0, 0}, 4, 4), GLenum{GL_INVALID_VALUE})
        << "in the middle of a block";
    EXPECT_EQ(copy(texels, GL_TEXTURE_2D, loose, GL_TEXTURE_2D, {0, 0}, {4, 4}, 2, 1), GLenum{GL_INVALID_VALUE})
        << "two blocks are eight texels";
}

TEST_F(CopyImageTest, WhatIsKeptIsCopiedHereAndWhatWasDrawnOnTheNodes) {
    const GLuint from = texture(GL_TEXTURE_2D, GL_RGBA8), to = texture(GL_TEXTURE_2D, GL_RGBA8);
    const GLuint color = renderbuffer(GL_RGBA8);
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D), GLenum{GL_NO_ERROR});
    EXPECT_FALSE(object(to)->is_drawn());
    EXPECT_EQ(copy(color, GL_RENDERBUFFER, to, GL_TEXTURE_2D), GLenum{GL_NO_ERROR});
    EXPECT_TRUE(object(to)->is_drawn());
    EXPECT_FALSE(share->renderbuffers.find(color)->is_drawn());
    EXPECT_EQ(copy(to, GL_TEXTURE_2D, color, GL_RENDERBUFFER), GLenum{GL_NO_ERROR});
    EXPECT_TRUE(share->renderbuffers.find(color)->is_drawn());
    EXPECT_EQ(copy(to, GL_TEXTURE_2D, from, GL_TEXTURE_2D), GLenum{GL_NO_ERROR});
    EXPECT_TRUE(object(from)->is_drawn());
}

TEST_F(CopyImageTest, ErrorsOfNamesTargetsAndLevels) {
    const GLuint from = texture(GL_TEXTURE_2D, GL_RGBA8), to = texture(GL_TEXTURE_2D, GL_RGBA8, 2);
    const GLuint color = renderbuffer(GL_RGBA8);
    EXPECT_EQ(copy(0, GL_TEXTURE_2D, to, GL_TEXTURE_2D), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to + 100, GL_TEXTURE_2D), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_3D, to, GL_TEXTURE_2D), GLenum{GL_INVALID_ENUM}) << "it is another's";
    EXPECT_EQ(copy(from, GL_TEXTURE_BUFFER, to, GL_TEXTURE_2D), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(copy(from, GL_PROXY_TEXTURE_2D, to, GL_TEXTURE_2D), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(copy(from, GL_TEXTURE_CUBE_MAP_POSITIVE_X, to, GL_TEXTURE_2D), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {}, {}, 4, 4, 1, 1), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {}, {}, 4, 4, 1, 0, 1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(copy(color, GL_RENDERBUFFER, to, GL_TEXTURE_2D, {}, {}, 4, 4, 1, 1), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {-1, 0}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {5, 0}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {}, {}, 4, 4, 2), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {}, {}, -1, 4), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, to, GL_TEXTURE_2D, {}, {}, 0, 0, 0), GLenum{GL_NO_ERROR});
}

TEST_F(CopyImageTest, ErrorsOfFormatsAndIncompleteTextures) {
    const GLuint from = texture(GL_TEXTURE_2D, GL_RGBA8), wide = texture(GL_TEXTURE_2D, GL_RGBA16);
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, wide, GL_TEXTURE_2D), GLenum{GL_INVALID_OPERATION});
    const GLuint depth = texture(GL_TEXTURE_2D, GL_DEPTH24_STENCIL8),
                 same = texture(GL_TEXTURE_2D, GL_DEPTH24_STENCIL8);
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, depth, GL_TEXTURE_2D), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(copy(depth, GL_TEXTURE_2D, same, GL_TEXTURE_2D), GLenum{GL_NO_ERROR});
    GLuint samples = 0, loose = 0;
    gl().CreateTextures(c, GL_TEXTURE_2D_MULTISAMPLE, 1, &samples);
    gl().TextureStorage2DMultisample(c, samples, 4, GL_RGBA8, kSize, kSize, GL_TRUE);
    EXPECT_EQ(copy(from, GL_TEXTURE_2D, samples, GL_TEXTURE_2D_MULTISAMPLE), GLenum{GL_INVALID_OPERATION});
    gl().GenTextures(c, 1, &loose);
    gl().BindTexture(c, GL_TEXTURE_2D, loose);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(copy(loose, GL_TEXTURE_2D, from, GL_TEXTURE_2D), GLenum{GL_INVALID_OPERATION}) << "lacks mipmaps";
    gl().TextureParameteri(c, loose, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    EXPECT_EQ(copy(loose, GL_TEXTURE_2D, from, GL_TEXTURE_2D), GLenum{GL_NO_ERROR});
}

TEST_F(CopyImageTest, TheImagingSubsetIsNotOffered) {
    GLubyte out[4] = {};
    gl().GetnColorTable(c, GL_COLOR_TABLE, GL_RGBA, GL_UNSIGNED_BYTE, sizeof out, out);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetnConvolutionFilter(c, GL_CONVOLUTION_1D, GL_RGBA, GL_UNSIGNED_BYTE, sizeof out, out);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetnHistogram(c, GL_HISTOGRAM, GL_FALSE, GL_RGBA, GL_UNSIGNED_BYTE, sizeof out, out);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetnMinmax(c, GL_MINMAX, GL_FALSE, GL_RGBA, GL_UNSIGNED_BYTE, sizeof out, out);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetnSeparableFilter(c, GL_SEPARABLE_2D, GL_RGBA, GL_UNSIGNED_BYTE, 4, out, 4, out, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

}  // namespace
}  // namespace wall::client
