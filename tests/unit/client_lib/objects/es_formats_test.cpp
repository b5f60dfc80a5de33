// SPDX-License-Identifier: MIT
// What OpenGL ES takes as images, draws to and reads from, held against Mesa's own contexts of OpenGL ES.
#include "client_lib/objects/es_formats.h"

#include <gtest/gtest.h>

#include <set>

#include "gen/client_lib/es_images.gen.h"
#include "tests/unit/mesa_context.h"

namespace wall::client {
namespace {

constexpr GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE,
                 kOperation = GL_INVALID_OPERATION;

const TextureFormat& format(GLint internal) { return *find_texture_format(internal); }

/// In a version, times ten.
std::set<GLenum> all_of(unsigned version, GLenum EsImageRow::*member) {
    std::set<GLenum> values;
    for (const EsImageRow& row : kEsImages)
        if (row.first == (version == 11)) values.insert(row.*member);
    return values;
}

class AgainstMesa : public testing::TestWithParam<unsigned> {
protected:
    void SetUp() override {
        mesa_ = GetParam() == 11 ? test::MesaContext::open_es1() : test::MesaContext::open_es();
        if (!mesa_) GTEST_SKIP() << "no Mesa that offers it";
    }
    const glapi::GlFunctions& gl() const { return mesa_->gl; }
    /// A texture of one texel; the error.
    GLenum define(GLenum internal, GLenum pixels, GLenum type) {
        GLuint name = 0;
        gl().GenTextures(1, &name);
        gl().BindTexture(GL_TEXTURE_2D, name);
        gl().TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), 1, 1, 0, pixels, type, nullptr);
        const GLenum error = gl().GetError();
        texture_ = name;
        return error;
    }
    bool is_drawn(GLenum point) {
        GLuint name = 0;
        gl().GenFramebuffers(1, &name);
        gl().BindFramebuffer(GL_FRAMEBUFFER, name);
        gl().FramebufferTexture2D(GL_FRAMEBUFFER, point, GL_TEXTURE_2D, texture_, 0);
        const bool complete = gl().CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
        gl().DeleteFramebuffers(1, &name);
        return complete;
    }
    void forget() { gl().DeleteTextures(1, &texture_); }

private:
    std::unique_ptr<test::MesaContext> mesa_;
    GLuint texture_ = 0;
};

bool is_sized(GLenum internal) {
    const TextureFormat* found = find_texture_format(static_cast<GLint>(internal));
    return found && client::is_sized(*found);
}

/// What Mesa takes besides, by extensions that are not offered here (EXT_texture_type_2_10_10_10_REV) or of its own;
/// and halves by their later number for formats without a size, which it does not take.
bool is_otherwise_on_mesa(GLenum internal, GLenum pixels, GLenum type) {
    if (type == GL_UNSIGNED_INT_2_10_10_10_REV && (pixels == GL_RGB || !is_sized(internal))) return true;
    return internal == GL_BGRA || (type == GL_HALF_FLOAT && !is_sized(internal));
}

TEST_P(AgainstMesa, ImagesAreMadeOfTheSamePixels) {
    const unsigned version = GetParam();
    for (const GLenum internal : all_of(version, &EsImageRow::internal_format))
        for (const GLenum pixels : all_of(version, &EsImageRow::format))
            for (const GLenum type : all_of(version, &EsImageRow::type)) {
                if (is_otherwise_on_mesa(internal, pixels, type)) continue;
                const GLenum mesa = define(internal, pixels, type);
                forget();
                const EsImage ours = es_image(version, static_cast<GLint>(internal), pixels, type);
                EXPECT_EQ(ours.error == kNone, mesa == kNone)
                    << std::hex << internal << " of " << pixels << " " << type << ": " << ours.error << " " << mesa;
            }
}

