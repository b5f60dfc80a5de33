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
#include "tileserver/objects/storage_access.h"

namespace wall::tileserver {
namespace {

using glapi::BlockPlace;

void read_doubles(const Gl& gl, GLuint program, GLint location, std::array<std::uint32_t, 32>& words) {
    std::array<GLdouble, 16> values{};
    gl.GetUniformdv(program, location, values.data());
    static_assert(sizeof values == sizeof words);
    std::memcpy(words.data(), values.data(), sizeof values);
}

void read_initial(const Gl& gl, GLuint program, glapi::ActiveUniform& uniform) {
    const auto* type = glapi::find_uniform_type(uniform.type);
    if (type == nullptr) return;
    std::array<std::uint32_t, 32> words;
    for (std::uint32_t i = 0; i < uniform.size; ++i) {
        words.fill(0);
        const GLint location = element_location(gl, program, uniform.name, i);
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

/// "name[0]" is told as an array of that name.
bool take_array_suffix(std::string& name) {
    if (!name.ends_with("[0]")) return false;
    name.resize(name.size() - 3);
    return true;
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
        if (type == GL_UNSIGNED_INT_ATOMIC_COUNTER) read_counter(gl, program, static_cast<GLuint>(i), uniform);
        if (uniform.has_location()) {
            if (gl.GetUniformLocation(program, uniform.name.c_str()) < 0) continue;
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

/// Words that ask whether each of kShaderStages refers to a resource.
constexpr GLenum kReferring[] = {GL_REFERENCED_BY_VERTEX_SHADER,          GL_REFERENCED_BY_FRAGMENT_SHADER,
                                 GL_REFERENCED_BY_GEOMETRY_SHADER,        GL_REFERENCED_BY_TESS_CONTROL_SHADER,
                                 GL_REFERENCED_BY_TESS_EVALUATION_SHADER, GL_REFERENCED_BY_COMPUTE_SHADER};
static_assert(std::size(kReferring) == std::size(glapi::kShaderStages));

/// What is told of a buffer that shaders write to.
struct WrittenBuffer {
    std::uint32_t binding = 0, bytes = 0, stages = 0;
};

WrittenBuffer read_written(const Gl& gl, GLuint program, GLenum kind, GLuint index) {
    std::array<GLenum, 2 + std::size(kReferring)> asked{GL_BUFFER_BINDING, GL_BUFFER_DATA_SIZE};
    std::ranges::copy(kReferring, asked.begin() + 2);
    std::array<GLint, asked.size()> answers{};
    gl.GetProgramResourceiv(program, kind, index, static_cast<GLsizei>(asked.size()), asked.data(),
                            static_cast<GLsizei>(answers.size()), nullptr, answers.data());
    WrittenBuffer out{static_cast<std::uint32_t>(answers[0]), static_cast<std::uint32_t>(answers[1]), 0};
    for (std::size_t stage = 0; stage < std::size(kReferring); ++stage)
        if (answers[2 + stage] != 0) out.stages |= 1u << stage;
    return out;
}

GLuint count_of(const Gl& gl, GLuint program, GLenum kind) {
    GLint count = 0;
    gl.GetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
    return static_cast<GLuint>(std::max(count, 0));
}

void read_storage_blocks(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition,
                         glapi::ProgramReflection& out) {
    GLint longest = 0;
    gl.GetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_MAX_NAME_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLuint i = 0; i < count_of(gl, program, GL_SHADER_STORAGE_BLOCK); ++i) {
        GLsizei length = 0;
        gl.GetProgramResourceName(program, GL_SHADER_STORAGE_BLOCK, i, static_cast<GLsizei>(name.size()), &length,
                                  name.data());
        const WrittenBuffer read = read_written(gl, program, GL_SHADER_STORAGE_BLOCK, i);
        glapi::ActiveStorageBlock block{
            {name.substr(0, static_cast<std::size_t>(length)), read.bytes, read.binding, read.stages}, true};
        block.written = !is_only_read(definition, block.name);
        out.storage_blocks.push_back(std::move(block));
    }
}

void read_counter_buffers(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    for (GLuint i = 0; i < count_of(gl, program, GL_ATOMIC_COUNTER_BUFFER); ++i) {
        const WrittenBuffer read = read_written(gl, program, GL_ATOMIC_COUNTER_BUFFER, i);
        out.counter_buffers.push_back({read.binding, read.bytes, read.stages});
    }
}

void read_group_size(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    std::array<GLint, 3> size{};
    gl.GetProgramiv(program, GL_COMPUTE_WORK_GROUP_SIZE, size.data());
    std::ranges::copy(size, out.group_size.begin());
}

/// What the last stage gives away is the driver's output of the program: colours, if that is a fragment shader.
void read_outputs(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    GLint count = 0, longest = 0;
    gl.GetProgramInterfaceiv(program, GL_PROGRAM_OUTPUT, GL_ACTIVE_RESOURCES, &count);
    gl.GetProgramInterfaceiv(program, GL_PROGRAM_OUTPUT, GL_MAX_NAME_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    constexpr GLenum kAsked[] = {GL_REFERENCED_BY_FRAGMENT_SHADER, GL_LOCATION, GL_LOCATION_INDEX, GL_ARRAY_SIZE};
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        GLsizei length = 0;
        std::array<GLint, std::size(kAsked)> answers{};
        gl.GetProgramResourceName(program, GL_PROGRAM_OUTPUT, i, static_cast<GLsizei>(name.size()), &length,
                                  name.data());
        gl.GetProgramResourceiv(program, GL_PROGRAM_OUTPUT, i, std::size(kAsked), kAsked,
                                static_cast<GLsizei>(answers.size()), nullptr, answers.data());
        if (answers[0] == 0 || answers[1] < 0) continue;
        glapi::ActiveOutput output{answers[1], std::max(answers[2], 0),
                                   static_cast<std::uint32_t>(std::max(answers[3], 1)), false,
                                   name.substr(0, static_cast<std::size_t>(length))};
        output.array = take_array_suffix(output.name);
        out.outputs.push_back(std::move(output));
    }
}

void read_captured(const Gl& gl, GLuint program, glapi::ProgramReflection& out) {
    GLint count = 0, longest = 0;
    gl.GetProgramiv(program, GL_TRANSFORM_FEEDBACK_VARYINGS, &count);
    gl.GetProgramiv(program, GL_TRANSFORM_FEEDBACK_VARYING_MAX_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        GLsizei length = 0, size = 0;
        GLenum type = 0;
        gl.GetTransformFeedbackVarying(program, i, static_cast<GLsizei>(name.size()), &length, &size, &type,
                                       name.data());
        out.captured.push_back(
            {type, static_cast<std::uint32_t>(size), name.substr(0, static_cast<std::size_t>(length))});
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
    if (element == 0) return gl.GetUniformLocation(program, name.c_str());
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
    read_attributes(gl, program, out);
    read_blocks(gl, program, out);
    read_outputs(gl, program, out);
    read_captured(gl, program, out);
    read_stages(gl, program, definition, out);
    read_subroutines(gl, program, out);
    read_storage_blocks(gl, program, definition, out);
    read_counter_buffers(gl, program, out);
    return out;
}

}  // namespace wall::tileserver
