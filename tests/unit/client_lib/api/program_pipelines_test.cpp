// SPDX-License-Identifier: MIT
// Program pipelines, subroutines and doubles without a wall: what is drawn with, whose uniforms are set, the errors.
#include <array>

#include "client_lib/objects/program_pipeline.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class ProgramPipelines : public ContextTest {
protected:
    /// As if a node had linked it.
    GLuint make(GLenum stage, GLenum uniform = GL_FLOAT) {
        const GLuint name = gl().CreateProgram(c);
        const auto program = of(name);
        glapi::ProgramDefinition definition;
        definition.shaders = {{stage, true, ""}};
        glapi::ProgramReflection reflection;
        reflection.linked = true;
        const auto* type = glapi::find_uniform_type(uniform);
        reflection.uniforms = {{uniform, 1, false, false, "level", std::vector<std::uint32_t>(type->words()), {}}};
        reflection.subroutines = {{stage, {"red", "blue"}, {{"tone", 2, true, 0, {1, 0}}}, 2}};
        program->executable = Executable::make(definition, reflection);
        program->linked = program->linked_separable = true;
        return name;
    }
    std::shared_ptr<Program> of(GLuint name) {
        return std::static_pointer_cast<Program>(share->glsl_objects.find(name));
    }
    GLint integer(GLenum word) {
        GLint value = -1;
        gl().GetIntegerv(c, word, &value);
        return value;
    }
};

