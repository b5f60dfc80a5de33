// SPDX-License-Identifier: MIT
// Textures: the table of internal formats against Mesa, what is sent to a node and what is not.
#include "client_lib/objects/texture.h"
#include "client_lib/objects/texture_formats.h"
#include "common/glapi/decoder.h"
#include "common/glstate/queries.h"
#include "gen/glstate/texture_elements.gen.h"
#include "tests/unit/client_lib/context_fixture.h"
#include "tests/unit/mesa_context.h"

namespace wall::client {
namespace {

using glapi::TextureTarget;

GLint level_parameter(const glapi::GlFunctions& gl, GLenum pname) {
    GLint value = -1;
    gl.GetTexLevelParameteriv(GL_TEXTURE_2D, 0, pname, &value);
    return value;
}

TEST(TextureFormats, AreWhatMesaAnswers) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no Mesa here";
    const auto& gl = mesa->gl;
    struct Pixels {
        GLenum format, type;
    };
    constexpr Pixels kPixels[] = {{GL_RGBA, GL_UNSIGNED_BYTE},
                                  {GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
                                  {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4},
                                  {GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1},
                                  {GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV},
                                  {GL_RGBA, GL_FLOAT},
                                  {GL_RGB, GL_UNSIGNED_BYTE_3_3_2},
                                  {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV},
                                  {GL_LUMINANCE, GL_UNSIGNED_BYTE},
                                  {GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT},
                                  {GL_DEPTH_COMPONENT, GL_FLOAT}};
    unsigned compared = 0;
    for (GLint internal = 1; internal < 0x9000; ++internal) {
        const TextureFormat* row = find_texture_format(internal);
        if (!row) continue;
        for (const Pixels& p : kPixels) {
            const std::vector<std::byte> memory(1024);
            gl.TexImage2D(GL_TEXTURE_2D, 0, internal, 4, 4, 0, p.format, p.type, memory.data());
            if (gl.GetError() != GL_NO_ERROR) continue;
            SCOPED_TRACE(testing::Message() << std::hex << internal << ' ' << p.format << ' ' << p.type);
            const ComponentBits bits = stored_bits(*row, p.format, p.type);
            EXPECT_EQ(row->answer, level_parameter(gl, GL_TEXTURE_INTERNAL_FORMAT));
            EXPECT_EQ(bits.red, level_parameter(gl, GL_TEXTURE_RED_SIZE));
            EXPECT_EQ(bits.green, level_parameter(gl, GL_TEXTURE_GREEN_SIZE));
            EXPECT_EQ(bits.blue, level_parameter(gl, GL_TEXTURE_BLUE_SIZE));
            EXPECT_EQ(bits.alpha, level_parameter(gl, GL_TEXTURE_ALPHA_SIZE));
            EXPECT_EQ(bits.luminance, level_parameter(gl, GL_TEXTURE_LUMINANCE_SIZE));
            EXPECT_EQ(bits.intensity, level_parameter(gl, GL_TEXTURE_INTENSITY_SIZE));
            EXPECT_EQ(bits.depth, level_parameter(gl, GL_TEXTURE_DEPTH_SIZE));
            EXPECT_EQ(bits.stencil, level_parameter(gl, GL_TEXTURE_STENCIL_SIZE));
            EXPECT_EQ(row->compressed, level_parameter(gl, GL_TEXTURE_COMPRESSED) != 0);
            ++compared;
        }
    }
    EXPECT_GT(compared, 500u);
}

/// Names of the commands in a buffer.
std::vector<std::string> commands(const wire::PackBuffer& buffer) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < buffer.commands(); ++i)
        names.emplace_back(glapi::kOpNames[std::to_integer<std::size_t>(buffer.opcode_at(i))]);
    return names;
}

std::vector<std::string> sent(const Texture& texture, std::uint64_t known) {
    wire::PackBuffer buffer;
    texture.pack_changes(known, buffer, no_limit);
    return commands(buffer);
}

void define(Texture& texture, GLint number, std::int32_t size) {
    TextureLevel& level = texture.level_at(0, number);
    level = {};
    level.internal_format = GL_RGBA8;
    level.width = level.height = size;
    level.depth = 1;
    level.format = level.data_format = GL_RGBA;
    level.type = level.data_type = GL_UNSIGNED_BYTE;
    level.content = LevelContent::stored;
    level.pixels.resize(static_cast<std::size_t>(size * size * 4));
    texture.stamp = level.stamp = next_stamp();
}

using Names = std::vector<std::string>;

TEST(Texture, ANodeGetsOnlyWhatItLacks) {
    Texture texture(ClientName(1), 1, TextureTarget::t2d);
    EXPECT_EQ(sent(texture, 0), Names{"TexParameter"});  // so that the name exists
    define(texture, 0, 8);
    EXPECT_EQ(sent(texture, 0), Names{"TexImage"});
    const auto known = texture.stamp;
    EXPECT_EQ(sent(texture, known), Names{});
    texture.level_at(0, 0).note_change({2, 2, 0, 3, 3, 1, texture.stamp = next_stamp()});
    EXPECT_EQ(sent(texture, known), Names{"TexSubImage"});
    EXPECT_EQ(sent(texture, 0), Names{"TexImage"});
    texture.parameters.wrap_s = GL_CLAMP;
    texture.parameter_changed(GL_TEXTURE_WRAP_S);
    EXPECT_EQ(sent(texture, known), (Names{"TexParameter", "TexSubImage"}));
}