TEST_P(AgainstMesa, TheSameIsDrawnTo) {
    for (const EsImageRow& row : kEsImages) {
        if (row.first || GetParam() == 11) continue;
        const GLenum base = format(row.desktop_format).base;
        const GLenum point = base == GL_DEPTH_COMPONENT || base == GL_DEPTH_STENCIL ? GL_DEPTH_ATTACHMENT
                             : base == GL_STENCIL_INDEX                             ? GL_STENCIL_ATTACHMENT
                                                                                    : GL_COLOR_ATTACHMENT0;
        if (row.desktop_format == GL_RGB16F) continue;  // EXT_color_buffer_half_float
        if (row.desktop_format == GL_RGB16 || row.desktop_format == GL_RGB16_SNORM)
            continue;  // on Mesa as textures only
        const bool real = row.type == GL_FLOAT || row.type == GL_HALF_FLOAT;
        if (real && !is_sized(row.internal_format)) continue;  // which Mesa does not draw to
        ASSERT_EQ(define(row.internal_format, row.format, row.type), kNone) << std::hex << row.internal_format;
        EXPECT_EQ(es_is_drawn(32, row.desktop_format), is_drawn(point))
            << std::hex << row.internal_format << " of " << row.format << " " << row.type;
        forget();
    }
}

INSTANTIATE_TEST_SUITE_P(Versions, AgainstMesa, testing::Values(11u, 32u));

TEST(EsFormats, TheFirstVersionHasOthers) {
    EXPECT_EQ(es_image(11, GL_RGBA, GL_RGBA, GL_UNSIGNED_BYTE).error, kNone);
    EXPECT_EQ(es_image(11, GL_LUMINANCE8, GL_LUMINANCE, GL_UNSIGNED_BYTE).error, kNone);
    EXPECT_EQ(es_image(11, GL_RGBA, GL_RGBA, GL_FLOAT).error, kOperation);
    EXPECT_EQ(es_image(11, GL_R8, GL_RED, GL_UNSIGNED_BYTE).error, kValue);
    EXPECT_EQ(es_image(30, GL_LUMINANCE8, GL_LUMINANCE, GL_UNSIGNED_BYTE).error, kValue);
    EXPECT_TRUE(es_is_drawn(11, GL_RGBA4));
    EXPECT_FALSE(es_is_drawn(11, GL_R8));
}

TEST(EsFormats, ImagesHaveTheirOwnErrors) {
    EXPECT_EQ(es_image(30, GL_RGBA, GL_RGBA, GL_UNSIGNED_BYTE).error, kNone);
    EXPECT_EQ(es_image(30, GL_RGBA12, GL_RGBA, GL_UNSIGNED_BYTE).error, kValue);
    EXPECT_EQ(es_image(30, GL_RGBA, GL_COLOR_INDEX, GL_UNSIGNED_BYTE).error, kEnum);
    EXPECT_EQ(es_image(30, GL_RGBA, GL_RGBA, GL_DOUBLE).error, kEnum);
    EXPECT_EQ(es_image(30, GL_RGBA, GL_RGB, GL_UNSIGNED_BYTE).error, kOperation);
    EXPECT_EQ(es_image(30, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_RGBA, GL_UNSIGNED_BYTE).error, kNone);
}

TEST(EsFormats, ImagesAreToldAsOpenGlHasThem) {
    EXPECT_EQ(es_image(30, GL_RGBA, GL_RGBA, kHalfFloatOes).internal_format, GL_RGBA16F);
    EXPECT_EQ(es_image(30, GL_RGBA, GL_RGBA, kHalfFloatOes).type, GLenum{GL_HALF_FLOAT});
    EXPECT_EQ(es_image(30, GL_BGRA, GL_BGRA, GL_UNSIGNED_BYTE).internal_format, GL_RGBA);
    EXPECT_EQ(es_image(30, GL_DEPTH_STENCIL, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8).internal_format,
              GL_DEPTH24_STENCIL8);
    EXPECT_EQ(es_image(30, GL_RG8UI, GL_RG_INTEGER, GL_UNSIGNED_BYTE).internal_format, GL_RG8UI);
}

TEST(EsFormats, TexturesAreChangedByWhatTheyAreMadeOf) {
    EXPECT_EQ(es_pixels(30, GL_RGBA32F, GL_RGBA, GL_FLOAT).error, kNone);
    EXPECT_EQ(es_pixels(30, GL_RGBA32F, GL_RGBA, GL_UNSIGNED_BYTE).error, kOperation);
    EXPECT_EQ(es_pixels(30, GL_RGB, GL_RGBA, GL_UNSIGNED_BYTE).error, kOperation);
    EXPECT_EQ(es_pixels(30, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE).error, kNone);
}

