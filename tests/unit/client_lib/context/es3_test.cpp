// SPDX-License-Identifier: MIT
// Contexts of OpenGL ES 3.0: what they have beyond 2.0, and where they are stricter than OpenGL.
#include <algorithm>
#include <vector>

#include "client_lib/context/es_version.h"
#include "client_lib/context/limits.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class Es3Context : public testing::Test {
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
    /// Draws to a renderbuffer of that format from now on.
    void draw_to(GLenum format) {
        gl().BindRenderbuffer(c, GL_RENDERBUFFER, 1);
        gl().RenderbufferStorage(c, GL_RENDERBUFFER, format, 4, 4);
        gl().BindFramebuffer(c, GL_FRAMEBUFFER, 1);
        gl().FramebufferRenderbuffer(c, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, 1);
    }

    Context c{std::make_shared<ShareGroup>(), {.es = 30}};
};

constexpr GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE,
                 kOperation = GL_INVALID_OPERATION;

TEST_F(Es3Context, RestartsPrimitivesAtTheLastIndex) {
    gl().Enable(c, GL_PRIMITIVE_RESTART_FIXED_INDEX);
    EXPECT_EQ(error(), kNone);
    EXPECT_TRUE(gl().IsEnabled(c, GL_PRIMITIVE_RESTART_FIXED_INDEX));
    EXPECT_EQ(value(GL_PRIMITIVE_RESTART_FIXED_INDEX), 1);
    gl().Enable(c, GL_PRIMITIVE_RESTART);
    EXPECT_EQ(error(), kEnum);
}