TEST_F(ProgramPipelines, ProgramsAreDrawnWithTogetherWhileNoneIsInUse) {
    const GLuint vertex = make(GL_VERTEX_SHADER), fragment = make(GL_FRAGMENT_SHADER);
    GLuint pipeline = 0;
    gl().GenProgramPipelines(c, 1, &pipeline);
    EXPECT_FALSE(gl().IsProgramPipeline(c, pipeline));
    gl().UseProgramStages(c, pipeline, GL_VERTEX_SHADER_BIT, vertex);
    gl().UseProgramStages(c, pipeline, GL_ALL_SHADER_BITS & ~GL_VERTEX_SHADER_BIT & 0x1f, fragment);
    gl().BindProgramPipeline(c, pipeline);
    EXPECT_TRUE(gl().IsProgramPipeline(c, pipeline));
    ASSERT_TRUE(c.program);
    EXPECT_EQ(c.program->executable->parts.size(), 2u);
    EXPECT_EQ(integer(GL_CURRENT_PROGRAM), 0);
    gl().UseProgram(c, vertex);
    EXPECT_EQ(c.program, of(vertex));
    gl().UseProgram(c, 0);
    EXPECT_EQ(c.program->executable->stages, 3u);
    gl().DeleteProgram(c, fragment);
    EXPECT_TRUE(of(fragment)) << "the pipeline has it";
    GLint name = 0;
    gl().GetProgramPipelineiv(c, pipeline, GL_FRAGMENT_SHADER, &name);
    EXPECT_EQ(name, static_cast<GLint>(fragment));
    gl().ValidateProgramPipeline(c, pipeline);
    gl().GetProgramPipelineiv(c, pipeline, GL_VALIDATE_STATUS, &name);
    EXPECT_EQ(name, 1);
    gl().BindProgramPipeline(c, 0);
    EXPECT_EQ(c.program, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ProgramPipelines, WhatDoesNotFitIsRefused) {
    const GLuint vertex = make(GL_VERTEX_SHADER);
    GLuint pipeline = 0;
    gl().GenProgramPipelines(c, 1, &pipeline);
    gl().UseProgramStages(c, pipeline, 0x40000000, vertex);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().UseProgramStages(c, 99, GL_VERTEX_SHADER_BIT, vertex);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    of(vertex)->linked_separable = false;
    gl().UseProgramStages(c, pipeline, GL_VERTEX_SHADER_BIT, vertex);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindProgramPipeline(c, 99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().ProgramParameteri(c, vertex, GL_PROGRAM_SEPARABLE, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ProgramParameteri(c, vertex, GL_PROGRAM_SEPARABLE, GL_TRUE);
    EXPECT_TRUE(of(vertex)->definition().separable);
}

TEST_F(ProgramPipelines, UniformsAreThoseOfTheActiveProgram) {
    const GLuint vertex = make(GL_VERTEX_SHADER), fragment = make(GL_FRAGMENT_SHADER, GL_DOUBLE_VEC2);
    GLuint pipeline = 0;
    gl().GenProgramPipelines(c, 1, &pipeline);
    gl().UseProgramStages(c, pipeline, GL_VERTEX_SHADER_BIT, vertex);
    gl().BindProgramPipeline(c, pipeline);
    gl().Uniform1f(c, 0, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "none is active";
    gl().ActiveShaderProgram(c, pipeline, vertex);
    gl().Uniform1f(c, 0, 2);
    GLfloat level = 0;
    gl().GetUniformfv(c, vertex, 0, &level);
    EXPECT_EQ(level, 2);
    gl().ProgramUniform2d(c, fragment, 0, 0.1, 0.2);
    std::array<GLdouble, 2> levels{};
    gl().GetUniformdv(c, fragment, 0, levels.data());
    EXPECT_EQ(levels, (std::array<GLdouble, 2>{0.1, 0.2}));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().ProgramUniform2f(c, fragment, 0, 1, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "no doubles";
}

TEST_F(ProgramPipelines, FunctionsBeginAnewWithTheProgram) {
    const GLuint vertex = make(GL_VERTEX_SHADER);
    gl().UseProgram(c, vertex);
    GLuint function = 7;
    gl().GetUniformSubroutineuiv(c, GL_VERTEX_SHADER, 0, &function);
    EXPECT_EQ(function, 1u) << "the first that it may name";
    const GLuint chosen[] = {0, 1};
    gl().UniformSubroutinesuiv(c, GL_VERTEX_SHADER, 2, chosen);
    gl().GetUniformSubroutineuiv(c, GL_VERTEX_SHADER, 0, &function);
    EXPECT_EQ(function, 0u);
    EXPECT_EQ(gl().GetSubroutineIndex(c, vertex, GL_VERTEX_SHADER, "blue"), 1u);
    EXPECT_EQ(gl().GetSubroutineUniformLocation(c, vertex, GL_VERTEX_SHADER, "tone[1]"), 1);
    EXPECT_EQ(gl().GetSubroutineUniformLocation(c, vertex, GL_VERTEX_SHADER, "tone[2]"), -1);
    gl().UseProgram(c, vertex);
    gl().GetUniformSubroutineuiv(c, GL_VERTEX_SHADER, 0, &function);
    EXPECT_EQ(function, 1u);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().UniformSubroutinesuiv(c, GL_VERTEX_SHADER, 1, chosen);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    const GLuint beyond[] = {0, 2};
    gl().UniformSubroutinesuiv(c, GL_VERTEX_SHADER, 2, beyond);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(ProgramPipelines, ViewportsAreSetForAllOrForOne) {
    gl().Viewport(c, 1, 2, 30, 40);
    const GLfloat two[] = {0.5f, 1, 2, 3, 4, 5, 6, 7};
    gl().ViewportArrayv(c, 3, 2, two);
    const auto viewport = [&](GLuint index) {
        std::array<GLfloat, 4> v{};
        gl().GetFloati_v(c, GL_VIEWPORT, index, v.data());
        return v;
    };
    EXPECT_EQ(viewport(0), (std::array<GLfloat, 4>{1, 2, 30, 40}));
    EXPECT_EQ(viewport(3), (std::array<GLfloat, 4>{0.5f, 1, 2, 3}));
    EXPECT_EQ(viewport(15), viewport(0));
    gl().ViewportIndexedf(c, 0, 9, 9, 9, 9);
    EXPECT_EQ(viewport(15), (std::array<GLfloat, 4>{1, 2, 30, 40}));
    gl().Viewport(c, 0, 0, 5, 5);
    EXPECT_EQ(viewport(3), viewport(0));
    gl().Enablei(c, GL_SCISSOR_TEST, 2);
    EXPECT_FALSE(gl().IsEnabled(c, GL_SCISSOR_TEST));
    EXPECT_TRUE(gl().IsEnabledi(c, GL_SCISSOR_TEST, 2));
    gl().DepthRangeIndexed(c, 1, -1, 0.5);
    std::array<GLdouble, 2> range{};
    gl().GetDoublei_v(c, GL_DEPTH_RANGE, 1, range.data());
    EXPECT_EQ(range, (std::array<GLdouble, 2>{0, 0.5}));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().ViewportArrayv(c, 15, 2, two);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ScissorIndexed(c, 1, 0, 0, -1, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

}  // namespace
}  // namespace wall::client
