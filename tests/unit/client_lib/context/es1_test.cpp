// SPDX-License-Identifier: MIT
// Contexts of OpenGL ES 1.1: fixed function out of numbers of fixed point, and no shaders. The answers are Mesa's.
#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "client_lib/context/core.h"
#include "client_lib/context/es_version.h"
#include "client_lib/context/es_words.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE,
                 kOperation = GL_INVALID_OPERATION;
constexpr GLfixed kOne = 65536, kHalf = kOne / 2;

class Es1Context : public testing::Test {
protected:
    void SetUp() override {
        tls_context = &c;
        tls_packer = &c.packer;
    }
    void TearDown() override {
        tls_context = nullptr;
        tls_packer = nullptr;
    }
    const GlTable& gl() const { return *c.table; }
    GLenum error() { return c.take_error(); }
    /// A command by its name, as programs call it.
    template <class... Given>
    void call(const char* name, Given... given) {
        reinterpret_cast<void (*)(Given...)>(gl_proc_address(name))(given...);
    }
    GLfixed fixed(GLenum word) {
        GLfixed out[16] = {-1};
        gl().GetFixedv(c, word, out);
        return out[0];
    }
    GLint number(GLenum word) {
        GLint out[16] = {-1};
        gl().GetIntegerv(c, word, out);
        return out[0];
    }
    /// The error of an image of 4x4 texels.
    GLenum image_error(GLint internal, GLenum format, GLenum type) {
        gl().TexImage2D(c, GL_TEXTURE_2D, 0, internal, 4, 4, 0, format, type, nullptr);
        return error();
    }

    Context c{std::make_shared<ShareGroup>(), {.es = 11}};
};

std::string text(const GLubyte* given) { return given ? reinterpret_cast<const char*>(given) : ""; }

TEST_F(Es1Context, SaysWhatItIs) {
    EXPECT_TRUE(text(gl().GetString(c, GL_VERSION)).starts_with("OpenGL ES-CM 1.1 "));
    const std::string words = text(gl().GetString(c, GL_EXTENSIONS));
    for (const char* word : {"GL_OES_fixed_point", "GL_OES_draw_texture", "GL_OES_query_matrix", "GL_KHR_debug"})
        EXPECT_NE(words.find(word), words.npos) << word;
    for (const char* word : {"GL_ARB_", "GL_OES_standard_derivatives", "GL_EXT_frag_depth"})
        EXPECT_EQ(words.find(word), words.npos) << word;
    gl().GetString(c, GL_SHADING_LANGUAGE_VERSION);
    EXPECT_EQ(error(), kEnum);
}

TEST(Es1Versions, AreAskedForByEitherNumber) {
    EXPECT_EQ(es_version_for(1, 0), 11u);
    EXPECT_EQ(es_version_for(1, 1), 11u);
    EXPECT_EQ(es_version_for(1, 2), 0u);
    EXPECT_TRUE(offers_es(1));
}

TEST(Es1Words, AreOthersThanThoseOfLaterVersions) {
    EXPECT_TRUE(is_es_word(11, GL_MODELVIEW));
    EXPECT_FALSE(is_es_word(20, GL_MODELVIEW));
    EXPECT_FALSE(is_es_word(11, GL_VERTEX_SHADER));
    EXPECT_FALSE(is_es_word(11, GL_QUADS));
    EXPECT_FALSE(is_es_word(11, GL_STREAM_DRAW));
    EXPECT_TRUE(is_es_word(11, GL_FRAMEBUFFER)) << "an extension's";
}