TEST_F(Es3Context, TakesNoBinaries) {
    EXPECT_EQ(value(GL_NUM_PROGRAM_BINARY_FORMATS), 0);
    const GLuint program = gl().CreateProgram(c);
    gl().ProgramParameteri(c, program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    EXPECT_EQ(error(), kNone);
    GLint hint = 7, length = -1;
    gl().GetProgramiv(c, program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, &hint);
    EXPECT_EQ(hint, GL_FALSE) << "it has not been linked since";
    gl().LinkProgram(c, program);
    gl().GetProgramiv(c, program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, &hint);
    gl().GetProgramiv(c, program, GL_PROGRAM_BINARY_LENGTH, &length);
    EXPECT_EQ(hint, GL_TRUE);
    EXPECT_EQ(length, 0);
    gl().ProgramParameteri(c, program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, 2);
    EXPECT_EQ(error(), kValue);
    gl().ProgramBinary(c, program, GL_RGBA, "", 0);
    EXPECT_EQ(error(), kEnum);
    gl().ProgramBinary(c, program, GL_RGBA, "", -1);
    EXPECT_EQ(error(), kValue);
    gl().ProgramBinary(c, program + 1, GL_RGBA, "", 0);
    EXPECT_EQ(error(), kValue) << "no such program";
    GLsizei given = 7;
    GLenum format = 0;
    gl().GetProgramBinary(c, program, 0, &given, &format, nullptr);
    EXPECT_EQ(error(), kOperation);
    EXPECT_EQ(given, 0);
}

TEST_F(Es3Context, KnowsWhatMayBeForgotten) {
    const GLenum buffers[] = {GL_COLOR, GL_DEPTH}, points[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_STENCIL_ATTACHMENT};
    gl().InvalidateFramebuffer(c, GL_FRAMEBUFFER, 2, buffers);
    EXPECT_EQ(error(), kNone);
    gl().InvalidateFramebuffer(c, GL_FRAMEBUFFER, 2, points);
    EXPECT_EQ(error(), kEnum) << "a window has no such";
    gl().InvalidateFramebuffer(c, GL_FRAMEBUFFER, -1, points);
    EXPECT_EQ(error(), kValue);
    gl().InvalidateSubFramebuffer(c, GL_FRAMEBUFFER, 2, buffers, 0, 0, -1, 1);
    EXPECT_EQ(error(), kValue);
    draw_to(GL_RGBA8);
    gl().InvalidateSubFramebuffer(c, GL_DRAW_FRAMEBUFFER, 2, points, 0, 0, 1, 1);
    EXPECT_EQ(error(), kNone);
    gl().InvalidateFramebuffer(c, GL_FRAMEBUFFER, 2, buffers);
    EXPECT_EQ(error(), kEnum);
    const GLenum far = GL_COLOR_ATTACHMENT8;
    gl().InvalidateFramebuffer(c, GL_FRAMEBUFFER, 1, &far);
    EXPECT_EQ(error(), kOperation);
}

TEST_F(Es3Context, SaysHowManySamplesThereAre) {
    GLint count = -1, samples[2] = {};
    gl().GetInternalformativ(c, GL_RENDERBUFFER, GL_RGBA8, GL_NUM_SAMPLE_COUNTS, 1, &count);
    ASSERT_EQ(count, 1);
    gl().GetInternalformativ(c, GL_RENDERBUFFER, GL_RGBA8, GL_SAMPLES, 2, samples);
    EXPECT_EQ(samples[0], kUsualSamples);
    gl().GetInternalformativ(c, GL_RENDERBUFFER, GL_RGBA8UI, GL_NUM_SAMPLE_COUNTS, 1, &count);
    EXPECT_EQ(count, 0) << "whole numbers have none";
    EXPECT_EQ(error(), kNone);
    for (const GLenum wrong : {GL_RGB9_E5, GL_LUMINANCE, GL_COMPRESSED_RGB8_ETC2}) {
        gl().GetInternalformativ(c, GL_RENDERBUFFER, wrong, GL_SAMPLES, 1, &count);
        EXPECT_EQ(error(), kEnum) << std::hex << wrong;
    }
    gl().GetInternalformativ(c, GL_TEXTURE_2D, GL_RGBA8, GL_SAMPLES, 1, &count);
    EXPECT_EQ(error(), kEnum);
    gl().GetInternalformativ(c, GL_RENDERBUFFER, GL_RGBA8, GL_SAMPLES, -1, &count);
    EXPECT_EQ(error(), kValue);
    gl().BindRenderbuffer(c, GL_RENDERBUFFER, 1);
    gl().RenderbufferStorageMultisample(c, GL_RENDERBUFFER, 2, GL_RGBA8, 4, 4);
    EXPECT_EQ(error(), kNone);
    gl().RenderbufferStorageMultisample(c, GL_RENDERBUFFER, 1, GL_RGBA8UI, 4, 4);
    EXPECT_EQ(error(), kOperation);
    gl().RenderbufferStorageMultisample(c, GL_RENDERBUFFER, 1000, GL_RGBA8, 4, 4);
    EXPECT_EQ(error(), kOperation);
}

TEST(SampleCounts, AreWhatDriversRoundTo) {
    EXPECT_EQ(sample_counts(1), std::vector<GLsizei>());
    EXPECT_EQ(sample_counts(4), std::vector<GLsizei>{4}) << "llvmpipe";
    EXPECT_EQ(sample_counts(8), (std::vector<GLsizei>{8, 4, 2}));
}

TEST_F(Es3Context, KeepsBlocksOfEtc2) {
    const std::vector<std::byte> blocks(64);
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, GL_COMPRESSED_RGBA8_ETC2_EAC, 8, 8, 0, 64, blocks.data());
    EXPECT_EQ(error(), kNone);
    gl().CompressedTexImage2D(c, GL_TEXTURE_2D, 0, GL_COMPRESSED_RGB8_ETC2, 8, 8, 0, 64, blocks.data());
    EXPECT_EQ(error(), kValue) << "half the bytes";
    gl().CompressedTexSubImage2D(c, GL_TEXTURE_2D, 0, 4, 0, 4, 4, GL_COMPRESSED_RGBA8_ETC2_EAC, 16, blocks.data());
    EXPECT_EQ(error(), kNone);
    gl().CompressedTexSubImage2D(c, GL_TEXTURE_2D, 0, 1, 0, 4, 4, GL_COMPRESSED_RGBA8_ETC2_EAC, 16, blocks.data());
    EXPECT_EQ(error(), kOperation);
    gl().TexSubImage2D(c, GL_TEXTURE_2D, 0, 0, 0, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, blocks.data());
    EXPECT_EQ(error(), kOperation) << "nodes do not compress";
    gl().TexImage2D(c, GL_TEXTURE_2D, 0, GL_COMPRESSED_RGB8_ETC2, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE, blocks.data());
    EXPECT_EQ(error(), kOperation);
    gl().GenerateMipmap(c, GL_TEXTURE_2D);
    EXPECT_EQ(error(), kOperation);
    gl().BindTexture(c, GL_TEXTURE_2D, 2);
    gl().TexStorage2D(c, GL_TEXTURE_2D, 2, GL_COMPRESSED_R11_EAC, 8, 8);
    EXPECT_EQ(error(), kNone);
    gl().CompressedTexSubImage2D(c, GL_TEXTURE_2D, 1, 0, 0, 4, 4, GL_COMPRESSED_R11_EAC, 8, blocks.data());
    EXPECT_EQ(error(), kNone);
    gl().BindTexture(c, GL_TEXTURE_3D, 3);
    gl().TexStorage3D(c, GL_TEXTURE_3D, 1, GL_COMPRESSED_R11_EAC, 8, 8, 8);
    EXPECT_EQ(error(), kOperation);
}

