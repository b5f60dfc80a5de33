// SPDX-License-Identifier: MIT
// The table of texture targets against Mesa: GL's words for each, where its bindings are, and which rules it has.
#include "common/glapi/texture_target.h"

#include <gtest/gtest.h>

#include <string>

#include "common/glstate/diff.h"
#include "common/glstate/queries.h"
#include "gen/glstate/texture_elements.gen.h"
#include "tests/unit/mesa_context.h"

namespace wall::glapi {
namespace {

TEST(TextureTarget, WordsAreFound) {
    for (const TextureTargetInfo& info : kTextureTargetInfo) {
        const auto object = find_target_word(info.target);
        ASSERT_TRUE(object);
        EXPECT_TRUE(object->is_object());
        EXPECT_EQ(object->info, &info);
        EXPECT_EQ(&info_of(info.id), &info);
        EXPECT_EQ(object->has_images(), face_count(info) == 1);
        if (info.proxy == 0) continue;
        const auto proxy = find_target_word(info.proxy);
        ASSERT_TRUE(proxy && proxy->is_proxy() && proxy->has_images());
        EXPECT_EQ(proxy->info, &info);
    }
    for (const GLenum word : {GL_NONE, GL_RGBA, GL_TEXTURE_WRAP_S, GL_TEXTURE_BINDING_2D, GL_TEXTURE0})
        EXPECT_FALSE(find_target_word(word)) << word;
}

TEST(TextureTarget, FacesAreWordsOfTheCubeMap) {
    const TextureTargetInfo& cube = info_of(TextureTarget::cube_map);
    ASSERT_EQ(face_count(cube), kCubeFaces);
    constexpr GLenum kFaces[] = {GL_TEXTURE_CUBE_MAP_POSITIVE_X, GL_TEXTURE_CUBE_MAP_NEGATIVE_X,
                                 GL_TEXTURE_CUBE_MAP_POSITIVE_Y, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y,
                                 GL_TEXTURE_CUBE_MAP_POSITIVE_Z, GL_TEXTURE_CUBE_MAP_NEGATIVE_Z};
    for (unsigned face = 0; face < kCubeFaces; ++face) {
        EXPECT_EQ(image_target(cube, face), kFaces[face]);
        const auto found = find_target_word(kFaces[face]);
        ASSERT_TRUE(found && !found->is_object() && !found->is_proxy() && found->has_images());
        EXPECT_EQ(found->info, &cube);
        EXPECT_EQ(found->face, face);
    }
    EXPECT_EQ(image_target(info_of(TextureTarget::t3d), 0), GLenum{GL_TEXTURE_3D});
}

TEST(TextureTarget, ElementsAreThoseOfTheTarget) {
    glstate::State state;
    for (const TextureTargetInfo& info : kTextureTargetInfo) {
        const auto value = static_cast<std::uint32_t>(info.id) + 100;
        glstate::with_binding(info.id, [&]<class E>(E) { EXPECT_TRUE(glstate::assign<E>(state, 3, value)); });
    }
    for (const TextureTargetInfo& info : kTextureTargetInfo) {
        const auto& bound = state.textures.*glstate::kTextureBindings[static_cast<std::size_t>(info.id)];
        EXPECT_EQ(bound[3], static_cast<std::uint32_t>(info.id) + 100);
        EXPECT_EQ(bound[2], 0u);
    }
    const auto enabled = glstate::kTextureSwitches[static_cast<std::size_t>(TextureTarget::rectangle)];
    ASSERT_NE(enabled, nullptr);
    (state.texture_units.*enabled)[1] = 1;
    EXPECT_EQ(glstate::el::texture_rectangle_enabled::ref(state, 1), 1u);
    EXPECT_EQ(glstate::kTextureSwitches[static_cast<std::size_t>(TextureTarget::buffer)], nullptr);
}

class TextureTargetOfMesa : public testing::Test {
protected:
    void SetUp() override {
        mesa_ = test::MesaContext::open();
        if (!mesa_) GTEST_SKIP() << "no Mesa here";
    }
    const GlFunctions& gl() const { return mesa_->gl; }
    GLenum error() const { return gl().GetError(); }