TEST_F(Es1Context, HasFixedFunctionAndNothingElse) {
    EXPECT_TRUE(c.profile.has_fixed_function());
    EXPECT_FALSE(c.profile.has_begin());
    gl().MatrixMode(c, GL_PROJECTION);
    gl().Enable(c, GL_LIGHTING);
    gl().Enable(c, GL_LIGHT7);
    gl().Enable(c, GL_TEXTURE_2D);
    gl().ShadeModel(c, GL_FLAT);
    EXPECT_EQ(error(), kNone);
    gl().Begin(c, GL_TRIANGLES);
    EXPECT_EQ(error(), kOperation);
    gl().NewList(c, 1, GL_COMPILE);
    EXPECT_EQ(error(), kOperation);
    gl().CreateShader(c, GL_VERTEX_SHADER);
    EXPECT_EQ(error(), kOperation);
    gl().VertexAttribPointer(c, 0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), kOperation);
    gl().PolygonMode(c, GL_FRONT_AND_BACK, GL_LINE);
    EXPECT_EQ(error(), kOperation);
}

TEST_F(Es1Context, HasNoDesktopWords) {
    for (const GLenum word : {GL_TEXTURE_1D, GL_TEXTURE_GEN_S, GL_LINE_STIPPLE, GL_FRAMEBUFFER_SRGB, GL_AUTO_NORMAL}) {
        gl().Enable(c, word);
        EXPECT_EQ(error(), kEnum) << std::hex << word;
    }
    gl().DrawArrays(c, GL_QUADS, 0, 4);
    EXPECT_EQ(error(), kEnum);
    gl().MatrixMode(c, GL_COLOR);
    EXPECT_EQ(error(), kEnum);
    gl().Clear(c, GL_ACCUM_BUFFER_BIT);
    EXPECT_EQ(error(), kValue);
    const GLfloat on = 1;
    gl().LightModelfv(c, GL_LIGHT_MODEL_LOCAL_VIEWER, &on);
    EXPECT_EQ(error(), kEnum);
    gl().GetIntegerv(c, GL_MAX_VERTEX_ATTRIBS, nullptr);
    EXPECT_EQ(error(), kEnum);
    const GLfloat clamp = GL_CLAMP;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &clamp);
    EXPECT_EQ(error(), kEnum);
}

TEST_F(Es1Context, TakesNumbersOfFixedPoint) {
    call("glClearColorx", kHalf, kOne, 2 * kOne, GLfixed{0});
    EXPECT_EQ(c.state.color_buffer.clear_color, (glstate::Vec4{0.5f, 1, 2, 0}));
    call("glPointSizex", 3 * kOne);
    EXPECT_EQ(fixed(GL_POINT_SIZE), 3 * kOne);
    call("glDepthRangex", kHalf, kOne);
    EXPECT_EQ(c.state.transform.depth_range.near_value, 0.5);
    call("glAlphaFuncx", GLenum{GL_LESS}, kHalf);
    EXPECT_EQ(fixed(GL_ALPHA_TEST_REF), kHalf);
    call("glColor4x", kOne, kHalf, GLfixed{0}, kOne);
    EXPECT_EQ(fixed(GL_CURRENT_COLOR), kOne);
    EXPECT_EQ(c.state.current.color[1], 0.5f);
    call("glTranslatex", kOne, kHalf, -kOne);
    EXPECT_EQ(c.state.matrix.modelview[13], 0.5f);
    call("glSampleCoveragex", kHalf, GLboolean{GL_TRUE});
    EXPECT_EQ(fixed(GL_SAMPLE_COVERAGE_VALUE), kHalf);
    call("glPointSizex", GLfixed{0});
    EXPECT_EQ(error(), kValue);
    call("glFrustumx", GLfixed{0}, kOne, GLfixed{0}, kOne, GLfixed{0}, kOne);
    EXPECT_EQ(error(), kValue);
}

