// SPDX-License-Identifier: MIT
// Transform feedback: its errors, and what it makes of the buffers.
#include <cstring>

#include "client_lib/api/indexed_buffers.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/objects/program.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class TransformFeedbackTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        name_ = gl().CreateProgram(c);
        const auto program = std::static_pointer_cast<Program>(share->glsl_objects.find(name_));
        glapi::ProgramReflection reflection;
        reflection.linked = true;
        reflection.captured = {{GL_FLOAT_VEC3, 1, "speed"}, {GL_FLOAT, 2, "size"}};
        glapi::ProgramDefinition definition;
        definition.feedback = {GL_SEPARATE_ATTRIBS, {"speed", "size"}};
        program->executable = Executable::make(definition, reflection);
        program->linked = true;
        gl().GenBuffers(c, 2, buffers_);
    }
    void bind(GLuint index) {
        gl().BindBufferBase(c, GL_TRANSFORM_FEEDBACK_BUFFER, index, buffers_[index]);
        gl().BufferData(c, GL_TRANSFORM_FEEDBACK_BUFFER, 64, nullptr, GL_DYNAMIC_COPY);
    }
    std::shared_ptr<Buffer> buffer(GLuint index) { return share->buffers.find(buffers_[index]); }

    GLuint name_ = 0, buffers_[2] = {};
};

