// SPDX-License-Identifier: MIT
#include "client_lib/objects/program_interfaces.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace wall::client {
namespace {

GLint number(std::uint32_t value) { return static_cast<GLint>(value); }

/// In the order of glapi::kShaderStages.
constexpr std::array kReferring = {
    GLenum{GL_REFERENCED_BY_VERTEX_SHADER},          GLenum{GL_REFERENCED_BY_FRAGMENT_SHADER},
    GLenum{GL_REFERENCED_BY_GEOMETRY_SHADER},        GLenum{GL_REFERENCED_BY_TESS_CONTROL_SHADER},
    GLenum{GL_REFERENCED_BY_TESS_EVALUATION_SHADER}, GLenum{GL_REFERENCED_BY_COMPUTE_SHADER}};
static_assert(kReferring.size() == std::size(glapi::kShaderStages));

/// Words beside those of kReferring.
constexpr GLenum kWords[] = {GL_NAME_LENGTH,
                             GL_TYPE,
                             GL_ARRAY_SIZE,
                             GL_OFFSET,
                             GL_BLOCK_INDEX,
                             GL_ARRAY_STRIDE,
                             GL_MATRIX_STRIDE,
                             GL_IS_ROW_MAJOR,
                             GL_ATOMIC_COUNTER_BUFFER_INDEX,
                             GL_BUFFER_BINDING,
                             GL_BUFFER_DATA_SIZE,
                             GL_NUM_ACTIVE_VARIABLES,
                             GL_ACTIVE_VARIABLES,
                             GL_TOP_LEVEL_ARRAY_SIZE,
                             GL_TOP_LEVEL_ARRAY_STRIDE,
                             GL_LOCATION,
                             GL_LOCATION_INDEX,
                             GL_LOCATION_COMPONENT,
                             GL_IS_PER_PATCH,
                             GL_NUM_COMPATIBLE_SUBROUTINES,
                             GL_COMPATIBLE_SUBROUTINES,
                             GL_TRANSFORM_FEEDBACK_BUFFER_INDEX,
                             GL_TRANSFORM_FEEDBACK_BUFFER_STRIDE};

void add_stages(Resource& to, std::uint32_t stages) {
    for (std::size_t i = 0; i < kReferring.size(); ++i) to.values.push_back({kReferring[i], number(stages >> i & 1)});
}

void add_place(Resource& to, const glapi::BlockPlace& place) {
    to.values.insert(to.values.end(), {{GL_OFFSET, place.offset},
                                       {GL_BLOCK_INDEX, place.block},
                                       {GL_ARRAY_STRIDE, place.array_stride},
                                       {GL_MATRIX_STRIDE, place.matrix_stride},
                                       {GL_IS_ROW_MAJOR, place.row_major}});
}

std::string with_suffix(const std::string& name, bool array) { return array ? name + "[0]" : name; }

// ---- uniforms and what lies in buffers ----

Resource describe_uniform(const Executable& executable, std::size_t index) {
    const Uniform& uniform = executable.uniforms[index];
    Resource out{{{GL_TYPE, number(uniform.type->type)},
                  {GL_ARRAY_SIZE, uniform.size},
                  {GL_ATOMIC_COUNTER_BUFFER_INDEX, uniform.counter_buffer},
                  {GL_LOCATION, uniform.location}},
                 {}};
    add_place(out, uniform.place);
    add_stages(out, uniform.stages);
    return out;
}

Resource describe_variable(const Executable& executable, std::size_t index) {
    const glapi::BufferVariable& variable = executable.buffer_variables[index];
    Resource out{{{GL_TYPE, number(variable.type)},
                  {GL_ARRAY_SIZE, number(variable.size)},
                  {GL_TOP_LEVEL_ARRAY_SIZE, number(variable.top_size)},
                  {GL_TOP_LEVEL_ARRAY_STRIDE, number(variable.top_stride)}},
                 {}};
    add_place(out, variable.place);
    add_stages(out, variable.stages);
    return out;
}

/// Of blocks, and of buffers that atomic counters lie in.
template <class Buffer>
Resource describe_buffer(const Buffer& buffer) {
    Resource out{{{GL_BUFFER_BINDING, number(buffer.binding)}, {GL_BUFFER_DATA_SIZE, number(buffer.bytes)}}, {}};
    add_stages(out, buffer.stages);
    return out;
}

template <auto kBlocks, auto kVariables>
Resource describe_block(const Executable& executable, std::size_t index) {
    const auto& blocks = executable.*kBlocks;
    Resource out = describe_buffer(blocks[index]);
    for_each_member(executable.*kVariables, blocks, index, [&](GLint member) { out.list.push_back(member); });
    return out;
}

Resource describe_counters(const Executable& executable, std::size_t index) {
    Resource out = describe_buffer(executable.counter_buffers[index]);
    for (std::size_t i = 0; i < executable.uniforms.size(); ++i)
        if (executable.uniforms[i].counter_buffer == static_cast<GLint>(index))
            out.list.push_back(static_cast<GLint>(i));
    return out;
}

// ---- what goes in and comes out ----

Resource describe_input(const Executable& executable, std::size_t index) {
    const glapi::ActiveAttribute& input = executable.taken()[index];
    Resource out{{{GL_TYPE, number(input.type)},
                  {GL_ARRAY_SIZE, number(input.size)},
                  {GL_LOCATION, input.location},
                  {GL_LOCATION_COMPONENT, number(input.component)},
                  {GL_IS_PER_PATCH, input.patch}},
                 {}};
    add_stages(out, input.stages);
    return out;
}

Resource describe_output(const Executable& executable, std::size_t index) {
    const glapi::ActiveOutput& output = executable.outputs[index];
    Resource out{{{GL_TYPE, number(output.type)},
                  {GL_ARRAY_SIZE, number(output.size)},
                  {GL_LOCATION, output.location},
                  {GL_LOCATION_INDEX, output.color() ? output.index : -1},
                  {GL_LOCATION_COMPONENT, number(output.component)},
                  {GL_IS_PER_PATCH, output.patch}},
                 {}};
    add_stages(out, output.stages);
    return out;
}

Resource describe_captured(const Executable& executable, std::size_t index) {
    const glapi::CapturedVarying& varying = executable.captured[index];
    return {{{GL_TYPE, number(varying.type)},
             {GL_ARRAY_SIZE, number(varying.size)},
             {GL_OFFSET, number(varying.offset)},
             {GL_TRANSFORM_FEEDBACK_BUFFER_INDEX, varying.buffer}},
            {}};
}

Resource describe_capture_buffer(const Executable& executable, std::size_t index) {
    const glapi::CaptureBuffer& buffer = executable.capture_buffers[index];
    Resource out{
        {{GL_BUFFER_BINDING, number(buffer.binding)}, {GL_TRANSFORM_FEEDBACK_BUFFER_STRIDE, number(buffer.stride)}},
        {}};
    for (std::size_t i = 0; i < executable.captured.size(); ++i)
        if (executable.captured[i].buffer == static_cast<GLint>(index)) out.list.push_back(static_cast<GLint>(i));
    return out;
}

// ---- subroutines ----

/// Null: the stage has none.
const Subroutines* stage_of(const Executable& executable, GLenum stage) {
    const auto found = std::ranges::find(executable.subroutines, stage, &Subroutines::stage);
    return found == executable.subroutines.end() ? nullptr : &*found;
}

template <GLenum kStage, auto kItems>
std::size_t count_of_stage(const Executable& executable) {
    const Subroutines* stage = stage_of(executable, kStage);
    return stage ? (stage->*kItems).size() : 0;
}

template <GLenum kStage>
std::string function_name(const Executable& executable, std::size_t index) {
    return stage_of(executable, kStage)->functions[index];
}

template <GLenum kStage>
GLuint function_number(const Executable& executable, std::size_t index) {
    return stage_of(executable, kStage)->index_of(index);
}

Resource describe_function(const Executable&, std::size_t) { return {}; }

template <GLenum kStage>
std::string subroutine_uniform_name(const Executable& executable, std::size_t index) {
    const glapi::SubroutineUniform& uniform = stage_of(executable, kStage)->uniforms[index];
    return with_suffix(uniform.name, uniform.array);
}

template <GLenum kStage>
Resource describe_subroutine_uniform(const Executable& executable, std::size_t index) {
    const glapi::SubroutineUniform& uniform = stage_of(executable, kStage)->uniforms[index];
    return {{{GL_ARRAY_SIZE, number(uniform.size)}, {GL_LOCATION, uniform.location}},
            {uniform.compatible.begin(), uniform.compatible.end()}};
}

// ---- the table ----

template <auto kItems>
std::size_t count_of(const Executable& executable) {
    return (executable.*kItems).size();
}

/// As it is told.
template <auto kItems>
std::string plain_name(const Executable& executable, std::size_t index) {
    return (executable.*kItems)[index].name;
}

template <auto kItems>
std::string full_name(const Executable& executable, std::size_t index) {
    const auto& item = (executable.*kItems)[index];
    return with_suffix(item.name, item.array);
}

std::size_t count_of_inputs(const Executable& executable) { return executable.taken().size(); }
std::string input_name(const Executable& executable, std::size_t index) { return executable.taken()[index].name; }

using E = Executable;
using S = glapi::SubroutineStage;

template <GLenum kStage>
constexpr ProgramInterface functions_of(GLenum name) {
    return {name,
            count_of_stage<kStage, &S::functions>,
            describe_function,
            function_name<kStage>,
            0,
            0,
            0,
            function_number<kStage>};
}

template <GLenum kStage>
constexpr ProgramInterface subroutine_uniforms_of(GLenum name) {
    return {name,
            count_of_stage<kStage, &S::uniforms>,
            describe_subroutine_uniform<kStage>,
            subroutine_uniform_name<kStage>,
            GL_COMPATIBLE_SUBROUTINES,
            GL_NUM_COMPATIBLE_SUBROUTINES,
            GL_MAX_NUM_COMPATIBLE_SUBROUTINES};
}

/// With a list of active variables.
constexpr ProgramInterface buffers_of(GLenum name, std::size_t (*count)(const E&),
                                      Resource (*describe)(const E&, std::size_t),
                                      std::string (*name_of)(const E&, std::size_t)) {
    return {name, count, describe, name_of, GL_ACTIVE_VARIABLES, GL_NUM_ACTIVE_VARIABLES, GL_MAX_NUM_ACTIVE_VARIABLES};
}

constexpr ProgramInterface kInterfaces[] = {
    {GL_UNIFORM, count_of<&E::uniforms>, describe_uniform, full_name<&E::uniforms>},
    buffers_of(GL_UNIFORM_BLOCK, count_of<&E::blocks>, describe_block<&E::blocks, &E::uniforms>,
               plain_name<&E::blocks>),
    {GL_PROGRAM_INPUT, count_of_inputs, describe_input, input_name},
    {GL_PROGRAM_OUTPUT, count_of<&E::outputs>, describe_output, full_name<&E::outputs>},
    {GL_BUFFER_VARIABLE, count_of<&E::buffer_variables>, describe_variable, full_name<&E::buffer_variables>},
    buffers_of(GL_SHADER_STORAGE_BLOCK, count_of<&E::storage_blocks>,
               describe_block<&E::storage_blocks, &E::buffer_variables>, plain_name<&E::storage_blocks>),
    buffers_of(GL_ATOMIC_COUNTER_BUFFER, count_of<&E::counter_buffers>, describe_counters, nullptr),
    {GL_TRANSFORM_FEEDBACK_VARYING, count_of<&E::captured>, describe_captured, plain_name<&E::captured>},
    buffers_of(GL_TRANSFORM_FEEDBACK_BUFFER, count_of<&E::capture_buffers>, describe_capture_buffer, nullptr),
    functions_of<GL_VERTEX_SHADER>(GL_VERTEX_SUBROUTINE),
    functions_of<GL_TESS_CONTROL_SHADER>(GL_TESS_CONTROL_SUBROUTINE),
    functions_of<GL_TESS_EVALUATION_SHADER>(GL_TESS_EVALUATION_SUBROUTINE),
    functions_of<GL_GEOMETRY_SHADER>(GL_GEOMETRY_SUBROUTINE),
    functions_of<GL_FRAGMENT_SHADER>(GL_FRAGMENT_SUBROUTINE),
    functions_of<GL_COMPUTE_SHADER>(GL_COMPUTE_SUBROUTINE),
    subroutine_uniforms_of<GL_VERTEX_SHADER>(GL_VERTEX_SUBROUTINE_UNIFORM),
    subroutine_uniforms_of<GL_TESS_CONTROL_SHADER>(GL_TESS_CONTROL_SUBROUTINE_UNIFORM),
    subroutine_uniforms_of<GL_TESS_EVALUATION_SHADER>(GL_TESS_EVALUATION_SUBROUTINE_UNIFORM),
    subroutine_uniforms_of<GL_GEOMETRY_SHADER>(GL_GEOMETRY_SUBROUTINE_UNIFORM),
    subroutine_uniforms_of<GL_FRAGMENT_SHADER>(GL_FRAGMENT_SUBROUTINE_UNIFORM),
    subroutine_uniforms_of<GL_COMPUTE_SHADER>(GL_COMPUTE_SUBROUTINE_UNIFORM),
};

}  // namespace

const ProgramInterface* find_program_interface(GLenum name) {
    const auto* found = std::ranges::find(kInterfaces, name, &ProgramInterface::name);
    return found == std::end(kInterfaces) ? nullptr : found;
}

bool is_resource_word(GLenum word) {
    return std::ranges::find(kWords, word) != std::end(kWords) ||
           std::ranges::find(kReferring, word) != kReferring.end();
}

GLuint resource_index(const ProgramInterface& interface, const Executable& executable, std::string_view name) {
    if (!interface.name_of) return GL_INVALID_INDEX;
    const bool exactly =
        interface.name == GL_TRANSFORM_FEEDBACK_VARYING;  // named as glTransformFeedbackVaryings was told
    const std::string first = std::string(name) + "[0]";
    const std::size_t count = interface.count(executable);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string each = interface.name_of(executable, i);
        if (each == name || (!exactly && each == first))
            return interface.number_of ? interface.number_of(executable, i) : static_cast<GLuint>(i);
    }
    return GL_INVALID_INDEX;
}

}  // namespace wall::client
