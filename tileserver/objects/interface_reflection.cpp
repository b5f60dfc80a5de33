// SPDX-License-Identifier: MIT
// What linking told about a program's interfaces (OpenGL 4.3, 7.3.1): what goes in, what comes out, what lies in
// buffers.
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "tileserver/objects/program_build.h"
#include "tileserver/objects/storage_access.h"

namespace wall::tileserver {
namespace {

/// Words that ask whether each of glapi::kShaderStages refers to a resource.
constexpr std::array kReferring = {
    GLenum{GL_REFERENCED_BY_VERTEX_SHADER},          GLenum{GL_REFERENCED_BY_FRAGMENT_SHADER},
    GLenum{GL_REFERENCED_BY_GEOMETRY_SHADER},        GLenum{GL_REFERENCED_BY_TESS_CONTROL_SHADER},
    GLenum{GL_REFERENCED_BY_TESS_EVALUATION_SHADER}, GLenum{GL_REFERENCED_BY_COMPUTE_SHADER}};
static_assert(kReferring.size() == std::size(glapi::kShaderStages));

constexpr std::uint32_t kOfFragments = 1u << 1;
static_assert(glapi::kShaderStages[1] == GL_FRAGMENT_SHADER);

/// A driver's number that cannot be negative.
std::uint32_t whole(GLint value) { return static_cast<std::uint32_t>(std::max(value, 0)); }

/// The questions about one interface of a program.
struct Interface {
    const Gl& gl;
    GLuint program;
    GLenum kind;

