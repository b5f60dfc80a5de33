// SPDX-License-Identifier: MIT
// Programs of OpenGL 3: unsigned uniforms, colours of outputs, blocks of uniforms and the buffers behind them.
#include <cstring>

#include "client_lib/api/indexed_buffers.h"
#include "client_lib/context/used_objects.h"
#include "client_lib/objects/program.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

glapi::ProgramReflection reflection() {
    glapi::ProgramReflection r;
    r.linked = true;
    r.uniforms = {{GL_UNSIGNED_INT_VEC2, 1, false, false, "mask", {0, 0}},
                  {GL_FLOAT, 1, false, false, "scale", {0}},
                  {GL_INT, 1, false, false, "shift", {0}},
                  {GL_BOOL, 1, false, false, "on", {0}},
                  {GL_FLOAT_VEC4, 2, false, true, "Light.color", {}, {0, 16, 16, -1, false}},
                  {GL_FLOAT_MAT4, 1, false, false, "turn", {}, {1, 0, -1, 16, true}}};
    r.blocks = {{"Light", 48, 0, 1}, {"Place[0]", 64, 2, 3}};
    r.outputs = {{2, 0, 1, false, "tint"}, {4, 1, 3, true, "more"}};
    return r;
}

class UniformBlocksTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        name_ = gl().CreateProgram(c);
        program_ = std::static_pointer_cast<Program>(share->glsl_objects.find(name_));
        program_->executable = Executable::make({}, reflection());
        ASSERT_TRUE(program_->executable);
        program_->linked = true;
        gl().UseProgram(c, name_);
    }
    GLuint buffer(std::size_t bytes) {
        GLuint made = 0;
        gl().GenBuffers(c, 1, &made);
        gl().BindBuffer(c, GL_UNIFORM_BUFFER, made);
        gl().BufferData(c, GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_DRAW);
        return made;
    }
    GLint of_block(GLuint block, GLenum pname) {
        GLint value = -99;
        gl().GetActiveUniformBlockiv(c, name_, block, pname, &value);
        return value;
    }
    GLint of_uniform(GLuint uniform, GLenum pname) {
        GLint value = -99;
        gl().GetActiveUniformsiv(c, name_, 1, &uniform, pname, &value);
        return value;
    }

    GLuint name_ = 0;
    std::shared_ptr<Program> program_;
};

TEST_F(UniformBlocksTest, UnsignedUniforms) {
    gl().Uniform2ui(c, 0, 7, ~GLuint{0});
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    GLuint got[2] = {};
    gl().GetUniformuiv(c, name_, 0, got);
    EXPECT_EQ(got[1], ~GLuint{0});
    gl().Uniform2i(c, 0, 1, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().Uniform1ui(c, 2, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().Uniform1ui(c, 3, 5);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR}) << "a boolean takes any";
    gl().GetUniformuiv(c, name_, 3, got);
    EXPECT_EQ(got[0], 1u);
}

TEST_F(UniformBlocksTest, TheNearestUnsignedNumberIsAnswered) {
    GLuint got = 0;
    gl().Uniform1f(c, 1, -3.0f);
    gl().GetUniformuiv(c, name_, 1, &got);
    EXPECT_EQ(got, 0u);
    gl().Uniform1f(c, 1, 2.6f);
    gl().GetUniformuiv(c, name_, 1, &got);
    EXPECT_EQ(got, 3u);
    gl().Uniform1i(c, 2, -1);
    gl().GetUniformuiv(c, name_, 2, &got);
    EXPECT_EQ(got, 0u);
}