    /// Defines level 0 by the command of as many dimensions.
    GLenum define(GLenum word, unsigned dimensions, GLint width, GLint height, GLint depth, GLint border = 0) {
        if (dimensions == 1) gl().TexImage1D(word, 0, GL_RGBA, width, border, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        else if (dimensions == 2)
            gl().TexImage2D(word, 0, GL_RGBA, width, height, border, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        else gl().TexImage3D(word, 0, GL_RGBA, width, height, depth, border, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        return error();
    }
    /// With a texture bound to it.
    template <class Each>
    void for_each_target(Each&& each) {
        for (const TextureTargetInfo& info : kTextureTargetInfo) {
            SCOPED_TRACE("target " + std::to_string(static_cast<unsigned>(info.id)));
            GLuint name = 0;
            gl().GenTextures(1, &name);
            gl().BindTexture(info.target, name);
            ASSERT_EQ(error(), GLenum{GL_NO_ERROR});
            each(info, name);
            gl().DeleteTextures(1, &name);
        }
    }

private:
    std::unique_ptr<test::MesaContext> mesa_;
};

TEST_F(TextureTargetOfMesa, IsBoundWhereItsElementSays) {
    for_each_target([&](const TextureTargetInfo& info, GLuint name) {
        const auto element = glstate::with_binding(info.id, []<class E>(E) { return E::id; });
        unsigned asked = 0;
        for (const glstate::GetEntry& entry : glstate::kGetEntries) {
            if (entry.id != element) continue;
            GLint bound = 0;
            gl().GetIntegerv(entry.pname, &bound);
            EXPECT_EQ(static_cast<GLuint>(bound), name);
            ++asked;
        }
        EXPECT_EQ(asked, 1u);
    });
}

TEST_F(TextureTargetOfMesa, GetsImagesByTheCommandOfItsDimensions) {
    for_each_target([&](const TextureTargetInfo& info, GLuint) {
        for (unsigned dimensions = 1; dimensions <= 3; ++dimensions) {
            const bool taken = dimensions == info.images;
            for (unsigned face = 0; face < face_count(info); ++face)
                EXPECT_EQ(define(image_target(info, face), dimensions, 4, 4, 6) == GL_NO_ERROR, taken) << dimensions;
            if (info.proxy == 0) continue;
            EXPECT_EQ(define(info.proxy, dimensions, 4, 4, 6) == GL_NO_ERROR, taken) << dimensions;
        }
        if (face_count(info) == 1) return;
        EXPECT_NE(define(info.target, info.images, 4, 4, 1), GLenum{GL_NO_ERROR});
    });
}

TEST_F(TextureTargetOfMesa, HasTheRulesOfItsLine) {
    for_each_target([&](const TextureTargetInfo& info, GLuint) {
        if (info.images == 0) return;
        const GLenum word = image_target(info, 0);
        EXPECT_EQ(define(word, info.images, 4, 4, 6, 1) == GL_NO_ERROR, info.mipmaps) << "border";
        if (info.images > 1) {
            EXPECT_EQ(define(word, info.images, 4, 2, 6) != GL_NO_ERROR, info.square) << "square";
        }
        gl().TexParameteri(info.target, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        EXPECT_EQ(error() == GL_NO_ERROR, info.mipmaps);
        gl().TexParameteri(info.target, GL_TEXTURE_WRAP_S, GL_REPEAT);
        EXPECT_EQ(error() == GL_NO_ERROR, info.repeats);
        GLint filter = 0, wrap = 0;
        GLuint fresh = 0;
        gl().GenTextures(1, &fresh);
        gl().BindTexture(info.target, fresh);
        gl().GetTexParameteriv(info.target, GL_TEXTURE_MIN_FILTER, &filter);
        gl().GetTexParameteriv(info.target, GL_TEXTURE_WRAP_R, &wrap);
        EXPECT_EQ(filter, info.mipmaps ? GL_NEAREST_MIPMAP_LINEAR : GL_LINEAR);
        EXPECT_EQ(wrap, info.repeats ? GL_REPEAT : GL_CLAMP_TO_EDGE);
        gl().DeleteTextures(1, &fresh);
        GLint largest = 0;
        gl().GetIntegerv(info.size_limit, &largest);
        EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
        EXPECT_EQ(define(word, info.images, largest + 1, info.square ? largest + 1 : 4, 6), GLenum{GL_INVALID_VALUE});
    });
}

TEST_F(TextureTargetOfMesa, KeepsLayersFromLevelToLevel) {
    for_each_target([&](const TextureTargetInfo& info, GLuint) {
        if (!info.mipmaps) return;
        const GLint size = 12;  // of a cube map array: two cubes
        for (unsigned face = 0; face < face_count(info); ++face)
            ASSERT_EQ(define(image_target(info, face), info.images, size, size, size), GLenum{GL_NO_ERROR});
        gl().GenerateMipmap(info.target);
        constexpr GLenum kSizes[] = {GL_TEXTURE_WIDTH, GL_TEXTURE_HEIGHT, GL_TEXTURE_DEPTH};
        for (unsigned dimension = 0; dimension < info.images; ++dimension) {
            GLint next = 0;
            gl().GetTexLevelParameteriv(image_target(info, 0), 1, kSizes[dimension], &next);
            EXPECT_EQ(next, info.layers && dimension + 1 == info.images ? size : size / 2) << dimension;
        }
    });
}

}  // namespace
}  // namespace wall::glapi