TEST(EsFormats, CopiesLackNothingAndConvertNothing) {
    const TextureFormat& bytes = format(GL_RGBA8);
    EXPECT_EQ(es_copy_error(30, GL_RGB, bytes, GL_RGBA), kNone);
    EXPECT_EQ(es_copy_error(30, GL_LUMINANCE, bytes, GL_RGB), kNone);
    EXPECT_EQ(es_copy_error(30, GL_ALPHA, bytes, GL_RGB), kOperation);
    EXPECT_EQ(es_copy_error(30, GL_RGB8, bytes, GL_RGBA), kNone);
    EXPECT_EQ(es_copy_error(30, GL_RGBA4, bytes, GL_RGBA), kOperation) << "of other sizes";
    EXPECT_EQ(es_copy_error(30, GL_SRGB8_ALPHA8, bytes, GL_RGBA), kOperation);
    EXPECT_EQ(es_copy_error(30, GL_RGBA8UI, bytes, GL_RGBA), kOperation);
    EXPECT_EQ(es_copy_error(30, GL_DEPTH_COMPONENT, bytes, GL_RGBA), kOperation);
    EXPECT_EQ(es_copy_error(30, GL_RGBA12, bytes, GL_RGBA), kEnum);
}

TEST(EsFormats, ReadsWhatTheColoursAre) {
    EXPECT_TRUE(es_can_read(GL_RGBA, GL_UNSIGNED_BYTE, format(GL_RGBA8)));
    EXPECT_FALSE(es_can_read(GL_RGBA, GL_FLOAT, format(GL_RGBA8)));
    EXPECT_TRUE(es_can_read(GL_RGBA, GL_FLOAT, format(GL_RGBA16F)));
    EXPECT_TRUE(es_can_read(GL_RGBA, GL_HALF_FLOAT, format(GL_RGBA16F)));
    EXPECT_FALSE(es_can_read(GL_RGBA, GL_HALF_FLOAT, format(GL_RGBA32F)));
    EXPECT_FALSE(es_can_read(GL_RGBA, GL_UNSIGNED_BYTE, format(GL_RGBA16F)));
    EXPECT_TRUE(es_can_read(GL_RGBA_INTEGER, GL_UNSIGNED_INT, format(GL_R8UI)));
    EXPECT_TRUE(es_can_read(GL_RED_INTEGER, GL_UNSIGNED_BYTE, format(GL_R8UI)));
    EXPECT_FALSE(es_can_read(GL_RG_INTEGER, GL_UNSIGNED_BYTE, format(GL_R8UI)));
    EXPECT_TRUE(es_can_read(GL_RG, GL_HALF_FLOAT, format(GL_RG16F)));
    EXPECT_TRUE(es_can_read(GL_RGBA, GL_UNSIGNED_SHORT, format(GL_RGBA16)));
    EXPECT_TRUE(es_can_read(GL_RGBA, GL_UNSIGNED_BYTE, format(GL_RGBA16)));
    EXPECT_TRUE(es_can_read(GL_RGB, GL_UNSIGNED_SHORT_5_6_5, format(GL_RGB565)));
    EXPECT_TRUE(es_can_read(GL_RGBA_INTEGER, GL_UNSIGNED_INT, format(GL_RGB10_A2UI)));
    EXPECT_FALSE(es_can_read(GL_RGBA_INTEGER, GL_INT, format(GL_R8UI)));
    EXPECT_TRUE(es_can_read(GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, format(GL_RGB10_A2)));
    EXPECT_TRUE(es_can_read(GL_BGRA, GL_UNSIGNED_BYTE, format(GL_RGBA8)));
    EXPECT_FALSE(es_can_read(GL_RGB, GL_UNSIGNED_BYTE, format(GL_RGBA8)));
    EXPECT_TRUE(es_can_read(GL_DEPTH_COMPONENT, GL_FLOAT, format(GL_DEPTH_COMPONENT32F)));
    EXPECT_FALSE(es_can_read(GL_DEPTH_COMPONENT, GL_FLOAT, format(GL_DEPTH_COMPONENT24)));
}

}  // namespace
}  // namespace wall::client