TEST_F(UniformBlocksTest, OutputsAreColours) {
    EXPECT_EQ(gl().GetFragDataLocation(c, name_, "tint"), 2);
    EXPECT_EQ(gl().GetFragDataIndex(c, name_, "tint"), 0);
    EXPECT_EQ(gl().GetFragDataLocation(c, name_, "more[2]"), 6);
    EXPECT_EQ(gl().GetFragDataIndex(c, name_, "more"), 1);
    for (const char* none : {"more[3]", "tint[0]", "other", ""})
        EXPECT_EQ(gl().GetFragDataLocation(c, name_, none), -1) << none;
    gl().BindFragDataLocation(c, name_, 1, "gl_FragColor");
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindFragDataLocation(c, name_, 99, "tint");
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindFragDataLocation(c, name_, 1, "tint");
    gl().BindFragDataLocation(c, name_, 3, "tint");
    ASSERT_EQ(program_->definition().outputs.size(), 1u);
    EXPECT_EQ(program_->definition().outputs[0].color, 3u);
}

TEST_F(UniformBlocksTest, WhatThereIsOfThem) {
    EXPECT_EQ(gl().GetUniformBlockIndex(c, name_, "Light"), 0u);
    EXPECT_EQ(gl().GetUniformBlockIndex(c, name_, "Place"), 1u);
    EXPECT_EQ(gl().GetUniformBlockIndex(c, name_, "Other"), GL_INVALID_INDEX);
    EXPECT_EQ(of_block(0, GL_UNIFORM_BLOCK_DATA_SIZE), 48);
    EXPECT_EQ(of_block(0, GL_UNIFORM_BLOCK_ACTIVE_UNIFORMS), 1);
    EXPECT_EQ(of_block(0, GL_UNIFORM_BLOCK_ACTIVE_UNIFORM_INDICES), 4);
    EXPECT_EQ(of_block(0, GL_UNIFORM_BLOCK_REFERENCED_BY_FRAGMENT_SHADER), GL_FALSE);
    EXPECT_EQ(of_block(1, GL_UNIFORM_BLOCK_REFERENCED_BY_FRAGMENT_SHADER), GL_TRUE);
    EXPECT_EQ(of_block(1, GL_UNIFORM_BLOCK_BINDING), 2);
    EXPECT_EQ(of_block(1, GL_UNIFORM_BLOCK_NAME_LENGTH), 9);
    EXPECT_EQ(of_block(2, GL_UNIFORM_BLOCK_BINDING), -99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    GLint blocks = 0;
    gl().GetProgramiv(c, name_, GL_ACTIVE_UNIFORM_BLOCKS, &blocks);
    EXPECT_EQ(blocks, 2);
    const GLchar* names[] = {"turn", "Light.color", "Light.color[0]", "Light.color[1]"};
    GLuint indices[4] = {};
    gl().GetUniformIndices(c, name_, 4, names, indices);
    EXPECT_EQ(indices[0], 5u);
    EXPECT_EQ(indices[1], 4u);
    EXPECT_EQ(indices[2], 4u);
    EXPECT_EQ(indices[3], GL_INVALID_INDEX);
    EXPECT_EQ(of_uniform(4, GL_UNIFORM_OFFSET), 16);
    EXPECT_EQ(of_uniform(4, GL_UNIFORM_SIZE), 2);
    EXPECT_EQ(of_uniform(4, GL_UNIFORM_NAME_LENGTH), static_cast<GLint>(sizeof "Light.color[0]"));
    EXPECT_EQ(of_uniform(5, GL_UNIFORM_IS_ROW_MAJOR), GL_TRUE);
    EXPECT_EQ(of_uniform(0, GL_UNIFORM_BLOCK_INDEX), -1);
    EXPECT_EQ(of_uniform(0, GL_UNIFORM_OFFSET), -1);
    EXPECT_EQ(gl().GetUniformLocation(c, name_, "turn"), -1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(UniformBlocksTest, ABindingIsAChangeOfTheProgram) {
    const auto known = program_->latest();
    gl().UniformBlockBinding(c, name_, 0, 5);
    EXPECT_EQ(of_block(0, GL_UNIFORM_BLOCK_BINDING), 5);
    wire::PackBuffer changes;
    program_->pack_changes(known, changes, no_limit);
    EXPECT_EQ(changes.commands(), 1u);
    const auto after = program_->latest();
    gl().UniformBlockBinding(c, name_, 0, 5);
    EXPECT_EQ(program_->latest(), after) << "an equal one is none";
    gl().UniformBlockBinding(c, name_, 2, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().UniformBlockBinding(c, name_, 0, glstate::el::uniform_buffer::count);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(UniformBlocksTest, PlacesHavePartsOfBuffers) {
    const GLuint made = buffer(256);
    gl().BindBufferRange(c, GL_UNIFORM_BUFFER, 3, made, 16, 32);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const auto value_of = [&](GLenum pname, GLuint index) {
        GLint64 value = -1;
        EXPECT_TRUE(get_indexed_buffer(c, pname, index, value));
        return value;
    };
    EXPECT_EQ(value_of(GL_UNIFORM_BUFFER_BINDING, 3), GLint64{made});
    EXPECT_EQ(value_of(GL_UNIFORM_BUFFER_START, 3), 16);
    EXPECT_EQ(value_of(GL_UNIFORM_BUFFER_SIZE, 3), 32);
    gl().BindBufferBase(c, GL_UNIFORM_BUFFER, 3, made);
    EXPECT_EQ(value_of(GL_UNIFORM_BUFFER_SIZE, 3), 0);
    GLint general = 0;
    gl().GetIntegerv(c, GL_UNIFORM_BUFFER_BINDING, &general);
    EXPECT_EQ(general, static_cast<GLint>(made));
    gl().BindBufferRange(c, GL_UNIFORM_BUFFER, 3, made, 0, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindBufferRange(c, GL_UNIFORM_BUFFER, 3, made, -4, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindBufferBase(c, GL_UNIFORM_BUFFER, glstate::el::uniform_buffer::count, made);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindBufferBase(c, GL_ARRAY_BUFFER, 0, made);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().DeleteBuffers(c, 1, &made);
    EXPECT_EQ(value_of(GL_UNIFORM_BUFFER_BINDING, 3), 0) << "deleted";
    GLint64 value = 0;
    EXPECT_FALSE(get_indexed_buffer(c, GL_VIEWPORT, 0, value));
}

TEST_F(UniformBlocksTest, DrawingNeedsTheBuffersOfTheProgramsBlocks) {
    const GLuint used = buffer(64), unused = buffer(64);
    gl().BindBufferBase(c, GL_UNIFORM_BUFFER, 2, used);  // of Place
    gl().BindBufferBase(c, GL_UNIFORM_BUFFER, 7, unused);
    std::vector<GLuint> names;
    for_each_used(c, [&](const Object& object) {
        if (dynamic_cast<const Buffer*>(&object)) names.push_back(object.name);
    });
    EXPECT_EQ(names, std::vector{used});
    const UseStamp before = use_stamp(c);
    EXPECT_EQ(use_stamp(c), before);
    gl().BindBuffer(c, GL_UNIFORM_BUFFER, used);
    gl().BufferSubData(c, GL_UNIFORM_BUFFER, 0, 4, "abcd");
    EXPECT_NE(use_stamp(c), before) << "its content is another";
}

TEST_F(UniformBlocksTest, AMemberOfNoBlockIsNoAnswer) {
    auto bad = reflection();
    bad.uniforms[4].place.block = 2;
    EXPECT_FALSE(Executable::make({}, std::move(bad)));
}

TEST_F(UniformBlocksTest, OtherNodesGetTheFirstOnesBlocksAndColours) {
    const auto sent = glapi::decode_definition(program_->executable->definition);
    ASSERT_TRUE(sent);
    EXPECT_EQ(sent->uniforms.size(), 4u) << "those in blocks have no location";
    EXPECT_EQ(sent->blocks, (std::vector<std::string>{"Light", "Place[0]"}));
    EXPECT_EQ(sent->outputs[1], (glapi::OutputBinding{4, 1, "more"}));
}

}  // namespace
}  // namespace wall::client
