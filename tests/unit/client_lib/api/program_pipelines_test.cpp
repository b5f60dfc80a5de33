// SPDX-License-Identifier: MIT
// Program pipelines, subroutines and doubles without a wall: what is drawn with, whose uniforms are set, the errors.
#include <array>
#include <mutex>
#include <utility>
#include <vector>

#include "client_lib/context/program_use.h"
#include "client_lib/objects/program_pipeline.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class ProgramPipelines : public ContextTest {
protected:
    /// As if a node had linked it.
    GLuint make(GLenum stage, GLenum uniform = GL_FLOAT) { return make(std::vector{stage}, uniform); }
    GLuint make(const std::vector<GLenum>& stages, GLenum uniform = GL_FLOAT) {
        const GLuint name = gl().CreateProgram(c);
        const auto program = of(name);
        glapi::ProgramDefinition definition;
        for (const GLenum stage : stages) definition.shaders.push_back({stage, true, ""});
        glapi::ProgramReflection reflection;
        reflection.linked = true;
        const auto* type = glapi::find_uniform_type(uniform);
        reflection.uniforms = {{uniform, 1, false, false, "level", std::vector<std::uint32_t>(type->words()), {}}};
        reflection.subroutines = {{stages[0], {"red", "blue"}, {{"tone", 2, true, 0, {1, 0}}}, 2}};
        program->executable = Executable::make(definition, reflection);
        program->linked = program->linked_separable = true;
        return name;
    }
    /// Of programs for stages; bound.
    GLuint bind(const std::vector<std::pair<GLbitfield, GLuint>>& programs) {
        GLuint pipeline = 0;
        gl().GenProgramPipelines(c, 1, &pipeline);
        for (const auto& [stages, program] : programs) gl().UseProgramStages(c, pipeline, stages, program);
        gl().BindProgramPipeline(c, pipeline);
        return pipeline;
    }
    bool is_valid(GLuint pipeline) {
        gl().ValidateProgramPipeline(c, pipeline);
        GLint valid = -1, length = -1;
        gl().GetProgramPipelineiv(c, pipeline, GL_VALIDATE_STATUS, &valid);
        gl().GetProgramPipelineiv(c, pipeline, GL_INFO_LOG_LENGTH, &length);
        GLchar log[200] = "";
        GLsizei written = 0;
        gl().GetProgramPipelineInfoLog(c, pipeline, sizeof log, &written, log);
        EXPECT_EQ(length, written == 0 ? 0 : written + 1);
        EXPECT_EQ(valid != 0, written == 0) << log;
        return valid != 0;
    }
    bool may_run() {
        std::lock_guard lock(c.share().mutex);
        return client::may_run(c);
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

TEST(ProgramPipeline, TakesExactlyWhatIsGivenIfAsked) {
    const auto made = [](GLenum stage, glapi::ProgramReflection reflection) {
        auto program = std::make_shared<Program>(next_object_id(), 1);
        glapi::ProgramDefinition definition;
        definition.shaders = {{stage, true, ""}};
        reflection.linked = true;
        program->executable = Executable::make(definition, reflection);
        program->linked_separable = true;
        return program;
    };
    const auto vertex = [&](std::vector<glapi::ActiveOutput> outputs) {
        outputs.push_back({-1, -1, 1, false, "gl_Position", GL_FLOAT_VEC4, 1});
        return made(GL_VERTEX_SHADER, {.outputs = std::move(outputs)});
    };
    const auto fragment = [&](std::vector<glapi::ActiveAttribute> inputs) {
        return made(GL_FRAGMENT_SHADER, {.attributes = std::move(inputs)});
    };
    const auto runs = [](std::shared_ptr<Program> before, std::shared_ptr<Program> behind, bool exact) {
        ProgramPipeline pipeline(1, exact);
        pipeline.programs[0] = std::move(before);
        pipeline.programs[1] = std::move(behind);
        pipeline.combine();
        return pipeline.fault().empty();
    };
    const glapi::ActiveOutput color{-1, -1, 1, false, "color", GL_FLOAT_VEC4, 1},
        third{3, -1, 1, false, "other", GL_FLOAT_VEC4, 1};
    const glapi::ActiveAttribute taken{GL_FLOAT_VEC4, 1, -1, "color", 2}, as_third{GL_FLOAT_VEC4, 1, 3, "color", 2},
        of_two{GL_FLOAT_VEC2, 1, -1, "color", 2};
    EXPECT_TRUE(runs(vertex({color}), fragment({taken}), true));
    EXPECT_TRUE(runs(vertex({third}), fragment({as_third}), true)) << "by location";
    EXPECT_FALSE(runs(vertex({color}), fragment({}), true)) << "nobody takes it";
    EXPECT_FALSE(runs(vertex({}), fragment({taken}), true)) << "nobody gives it";
    EXPECT_FALSE(runs(vertex({color}), fragment({of_two}), true));
    EXPECT_TRUE(runs(vertex({color}), fragment({of_two}), false));
}

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

// ARB_separate_shader_objects, issue 9
TEST_F(ProgramPipelines, StagesAreSetByDisplayLists) {
    const GLuint red = make(GL_FRAGMENT_SHADER), green = make(GL_FRAGMENT_SHADER), list = gl().GenLists(c, 1);
    GLuint pipeline = 0;
    gl().GenProgramPipelines(c, 1, &pipeline);
    gl().UseProgramStages(c, pipeline, GL_FRAGMENT_SHADER_BIT, red);
    const auto fragment = [&] {
        GLint name = 0;
        gl().GetProgramPipelineiv(c, pipeline, GL_FRAGMENT_SHADER, &name);
        return static_cast<GLuint>(name);
    };
    gl().NewList(c, list, GL_COMPILE);
    gl().UseProgramStages(c, pipeline, GL_FRAGMENT_SHADER_BIT, green);
    gl().EndList(c);
    EXPECT_EQ(fragment(), red);
    gl().CallList(c, list);
    EXPECT_EQ(fragment(), green);
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

TEST_F(ProgramPipelines, AProgramIsUsedForAllOfItsStages) {
    const GLuint both = make({GL_VERTEX_SHADER, GL_FRAGMENT_SHADER}), fragment = make(GL_FRAGMENT_SHADER);
    EXPECT_TRUE(is_valid(bind({{GL_ALL_SHADER_BITS, both}})));
    EXPECT_TRUE(may_run());
    const GLuint mixed = bind({{GL_ALL_SHADER_BITS, both}, {GL_FRAGMENT_SHADER_BIT, fragment}});
    EXPECT_FALSE(is_valid(mixed));
    EXPECT_FALSE(may_run());
    gl().UseProgram(c, fragment);
    EXPECT_TRUE(may_run()) << "the pipeline is not drawn with";
    gl().UseProgram(c, 0);
    gl().UseProgramStages(c, mixed, GL_VERTEX_SHADER_BIT, make(GL_VERTEX_SHADER));
    EXPECT_TRUE(is_valid(mixed));
    EXPECT_TRUE(may_run());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ProgramPipelines, NoProgramHasStagesOnBothSidesOfAnother) {
    const GLuint outer = make({GL_VERTEX_SHADER, GL_FRAGMENT_SHADER}), inner = make(GL_GEOMETRY_SHADER),
                 compute = make(GL_COMPUTE_SHADER);
    const GLuint pipeline = bind({{GL_VERTEX_SHADER_BIT | GL_FRAGMENT_SHADER_BIT, outer}});
    gl().UseProgramStages(c, pipeline, GL_COMPUTE_SHADER_BIT, compute);
    EXPECT_TRUE(is_valid(pipeline)) << "the compute shader lies beside them";
    gl().UseProgramStages(c, pipeline, GL_GEOMETRY_SHADER_BIT, inner);
    EXPECT_FALSE(is_valid(pipeline));
    EXPECT_FALSE(may_run());
    gl().UseProgramStages(c, pipeline, GL_GEOMETRY_SHADER_BIT, 0);
    EXPECT_TRUE(is_valid(pipeline));
}

TEST_F(ProgramPipelines, StagesBehindVerticesNeedAVertexShader) {
    const GLuint pipeline = bind({{GL_GEOMETRY_SHADER_BIT, make(GL_GEOMETRY_SHADER)}});
    EXPECT_FALSE(is_valid(pipeline));
    EXPECT_FALSE(may_run());
    gl().UseProgramStages(c, pipeline, GL_VERTEX_SHADER_BIT, make(GL_VERTEX_SHADER));
    EXPECT_TRUE(is_valid(pipeline));
    EXPECT_FALSE(is_valid(bind({}))) << "it has none at all";
}

TEST_F(ProgramPipelines, AProgramStaysSeparable) {
    const GLuint vertex = make(GL_VERTEX_SHADER);
    const GLuint pipeline = bind({{GL_VERTEX_SHADER_BIT, vertex}});
    EXPECT_TRUE(is_valid(pipeline));
    of(vertex)->linked_separable = false;  // linked again
    of(vertex)->executable->stamp = next_stamp();
    EXPECT_FALSE(is_valid(pipeline));
    EXPECT_FALSE(may_run());
}

TEST_F(ProgramPipelines, SamplersOfAllProgramsAgree) {
    const GLuint vertex = make(GL_VERTEX_SHADER, GL_SAMPLER_2D), fragment = make(GL_FRAGMENT_SHADER, GL_SAMPLER_3D);
    const GLuint pipeline = bind({{GL_VERTEX_SHADER_BIT, vertex}, {GL_FRAGMENT_SHADER_BIT, fragment}});
    EXPECT_FALSE(is_valid(pipeline));
    EXPECT_FALSE(may_run());
    gl().ProgramUniform1i(c, fragment, 0, 1);
    EXPECT_TRUE(is_valid(pipeline));
    EXPECT_TRUE(may_run());
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

TEST_F(ProgramPipelines, FunctionsMayHaveNumbersOfTheShader) {
    const GLuint vertex = make(GL_VERTEX_SHADER);
    auto& stage = of(vertex)->executable->subroutines[0];
    stage.indices = {7, 3};
    stage.uniforms[0].compatible = {7};
    gl().UseProgram(c, vertex);
    EXPECT_EQ(gl().GetSubroutineIndex(c, vertex, GL_VERTEX_SHADER, "blue"), 3u);
    EXPECT_EQ(gl().GetProgramResourceIndex(c, vertex, GL_VERTEX_SUBROUTINE, "red"), 7u);
    const GLuint red[] = {7, 7}, blue[] = {7, 3}, none[] = {7, 1};
    gl().UniformSubroutinesuiv(c, GL_VERTEX_SHADER, 2, red);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().UniformSubroutinesuiv(c, GL_VERTEX_SHADER, 2, blue);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "it fits another variable";
    gl().UniformSubroutinesuiv(c, GL_VERTEX_SHADER, 2, none);
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