TEST_F(Es1Context, AnswersAllInFixedPoint) {
    EXPECT_EQ(fixed(GL_MATRIX_MODE), GLfixed{GL_MODELVIEW} * kOne) << "words as well";
    EXPECT_EQ(fixed(GL_MAX_LIGHTS), 8 * kOne);
    EXPECT_EQ(fixed(GL_DITHER), kOne);
    EXPECT_EQ(fixed(GL_STENCIL_WRITEMASK), 255 * kOne);
    EXPECT_EQ(fixed(GL_COMPRESSED_TEXTURE_FORMATS), std::numeric_limits<GLfixed>::max()) << "a word with too many bits";
    EXPECT_EQ(fixed(GL_MAX_VERTEX_ATTRIBS), -1);
    EXPECT_EQ(error(), kEnum);
}

TEST_F(Es1Context, TakesWordsAsTheyAreAndParametersOfFixedPoint) {
    call("glFogx", GLenum{GL_FOG_MODE}, GLfixed{GL_LINEAR});
    EXPECT_EQ(c.state.fog.fog_mode, GLenum{GL_LINEAR});
    call("glFogx", GLenum{GL_FOG_DENSITY}, kHalf);
    EXPECT_EQ(c.state.fog.fog_density, 0.5f);
    call("glFogx", GLenum{GL_FOG_DENSITY}, GLfixed{-1});
    EXPECT_EQ(error(), kValue);
    const GLfixed color[4] = {kHalf, 0, kOne, kOne};
    call("glFogxv", GLenum{GL_FOG_COLOR}, color);
    EXPECT_EQ(c.state.fog.fog_color, (glstate::Vec4{0.5f, 0, 1, 1}));
    call("glLightModelx", GLenum{GL_LIGHT_MODEL_TWO_SIDE}, GLfixed{1});
    EXPECT_TRUE(c.state.lights.light_model_two_side);
    call("glTexEnvx", GLenum{GL_TEXTURE_ENV}, GLenum{GL_TEXTURE_ENV_MODE}, GLfixed{GL_DECAL});
    call("glTexEnvx", GLenum{GL_TEXTURE_ENV}, GLenum{GL_RGB_SCALE}, 2 * kOne);
    EXPECT_EQ(error(), kNone);
    call("glTexEnvx", GLenum{GL_TEXTURE_ENV}, GLenum{GL_RGB_SCALE}, GLfixed{2});
    EXPECT_EQ(error(), kValue);
    GLfixed got[4] = {};
    gl().GetTexEnvxv(c, GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, got);
    EXPECT_EQ(got[0], GL_DECAL);
    gl().GetTexEnvxv(c, GL_TEXTURE_ENV, GL_RGB_SCALE, got);
    EXPECT_EQ(got[0], 2 * kOne);
    gl().GetLightxv(c, GL_LIGHT0, GL_SPOT_CUTOFF, got);
    EXPECT_EQ(got[0], 180 * kOne);
    call("glTexParameterx", GLenum{GL_TEXTURE_2D}, GLenum{GL_TEXTURE_MIN_FILTER}, GLfixed{GL_LINEAR});
    gl().GetTexParameterxv(c, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, got);
    EXPECT_EQ(got[0], GL_LINEAR);
    call("glTexEnvx", GLenum{GL_TEXTURE_ENV}, GLenum{GL_TEXTURE_ENV_COLOR}, kOne);
    EXPECT_EQ(error(), kEnum) << "it has four values";
    got[0] = 7;
    gl().GetLightxv(c, GL_LIGHT0, GL_SHININESS, got);
    EXPECT_EQ(error(), kEnum);
    EXPECT_EQ(got[0], 7);
}

TEST_F(Es1Context, HasMaterialsOfBothSides) {
    const GLfloat half[4] = {0.5f, 0.5f, 0.5f, 0.5f};
    gl().Materialfv(c, GL_FRONT, GL_AMBIENT, half);
    EXPECT_EQ(error(), kEnum);
    gl().Materialfv(c, GL_FRONT_AND_BACK, GL_AMBIENT, half);
    call("glMaterialx", GLenum{GL_FRONT_AND_BACK}, GLenum{GL_SHININESS}, 5 * kOne);
    GLfixed got[4] = {};
    gl().GetMaterialxv(c, GL_BACK, GL_AMBIENT, got);
    EXPECT_EQ(got[3], kHalf);
    gl().GetMaterialxv(c, GL_FRONT, GL_SHININESS, got);
    EXPECT_EQ(got[0], 5 * kOne);
    EXPECT_EQ(error(), kNone);
}

