// SPDX-License-Identifier: MIT
// What linking told about a program.
#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <utility>

#include "tileserver/objects/info_log.h"
#include "tileserver/objects/program_build.h"
#include "tileserver/objects/shader_patch.h"

namespace wall::tileserver {
namespace {

using glapi::BlockPlace;

/// Whether there were any.
bool take_errors(const Gl& gl) {
    int errors = 0;
    while (errors < 64 && gl.GetError() != GL_NO_ERROR) ++errors;
    return errors != 0;
}

void read_doubles(const Gl& gl, GLuint program, GLint location, std::array<std::uint32_t, 32>& words) {
    std::array<GLdouble, 16> values{};
    gl.GetUniformdv(program, location, values.data());
    static_assert(sizeof values == sizeof words);
    std::memcpy(words.data(), values.data(), sizeof values);
}

std::vector<GLint> element_locations(const Gl& gl, GLuint program, const std::string& name, std::uint32_t elements) {
    std::vector<GLint> out;
    for (std::uint32_t i = 0; i < std::max(elements, 1u); ++i) out.push_back(element_location(gl, program, name, i));
    return out;
}

/// Whether each lies behind the one before it, as the client's do.
bool is_row(const std::vector<GLint>& locations) {
    for (std::size_t i = 1; i < locations.size(); ++i)
        if (locations[i] != locations[0] + static_cast<GLint>(i)) return false;
    return true;
}

void read_initial(const Gl& gl, GLuint program, const std::vector<GLint>& locations, glapi::ActiveUniform& uniform) {
    const auto* type = glapi::find_uniform_type(uniform.type);
    if (type == nullptr) return;
    std::array<std::uint32_t, 32> words;
    for (const GLint location : locations) {
        words.fill(0);
        if (location >= 0) {
            if (type->base == glapi::UniformBase::real)
                gl.GetUniformfv(program, location, reinterpret_cast<GLfloat*>(words.data()));
            else if (type->base == glapi::UniformBase::double_real) read_doubles(gl, program, location, words);
            else if (type->base == glapi::UniformBase::unsigned_integer)
                gl.GetUniformuiv(program, location, words.data());
            else gl.GetUniformiv(program, location, reinterpret_cast<GLint*>(words.data()));
        }
        uniform.initial.insert(uniform.initial.end(), words.begin(), words.begin() + type->words());
    }
}

BlockPlace read_place(const Gl& gl, GLuint program, GLuint uniform) {
    const auto ask = [&](GLenum what) {
        GLint value = -1;
        gl.GetActiveUniformsiv(program, 1, &uniform, what, &value);
        return value;
    };
    const GLint block = ask(GL_UNIFORM_BLOCK_INDEX);
    if (block < 0) return {};
    return {block, ask(GL_UNIFORM_OFFSET), ask(GL_UNIFORM_ARRAY_STRIDE), ask(GL_UNIFORM_MATRIX_STRIDE),
            ask(GL_UNIFORM_IS_ROW_MAJOR) == GL_TRUE};
}

/// Where an atomic counter lies.
void read_counter(const Gl& gl, GLuint program, GLuint uniform, glapi::ActiveUniform& counter) {
    const auto ask = [&](GLenum what) {
        GLint value = -1;
        gl.GetActiveUniformsiv(program, 1, &uniform, what, &value);
        return value;
    };
    counter.counter_buffer = ask(GL_UNIFORM_ATOMIC_COUNTER_BUFFER_INDEX);
    counter.place.offset = ask(GL_UNIFORM_OFFSET);
    counter.place.array_stride = ask(GL_UNIFORM_ARRAY_STRIDE);
    counter.place.matrix_stride = 0;
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
        uniform.array = take_array_suffix(uniform.name) || size > 1;
        uniform.built_in = uniform.name.starts_with("gl_");
        uniform.place = read_place(gl, program, static_cast<GLuint>(i));
        uniform.stages = uniform_stages(gl, program, static_cast<GLuint>(i));
        if (type == GL_UNSIGNED_INT_ATOMIC_COUNTER) read_counter(gl, program, static_cast<GLuint>(i), uniform);
        if (uniform.has_location()) {
            const std::vector<GLint> locations = element_locations(gl, program, uniform.name, uniform.size);
            if (locations.front() < 0) continue;
            if (is_row(locations)) uniform.location = locations.front();
            read_initial(gl, program, locations, uniform);
        }
        out.uniforms.push_back(std::move(uniform));
    }
}

void read_blocks(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    constexpr GLenum kReferenced[] = {
        GL_UNIFORM_BLOCK_REFERENCED_BY_VERTEX_SHADER,          GL_UNIFORM_BLOCK_REFERENCED_BY_FRAGMENT_SHADER,
        GL_UNIFORM_BLOCK_REFERENCED_BY_GEOMETRY_SHADER,        GL_UNIFORM_BLOCK_REFERENCED_BY_TESS_CONTROL_SHADER,
        GL_UNIFORM_BLOCK_REFERENCED_BY_TESS_EVALUATION_SHADER, GL_UNIFORM_BLOCK_REFERENCED_BY_COMPUTE_SHADER};
    static_assert(std::size(kReferenced) == std::size(glapi::kShaderStages));
    GLint count = 0, longest = 0;
    gl.GetProgramiv(program, GL_ACTIVE_UNIFORM_BLOCKS, &count);
    gl.GetProgramiv(program, GL_ACTIVE_UNIFORM_BLOCK_MAX_NAME_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        GLsizei length = 0;
        gl.GetActiveUniformBlockName(program, i, static_cast<GLsizei>(name.size()), &length, name.data());
        const auto ask = [&](GLenum what) {
            GLint value = 0;
            gl.GetActiveUniformBlockiv(program, i, what, &value);
            return static_cast<std::uint32_t>(value);
        };
        glapi::ActiveBlock block{name.substr(0, static_cast<std::size_t>(length)), ask(GL_UNIFORM_BLOCK_DATA_SIZE),
                                 ask(GL_UNIFORM_BLOCK_BINDING), 0};
        for (std::size_t stage = 0; stage < std::size(kReferenced); ++stage)
            if (ask(kReferenced[stage]) != 0) block.stages |= 1u << stage;
        out.blocks.push_back(std::move(block));
    }
}

void read_group_size(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    std::array<GLint, 3> size{};
    gl.GetProgramiv(program, GL_COMPUTE_WORK_GROUP_SIZE, size.data());
    std::ranges::copy(size, out.group_size.begin());
}

/// A shader may give a uniform a location and not use it.
bool gives_locations(const glapi::ProgramDefinition& definition) {
    return std::ranges::any_of(definition.shaders, [](const glapi::ShaderSource& shader) {
        return shader.source.find("location") != std::string::npos &&
               shader.source.find("uniform") != std::string::npos;
    });
}

/// No driver lists them: a value is set where no active uniform is, which is an error but at such a location. They are
/// looked for below OpenGL's least GL_MAX_UNIFORM_LOCATIONS.
void find_unused_locations(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition,
                           glapi::ProgramReflection& out) {
    constexpr std::uint32_t kLookedFor = 1024;
    if (!gives_locations(definition)) return;
    std::array<bool, kLookedFor> active{};
    for (const glapi::ActiveUniform& uniform : out.uniforms) {
        if (!uniform.has_location()) continue;
        if (uniform.location < 0) return;
        for (std::uint64_t i = 0; i < uniform.size; ++i)
            if (const std::uint64_t at = static_cast<std::uint64_t>(uniform.location) + i; at < kLookedFor)
                active[at] = true;
    }
    if (const GLint window = gl.GetUniformLocation(program, kWindowUniform);
        window >= 0 && window < static_cast<GLint>(kLookedFor))
        active[static_cast<std::size_t>(window)] = true;
    take_errors(gl);
    for (std::uint32_t i = 0; i < kLookedFor; ++i) {
        if (active[i]) continue;
        gl.ProgramUniform1i(program, static_cast<GLint>(i), 0);
        if (!take_errors(gl)) out.unused_locations.push_back(i);
    }
}

/// Of the stages between that of vertices and that of fragments.
void read_stages(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition,
                 glapi::ProgramReflection& out) {
    const auto ask = [&](GLenum what) {
        GLint value = 0;
        gl.GetProgramiv(program, what, &value);
        return static_cast<std::uint32_t>(value);
    };
    const auto has = [&](GLenum type) {
        return std::ranges::find(definition.shaders, type, &glapi::ShaderSource::type) != definition.shaders.end();
    };
    if (has(GL_TESS_CONTROL_SHADER)) out.tessellation.vertices = ask(GL_TESS_CONTROL_OUTPUT_VERTICES);
    if (has(GL_TESS_EVALUATION_SHADER)) {
        out.tessellation.mode = ask(GL_TESS_GEN_MODE);
        out.tessellation.spacing = ask(GL_TESS_GEN_SPACING);
        out.tessellation.order = ask(GL_TESS_GEN_VERTEX_ORDER);
        out.tessellation.point_mode = ask(GL_TESS_GEN_POINT_MODE);
    }
    if (has(GL_COMPUTE_SHADER)) read_group_size(gl, program, out);
    if (!has(GL_GEOMETRY_SHADER)) return;
    out.geometry = {ask(GL_GEOMETRY_INPUT_TYPE), ask(GL_GEOMETRY_OUTPUT_TYPE), ask(GL_GEOMETRY_VERTICES_OUT),
                    ask(GL_GEOMETRY_SHADER_INVOCATIONS)};
}

}  // namespace

GLint element_location(const Gl& gl, GLuint program, const std::string& name, std::uint32_t element) {
    const GLint first = element == 0 ? gl.GetUniformLocation(program, name.c_str()) : -1;
    if (first >= 0) return first;  // of an array of arrays the name alone may be none
    return gl.GetUniformLocation(program, (name + "[" + std::to_string(element) + "]").c_str());
}

glapi::ProgramReflection reflect_program(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition) {
    glapi::ProgramReflection out;
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    out.linked = linked != 0;
    out.log = read_log([&](GLint* n) { gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, n); },
                       [&](GLsizei n, GLsizei* w, GLchar* to) { gl.GetProgramInfoLog(program, n, w, to); });
    if (!out.linked) return out;
    read_uniforms(gl, program, out);
    read_blocks(gl, program, out);
    read_stages(gl, program, definition, out);
    read_subroutines(gl, program, out);
    read_interfaces(gl, program, definition, out);
    find_unused_locations(gl, program, definition, out);
    return out;
}

}  // namespace wall::tileserver
