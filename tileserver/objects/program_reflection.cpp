// SPDX-License-Identifier: MIT
// What linking told about a program.
#include <algorithm>
#include <array>
#include <utility>

#include "tileserver/objects/info_log.h"
#include "tileserver/objects/program_build.h"
#include "tileserver/objects/shader_patch.h"

namespace wall::tileserver {
namespace {

void read_initial(const Gl& gl, GLuint program, glapi::ActiveUniform& uniform) {
    const auto* type = glapi::find_uniform_type(uniform.type);
    if (type == nullptr) return;
    std::array<std::uint32_t, 16> words;
    for (std::uint32_t i = 0; i < uniform.size; ++i) {
        words.fill(0);
        const GLint location = element_location(gl, program, uniform.name, i);
        if (location >= 0) {
            if (type->base == glapi::UniformBase::real)
                gl.GetUniformfv(program, location, reinterpret_cast<GLfloat*>(words.data()));
            else gl.GetUniformiv(program, location, reinterpret_cast<GLint*>(words.data()));
        }
        uniform.initial.insert(uniform.initial.end(), words.begin(), words.begin() + type->words());
    }
}

void read_uniforms(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    GLint count = 0, longest = 0;
    gl.GetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    gl.GetProgramiv(program, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLint i = 0; i < count; ++i) {
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gl.GetActiveUniform(program, static_cast<GLuint>(i), static_cast<GLsizei>(name.size()), &length, &size, &type,
                            name.data());
        glapi::ActiveUniform uniform{
            type, static_cast<std::uint32_t>(size), false, false, name.substr(0, static_cast<std::size_t>(length)), {}};
        if (uniform.name == kWindowUniform) continue;
        if (uniform.name.ends_with("[0]")) {
            uniform.array = true;
            uniform.name.resize(uniform.name.size() - 3);
        }
        uniform.array |= size > 1;
        uniform.built_in = uniform.name.starts_with("gl_");
        if (!uniform.built_in) {
            if (gl.GetUniformLocation(program, uniform.name.c_str()) < 0) continue;  // in a block
            read_initial(gl, program, uniform);
        }
        out.uniforms.push_back(std::move(uniform));
    }
}

void read_attributes(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    GLint count = 0, longest = 0;
    gl.GetProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
    gl.GetProgramiv(program, GL_ACTIVE_ATTRIBUTE_MAX_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLint i = 0; i < count; ++i) {
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gl.GetActiveAttrib(program, static_cast<GLuint>(i), static_cast<GLsizei>(name.size()), &length, &size, &type,
                           name.data());
        glapi::ActiveAttribute attribute{type, static_cast<std::uint32_t>(size), -1,
                                         name.substr(0, static_cast<std::size_t>(length))};
        attribute.location = gl.GetAttribLocation(program, attribute.name.c_str());
        out.attributes.push_back(std::move(attribute));
    }
}

}  // namespace

GLint element_location(const Gl& gl, GLuint program, const std::string& name, std::uint32_t element) {
    if (element == 0) return gl.GetUniformLocation(program, name.c_str());
    return gl.GetUniformLocation(program, (name + "[" + std::to_string(element) + "]").c_str());
}

glapi::ProgramReflection reflect_program(const Gl& gl, GLuint program) {
    glapi::ProgramReflection out;
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    out.linked = linked != 0;
    out.log = read_log([&](GLint* n) { gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, n); },
                       [&](GLsizei n, GLsizei* w, GLchar* to) { gl.GetProgramInfoLog(program, n, w, to); });
    if (!out.linked) return out;
    read_uniforms(gl, program, out);
    read_attributes(gl, program, out);
    return out;
}

}  // namespace wall::tileserver