TEST_F(Es3Context, NodesAreToldOfTheLastLevelOfStorage) {
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    gl().TexStorage2D(c, GL_TEXTURE_2D, 2, GL_RGBA8, 16, 16);
    EXPECT_EQ(error(), kNone);
    const auto texture = c.share().textures.find(1);
    EXPECT_TRUE(std::ranges::any_of(texture->parameter_stamps,
                                    [](const auto& known) { return known.first == GL_TEXTURE_MAX_LEVEL; }));
}

TEST_F(Es3Context, ListsItsBlockFormats) {
    const Caps caps{.extensions = "GL_ARB_ES3_compatibility GL_EXT_texture_compression_s3tc"};
    const auto formats = listed_block_formats(c.profile, caps);
    EXPECT_EQ(formats.size(), 15u);
    EXPECT_EQ(std::ranges::count(formats, GLenum{GL_COMPRESSED_SRGB8_ETC2}), 1);
    EXPECT_EQ(listed_block_formats({}, caps).size(), 10u);
    EXPECT_TRUE(listed_block_formats(c.profile, {}).empty());
}

TEST_F(Es3Context, IsOfNoMoreThanItsNodesCan) {
    const auto version = [&](const char* words) { return version_in(c.profile, {.extensions = words}); };
    EXPECT_EQ(version("GL_ARB_ES2_compatibility GL_ARB_ES3_compatibility").major, 3);
    EXPECT_EQ(version("GL_ARB_ES2_compatibility").major, 2);
}

TEST_F(Es3Context, ReadsWhatTheColoursAre) {
    draw_to(GL_RGBA16I);
    EXPECT_EQ(value(GL_IMPLEMENTATION_COLOR_READ_FORMAT), GL_RGBA_INTEGER);
    EXPECT_EQ(value(GL_IMPLEMENTATION_COLOR_READ_TYPE), GL_SHORT);
    EXPECT_EQ(gl().CheckFramebufferStatus(c, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    GLint pixel[4];
    gl().ReadPixels(c, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    EXPECT_EQ(error(), kOperation);
}

TEST_F(Es3Context, HasObjectsOfBuffersOnly) {
    GLuint object = 0;
    const GLfloat array[4] = {};
    gl().VertexAttribPointer(c, 0, 4, GL_FLOAT, GL_FALSE, 0, array);
    EXPECT_EQ(error(), kNone);
    gl().GenVertexArrays(c, 1, &object);
    gl().BindVertexArray(c, object);
    gl().VertexAttribPointer(c, 0, 4, GL_FLOAT, GL_FALSE, 0, array);
    EXPECT_EQ(error(), kOperation);
    gl().VertexAttribPointer(c, 0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    EXPECT_EQ(error(), kNone);
}

TEST_F(Es3Context, CountsForGeneratedNamesOnly) {
    gl().BeginQueryIndexed(c, GL_ANY_SAMPLES_PASSED_CONSERVATIVE, 0, 77);
    EXPECT_EQ(error(), kOperation);
    GLuint name = 0;
    gl().GenQueries(c, 1, &name);
    gl().BeginQueryIndexed(c, GL_ANY_SAMPLES_PASSED_CONSERVATIVE, 0, name);
    EXPECT_EQ(error(), kNone);
    gl().BeginQueryIndexed(c, GL_SAMPLES_PASSED, 0, name);
    EXPECT_EQ(error(), kEnum);
}

TEST_F(Es3Context, SeesDepthsOfASizeInRed) {
    const auto depth_mode = [&](GLint internal, GLenum type) {
        gl().BindTexture(c, GL_TEXTURE_2D, 1);
        gl().TexImage2D(c, GL_TEXTURE_2D, 0, internal, 1, 1, 0, GL_DEPTH_COMPONENT, type, nullptr);
        EXPECT_EQ(error(), kNone);
        return c.share().textures.find(1)->parameters.depth_mode;
    };
    EXPECT_EQ(depth_mode(GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT), GLenum{GL_LUMINANCE});
    EXPECT_EQ(depth_mode(GL_DEPTH_COMPONENT24, GL_UNSIGNED_INT), GLenum{GL_RED});
    EXPECT_EQ(depth_mode(GL_DEPTH_COMPONENT32F, GL_FLOAT), GLenum{GL_RED});
}

}  // namespace
}  // namespace wall::client
