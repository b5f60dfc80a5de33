// SPDX-License-Identifier: MIT
#include "tileserver/gpu/extensions.h"

#include <algorithm>

namespace wall::tileserver {

bool has_extension(const Gl& gl, std::string_view wanted) {
    GLint count = 0;
    gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        const auto* name = reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
        if (name != nullptr && wanted == name) return true;
    }
    return false;
}

bool has_assembly(const Gl& gl) {
    return gl.ProgramStringARB != nullptr && has_extension(gl, "GL_ARB_vertex_program") &&
           has_extension(gl, "GL_ARB_fragment_program");
}

GLint assembly_value(const Gl& gl, glapi::AssemblyStage stage, GLenum word) {
    GLint value = 0;
    gl.GetProgramivARB(glapi::target_of(stage), word, &value);
    return value;
}

unsigned environment_parameters(const Gl& gl, glapi::AssemblyStage stage) {
    const unsigned own = stage == glapi::AssemblyStage::fragment ? kWindowParameters : 0;
    const GLint all = assembly_value(gl, stage, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB);
    return std::max(static_cast<unsigned>(std::max(all, 0)), own) - own;
}

}  // namespace wall::tileserver