TEST(Texture, AChangedRectangleIsCutOut) {
    Texture texture(ClientName(1), 1, TextureTarget::t2d);
    define(texture, 0, 8);
    TextureLevel& level = texture.level_at(0, 0);
    for (std::size_t i = 0; i < level.pixels.size(); ++i) level.pixels[i] = static_cast<std::byte>(i);
    const auto known = texture.stamp;
    level.note_change({2, 3, 0, 1, 2, 1, next_stamp()});
    wire::PackBuffer buffer;
    texture.pack_changes(known, buffer, no_limit);
    const auto operands = buffer.operands();
    ASSERT_GE(operands.size(), 8u);
    const std::vector<std::byte> tail(operands.end() - 8, operands.end());
    const std::size_t first = (3 * 8 + 2) * 4, second = (4 * 8 + 2) * 4;
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(tail[k], static_cast<std::byte>(first + k));
        EXPECT_EQ(tail[4 + k], static_cast<std::byte>(second + k));
    }
}

TEST(Texture, ManyChangesAreMerged) {
    Texture texture(ClientName(1), 1, TextureTarget::t2d);
    define(texture, 0, 64);
    const auto known = texture.stamp;
    for (int i = 0; i < 60; ++i) texture.level_at(0, 0).note_change({i, i, 0, 1, 1, 1, next_stamp()});
    EXPECT_LE(sent(texture, known).size(), 16u);
    texture.level_at(0, 0).note_change({0, 0, 0, 64, 64, 1, next_stamp()});
    EXPECT_EQ(sent(texture, known).size(), 1u);
}

TEST(Texture, LargeImagesTravelInPieces) {
    Texture texture(ClientName(1), 1, TextureTarget::t2d);
    define(texture, 0, 3000);
    wire::PackBuffer buffer;
    std::size_t largest = 0, commands = 0;
    texture.pack_changes(0, buffer, [&] {
        largest = std::max(largest, buffer.bytes());
        ++commands;
        buffer.clear();
    });
    EXPECT_EQ(commands, 1u + 3u);  // defined empty, then 36 MB in pieces of at most 16
    EXPECT_LE(largest, kLargestImageCommand + 256);
}

TEST(Texture, MipmapsAreMadeByTheNode) {
    Texture texture(ClientName(1), 1, TextureTarget::t2d);
    texture.parameters.generate_mipmap = true;
    define(texture, 0, 8);
    texture.mipmaps_generated();
    ASSERT_NE(texture.find_level(0, 3), nullptr);
    EXPECT_EQ(texture.find_level(0, 3)->width, 1);
    EXPECT_EQ(texture.find_level(0, 4), nullptr);
    EXPECT_EQ(sent(texture, 0), (Names{"TexImage", "TexMipmaps"}));
    define(texture, 1, 4);  // replaced by the application: comes after the generation
    EXPECT_EQ(sent(texture, 0), (Names{"TexImage", "TexMipmaps", "TexImage"}));
    const std::uint64_t known = texture.latest();
    texture.mipmaps_generated();
    EXPECT_EQ(sent(texture, known), Names{"TexMipmaps"}) << "of the base that the node has";
}

TEST(Texture, MipmapsKeepTheLayers) {
    for (const TextureTarget target : {TextureTarget::t3d, TextureTarget::t2d_array, TextureTarget::t1d_array}) {
        Texture texture(ClientName(1), 1, target);
        define(texture, 0, 8);
        texture.level_at(0, 0).depth = texture.info.images == 3 ? 6 : 1;
        texture.mipmaps_generated();
        const TextureLevel* level = texture.find_level(0, 3);
        ASSERT_NE(level, nullptr);
        EXPECT_EQ(level->width, 1);
        EXPECT_EQ(level->height, target == TextureTarget::t1d_array ? 8 : 1);
        EXPECT_EQ(level->depth, target == TextureTarget::t2d_array ? 6 : 1);
        EXPECT_EQ(texture.find_level(0, 4), nullptr);
    }
}

class TextureApiTest : public ContextTest {
protected:
    static GLenum binding_of(const glapi::TextureTargetInfo& info) {
        const auto element = glstate::with_binding(info.id, []<class E>(E) { return E::id; });
        const auto entry = std::ranges::find(glstate::kGetEntries, element, &glstate::GetEntry::id);
        return entry->pname;
    }
};

