// SPDX-License-Identifier: MIT
// Views of textures: they have their origin's texels, through whichever texture these come; parameters are their own;
// what a node is told of them; errors are Mesa's. What textures of stencil values are.
#include "client_lib/objects/texture_view.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "client_lib/context/used_objects.h"
#include "client_lib/objects/texture.h"
#include "common/glapi/decoder.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr GLsizei kSize = 8;

class TextureViewTest : public ContextTest {
protected:
    GLuint array(GLenum format = GL_RGBA8, GLsizei levels = 2, GLsizei layers = 7) {
        GLuint name = 0;
        gl().CreateTextures(c, GL_TEXTURE_2D_ARRAY, 1, &name);
        gl().TextureStorage3D(c, name, levels, format, kSize, kSize, layers);
        EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
        return name;
    }
    GLuint new_name() {
        GLuint name = 0;
        gl().GenTextures(c, 1, &name);
        return name;
    }
    struct Part {
        GLuint first_level = 0, levels = 1, first_layer = 0, layers = 1;
    };
    GLenum try_view(GLuint name, GLuint origin, GLenum target, GLenum format, const Part& part) {
        gl().TextureView(c, name, target, origin, format, part.first_level, part.levels, part.first_layer, part.layers);
        return error();
    }
    GLuint view(GLuint origin, GLenum target, GLenum format, const Part& part) {
        const GLuint name = new_name();
        EXPECT_EQ(try_view(name, origin, target, format, part), GLenum{GL_NO_ERROR});
        return name;
    }
    GLint parameter(GLuint name, GLenum word) {
        GLint value = -99;
        gl().GetTextureParameteriv(c, name, word, &value);
        return value;
    }
    std::shared_ptr<Texture> object(GLuint name) { return share->textures.find(name); }
    /// Names of the commands that a node with what was known at a stamp is sent.
    static std::vector<std::string> told(const Texture& texture, std::uint64_t known = 0) {
        wire::PackBuffer buffer;
        texture.pack_changes(known, buffer, no_limit);
        std::vector<std::string> names;
        const auto opcodes = buffer.opcodes();
        for (auto at = opcodes.rbegin(); at != opcodes.rend(); ++at)
            names.emplace_back(glapi::kOpNames[std::to_integer<std::size_t>(*at)]);
        return names;
    }
};

