// SPDX-License-Identifier: MIT
#include "tileserver/objects/program_build.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "tileserver/objects/info_log.h"
#include "tileserver/objects/shader_patch.h"

namespace wall::tileserver {
namespace {

std::string_view text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_shader_type(GLenum type) {
    return std::ranges::find(glapi::kShaderStages, type) != std::end(glapi::kShaderStages);
}

GLuint build_shader(const Gl& gl, const glapi::ShaderSource& shader, BuiltProgram& built) {
    const GLuint made = gl.CreateShader(shader.type);
    if (!shader.compiled) return made;
    const PatchedShader patched =
        shader.type == GL_FRAGMENT_SHADER ? patch_fragment_shader(shader.source) : PatchedShader{shader.source};
    built.upper_left |= patched.upper_left;
    built.whole_centers |= patched.whole_centers;
    const GLchar* string = patched.source.data();
    const auto length = static_cast<GLint>(patched.source.size());
    gl.ShaderSource(made, 1, &string, &length);
    gl.CompileShader(made);
    return made;
}

void capture(const Gl& gl, GLuint program, const glapi::FeedbackDefinition& feedback) {
    if (feedback.names.empty()) return;
    std::vector<const GLchar*> names;
    for (const std::string& name : feedback.names) names.push_back(name.c_str());
    gl.TransformFeedbackVaryings(program, static_cast<GLsizei>(names.size()), names.data(), feedback.mode);
}

}  // namespace

Result<std::vector<std::byte>> compile_shader(const Gl& gl, GLenum type, std::span<const std::byte> source) {
    if (!is_shader_type(type)) return fail("no such kind of shader");
    const GLuint shader = gl.CreateShader(type);
    const GLchar* string = text(source).data();
    const auto length = static_cast<GLint>(source.size());
    gl.ShaderSource(shader, 1, &string, &length);
    gl.CompileShader(shader);
    GLint compiled = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glapi::CompileResult result{
        compiled != 0, read_log([&](GLint* n) { gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, n); },
                                [&](GLsizei n, GLsizei* w, GLchar* to) { gl.GetShaderInfoLog(shader, n, w, to); })};
    gl.DeleteShader(shader);
    return encode(result);
}

Result<glapi::ProgramDefinition> read_definition(std::span<const std::byte> bytes) {
    auto definition = glapi::decode_definition(bytes);
    if (!definition) return fail("bad program definition");
    for (const auto& shader : definition->shaders)
        if (!is_shader_type(shader.type)) return fail("no such kind of shader");
    std::uint64_t locations = 0;
    for (const auto& uniform : definition->uniforms) {
        locations += uniform.size;
        const std::uint64_t behind = std::uint64_t{uniform.location} + uniform.size;
        if (std::max(behind, locations) > glapi::kMostUniformLocations) return fail("too many uniforms");
    }
    return *std::move(definition);
}

BuiltProgram build_program(const Gl& gl, const glapi::ProgramDefinition& definition) {
    BuiltProgram built{gl.CreateProgram()};
    std::vector<GLuint> shaders;
    for (const auto& shader : definition.shaders) {
        shaders.push_back(build_shader(gl, shader, built));
        gl.AttachShader(built.driver, shaders.back());
    }
    for (const auto& attribute : definition.attributes)
        gl.BindAttribLocation(built.driver, attribute.index, attribute.name.c_str());
    for (const auto& output : definition.outputs)
        gl.BindFragDataLocationIndexed(built.driver, output.color, output.index, output.name.c_str());
    capture(gl, built.driver, definition.feedback);
    if (definition.separable) gl.ProgramParameteri(built.driver, GL_PROGRAM_SEPARABLE, GL_TRUE);
    gl.LinkProgram(built.driver);
    for (const GLuint shader : shaders) {
        gl.DetachShader(built.driver, shader);
        gl.DeleteShader(shader);
    }
    return built;
}

}  // namespace wall::tileserver