TEST_F(Es1Context, HasClipPlanesOfSingleNumbers) {
    const GLfloat plane[4] = {1, 2, 3, 4.5f};
    gl().ClipPlanef(c, GL_CLIP_PLANE0, plane);
    GLfixed got[4] = {};
    gl().GetClipPlanex(c, GL_CLIP_PLANE0, got);
    EXPECT_EQ(got[3], 4 * kOne + kHalf);
    gl().ClipPlanex(c, GL_CLIP_PLANE1, got);
    GLfloat back[4] = {};
    gl().GetClipPlanef(c, GL_CLIP_PLANE1, back);
    EXPECT_TRUE(std::ranges::equal(back, plane));
    gl().GetClipPlanef(c, GL_CLIP_PLANE0 + 8, back);
    EXPECT_EQ(error(), kEnum);
    EXPECT_TRUE(std::ranges::equal(back, plane));
}

TEST_F(Es1Context, TellsMatricesAsMantissasAndExponents) {
    std::array<GLfloat, 16> matrix{1};
    matrix[12] = 1.5f, matrix[13] = -3, matrix[14] = std::numeric_limits<float>::infinity();
    gl().LoadMatrixf(c, matrix.data());
    GLfixed mantissa[16];
    GLint exponent[16];
    EXPECT_EQ(gl().QueryMatrixxOES(c, mantissa, exponent), 1u << 14);
    EXPECT_EQ(mantissa[0], kHalf);
    EXPECT_EQ(exponent[0], 1);
    EXPECT_EQ(mantissa[12], 49152);
    EXPECT_EQ(mantissa[13], -49152);
    EXPECT_EQ(exponent[13], 2);
    EXPECT_EQ(mantissa[1], 0);
}

TEST_F(Es1Context, LoadsMatricesOfFixedPoint) {
    GLfixed m[16];
    for (GLfixed i = 0; i < 16; ++i) m[i] = i * kHalf;
    gl().LoadMatrixx(c, m);
    EXPECT_EQ(c.state.matrix.modelview[3], 1.5f);
    const GLfixed twice[16] = {2 * kOne, 0, 0, 0, 0, 2 * kOne, 0, 0, 0, 0, 2 * kOne, 0, 0, 0, 0, 2 * kOne};
    gl().MultMatrixx(c, twice);
    EXPECT_EQ(c.state.matrix.modelview[3], 3);
}

TEST_F(Es1Context, TakesArraysOfItsTypes) {
    gl().VertexPointer(c, 2, GL_BYTE, 0, nullptr);
    gl().VertexPointer(c, 3, GL_FIXED, 0, nullptr);
    gl().NormalPointer(c, GL_FIXED, 0, nullptr);
    gl().ColorPointer(c, 4, GL_UNSIGNED_BYTE, 0, nullptr);
    gl().TexCoordPointer(c, 2, GL_BYTE, 0, nullptr);
    gl().PointSizePointerOES(c, GL_FIXED, 0, nullptr);
    gl().EnableClientState(c, GL_POINT_SIZE_ARRAY_OES);
    EXPECT_TRUE(gl().IsEnabled(c, GL_POINT_SIZE_ARRAY_OES));
    EXPECT_EQ(number(GL_POINT_SIZE_ARRAY_TYPE_OES), GL_FIXED);
    EXPECT_EQ(error(), kNone);
    gl().VertexPointer(c, 2, GL_INT, 0, nullptr);
    EXPECT_EQ(error(), kEnum);
    gl().VertexPointer(c, 1, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), kValue);
    gl().ColorPointer(c, 3, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), kValue);
    gl().ColorPointer(c, 4, GL_SHORT, 0, nullptr);
    EXPECT_EQ(error(), kEnum);
    gl().TexCoordPointer(c, 1, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), kValue);
    gl().PointSizePointerOES(c, GL_SHORT, 0, nullptr);
    EXPECT_EQ(error(), kEnum);
    Context desktop(std::make_shared<ShareGroup>());
    desktop.table->EnableClientState(desktop, GL_POINT_SIZE_ARRAY_OES);
    EXPECT_EQ(desktop.take_error(), kEnum);
    desktop.table->VertexPointer(desktop, 3, GL_FIXED, 0, nullptr);
    EXPECT_EQ(desktop.take_error(), kEnum);
}