TEST_F(TextureApiTest, NamesAreMesas) {
    GLuint names[3];
    gl().GenTextures(c, 3, names);
    EXPECT_EQ(names[0], 1u);
    EXPECT_EQ(names[2], 3u);
    EXPECT_FALSE(gl().IsTexture(c, names[0]));
    gl().BindTexture(c, GL_TEXTURE_2D, names[0]);
    EXPECT_TRUE(gl().IsTexture(c, names[0]));
    gl().BindTexture(c, GL_TEXTURE_2D, 77);
    GLuint next;
    gl().GenTextures(c, 1, &next);
    EXPECT_EQ(next, 78u);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(TextureApiTest, Errors) {
    gl().BindTexture(c, GL_TEXTURE_2D, 5);
    gl().BindTexture(c, GL_TEXTURE_1D, 5);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindTexture(c, GL_RGBA, 5);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().GenTextures(c, -1, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    const GLfloat bad = 3;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, &bad);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    const GLfloat negative = -1;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, &negative);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(TextureApiTest, ProgramsHaveTheTargetsThatAreNotForLater) {
    for (const auto& info : glapi::kTextureTargetInfo) {
        SCOPED_TRACE(static_cast<unsigned>(info.id));
        const auto name = static_cast<GLuint>(info.id) + 1;
        gl().BindTexture(c, info.target, name);
        EXPECT_EQ(error(), info.later ? GLenum{GL_INVALID_ENUM} : GLenum{GL_NO_ERROR});
        if (info.proxy != 0) {
            gl().BindTexture(c, info.proxy, name);
            EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
        }
        if (info.later) continue;
        GLint bound = 0;
        gl().GetIntegerv(c, binding_of(info), &bound);
        EXPECT_EQ(static_cast<GLuint>(bound), name);
        if (info.global == 0) continue;
        gl().BindTexture(c, info.global, name + 100);
        EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
        gl().GetIntegerv(c, binding_of(info), &bound);
        EXPECT_EQ(static_cast<GLuint>(bound), name + 100);
        EXPECT_TRUE(c.share().textures.find(name + 100)->global);
    }
}

TEST_F(TextureApiTest, ImagesOfOtherDimensionsAreRefused) {
    const auto define = [&](GLenum word, unsigned dimensions) {
        if (dimensions == 1) gl().TexImage1D(c, word, 0, GL_RGBA, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        else if (dimensions == 2) gl().TexImage2D(c, word, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        else gl().TexImage3D(c, word, 0, GL_RGBA, 4, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        return error();
    };
    for (const auto& info : glapi::kTextureTargetInfo)
        for (unsigned dimensions = 1; dimensions <= 3; ++dimensions) {
            SCOPED_TRACE(testing::Message() << static_cast<unsigned>(info.id) << ' ' << dimensions);
            const bool fits = !info.later && dimensions == info.images;
            for (unsigned face = 0; !fits && face < glapi::face_count(info); ++face)
                EXPECT_EQ(define(glapi::image_target(info, face), dimensions), GLenum{GL_INVALID_ENUM});
            if (!fits && info.proxy != 0) {
                EXPECT_EQ(define(info.proxy, dimensions), GLenum{GL_INVALID_ENUM});
            }
            if (glapi::face_count(info) > 1) {
                EXPECT_EQ(define(info.target, dimensions), GLenum{GL_INVALID_ENUM});
            }
        }
}

TEST_F(TextureApiTest, ParametersGoByTheTargetsRules) {
    const auto value_of = [&](GLenum target, GLenum pname) {
        GLint value = 0;
        gl().GetTexParameteriv(c, target, pname, &value);
        return value;
    };
    const GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM;
    for (const auto& info : glapi::kTextureTargetInfo) {
        if (info.later) continue;
        SCOPED_TRACE(static_cast<unsigned>(info.id));
        EXPECT_EQ(value_of(info.target, GL_TEXTURE_MIN_FILTER), info.mipmaps ? GL_NEAREST_MIPMAP_LINEAR : GL_LINEAR);
        EXPECT_EQ(value_of(info.target, GL_TEXTURE_WRAP_R), info.repeats ? GL_REPEAT : GL_CLAMP_TO_EDGE);
        const GLfloat mipmapped = GL_LINEAR_MIPMAP_LINEAR, mirrored = GL_MIRRORED_REPEAT;
        gl().TexParameterfv(c, info.target, GL_TEXTURE_MIN_FILTER, &mipmapped);
        EXPECT_EQ(error(), info.mipmaps ? kNone : kEnum);
        gl().TexParameterfv(c, info.target, GL_TEXTURE_WRAP_S, &mirrored);
        EXPECT_EQ(error(), info.repeats ? kNone : kEnum);
        gl().GenerateMipmap(c, info.target);  // of no image
        EXPECT_EQ(error(), info.mipmaps ? GLenum{GL_INVALID_OPERATION} : kEnum);
    }
}

TEST_F(TextureApiTest, AttributeStackKeepsParameters) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    const GLfloat clamp = GL_CLAMP, repeat = GL_REPEAT;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &clamp);
    gl().PushAttrib(c, GL_TEXTURE_BIT);
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &repeat);
    gl().PopAttrib(c);
    GLint wrap = 0;
    gl().GetTexParameteriv(c, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &wrap);
    EXPECT_EQ(wrap, GL_CLAMP);
}

}  // namespace
}  // namespace wall::client