TEST_F(TransformFeedbackTest, ItBeginsWithAProgramAndItsBuffers) {
    gl().BeginTransformFeedback(c, GL_QUADS);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().BeginTransformFeedback(c, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "no program";
    gl().UseProgram(c, name_);
    bind(0);
    gl().BeginTransformFeedback(c, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "one buffer of two";
    gl().EndTransformFeedback(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    bind(1);
    gl().BeginTransformFeedback(c, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().BeginTransformFeedback(c, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().UseProgram(c, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().LinkProgram(c, name_);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindBufferBase(c, GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(c.captures->bound().active->parts().size(), 2u);
    gl().EndTransformFeedback(c);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(TransformFeedbackTest, PlacesThatNoShaderNamesNeedNoBuffer) {
    Executable& executable = *std::static_pointer_cast<Program>(share->glsl_objects.find(name_))->executable;
    executable.capture_buffers = {{1, 28}};
    gl().UseProgram(c, name_);
    gl().BeginTransformFeedback(c, GL_POINTS);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    bind(1);
    gl().BeginTransformFeedback(c, GL_POINTS);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const auto& parts = c.captures->bound().active->parts();
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].buffer, nullptr);
    EXPECT_EQ(parts[1].buffer, buffer(1));
    gl().EndTransformFeedback(c);
    executable.capture_buffers = {{~0u, 28}};
    gl().BeginTransformFeedback(c, GL_POINTS);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "there is no such place";
}

TEST_F(TransformFeedbackTest, PlacesHavePartsOfBuffers) {
    bind(1);
    gl().BindBufferRange(c, GL_TRANSFORM_FEEDBACK_BUFFER, 1, buffers_[1], 8, 16);
    GLint64 value = 0;
    EXPECT_TRUE(get_indexed_buffer(c, GL_TRANSFORM_FEEDBACK_BUFFER_START, 1, value));
    EXPECT_EQ(value, 8);
    gl().BindBufferRange(c, GL_TRANSFORM_FEEDBACK_BUFFER, 1, buffers_[1], 8, 18);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindBufferRange(c, GL_TRANSFORM_FEEDBACK_BUFFER, 1, buffers_[1], 2, 16);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindBufferBase(c, GL_TRANSFORM_FEEDBACK_BUFFER, kCaptureBuffers, buffers_[1]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(TransformFeedbackTest, VaryingsTakePartInLinking) {
    const GLchar* names[] = {"a", "b"};
    gl().TransformFeedbackVaryings(c, name_, 2, names, GL_INTERLEAVED_ATTRIBS);
    const auto program = std::static_pointer_cast<Program>(share->glsl_objects.find(name_));
    EXPECT_EQ(program->definition().feedback.names, (std::vector<std::string>{"a", "b"}));
    gl().TransformFeedbackVaryings(c, name_, 2, names, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().TransformFeedbackVaryings(c, name_, -1, names, GL_INTERLEAVED_ATTRIBS);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    GLchar name[16];
    GLsizei length = 0, size = 0;
    GLenum type = 0;
    gl().GetTransformFeedbackVarying(c, name_, 1, sizeof name, &length, &size, &type, name);
    EXPECT_STREQ(name, "size") << "as linked last";
    EXPECT_EQ(size, 2);
    EXPECT_EQ(type, GLenum{GL_FLOAT});
    gl().GetTransformFeedbackVarying(c, name_, 2, sizeof name, &length, &size, &type, name);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    GLint value = 0;
    gl().GetProgramiv(c, name_, GL_TRANSFORM_FEEDBACK_VARYINGS, &value);
    EXPECT_EQ(value, 2);
}

TEST_F(TransformFeedbackTest, OnlyPrimitivesOfItsKindAreDrawn) {
    gl().UseProgram(c, name_);
    bind(0);
    bind(1);
    gl().BeginTransformFeedback(c, GL_LINES);
    gl().Begin(c, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_FALSE(c.packer.inside());
    gl().Begin(c, GL_LINE_STRIP);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().End(c);
    c.packer.reset();
    gl().EndTransformFeedback(c);
}

TEST_F(TransformFeedbackTest, WhatANodeSaysIsTheContentFromThenOn) {
    bind(0);
    gl().BufferSubData(c, GL_TRANSFORM_FEEDBACK_BUFFER, 0, 4, "abcd");
    const auto before = buffer(0)->latest();
    buffer(0)->note_drawn();
    EXPECT_TRUE(buffer(0)->is_drawn());
    EXPECT_GT(buffer(0)->latest(), before);
    std::vector<std::byte> content(64, std::byte{7});
    buffer(0)->take_drawn(content);
    EXPECT_FALSE(buffer(0)->is_drawn());
    EXPECT_EQ(buffer(0)->data()[63], std::byte{7});
    wire::PackBuffer known, late;
    buffer(0)->pack_changes(buffer(0)->latest(), known, no_limit);
    EXPECT_EQ(known.commands(), 0u) << "a node that captured it has it";
    buffer(0)->pack_changes(0, late, no_limit);
    EXPECT_EQ(late.commands(), 2u);
    gl().BufferData(c, GL_TRANSFORM_FEEDBACK_BUFFER, 64, nullptr, GL_DYNAMIC_COPY);
    buffer(0)->note_drawn();
    gl().BufferData(c, GL_TRANSFORM_FEEDBACK_BUFFER, 8, nullptr, GL_DYNAMIC_COPY);
    EXPECT_FALSE(buffer(0)->is_drawn()) << "new memory";
}

TEST_F(TransformFeedbackTest, WhileItDrawsForTheBuffersTheirNodesNeedThem) {
    gl().UseProgram(c, name_);
    bind(0);
    bind(1);
    gl().BeginTransformFeedback(c, GL_POINTS);
    int passes = 0, captures = 0;
    draw_in_passes(c.state, *c.captures, [&] {
        ++passes;
        captures += c.captures->now == c.captures->bound().active.get() &&
                    c.state.objects.capture == c.captures->bound().active->id.value;
    });
    EXPECT_EQ(passes, 2);
    EXPECT_EQ(captures, 1);
    gl().Enable(c, GL_RASTERIZER_DISCARD);
    draw_in_passes(c.state, *c.captures, [&] { ++passes; });
    EXPECT_EQ(passes, 3);
    gl().EndTransformFeedback(c);
    EXPECT_EQ(c.state.objects.capture, 0u);
}

TEST_F(TransformFeedbackTest, ObjectsHaveBuffersAndWhatGoesOn) {
    GLuint objects[2] = {};
    gl().GenTransformFeedbacks(c, 2, objects);
    EXPECT_FALSE(gl().IsTransformFeedback(c, objects[0])) << "it was never bound";
    gl().UseProgram(c, name_);
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, objects[0]);
    EXPECT_TRUE(gl().IsTransformFeedback(c, objects[0]));
    bind(0);
    bind(1);
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, objects[1]);
    GLint64 value = -1;
    get_indexed_buffer(c, GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, value);
    EXPECT_EQ(value, 0);
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, objects[0]);
    get_indexed_buffer(c, GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, value);
    EXPECT_EQ(value, buffers_[0]);
    gl().BeginTransformFeedback(c, GL_POINTS);
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, objects[1]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "one that goes on stays bound";
    gl().ResumeTransformFeedback(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().PauseTransformFeedback(c);
    EXPECT_EQ(c.captures->captures(), nullptr);
    GLint paused = 0;
    gl().GetIntegerv(c, GL_TRANSFORM_FEEDBACK_BUFFER_PAUSED, &paused);
    EXPECT_EQ(paused, 1);
    gl().UseProgram(c, 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR}) << "while it is paused";
    gl().ResumeTransformFeedback(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "another program";
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, 0);
    gl().GetIntegerv(c, GL_TRANSFORM_FEEDBACK_BUFFER_PAUSED, &paused);
    EXPECT_EQ(paused, 0);
    gl().LinkProgram(c, name_);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "an object goes on with it";
    gl().DeleteTransformFeedbacks(c, 2, objects);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, objects[0]);
    gl().EndTransformFeedback(c);
    gl().DeleteTransformFeedbacks(c, 2, objects);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    GLint bound = -1;
    gl().GetIntegerv(c, GL_TRANSFORM_FEEDBACK_BINDING, &bound);
    EXPECT_EQ(bound, 0);
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, objects[0]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(TransformFeedbackTest, AsManyAreDrawnAsWereCaptured) {
    gl().DrawTransformFeedbackStreamInstanced(c, GL_POINTS, 0, 0, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "nothing has ended yet";
    gl().UseProgram(c, name_);
    bind(0);
    bind(1);
    gl().BeginTransformFeedback(c, GL_POINTS);
    const ClientName id = c.captures->bound().active->id;
    gl().EndTransformFeedback(c);
    gl().DrawTransformFeedbackStreamInstanced(c, GL_POINTS, 0, 0, 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().DrawTransformFeedbackStreamInstanced(c, GL_POINTS, 0, kVertexStreams, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().DrawTransformFeedbackStreamInstanced(c, GL_POINTS, 7, 0, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    EXPECT_TRUE(share->by_id.contains(id)) << "the nodes know it";
    gl().BeginTransformFeedback(c, GL_POINTS);
    gl().EndTransformFeedback(c);
    EXPECT_FALSE(share->by_id.contains(id)) << "there is a newer one";
}

TEST_F(TransformFeedbackTest, ALateNodeIsToldTheCounts) {
    Capture capture(GL_POINTS, {});
    wire::PackBuffer before, behind, late;
    capture.pack_changes(0, before, no_limit);
    EXPECT_EQ(before.commands(), 1u);
    const auto known = capture.latest();
    capture.end();
    EXPECT_FALSE(capture.is_drawn()) << "nothing was captured";
    capture.pack_changes(known, behind, no_limit);
    EXPECT_EQ(behind.commands(), 1u);
    capture.note_drawn();
    ASSERT_TRUE(capture.is_drawn());
    capture.pack_changes(0, late, no_limit);
    EXPECT_EQ(late.commands(), 0u);
    capture.pack_drawn([](const auto&, const ImageRows&) { return std::vector<std::byte>(8 * kVertexStreams); }, late,
                       no_limit);
    EXPECT_EQ(late.commands(), 1u);
}

}  // namespace
}  // namespace wall::client
