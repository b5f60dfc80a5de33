// SPDX-License-Identifier: MIT
// Textures: the table of internal formats against Mesa, what is sent to a node and what is not.
#include "client_lib/objects/texture.h"

#include <array>
#include <limits>

#include "client_lib/context/texture_units.h"
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

void expect_types(const glapi::GlFunctions& gl, const TextureFormat& row, const ComponentBits& bits) {
    const auto expect_type = [&](unsigned size, GLenum pname) {
        EXPECT_EQ(size ? row.component_type : 0, static_cast<GLenum>(level_parameter(gl, pname))) << std::hex << pname;
    };
    expect_type(bits.red, GL_TEXTURE_RED_TYPE);
    expect_type(bits.alpha, GL_TEXTURE_ALPHA_TYPE);
    expect_type(bits.luminance, GL_TEXTURE_LUMINANCE_TYPE);
    expect_type(bits.intensity, GL_TEXTURE_INTENSITY_TYPE);
    expect_type(bits.depth, GL_TEXTURE_DEPTH_TYPE);
}

TEST(TextureFormats, AreDrawnToAsInMesa) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no Mesa here";
    const auto& gl = mesa->gl;
    GLuint name = 0, framebuffer = 0;
    gl.GenTextures(1, &name);
    gl.BindTexture(GL_TEXTURE_2D, name);
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    unsigned compared = 0;
    for (GLint internal = 1; internal < 0x9100; ++internal) {
        const TextureFormat* row = find_texture_format(internal);
        if (!row || row->base == GL_DEPTH_COMPONENT || row->base == GL_DEPTH_STENCIL || row->base == GL_STENCIL_INDEX)
            continue;
        SCOPED_TRACE(testing::Message() << std::hex << internal);
        gl.TexImage2D(GL_TEXTURE_2D, 0, internal, 4, 4, 0, row->whole() ? GL_RGBA_INTEGER : GL_RGBA, GL_UNSIGNED_BYTE,
                      nullptr);
        ASSERT_EQ(gl.GetError(), GLenum{GL_NO_ERROR});
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
        const GLenum expected = row->use == ImageUse::drawn     ? GLenum{GL_FRAMEBUFFER_COMPLETE}
                                : row->use == ImageUse::sampled ? GLenum{GL_FRAMEBUFFER_UNSUPPORTED}
                                                                : GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT};
        EXPECT_EQ(gl.CheckFramebufferStatus(GL_FRAMEBUFFER), expected);
        GLint encoding = 0;
        gl.GetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                                               GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING, &encoding);
        EXPECT_EQ(row->srgb, encoding == GL_SRGB);
        ++compared;
    }
    EXPECT_GT(compared, 150u);
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
                                  {GL_RGBA_INTEGER, GL_INT},
                                  {GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT},
                                  {GL_DEPTH_COMPONENT, GL_UNSIGNED_INT},
                                  {GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8},
                                  {GL_STENCIL_INDEX, GL_UNSIGNED_BYTE},
                                  {GL_DEPTH_COMPONENT, GL_FLOAT}};
    unsigned compared = 0;
    for (GLint internal = 1; internal < 0x9100; ++internal) {
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
            EXPECT_EQ(row->compressed(), level_parameter(gl, GL_TEXTURE_COMPRESSED) != 0);
            expect_types(gl, *row, bits);
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

TEST_F(TextureApiTest, ProgramsHaveAllTargets) {
    for (const auto& info : glapi::kTextureTargetInfo) {
        SCOPED_TRACE(static_cast<unsigned>(info.id));
        const auto name = static_cast<GLuint>(info.id) + 1;
        gl().BindTexture(c, info.target, name);
        EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
        if (info.proxy != 0) {
            gl().BindTexture(c, info.proxy, name);
            EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
        }
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
            const bool fits = dimensions == info.images;
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
        if (info.samples || info.images == 0) continue;  // those have no filters
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

TEST_F(TextureApiTest, ABorderColorOfWholeNumbersIsKeptToTheBit) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    const std::array<GLint, 4> signed_border{-1, std::numeric_limits<GLint>::min(), 7, 0};
    gl().TexParameterIiv(c, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, signed_border.data());
    std::array<GLint, 4> read{};
    gl().GetTexParameterIiv(c, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, read.data());
    EXPECT_EQ(read, signed_border);
    const Texture& texture = *c.share().textures.find(1);
    EXPECT_EQ(sent(texture, 0), Names{"TexBorderWhole"});
    const auto known = texture.stamp;
    const std::array<GLuint, 4> zero{};
    gl().TexParameterIuiv(c, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, zero.data());
    EXPECT_EQ(sent(texture, known), Names{"TexBorderWhole"}) << "minus zero is another number";
    const std::array<GLfloat, 4> real{};
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, real.data());
    EXPECT_EQ(sent(texture, known), Names{"TexParameter"});
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(TextureApiTest, SwizzlesAreFourParameters) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    const std::array<GLfloat, 4> all{GL_ONE, GL_RED, GL_BLUE, GL_ZERO};
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, all.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    std::array<GLint, 4> read{};
    gl().GetTexParameteriv(c, GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, read.data());
    EXPECT_EQ(read, (std::array<GLint, 4>{GL_ONE, GL_RED, GL_BLUE, GL_ZERO}));
    gl().GetTexParameteriv(c, GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_G, read.data());
    EXPECT_EQ(read[0], GL_RED);
    EXPECT_EQ(sent(*c.share().textures.find(1), 0), (Names{"TexParameter", "TexParameter", "TexParameter"}));
    const std::array<GLfloat, 4> bad{GL_RED, GL_RED, GL_RED, GL_LUMINANCE};
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, bad.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(TextureApiTest, ArraysHaveLayers) {
    gl().BindTexture(c, GL_TEXTURE_1D_ARRAY, 1);
    gl().TexImage2D(c, GL_TEXTURE_1D_ARRAY, 0, GL_RGBA8, 8, 3, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl().TexImage2D(c, GL_TEXTURE_1D_ARRAY, 1, GL_RGBA8, 4, 3, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().TexImage2D(c, GL_TEXTURE_1D_ARRAY, 0, GL_RGBA8, 8, 1 << 20, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindTexture(c, GL_TEXTURE_CUBE_MAP_ARRAY, 2);
    gl().TexImage3D(c, GL_TEXTURE_CUBE_MAP_ARRAY, 0, GL_RGBA8, 8, 8, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE}) << "faces come by sixes";
    gl().TexImage3D(c, GL_TEXTURE_CUBE_MAP_ARRAY, 0, GL_RGBA8, 8, 8, 12, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const std::vector<std::byte> blocks(2 * 2 * 8 * 3);
    gl().BindTexture(c, GL_TEXTURE_2D_ARRAY, 3);
    gl().CompressedTexImage3D(c, GL_TEXTURE_2D_ARRAY, 0, GL_COMPRESSED_RED_RGTC1, 8, 8, 3, 0,
                              static_cast<GLsizei>(blocks.size()), blocks.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().BindTexture(c, GL_TEXTURE_3D, 4);
    gl().CompressedTexImage3D(c, GL_TEXTURE_3D, 0, GL_COMPRESSED_RED_RGTC1, 8, 8, 3, 0,
                              static_cast<GLsizei>(blocks.size()), blocks.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(TextureApiTest, VolumesHaveBlocksOfBptcOnly) {
    std::vector<std::byte> blocks(2 * 1 * 16 * 3);
    for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = static_cast<std::byte>(i);
    const auto bytes = static_cast<GLsizei>(blocks.size());
    gl().BindTexture(c, GL_TEXTURE_3D, 1);
    for (const GLenum format : {GL_COMPRESSED_RGBA_BPTC_UNORM, GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM,
                                GL_COMPRESSED_RGB_BPTC_SIGNED_FLOAT, GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT}) {
        gl().CompressedTexImage3D(c, GL_TEXTURE_3D, 0, format, 8, 3, 3, 0, bytes, blocks.data());
        EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
        gl().CompressedTexImage3D(c, GL_TEXTURE_3D, 0, format, 8, 3, 3, 0, bytes / 2, blocks.data());
        EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE}) << "16 bytes a block";
    }
    EXPECT_EQ(sent(*c.share().textures.find(1), 0), Names{"TexCompressed"});
    std::vector<std::byte> read(blocks.size());
    gl().GetCompressedTexImage(c, GL_TEXTURE_3D, 0, read.data());
    EXPECT_EQ(read, blocks);
    gl().TexImage3D(c, GL_TEXTURE_3D, 0, GL_COMPRESSED_RGBA_BPTC_UNORM, 4, 4, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().TexImage3D(c, GL_TEXTURE_3D, 0, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, 4, 4, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                    nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().TexStorage3D(c, GL_TEXTURE_3D, 1, GL_COMPRESSED_RED_RGTC1, 8, 8, 3);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().TexStorage3D(c, GL_TEXTURE_3D, 1, GL_COMPRESSED_RGBA_BPTC_UNORM, 8, 8, 3);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(TextureApiTest, BlocksLieInMemoryAsPixelStoreSays) {
    std::vector<std::byte> memory(4 * 3 * 8);  // three rows of four blocks
    for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = static_cast<std::byte>(i);
    const GLenum format = GL_COMPRESSED_RED_RGTC1;
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().PixelStorei(c, GL_UNPACK_ROW_LENGTH, 16);
    gl().PixelStorei(c, GL_UNPACK_SKIP_PIXELS, 4);
    gl().PixelStorei(c, GL_UNPACK_SKIP_ROWS, 4);
    std::vector<std::byte> read(4 * 8);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, format, 8, 8, 0, 32, memory.data());
    gl().GetCompressedTexImage(c, GL_TEXTURE_2D, 0, read.data());
    EXPECT_EQ(read[31], std::byte{31}) << "without the size of a block they mean nothing";
    gl().PixelStorei(c, GL_UNPACK_COMPRESSED_BLOCK_SIZE, 8);
    gl().PixelStorei(c, GL_UNPACK_COMPRESSED_BLOCK_WIDTH, 4);
    gl().PixelStorei(c, GL_UNPACK_COMPRESSED_BLOCK_HEIGHT, 4);
    gl().PixelStorei(c, GL_UNPACK_COMPRESSED_BLOCK_DEPTH, 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().PixelStorei(c, GL_UNPACK_COMPRESSED_BLOCK_DEPTH, -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    GLint height = 0;
    gl().GetIntegerv(c, GL_UNPACK_COMPRESSED_BLOCK_HEIGHT, &height);
    EXPECT_EQ(height, 4);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, format, 8, 8, 0, 32, memory.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().GetCompressedTexImage(c, GL_TEXTURE_2D, 0, read.data());
    EXPECT_EQ(read.front(), std::byte{40});
    EXPECT_EQ(read[16], std::byte{72});
    gl().CompressedTexSubImage2D(c, GL_TEXTURE_2D, 0, 4, 4, 4, 4, format, 8, memory.data());
    gl().GetCompressedTexImage(c, GL_TEXTURE_2D, 0, read.data());
    EXPECT_EQ(read[24], std::byte{40});
    gl().PixelStorei(c, GL_UNPACK_SKIP_PIXELS, 2);
    gl().CompressedTexSubImage2D(c, GL_TEXTURE_2D, 0, 4, 4, 4, 4, format, 8, memory.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "half a block";
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, format, 8, 8, 0, 32, memory.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().PushClientAttrib(c, GL_CLIENT_PIXEL_STORE_BIT);
    gl().PixelStorei(c, GL_PACK_ROW_LENGTH, 12);
    gl().PixelStorei(c, GL_PACK_SKIP_PIXELS, 4);
    gl().PixelStorei(c, GL_PACK_COMPRESSED_BLOCK_SIZE, 8);
    gl().PixelStorei(c, GL_PACK_COMPRESSED_BLOCK_WIDTH, 4);
    std::vector<std::byte> wide(2 * 3 * 8, std::byte{255});
    gl().GetnCompressedTexImage(c, GL_TEXTURE_2D, 0, 47, wide.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetnCompressedTexImage(c, GL_TEXTURE_2D, 0, 48, wide.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(wide[7], std::byte{255});
    EXPECT_EQ(wide[8], read[0]);
    EXPECT_EQ(wide[24], std::byte{255});
    EXPECT_EQ(wide[32], read[16]);
    gl().PopClientAttrib(c);
    GLint size = -1;
    gl().GetIntegerv(c, GL_PACK_COMPRESSED_BLOCK_SIZE, &size);
    EXPECT_EQ(size, 0);
}

TEST_F(TextureApiTest, WholeNumbersKeepEveryBit) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    const std::array<GLuint, 4> texels{0xffffffff, 0x80000001, 3, 0x01234567};
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_R32UI, 2, 2, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, texels.data());
    const GLushort other = 0xfedc;
    gl().TexSubImage2D(c, GL_TEXTURE_2D, 0, 0, 1, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_SHORT, &other);
    std::array<GLuint, 4> read{};
    gl().GetTexImage(c, GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, read.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(read, (std::array<GLuint, 4>{0xffffffff, 0x80000001, 0xfedc, 0x01234567}));
    std::array<GLubyte, 4> bytes{};
    gl().PixelStorei(c, GL_PACK_ALIGNMENT, 1);
    gl().GetTexImage(c, GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, bytes.data());
    EXPECT_EQ(bytes, (std::array<GLubyte, 4>{255, 255, 255, 255})) << "the nearest that a byte holds";
    gl().GetTexImage(c, GL_TEXTURE_2D, 0, GL_RED, GL_FLOAT, read.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "whole numbers are no fractions";
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_R32UI, 2, 2, 0, GL_RED, GL_FLOAT, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GenerateMipmap(c, GL_TEXTURE_2D);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(TextureApiTest, UnitsOfSamplersOnlyHaveNoFixedFunction) {
    gl().ActiveTexture(c, GL_TEXTURE0 + kTextureCoords);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().BindTexture(c, GL_TEXTURE_2D, 9);
    GLint bound = 0;
    gl().GetIntegerv(c, GL_TEXTURE_BINDING_2D, &bound);
    EXPECT_EQ(bound, 9);
    gl().Enable(c, GL_TEXTURE_2D);
    EXPECT_FALSE(gl().IsEnabled(c, GL_TEXTURE_2D));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const GLfloat linear = GL_OBJECT_LINEAR;
    gl().TexGenfv(c, GL_S, GL_TEXTURE_GEN_MODE, &linear);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().MatrixMode(c, GL_TEXTURE);
    gl().LoadIdentity(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().ActiveTexture(c, GL_TEXTURE0 + kActiveTextures);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(TextureApiTest, TexelsMayHaveSamples) {
    gl().BindTexture(c, GL_TEXTURE_2D_MULTISAMPLE, 1);
    gl().TexImage2DMultisample(c, GL_TEXTURE_2D_MULTISAMPLE, 2, GL_RGBA8, 16, 8, GL_TRUE);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    GLint samples = 0;
    gl().GetTexLevelParameteriv(c, GL_TEXTURE_2D_MULTISAMPLE, 0, GL_TEXTURE_SAMPLES, &samples);
    EXPECT_GE(samples, 2);
    EXPECT_EQ(sent(*c.share().textures.find(1), 0), Names{"TexImageSamples"});
    const GLfloat linear = GL_LINEAR;
    gl().TexParameterfv(c, GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_MAG_FILTER, &linear);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().TexImage2DMultisample(c, GL_TEXTURE_2D_MULTISAMPLE, 0, GL_RGBA8, 16, 8, GL_TRUE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().TexImage2DMultisample(c, GL_TEXTURE_2D_MULTISAMPLE, 1000, GL_RGBA8, 16, 8, GL_TRUE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().TexImage2DMultisample(c, GL_TEXTURE_2D_MULTISAMPLE, 2, GL_COMPRESSED_RGBA, 16, 8, GL_TRUE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(TextureApiTest, StorageIsForGood) {
    gl().TexStorage2D(c, GL_TEXTURE_2D, 1, GL_RGBA8, 8, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "the default texture";
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().TexStorage2D(c, GL_TEXTURE_2D, 1, GL_RGBA, 8, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM}) << "not sized";
    gl().TexStorage2D(c, GL_TEXTURE_2D, 5, GL_RGBA8, 8, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "8, 4, 2, 1 are four";
    gl().TexStorage2D(c, GL_TEXTURE_2D, 4, GL_RGBA8, 8, 4);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const Texture& texture = *c.share().textures.find(1);
    EXPECT_EQ(sent(texture, 0), Names(4, "TexImage"));
    EXPECT_EQ(texture.find_level(0, 3)->width, 1);
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_RGBA8, 8, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    GLint levels = 0;
    gl().GetTexParameteriv(c, GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
    EXPECT_EQ(levels, 4);
    const std::vector<std::byte> texels(2 * 2 * 4);
    gl().TexSubImage2D(c, GL_TEXTURE_2D, 0, 1, 1, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
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