    GLuint value(GLenum what) const {
        GLint value = 0;
        gl.GetProgramInterfaceiv(program, kind, what, &value);
        return whole(value);
    }
    GLuint count() const { return value(GL_ACTIVE_RESOURCES); }
    std::string name(GLuint index) const {
        std::string text(value(GL_MAX_NAME_LENGTH) + 1, '\0');
        GLsizei length = 0;
        gl.GetProgramResourceName(program, kind, index, static_cast<GLsizei>(text.size()), &length, text.data());
        text.resize(static_cast<std::size_t>(length));
        return text;
    }
    template <std::size_t kCount>
    std::array<GLint, kCount> values(GLuint index, const std::array<GLenum, kCount>& asked) const {
        std::array<GLint, kCount> answers{};
        gl.GetProgramResourceiv(program, kind, index, static_cast<GLsizei>(kCount), asked.data(),
                                static_cast<GLsizei>(kCount), nullptr, answers.data());
        return answers;
    }
    /// Of a location, that a variable begins with; 0 as well where drivers do not know the word (before OpenGL 4.4).
    std::uint32_t component(GLuint index) const {
        return whole(values(index, std::array{GLenum{GL_LOCATION_COMPONENT}})[0]);
    }
    std::uint32_t stages(GLuint index) const {
        const auto answers = values(index, kReferring);
        std::uint32_t out = 0;
        for (std::size_t stage = 0; stage < answers.size(); ++stage)
            if (answers[stage] != 0) out |= 1u << stage;
        return out;
    }
};

void read_inputs(const Interface& inputs, glapi::ProgramReflection& out) {
    constexpr std::array kAsked = {GLenum{GL_TYPE}, GLenum{GL_ARRAY_SIZE}, GLenum{GL_LOCATION},
                                   GLenum{GL_IS_PER_PATCH}};
    for (GLuint i = 0; i < inputs.count(); ++i) {
        const auto [type, size, location, patch] = inputs.values(i, kAsked);
        out.attributes.push_back({static_cast<GLenum>(type), std::max(whole(size), 1u), location, inputs.name(i),
                                  inputs.stages(i), patch != 0, inputs.component(i)});
    }
}

void read_outputs(const Interface& outputs, glapi::ProgramReflection& out) {
    constexpr std::array kAsked = {GLenum{GL_TYPE}, GLenum{GL_ARRAY_SIZE}, GLenum{GL_LOCATION},
                                   GLenum{GL_LOCATION_INDEX}, GLenum{GL_IS_PER_PATCH}};
    for (GLuint i = 0; i < outputs.count(); ++i) {
        const auto [type, size, location, index, patch] = outputs.values(i, kAsked);
        glapi::ActiveOutput output{
            location,          index,      std::max(whole(size), 1u), false, outputs.name(i), static_cast<GLenum>(type),
            outputs.stages(i), patch != 0, outputs.component(i)};
        output.array = take_array_suffix(output.name);
        const bool of_fragments = (output.stages & kOfFragments) != 0;
        output.index = of_fragments && location >= 0 ? std::max(index, 0) : -1;
        out.outputs.push_back(std::move(output));
    }
}

void read_buffer_variables(const Interface& variables, glapi::ProgramReflection& out) {
    constexpr std::array kAsked = {
        GLenum{GL_TYPE},         GLenum{GL_ARRAY_SIZE},           GLenum{GL_BLOCK_INDEX},
        GLenum{GL_OFFSET},       GLenum{GL_ARRAY_STRIDE},         GLenum{GL_MATRIX_STRIDE},
        GLenum{GL_IS_ROW_MAJOR}, GLenum{GL_TOP_LEVEL_ARRAY_SIZE}, GLenum{GL_TOP_LEVEL_ARRAY_STRIDE}};
    for (GLuint i = 0; i < variables.count(); ++i) {
        const auto [type, size, block, offset, array_stride, matrix_stride, row_major, top_size, top_stride] =
            variables.values(i, kAsked);
        glapi::BufferVariable variable{static_cast<GLenum>(type),
                                       whole(size),
                                       false,
                                       variables.name(i),
                                       {block, offset, array_stride, matrix_stride, row_major != 0},
                                       whole(top_size),
                                       whole(top_stride),
                                       variables.stages(i)};
        variable.array = take_array_suffix(variable.name);
        out.buffer_variables.push_back(std::move(variable));
    }
}

constexpr std::array kAskedOfBuffer = {GLenum{GL_BUFFER_BINDING}, GLenum{GL_BUFFER_DATA_SIZE}};

void read_storage_blocks(const Interface& blocks, const glapi::ProgramDefinition& definition,
                         glapi::ProgramReflection& out) {
    for (GLuint i = 0; i < blocks.count(); ++i) {
        const auto [binding, bytes] = blocks.values(i, kAskedOfBuffer);
        glapi::ActiveStorageBlock block{{blocks.name(i), whole(bytes), whole(binding), blocks.stages(i)}, true};
        block.written = !is_only_read(definition, block.name);
        out.storage_blocks.push_back(std::move(block));
    }
}

void read_counter_buffers(const Interface& buffers, glapi::ProgramReflection& out) {
    for (GLuint i = 0; i < buffers.count(); ++i) {
        const auto [binding, bytes] = buffers.values(i, kAskedOfBuffer);
        out.counter_buffers.push_back({whole(binding), whole(bytes), buffers.stages(i)});
    }
}

/// "gl_NextBuffer" lies in none.
void read_captured(const Interface& varyings, const Interface& buffers, glapi::ProgramReflection& out) {
    constexpr std::array kOfBuffer = {GLenum{GL_BUFFER_BINDING}, GLenum{GL_TRANSFORM_FEEDBACK_BUFFER_STRIDE}};
    for (GLuint i = 0; i < buffers.count(); ++i) {
        const auto [binding, stride] = buffers.values(i, kOfBuffer);
        out.capture_buffers.push_back({whole(binding), whole(stride)});
    }
    constexpr std::array kAsked = {GLenum{GL_TYPE}, GLenum{GL_ARRAY_SIZE}};
    constexpr std::array kPlace = {GLenum{GL_OFFSET}, GLenum{GL_TRANSFORM_FEEDBACK_BUFFER_INDEX}};
    for (GLuint i = 0; i < varyings.count(); ++i) {
        const auto [type, size] = varyings.values(i, kAsked);
        const auto [offset, buffer] = varyings.values(i, kPlace);
        const bool known = buffer >= 0 && static_cast<std::size_t>(buffer) < out.capture_buffers.size();
        out.captured.push_back({static_cast<GLenum>(type), whole(size), varyings.name(i), whole(offset),
                                known && size != 0 ? buffer : -1});
    }
}

}  // namespace

std::uint32_t uniform_stages(const Gl& gl, GLuint program, GLuint index) {
    return Interface{gl, program, GL_UNIFORM}.stages(index);
}

bool take_array_suffix(std::string& name) {
    if (!name.ends_with("[0]")) return false;
    name.resize(name.size() - 3);
    return true;
}

void read_interfaces(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition,
                     glapi::ProgramReflection& out) {
    const auto of = [&](GLenum kind) { return Interface{gl, program, kind}; };
    read_inputs(of(GL_PROGRAM_INPUT), out);
    read_outputs(of(GL_PROGRAM_OUTPUT), out);
    read_captured(of(GL_TRANSFORM_FEEDBACK_VARYING), of(GL_TRANSFORM_FEEDBACK_BUFFER), out);
    read_storage_blocks(of(GL_SHADER_STORAGE_BLOCK), definition, out);
    read_buffer_variables(of(GL_BUFFER_VARIABLE), out);
    read_counter_buffers(of(GL_ATOMIC_COUNTER_BUFFER), out);
}

}  // namespace wall::tileserver