TEST_F(TextureViewTest, SaysWhichPartItIs) {
    const GLuint origin = array(), shown = view(origin, GL_TEXTURE_2D_ARRAY, GL_RGBA8UI, {1, 9, 2, 9}),
                 again = view(shown, GL_TEXTURE_2D, GL_R32F, {0, 1, 3, 1});
    EXPECT_EQ(parameter(origin, GL_TEXTURE_VIEW_NUM_LEVELS), 2);
    EXPECT_EQ(parameter(origin, GL_TEXTURE_VIEW_NUM_LAYERS), 7);
    EXPECT_EQ(parameter(shown, GL_TEXTURE_VIEW_MIN_LEVEL), 1);
    EXPECT_EQ(parameter(shown, GL_TEXTURE_VIEW_NUM_LEVELS), 1) << "there are no more";
    EXPECT_EQ(parameter(shown, GL_TEXTURE_VIEW_MIN_LAYER), 2);
    EXPECT_EQ(parameter(shown, GL_TEXTURE_VIEW_NUM_LAYERS), 5);
    EXPECT_EQ(parameter(shown, GL_TEXTURE_IMMUTABLE_FORMAT), 1);
    EXPECT_EQ(parameter(shown, GL_TEXTURE_IMMUTABLE_LEVELS), 2) << "of the storage";
    EXPECT_EQ(parameter(again, GL_TEXTURE_VIEW_MIN_LEVEL), 1);
    EXPECT_EQ(parameter(again, GL_TEXTURE_VIEW_MIN_LAYER), 5);
    GLint width = 0, format = 0;
    gl().GetTextureLevelParameteriv(c, again, 0, GL_TEXTURE_WIDTH, &width);
    gl().GetTextureLevelParameteriv(c, again, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    EXPECT_EQ(width, kSize / 2);
    EXPECT_EQ(format, GL_R32F);
    EXPECT_EQ(object(again)->view.origin, object(origin)) << "the one that has the storage";
    EXPECT_EQ(object(origin)->views, 2u);
    gl().TextureParameteri(c, shown, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    EXPECT_EQ(parameter(origin, GL_TEXTURE_MAG_FILTER), GL_LINEAR) << "parameters are a view's own";
}

TEST_F(TextureViewTest, TexelsAreOneWhicheverTextureTheyComeThrough) {
    const GLuint origin = array(), shown = view(origin, GL_TEXTURE_2D, GL_R32UI, {0, 1, 3, 1});
    std::vector<GLubyte> bytes(4 * kSize * kSize * 7);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<GLubyte>(11 * i + i / 256);
    gl().TextureSubImage3D(c, origin, 0, 0, 0, 0, kSize, kSize, 7, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    std::array<GLuint, kSize * kSize> words{};
    gl().GetTextureImage(c, shown, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof words, words.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(0, std::memcmp(words.data(), &bytes[3 * sizeof words], sizeof words));
    const GLuint word = 0x44332211;
    gl().TextureSubImage2D(c, shown, 0, 2, 1, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
    std::vector<GLubyte> got(bytes.size());
    gl().GetTextureImage(c, origin, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(got.size()), got.data());
    std::memcpy(&bytes[3 * sizeof words + 4 * (kSize + 2)], &word, 4);
    EXPECT_EQ(got, bytes);
    EXPECT_TRUE(object(shown)->find_level(0, 0)->changes.empty()) << "the origin keeps it";
}

TEST_F(TextureViewTest, LayersAreFacesOfACube) {
    const GLuint origin = array(GL_R8, 1), cube = view(origin, GL_TEXTURE_CUBE_MAP, GL_R8, {0, 1, 1, 6});
    const GLubyte value = 77;
    gl().BindTexture(c, GL_TEXTURE_CUBE_MAP, cube);
    gl().TexSubImage2D(c, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, 0, 4, 5, 1, 1, GL_RED, GL_UNSIGNED_BYTE, &value);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    std::vector<GLubyte> got(kSize * kSize * 7);
    gl().GetTextureImage(c, origin, 0, GL_RED, GL_UNSIGNED_BYTE, static_cast<GLsizei>(got.size()), got.data());
    EXPECT_EQ(got[4 * kSize * kSize + 5 * kSize + 4], value);
    const GLuint slice = view(cube, GL_TEXTURE_2D, GL_R8UI, {0, 1, 3, 1});
    std::array<GLubyte, kSize * kSize> face{};
    gl().GetTextureImage(c, slice, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, sizeof face, face.data());
    EXPECT_EQ(face[5 * kSize + 4], value);
}

TEST_F(TextureViewTest, BlocksAreSeenAsTheyAre) {
    GLuint origin = 0;
    gl().CreateTextures(c, GL_TEXTURE_2D, 1, &origin);
    gl().TextureStorage2D(c, origin, 1, GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, kSize, kSize);
    object(origin)->level_at(0, 0).compressed = true;  // as after blocks were given
    object(origin)->level_at(0, 0).content = LevelContent::stored;
    object(origin)->level_at(0, 0).pixels.resize(4 * 8);
    const GLuint curved = view(origin, GL_TEXTURE_2D, GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT, {});
    const std::array<GLubyte, 8> block{1, 2, 3, 4, 5, 6, 7, 8};
    gl().CompressedTextureSubImage2D(c, curved, 0, 4, 4, 4, 4, GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT, 8, block.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    std::array<GLubyte, 32> got{};
    gl().GetCompressedTextureImage(c, origin, 0, sizeof got, got.data());
    EXPECT_EQ(0, std::memcmp(&got[24], block.data(), 8));
    got = {};
    gl().GetCompressedTextureImage(c, curved, 0, sizeof got, got.data());
    EXPECT_EQ(0, std::memcmp(&got[24], block.data(), 8));
}

TEST_F(TextureViewTest, NodesGetTheOriginFirst) {
    const GLuint origin = array(), shown = view(origin, GL_TEXTURE_2D, GL_RGBA8, {1, 1, 2, 1});
    gl().TextureParameteri(c, shown, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const auto told_origin = told(*object(origin)), told_view = told(*object(shown));
    ASSERT_FALSE(told_origin.empty());
    EXPECT_EQ(told_origin.front(), "TexStorage");
    EXPECT_EQ(told_view, (std::vector<std::string>{"TexView", "TexParameter"}));
    EXPECT_EQ(object(shown)->rests_on(), object(origin).get());
    gl().BindTexture(c, GL_TEXTURE_2D, shown);
    gl().Enable(c, GL_TEXTURE_2D);
    std::vector<const Object*> used;
    for_each_used(c, [&](const Object& one) { used.push_back(&one); });
    const auto place = [&](GLuint name) { return std::ranges::find(used, object(name).get()) - used.begin(); };
    EXPECT_LT(place(origin), place(shown));
    EXPECT_FALSE(object(origin)->worth_asking());
    const std::uint64_t known = object(origin)->latest();
    const GLuint red = 0xff;
    gl().TextureSubImage2D(c, shown, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &red);
    EXPECT_EQ(told(*object(origin), known), (std::vector<std::string>{"TexSubImage"}));
}

TEST_F(TextureViewTest, WhatIsDrawnThroughAViewTheOriginHas) {
    const GLuint origin = array(), shown = view(origin, GL_TEXTURE_2D, GL_RGBA8, {1, 1, 2, 1});
    object(shown)->note_drawn(0, 0);
    EXPECT_TRUE(object(origin)->is_drawn());
    EXPECT_EQ(object(origin)->find_level(0, 1)->content, LevelContent::drawn);
    EXPECT_EQ(object(origin)->find_level(0, 0)->content, LevelContent::none);
    EXPECT_FALSE(object(shown)->is_drawn()) << "late nodes get it with the origin";
    const GLuint cube = view(array(), GL_TEXTURE_CUBE_MAP, GL_RGBA8, {0, 2, 0, 6});
    gl().GenerateTextureMipmap(c, cube);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(object(cube)->view.origin->find_level(0, 1)->content, LevelContent::drawn);
}

TEST_F(TextureViewTest, TheOriginLivesAsLongAsItsViews) {
    const GLuint origin = array(), shown = view(origin, GL_TEXTURE_2D, GL_RGBA8, {});
    const ClientName id = object(origin)->id;
    gl().DeleteTextures(c, 1, &origin);
    EXPECT_TRUE(share->by_id.contains(id));
    std::array<GLubyte, 4> red{255, 0, 0, 255}, got{};
    gl().TextureSubImage2D(c, shown, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, red.data());
    gl().GetTextureSubImage(c, shown, 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, sizeof got, got.data());
    EXPECT_EQ(got, red);
    gl().DeleteTextures(c, 1, &shown);
    EXPECT_FALSE(share->by_id.contains(id));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(TextureViewTest, Errors) {
    const GLuint origin = array(), name = new_name();
    GLuint loose = 0;
    gl().CreateTextures(c, GL_TEXTURE_2D, 1, &loose);
    EXPECT_EQ(try_view(name, 0, GL_TEXTURE_2D, GL_RGBA8, {}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name, loose, GL_TEXTURE_2D, GL_RGBA8, {}), GLenum{GL_INVALID_OPERATION}) << "no storage";
    EXPECT_EQ(try_view(0, origin, GL_TEXTURE_2D, GL_RGBA8, {}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name + 100, origin, GL_TEXTURE_2D, GL_RGBA8, {}), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(try_view(loose, origin, GL_TEXTURE_2D, GL_RGBA8, {}), GLenum{GL_INVALID_OPERATION}) << "has a target";
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_3D, GL_RGBA8, {}), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_2D, GL_RGBA16, {}), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_2D, GL_RGBA8, {2, 1, 0, 1}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_2D, GL_RGBA8, {0, 1, 7, 1}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_2D, GL_RGBA8, {0, 0, 0, 1}), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_2D, GL_RGBA8, {0, 1, 0, 2}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_CUBE_MAP, GL_RGBA8, {0, 1, 0, 5}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_CUBE_MAP_ARRAY, GL_RGBA8, {0, 1, 0, 7}), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(try_view(name, origin, GL_TEXTURE_CUBE_MAP_ARRAY, GL_RGBA8, {0, 1, 0, 6}), GLenum{GL_NO_ERROR});
    gl().BindTexture(c, GL_TEXTURE_CUBE_MAP_ARRAY, name);
    gl().TexStorage3D(c, GL_TEXTURE_CUBE_MAP_ARRAY, 1, GL_RGBA8, 4, 4, 6);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "it has storage";
}

TEST_F(TextureViewTest, StencilValuesAreTexels) {
    GLuint stencil = 0, both = 0;
    gl().CreateTextures(c, GL_TEXTURE_2D, 1, &stencil);
    gl().TextureStorage2D(c, stencil, 1, GL_STENCIL_INDEX8, 2, 2);
    const std::array<GLubyte, 4> values{1, 20, 255, 7};
    gl().PixelStorei(c, GL_UNPACK_ALIGNMENT, 1);
    gl().PixelStorei(c, GL_PACK_ALIGNMENT, 1);
    gl().TextureSubImage2D(c, stencil, 0, 0, 0, 2, 2, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, values.data());
    const std::array<GLuint, 1> word{9};
    gl().TextureSubImage2D(c, stencil, 0, 1, 1, 1, 1, GL_STENCIL_INDEX, GL_UNSIGNED_INT, word.data());
    std::array<GLushort, 4> got{};
    gl().GetTextureImage(c, stencil, 0, GL_STENCIL_INDEX, GL_UNSIGNED_SHORT, sizeof got, got.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(got, (std::array<GLushort, 4>{1, 20, 255, 9}));
    gl().GetTextureImage(c, stencil, 0, GL_RED, GL_UNSIGNED_SHORT, sizeof got, got.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().CreateTextures(c, GL_TEXTURE_2D, 1, &both);
    gl().TextureStorage2D(c, both, 1, GL_DEPTH24_STENCIL8, 1, 1);
    const GLuint pixel = 0xffffff2a;
    gl().TextureSubImage2D(c, both, 0, 0, 0, 1, 1, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, &pixel);
    GLubyte value = 0;
    gl().GetTextureImage(c, both, 0, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, 1, &value);
    EXPECT_EQ(value, 0x2a);
    EXPECT_EQ(parameter(both, GL_DEPTH_STENCIL_TEXTURE_MODE), GL_DEPTH_COMPONENT);
    gl().TextureParameteri(c, both, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_STENCIL_INDEX);
    EXPECT_EQ(parameter(both, GL_DEPTH_STENCIL_TEXTURE_MODE), GL_STENCIL_INDEX);
    gl().TextureParameteri(c, both, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_RED);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

}  // namespace
}  // namespace wall::client
