// SPDX-License-Identifier: MIT
// What linking told about a program's subroutines (OpenGL 4.0, 2.11.5).
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tileserver/objects/program_build.h"

namespace wall::tileserver {
namespace {

/// The questions about one stage of a program.
struct StageQuestions {
    const Gl& gl;
    GLuint program;
    GLenum stage;

    std::uint32_t ask(GLenum what) const {
        GLint value = 0;
        gl.GetProgramStageiv(program, stage, what, &value);
        return static_cast<std::uint32_t>(std::max(value, 0));
    }
    std::uint32_t ask(GLuint uniform, GLenum what) const {
        GLint value = 0;
        gl.GetActiveSubroutineUniformiv(program, stage, uniform, what, &value);
        return static_cast<std::uint32_t>(std::max(value, 0));
    }
    /// The name of number `index`, as `get` of the driver's functions gives it.
    template <class Get>
    std::string name(Get get, GLuint index, std::uint32_t longest) const {
        std::string text(longest + 1, '\0');
        GLsizei length = 0;
        get(program, stage, index, static_cast<GLsizei>(text.size()), &length, text.data());
        text.resize(static_cast<std::size_t>(length));
        return text;
    }
};

glapi::SubroutineUniform read_uniform(const StageQuestions& questions, GLuint index, std::uint32_t longest) {
    glapi::SubroutineUniform out;
    out.name = questions.name(questions.gl.GetActiveSubroutineUniformName, index, longest);
    out.size = std::max(questions.ask(index, GL_UNIFORM_SIZE), 1u);
    out.array = out.name.ends_with("[0]");
    out.location = questions.gl.GetSubroutineUniformLocation(questions.program, questions.stage, out.name.c_str());
    if (out.array) out.name.resize(out.name.size() - 3);
    std::vector<GLint> compatible(questions.ask(index, GL_NUM_COMPATIBLE_SUBROUTINES));
    if (!compatible.empty())
        questions.gl.GetActiveSubroutineUniformiv(questions.program, questions.stage, index, GL_COMPATIBLE_SUBROUTINES,
                                                  compatible.data());
    out.compatible.assign(compatible.begin(), compatible.end());
    return out;
}

}  // namespace

void read_subroutines(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    for (const GLenum stage : glapi::kShaderStages) {
        const StageQuestions questions{gl, program, stage};
        const std::uint32_t functions = questions.ask(GL_ACTIVE_SUBROUTINES),
                            uniforms = questions.ask(GL_ACTIVE_SUBROUTINE_UNIFORMS);
        if (functions == 0 && uniforms == 0) continue;
        glapi::SubroutineStage found{stage, {}, {}, questions.ask(GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS), {}};
        const std::uint32_t longest = questions.ask(GL_ACTIVE_SUBROUTINE_MAX_LENGTH),
                            longest_uniform = questions.ask(GL_ACTIVE_SUBROUTINE_UNIFORM_MAX_LENGTH);
        for (GLuint i = 0; i < functions; ++i) {
            found.functions.push_back(questions.name(gl.GetActiveSubroutineName, i, longest));
            found.indices.push_back(gl.GetSubroutineIndex(program, stage, found.functions.back().c_str()));
        }
        for (GLuint i = 0; i < uniforms; ++i) found.uniforms.push_back(read_uniform(questions, i, longest_uniform));
        out.subroutines.push_back(std::move(found));
    }
}

}  // namespace wall::tileserver