TEST_F(Es1Context, GeneratesCoordinatesForCubeMaps) {
    GLint got = 0;
    gl().GetTexGeniv(c, GL_TEXTURE_GEN_STR_OES, GL_TEXTURE_GEN_MODE, &got);
    EXPECT_EQ(got, GL_REFLECTION_MAP);
    call("glTexGeniOES", GLenum{GL_TEXTURE_GEN_STR_OES}, GLenum{GL_TEXTURE_GEN_MODE}, GLint{GL_NORMAL_MAP});
    call("glTexGenxOES", GLenum{GL_TEXTURE_GEN_STR_OES}, GLenum{GL_TEXTURE_GEN_MODE}, GLfixed{GL_NORMAL_MAP});
    EXPECT_EQ(error(), kNone);
    for (unsigned i = 0; i < 3; ++i) EXPECT_EQ(c.state.texture_gen.tex_gen_mode[i], GLenum{GL_NORMAL_MAP});
    call("glTexGeniOES", GLenum{GL_TEXTURE_GEN_STR_OES}, GLenum{GL_TEXTURE_GEN_MODE}, GLint{GL_EYE_LINEAR});
    EXPECT_EQ(error(), kEnum);
    call("glTexGeniOES", GLenum{GL_S}, GLenum{GL_TEXTURE_GEN_MODE}, GLint{GL_NORMAL_MAP});
    EXPECT_EQ(error(), kEnum);
    gl().Enable(c, GL_TEXTURE_GEN_STR_OES);
    EXPECT_TRUE(gl().IsEnabled(c, GL_TEXTURE_GEN_STR_OES));
    for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(c.state.texture_gen.tex_gen_enabled[i] != 0, i < 3) << i;
}

