// SPDX-License-Identifier: MIT
// Commands about objects by name: they do what the commands about bound objects do, and leave all bindings, and the
// value ids of the state, alone.
#include <array>
#include <vector>

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class NamedObjectsTest : public ContextTest {
protected:
    GLint integer(GLenum word) {
        GLint value = -1;
        gl().GetIntegerv(c, word, &value);
        return value;
    }
    GLuint texture(GLenum target) {
        GLuint name = 0;
        gl().CreateTextures(c, target, 1, &name);
        return name;
    }
};

TEST_F(NamedObjectsTest, ABufferIsThereWithoutHavingBeenBound) {
    GLuint names[2] = {};
    gl().CreateBuffers(c, 2, names);
    EXPECT_TRUE(gl().IsBuffer(c, names[1]));
    const std::array<GLubyte, 4> bytes{1, 2, 3, 4};
    gl().NamedBufferData(c, names[0], 4, bytes.data(), GL_STATIC_DRAW);
    gl().NamedBufferStorage(c, names[1], 4, nullptr, GL_DYNAMIC_STORAGE_BIT);
    gl().CopyNamedBufferSubData(c, names[0], names[1], 1, 0, 3);
    std::array<GLubyte, 4> got{};
    gl().GetNamedBufferSubData(c, names[1], 0, 4, got.data());
    EXPECT_EQ(got, (std::array<GLubyte, 4>{2, 3, 4, 0}));
    GLint size = 0;
    gl().GetNamedBufferParameteriv(c, names[1], GL_BUFFER_SIZE, &size);
    EXPECT_EQ(size, 4);
    auto* mapped = static_cast<GLubyte*>(gl().MapNamedBuffer(c, names[0], GL_READ_ONLY));
    ASSERT_TRUE(mapped);
    EXPECT_EQ(mapped[3], 4);
    EXPECT_TRUE(gl().UnmapNamedBuffer(c, names[0]));
    EXPECT_EQ(integer(GL_COPY_WRITE_BUFFER_BINDING), 0);
    EXPECT_EQ(integer(GL_COPY_READ_BUFFER_BINDING), 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    GLuint reserved = 0;
    gl().GenBuffers(c, 1, &reserved);
    gl().NamedBufferData(c, reserved, 4, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "a name is no object";
    EXPECT_EQ(gl().MapNamedBuffer(c, 0, GL_READ_ONLY), nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(NamedObjectsTest, OneValueFillsABuffer) {
    GLuint name = 0;
    gl().CreateBuffers(c, 1, &name);
    gl().NamedBufferData(c, name, 8, nullptr, GL_STATIC_DRAW);
    const GLfloat half[] = {0.5f, 1.0f};
    gl().ClearNamedBufferData(c, name, GL_RG8, GL_RG, GL_FLOAT, half);
    const GLubyte seven = 7;
    gl().ClearNamedBufferSubData(c, name, GL_R8UI, 2, 3, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &seven);
    std::array<GLubyte, 8> got{};
    gl().GetNamedBufferSubData(c, name, 0, 8, got.data());
    EXPECT_EQ(got, (std::array<GLubyte, 8>{128, 255, 7, 7, 7, 255, 128, 255}));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().ClearNamedBufferSubData(c, name, GL_RG8, 1, 2, GL_RG, GL_FLOAT, half);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE}) << "not at a texel";
    gl().ClearNamedBufferData(c, name, GL_RGB8, GL_RGB, GL_FLOAT, half);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().ClearNamedBufferData(c, name, GL_R8UI, GL_RED, GL_FLOAT, half);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().ClearNamedBufferData(c, name, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
    gl().GetNamedBufferSubData(c, name, 0, 8, got.data());
    EXPECT_EQ(got, (std::array<GLubyte, 8>{}));
}

TEST_F(NamedObjectsTest, OneValueFillsWhatIsNotMapped) {
    GLuint name = 0;
    gl().CreateBuffers(c, 1, &name);
    gl().NamedBufferData(c, name, 6, nullptr, GL_STATIC_DRAW);
    gl().ClearNamedBufferData(c, name, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE}) << "no whole number of texels";
    gl().MapNamedBufferRange(c, name, 0, 2, GL_MAP_READ_BIT);
    const GLubyte seven = 7;
    gl().ClearNamedBufferSubData(c, name, GL_R8UI, 2, 4, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &seven);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().ClearNamedBufferSubData(c, name, GL_R8UI, 1, 2, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &seven);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(NamedObjectsTest, ATargetIsTheTexturesOwnFault) {
    const GLuint cube = texture(GL_TEXTURE_CUBE_MAP), samples = texture(GL_TEXTURE_2D_MULTISAMPLE);
    gl().TextureStorage3D(c, cube, 1, GL_RGBA8, 4, 4, 6);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().TextureParameteri(c, samples, GL_TEXTURE_WRAP_S, GL_REPEAT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().TexStorage3D(c, GL_TEXTURE_CUBE_MAP, 1, GL_RGBA8, 4, 4, 6);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(NamedObjectsTest, ATextureChangesWhereItIsNotBound) {
    const GLuint name = texture(GL_TEXTURE_2D), other = texture(GL_TEXTURE_2D);
    gl().BindTexture(c, GL_TEXTURE_2D, other);
    const auto textures = static_cast<std::size_t>(glstate::Category::textures);
    const std::uint64_t id = c.state.ids[textures];
    gl().TextureStorage2D(c, name, 2, GL_RGBA8, 4, 2);
    gl().TextureParameteri(c, name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    const std::vector<GLubyte> red{255, 0, 0, 255};
    gl().TextureSubImage2D(c, name, 0, 1, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, red.data());
    GLint value = 0;
    gl().GetTextureLevelParameteriv(c, name, 1, GL_TEXTURE_WIDTH, &value);
    EXPECT_EQ(value, 2);
    gl().GetTextureParameteriv(c, name, GL_TEXTURE_MIN_FILTER, &value);
    EXPECT_EQ(value, GL_NEAREST);
    std::vector<GLubyte> got(2 * 4);
    gl().GetTextureSubImage(c, name, 0, 1, 0, 0, 1, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE, 8, got.data());
    EXPECT_EQ(std::vector<GLubyte>(got.begin() + 4, got.end()), red);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().GetTextureSubImage(c, name, 0, 1, 0, 0, 1, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE, 7, got.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "no room";
    gl().GetTextureSubImage(c, name, 0, 1, 0, 0, 4, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE, 99, got.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), static_cast<GLint>(other));
    EXPECT_EQ(c.state.ids[textures], id);
    gl().TextureParameteri(c, 99, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(NamedObjectsTest, FacesOfACubeAreSlices) {
    const GLuint name = texture(GL_TEXTURE_CUBE_MAP);
    gl().TextureStorage2D(c, name, 1, GL_R8, 1, 1);
    const std::vector<GLubyte> bytes{10, 20, 30};
    gl().PixelStorei(c, GL_UNPACK_ALIGNMENT, 1);
    gl().TextureSubImage3D(c, name, 0, 0, 0, 2, 1, 1, 3, GL_RED, GL_UNSIGNED_BYTE, bytes.data());
    gl().PixelStorei(c, GL_PACK_ALIGNMENT, 1);
    std::array<GLubyte, 6> got{};
    gl().GetTextureImage(c, name, 0, GL_RED, GL_UNSIGNED_BYTE, 6, got.data());
    EXPECT_EQ(got, (std::array<GLubyte, 6>{0, 0, 10, 20, 30, 0}));
    const GLubyte nine = 9;
    gl().ClearTexSubImage(c, name, 0, 0, 0, 4, 1, 1, 2, GL_RED, GL_UNSIGNED_BYTE, &nine);
    gl().GetTextureImage(c, name, 0, GL_RED, GL_UNSIGNED_BYTE, 6, got.data());
    EXPECT_EQ(got, (std::array<GLubyte, 6>{0, 0, 10, 20, 9, 9}));
    gl().ClearTexImage(c, name, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
    gl().GetTextureImage(c, name, 0, GL_RED, GL_UNSIGNED_BYTE, 6, got.data());
    EXPECT_EQ(got, (std::array<GLubyte, 6>{}));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().TextureSubImage3D(c, name, 0, 0, 0, 5, 1, 1, 2, GL_RED, GL_UNSIGNED_BYTE, bytes.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE}) << "there are six";
}

TEST_F(NamedObjectsTest, AFramebufferWithoutAttachments) {
    GLuint name = 0;
    gl().CreateFramebuffers(c, 1, &name);
    EXPECT_TRUE(gl().IsFramebuffer(c, name));
    EXPECT_EQ(gl().CheckNamedFramebufferStatus(c, name, GL_FRAMEBUFFER),
              GLenum{GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT});
    gl().NamedFramebufferParameteri(c, name, GL_FRAMEBUFFER_DEFAULT_WIDTH, 64);
    gl().NamedFramebufferParameteri(c, name, GL_FRAMEBUFFER_DEFAULT_HEIGHT, 32);
    EXPECT_EQ(gl().CheckNamedFramebufferStatus(c, name, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    GLint width = 0;
    gl().GetNamedFramebufferParameteriv(c, name, GL_FRAMEBUFFER_DEFAULT_WIDTH, &width);
    EXPECT_EQ(width, 64);
    EXPECT_EQ(integer(GL_DRAW_FRAMEBUFFER_BINDING), 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().NamedFramebufferParameteri(c, name, GL_FRAMEBUFFER_DEFAULT_WIDTH, -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().NamedFramebufferParameteri(c, name, GL_DOUBLEBUFFER, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().NamedFramebufferParameteri(c, 0, GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "the window has a size of its own";
}

TEST_F(NamedObjectsTest, ARenderbufferAndAFramebuffer) {
    GLuint renderbuffer = 0, framebuffer = 0;
    gl().CreateRenderbuffers(c, 1, &renderbuffer);
    gl().CreateFramebuffers(c, 1, &framebuffer);
    gl().NamedRenderbufferStorage(c, renderbuffer, GL_RGBA8, 8, 8);
    gl().NamedFramebufferRenderbuffer(c, framebuffer, GL_COLOR_ATTACHMENT1, GL_RENDERBUFFER, renderbuffer);
    gl().NamedFramebufferDrawBuffer(c, framebuffer, GL_COLOR_ATTACHMENT1);
    gl().NamedFramebufferReadBuffer(c, framebuffer, GL_COLOR_ATTACHMENT1);
    EXPECT_EQ(gl().CheckNamedFramebufferStatus(c, framebuffer, GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    GLint value = 0;
    gl().GetNamedRenderbufferParameteriv(c, renderbuffer, GL_RENDERBUFFER_WIDTH, &value);
    EXPECT_EQ(value, 8);
    gl().GetNamedFramebufferAttachmentParameteriv(c, framebuffer, GL_COLOR_ATTACHMENT1,
                                                  GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &value);
    EXPECT_EQ(value, static_cast<GLint>(renderbuffer));
    EXPECT_EQ(integer(GL_RENDERBUFFER_BINDING), 0);
    EXPECT_EQ(integer(GL_READ_FRAMEBUFFER_BINDING), 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().CheckNamedFramebufferStatus(c, 99, GL_FRAMEBUFFER);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(NamedObjectsTest, AVertexArrayIsSetUpByName) {
    GLuint array = 0, buffer = 0;
    gl().CreateVertexArrays(c, 1, &array);
    gl().CreateBuffers(c, 1, &buffer);
    EXPECT_TRUE(gl().IsVertexArray(c, array));
    gl().EnableVertexArrayAttrib(c, array, 3);
    gl().VertexArrayAttribFormat(c, array, 3, 2, GL_FLOAT, GL_FALSE, 8);
    gl().VertexArrayAttribBinding(c, array, 3, 5);
    gl().VertexArrayVertexBuffer(c, array, 5, buffer, 100, 20);
    gl().VertexArrayElementBuffer(c, array, buffer);
    EXPECT_EQ(integer(GL_VERTEX_ARRAY_BINDING), 0);
    GLint value = 0;
    gl().GetVertexArrayIndexediv(c, array, 3, GL_VERTEX_ATTRIB_RELATIVE_OFFSET, &value);
    EXPECT_EQ(value, 8);
    GLint64 offset = 0;
    gl().GetVertexArrayIndexed64iv(c, array, 5, GL_VERTEX_BINDING_OFFSET, &offset);
    EXPECT_EQ(offset, 100);
    gl().GetVertexArrayiv(c, array, GL_ELEMENT_ARRAY_BUFFER_BINDING, &value);
    EXPECT_EQ(value, static_cast<GLint>(buffer));
    EXPECT_FALSE(c.state.vertex_arrays.attrib_array[3].enabled);
    gl().BindVertexArray(c, array);
    EXPECT_TRUE(c.state.vertex_arrays.attrib_array[3].enabled);
    EXPECT_EQ(c.state.vertex_arrays.attrib_array[3].pointer, 108u);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().EnableVertexArrayAttrib(c, 99, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(NamedObjectsTest, TransformFeedbackHasItsOwnBuffers) {
    GLuint feedback = 0, buffer = 0;
    gl().CreateTransformFeedbacks(c, 1, &feedback);
    gl().CreateBuffers(c, 1, &buffer);
    gl().TransformFeedbackBufferRange(c, feedback, 1, buffer, 4, 8);
    GLint64 value = 0;
    gl().GetTransformFeedbacki64_v(c, feedback, GL_TRANSFORM_FEEDBACK_BUFFER_START, 1, &value);
    EXPECT_EQ(value, 4);
    GLint name = 0;
    gl().GetTransformFeedbacki_v(c, feedback, GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 1, &name);
    EXPECT_EQ(name, static_cast<GLint>(buffer));
    gl().GetTransformFeedbacki_v(c, 0, GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 1, &name);
    EXPECT_EQ(name, 0) << "of the object that is bound";
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().TransformFeedbackBufferBase(c, feedback, 99, buffer);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().TransformFeedbackBufferBase(c, feedback, 0, 99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().GetTransformFeedbackiv(c, 99, GL_TRANSFORM_FEEDBACK_ACTIVE, &name);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(NamedObjectsTest, QueriesHaveATargetFromTheBeginning) {
    GLuint query = 0, buffer = 0;
    gl().CreateQueries(c, GL_SAMPLES_PASSED, 1, &query);
    EXPECT_TRUE(gl().IsQuery(c, query));
    gl().CreateBuffers(c, 1, &buffer);
    gl().NamedBufferData(c, buffer, 8, "\1\1\1\1\1\1\1", GL_STREAM_READ);
    gl().GetQueryBufferObjectuiv(c, query, buffer, GL_QUERY_RESULT, 4);
    std::array<GLuint, 2> got{};
    gl().GetNamedBufferSubData(c, buffer, 0, 8, got.data());
    EXPECT_EQ(got, (std::array<GLuint, 2>{0x01010101, 0}));
    gl().BindBuffer(c, GL_QUERY_BUFFER, buffer);
    gl().GetQueryObjectuiv(c, query, GL_QUERY_RESULT_AVAILABLE, nullptr);
    gl().GetNamedBufferSubData(c, buffer, 0, 8, got.data());
    EXPECT_EQ(got[0], 1u);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().GetQueryBufferObjectuiv(c, query, buffer, GL_QUERY_RESULT, 6);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "beyond its end";
    gl().CreateQueries(c, GL_FLOAT, 1, &query);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(NamedObjectsTest, SeveralAtOnce) {
    const GLuint textures[] = {texture(GL_TEXTURE_2D), 99, texture(GL_TEXTURE_3D)};
    gl().BindTextures(c, 1, 3, textures);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "one of them is none";
    gl().ActiveTexture(c, GL_TEXTURE1);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), static_cast<GLint>(textures[0]));
    gl().ActiveTexture(c, GL_TEXTURE3);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_3D), static_cast<GLint>(textures[2]));
    gl().BindTextures(c, 1, 3, nullptr);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_3D), 0);
    gl().BindTextureUnit(c, 3, textures[0]);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), static_cast<GLint>(textures[0]));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().BindTextures(c, 95, 2, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    GLuint buffers[2] = {};
    gl().CreateBuffers(c, 2, buffers);
    gl().BindBuffersBase(c, GL_UNIFORM_BUFFER, 3, 2, buffers);
    GLint bound = 0;
    gl().GetIntegeri_v(c, GL_UNIFORM_BUFFER_BINDING, 4, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(buffers[1]));
    EXPECT_EQ(integer(GL_UNIFORM_BUFFER_BINDING), 0) << "the target itself stays";
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().BindBuffersBase(c, GL_UNIFORM_BUFFER, 83, 2, buffers);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    const GLuint mixed[] = {99, buffers[0]};
    gl().BindBuffersBase(c, GL_UNIFORM_BUFFER, 3, 2, mixed);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().GetIntegeri_v(c, GL_UNIFORM_BUFFER_BINDING, 3, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(buffers[0])) << "what is wrong leaves its place alone";
}

TEST_F(NamedObjectsTest, ClipSpaceIsTurnedAround) {
    gl().ClipControl(c, GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    EXPECT_EQ(integer(GL_CLIP_ORIGIN), GL_UPPER_LEFT);
    EXPECT_EQ(integer(GL_CLIP_DEPTH_MODE), GL_ZERO_TO_ONE);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().ClipControl(c, GL_LEFT, GL_ZERO_TO_ONE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

}  // namespace
}  // namespace wall::client