TEST_F(Es1Context, TakesPixelsOfItsFormats) {
    EXPECT_EQ(image_error(GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4), kNone);
    EXPECT_EQ(image_error(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(image_error(GL_BGRA, GL_BGRA, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(image_error(GL_ALPHA, GL_ALPHA, GL_UNSIGNED_BYTE), kNone);
    EXPECT_EQ(image_error(GL_RGBA, GL_RGB, GL_UNSIGNED_BYTE), kOperation);
    EXPECT_EQ(image_error(GL_RGBA, GL_RGBA, GL_FLOAT), kOperation);
    EXPECT_EQ(image_error(4, GL_RGBA, GL_UNSIGNED_BYTE), kValue);
    EXPECT_EQ(image_error(GL_R8, GL_RGBA, GL_UNSIGNED_BYTE), kValue);
    EXPECT_EQ(image_error(GL_RGBA16F, GL_RGBA, GL_UNSIGNED_BYTE), kValue);
}

TEST_F(Es1Context, KeepsWhatIsCutOutOfTextures) {
    const GLint part[4] = {1, 2, 3, -4};
    call("glTexParameteriv", GLenum{GL_TEXTURE_2D}, GLenum{GL_TEXTURE_CROP_RECT_OES}, part);
    EXPECT_EQ(error(), kNone);
    GLint got[4] = {};
    gl().GetTexParameteriv(c, GL_TEXTURE_2D, GL_TEXTURE_CROP_RECT_OES, got);
    EXPECT_TRUE(std::ranges::equal(got, part));
    GLfixed same[4] = {};
    gl().GetTexParameterxv(c, GL_TEXTURE_2D, GL_TEXTURE_CROP_RECT_OES, same);
    EXPECT_EQ(same[3], -4 * kOne);
    call("glDrawTexfOES", 0.f, 0.f, 0.f, 0.f, 1.f);
    EXPECT_EQ(error(), kValue);
}

TEST_F(Es1Context, TakesImagesOfPalettes) {
    std::array<GLubyte, 48 + 8 + 2> image{};
    image[3] = 200;  // red of the second colour
    image[48] = 0x10;
    const auto define = [&](GLenum format, GLint level, GLsizei bytes) {
        gl().CompressedTexImage2D(c, GL_TEXTURE_2D, level, format, 4, 4, 0, bytes, image.data());
        return error();
    };
    EXPECT_EQ(define(GL_PALETTE4_RGB8_OES, 0, 48 + 7), kValue);
    EXPECT_EQ(define(GL_PALETTE4_RGB8_OES, 1, 48 + 8), kValue);
    EXPECT_EQ(define(GL_PALETTE4_RGB8_OES, -20, 48 + 8), kValue);
    EXPECT_EQ(define(GL_PALETTE4_RGB8_OES, -1, 48 + 8 + 2), kNone);
    const auto texture = c.share().default_textures[glapi::TextureTarget::t2d];
    ASSERT_TRUE(texture);
    const TextureLevel* level = texture->find_level(0, 0);
    ASSERT_TRUE(level);
    EXPECT_EQ(level->pixels[0], std::byte{200});
    EXPECT_EQ(level->pixels[3], std::byte{0});
    ASSERT_TRUE(texture->find_level(0, 1));
    EXPECT_EQ(texture->find_level(0, 1)->width, 2);
}

TEST_F(Es1Context, ReadsBlocksOfEtc1) {
    const std::array<GLubyte, 9> block{};
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, GL_ETC1_RGB8_OES, 4, 4, 0, 8, block.data());
    EXPECT_EQ(error(), kNone);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, GL_ETC1_RGB8_OES, 4, 4, 0, 9, block.data());
    EXPECT_EQ(error(), kValue);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, GL_COMPRESSED_RGB8_ETC2, 4, 4, 0, 8, block.data());
    EXPECT_EQ(error(), kEnum) << "of OpenGL ES 3.0";
}

TEST_F(Es1Context, HasFramebuffersByTheirOldNames) {
    GLuint name = 0;
    call("glGenFramebuffersOES", GLsizei{1}, &name);
    call("glBindFramebufferOES", GLenum{GL_FRAMEBUFFER}, name);
    call("glBindRenderbufferOES", GLenum{GL_RENDERBUFFER}, GLuint{5});
    call("glRenderbufferStorageOES", GLenum{GL_RENDERBUFFER}, GLenum{GL_RGBA8}, GLsizei{4}, GLsizei{4});
    call("glFramebufferRenderbufferOES", GLenum{GL_FRAMEBUFFER}, GLenum{GL_COLOR_ATTACHMENT0}, GLenum{GL_RENDERBUFFER},
         GLuint{5});
    EXPECT_EQ(error(), kNone);
    EXPECT_EQ(gl().CheckFramebufferStatus(c, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    call("glRenderbufferStorageOES", GLenum{GL_RENDERBUFFER}, GLenum{GL_R8}, GLsizei{4}, GLsizei{4});
    EXPECT_EQ(error(), kEnum);
    call("glBindFramebufferOES", GLenum{GL_DRAW_FRAMEBUFFER}, name);
    EXPECT_EQ(error(), kEnum);
}

}  // namespace
}  // namespace wall::client
