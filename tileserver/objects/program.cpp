// SPDX-License-Identifier: MIT
#include "tileserver/objects/program.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "common/glapi/named_camera.h"
#include "common/glstate/view_change.h"
#include "tileserver/objects/position_recogniser.h"
#include "tileserver/objects/program_build.h"
#include "tileserver/objects/shader_patch.h"
#include "tileserver/objects/window_coordinates.h"

namespace wall::tileserver {
namespace {

// A linked program is source, intermediate code and machine code.
constexpr std::uint64_t kProgramBytes = 64 << 10, kBytesForEachOfSource = 8;

void set_matrix(const Gl& gl, GLuint program, GLint location, GLsizei count, const glapi::UniformType& type,
                const GLfloat* v) {
    using Call = decltype(gl.ProgramUniformMatrix2fv);
    const Call calls[3][3] = {
        {gl.ProgramUniformMatrix2fv, gl.ProgramUniformMatrix2x3fv, gl.ProgramUniformMatrix2x4fv},
        {gl.ProgramUniformMatrix3x2fv, gl.ProgramUniformMatrix3fv, gl.ProgramUniformMatrix3x4fv},
        {gl.ProgramUniformMatrix4x2fv, gl.ProgramUniformMatrix4x3fv, gl.ProgramUniformMatrix4fv},
    };
    calls[type.columns - 2][type.rows - 2](program, location, count, GL_FALSE, v);
}

void set_matrix(const Gl& gl, GLuint program, GLint location, GLsizei count, const glapi::UniformType& type,
                const GLdouble* v) {
    using Call = decltype(gl.ProgramUniformMatrix2dv);
    const Call calls[3][3] = {
        {gl.ProgramUniformMatrix2dv, gl.ProgramUniformMatrix2x3dv, gl.ProgramUniformMatrix2x4dv},
        {gl.ProgramUniformMatrix3x2dv, gl.ProgramUniformMatrix3dv, gl.ProgramUniformMatrix3x4dv},
        {gl.ProgramUniformMatrix4x2dv, gl.ProgramUniformMatrix4x3dv, gl.ProgramUniformMatrix4dv},
    };
    calls[type.columns - 2][type.rows - 2](program, location, count, GL_FALSE, v);
}

/// `bytes` are aligned to 4.
void set_doubles(const Gl& gl, GLuint program, GLint location, GLsizei count, const glapi::UniformType& type,
                 std::span<const std::byte> bytes) {
    std::vector<GLdouble> values(bytes.size() / sizeof(GLdouble));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(GLdouble));
    if (type.matrix()) return set_matrix(gl, program, location, count, type, values.data());
    const decltype(gl.ProgramUniform1dv) calls[] = {gl.ProgramUniform1dv, gl.ProgramUniform2dv, gl.ProgramUniform3dv,
                                                    gl.ProgramUniform4dv};
    calls[type.rows - 1](program, location, count, values.data());
}

void set_vector(const Gl& gl, GLuint program, GLint location, GLsizei count, const glapi::UniformType& type,
                const std::byte* values) {
    const auto call = [&](const auto(&calls)[4], auto* v) { calls[type.rows - 1](program, location, count, v); };
    if (type.base == glapi::UniformBase::real) {
        const decltype(gl.ProgramUniform1fv) calls[] = {gl.ProgramUniform1fv, gl.ProgramUniform2fv,
                                                        gl.ProgramUniform3fv, gl.ProgramUniform4fv};
        call(calls, reinterpret_cast<const GLfloat*>(values));
    } else if (type.base == glapi::UniformBase::unsigned_integer) {
        const decltype(gl.ProgramUniform1uiv) calls[] = {gl.ProgramUniform1uiv, gl.ProgramUniform2uiv,
                                                         gl.ProgramUniform3uiv, gl.ProgramUniform4uiv};
        call(calls, reinterpret_cast<const GLuint*>(values));
    } else {
        const decltype(gl.ProgramUniform1iv) calls[] = {gl.ProgramUniform1iv, gl.ProgramUniform2iv,
                                                        gl.ProgramUniform3iv, gl.ProgramUniform4iv};
        call(calls, reinterpret_cast<const GLint*>(values));
    }
}

/// Geometry and tessellation shaders may put several triangles at one depth. A word in a comment does no harm.
bool draws_each_alone(const glapi::ProgramDefinition& definition) {
    return std::ranges::all_of(definition.shaders, [](const glapi::ShaderSource& shader) {
        const bool plain = shader.type == GL_VERTEX_SHADER || shader.type == GL_FRAGMENT_SHADER;
        return plain && shader.source.find("gl_PrimitiveID") == std::string::npos;
    });
}

}  // namespace

void Program::release() {
    if (name_ == 0) return;
    driver_.forget_program(name_);
    driver_.gl().DeleteProgram(std::exchange(name_, 0));
}

std::vector<GLint> Program::map_locations(GLuint program, const std::vector<glapi::UniformName>& names) const {
    std::vector<GLint> out;
    for (const auto& uniform : names) {
        out.resize(std::max<std::size_t>(out.size(), uniform.location + uniform.size), -1);
        for (std::uint32_t i = 0; i < uniform.size; ++i)
            out[uniform.location + i] = element_location(driver_.gl(), program, uniform.name, i);
    }
    return out;
}

/// All that are active, whether the client has named them or not: what others have bound must not be seen.
void Program::find_blocks(const std::vector<std::string>& names) {
    const Gl& gl = driver_.gl();
    blocks_.clear();
    for (const std::string& name : names) blocks_.push_back(gl.GetUniformBlockIndex(name_, name.c_str()));
    GLint count = 0;
    gl.GetProgramiv(name_, GL_ACTIVE_UNIFORM_BLOCKS, &count);
    block_bindings_.clear();
    for (GLuint i = 0; i < static_cast<GLuint>(std::max(count, 0)); ++i) {
        GLint binding = 0;
        gl.GetActiveUniformBlockiv(name_, i, GL_UNIFORM_BLOCK_BINDING, &binding);
        constexpr auto kLast = static_cast<GLint>(glstate::el::uniform_buffer::count - 1);
        if (binding > kLast) gl.UniformBlockBinding(name_, i, static_cast<GLuint>(kLast));
        block_bindings_.push_back(static_cast<std::uint32_t>(std::clamp(binding, 0, kLast)));
    }
}

namespace {

/// Calls use(index) for each active resource of a kind.
template <class Use>
void for_each_resource(const Gl& gl, GLuint program, GLenum kind, Use&& use) {
    GLint count = 0;
    gl.GetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; ++i) use(static_cast<GLuint>(i));
}

GLint resource_value(const Gl& gl, GLuint program, GLenum kind, GLuint index, GLenum what) {
    GLint value = 0;
    gl.GetProgramResourceiv(program, kind, index, 1, &what, 1, nullptr, &value);
    return value;
}

}  // namespace

/// As find_blocks().
void Program::find_storage_blocks(const std::vector<std::string>& names) {
    const Gl& gl = driver_.gl();
    storage_blocks_.clear();
    for (const std::string& name : names)
        storage_blocks_.push_back(gl.GetProgramResourceIndex(name_, GL_SHADER_STORAGE_BLOCK, name.c_str()));
    storage_bindings_.clear();
    for_each_resource(gl, name_, GL_SHADER_STORAGE_BLOCK, [&](GLuint i) {
        const GLint binding = resource_value(gl, name_, GL_SHADER_STORAGE_BLOCK, i, GL_BUFFER_BINDING);
        constexpr auto kLast = static_cast<GLint>(glstate::el::storage_buffer::count - 1);
        if (binding > kLast) gl.ShaderStorageBlockBinding(name_, i, static_cast<GLuint>(kLast));
        storage_bindings_.push_back(static_cast<std::uint32_t>(std::clamp(binding, 0, kLast)));
    });
}

/// Behind the last place nothing is ever bound.
void Program::find_counters() {
    const Gl& gl = driver_.gl();
    counter_bindings_.clear();
    for_each_resource(gl, name_, GL_ATOMIC_COUNTER_BUFFER, [&](GLuint i) {
        const GLint binding = resource_value(gl, name_, GL_ATOMIC_COUNTER_BUFFER, i, GL_BUFFER_BINDING);
        if (binding >= 0 && binding < static_cast<GLint>(glstate::el::counter_buffer::count))
            counter_bindings_.push_back(static_cast<std::uint32_t>(binding));
    });
}

void Program::find_images() {
    has_images_ = false;
    for_each_resource(driver_.gl(), name_, GL_UNIFORM, [&](GLuint i) {
        const auto* type =
            glapi::find_uniform_type(static_cast<GLenum>(resource_value(driver_.gl(), name_, GL_UNIFORM, i, GL_TYPE)));
        has_images_ = has_images_ || (type != nullptr && type->base == glapi::UniformBase::image);
    });
}

void Program::find_attributes() {
    const Gl& gl = driver_.gl();
    attributes_ = 0;
    for_each_resource(gl, name_, GL_PROGRAM_INPUT, [&](GLuint i) {
        const auto value = [&](GLenum what) { return resource_value(gl, name_, GL_PROGRAM_INPUT, i, what); };
        const GLint location = value(GL_LOCATION);
        if (location < 0 || value(GL_REFERENCED_BY_VERTEX_SHADER) == 0) return;  // of fixed function, or no vertex's
        const auto* type = glapi::find_uniform_type(static_cast<GLenum>(value(GL_TYPE)));
        const GLint places = std::max(value(GL_ARRAY_SIZE), 1) * (type != nullptr ? type->columns : 1);
        constexpr auto kAll = static_cast<GLint>(glstate::el::vertex_attrib::count);
        for (GLint at = location; at < std::min(location + places, kAll); ++at) attributes_ |= 1u << at;
    });
}

void Program::find_group() {
    std::array<GLint, 3> size{};
    if (computes_) driver_.gl().GetProgramiv(name_, GL_COMPUTE_WORK_GROUP_SIZE, size.data());
    group_invocations_ = 1;
    for (const GLint each : size) group_invocations_ *= static_cast<std::uint64_t>(std::max(each, 0));
}

/// With the values that the driver begins with. One with a uniform that is not active here is not followed.
void Program::follow_position(glapi::PositionProgram position, const std::vector<glapi::UniformName>& names) {
    position_ = {};
    std::vector<std::uint32_t> locations;
    for (const glapi::PositionUniform& wanted : position.uniforms) {
        const auto at = std::ranges::find(names, wanted.name, &glapi::UniformName::name);
        if (at == names.end() || wanted.element >= at->size || locations_[at->location + wanted.element] < 0) return;
        locations.push_back(at->location + wanted.element);
    }
    position_ = {std::move(position), std::move(locations)};
    const auto begin_with = [&](std::uint32_t uniform, std::size_t components) {
        const std::uint32_t location = position_.locations()[uniform];
        std::array<std::uint32_t, 16> words{};
        driver_.gl().GetUniformfv(name_, locations_[location], reinterpret_cast<GLfloat*>(words.data()));
        position_.set(location, components, std::span(words).first(components));
    };
    for (const glapi::PositionStep& step : position_.program().steps)
        if (step.op == glapi::PositionOp::uniform) begin_with(step.operands[0], step.components());
    if (const auto& camera = position_.program().camera) begin_with(*camera, 16);
}

Result<std::vector<std::byte>> Program::link(std::span<const std::byte> bytes, bool wants_reflection,
                                             const glapi::ProgramReflection* recognised) {
    const auto definition = read_definition(bytes);
    if (!definition) return tl::unexpected(definition.error());
    const BuiltProgram built = build_program(driver_.gl(), *definition);
    GLint linked = 0;
    driver_.gl().GetProgramiv(built.driver, GL_LINK_STATUS, &linked);
    glapi::ProgramReflection reflection;
    const bool named =
        !definition->uniforms.empty() || !definition->blocks.empty() || !definition->storage_blocks.empty();
    if (wants_reflection || !named) reflection = reflect_program(driver_.gl(), built.driver, *definition);
    if (linked == 0) {
        driver_.gl().DeleteProgram(built.driver);
        return encode(reflection);
    }
    // Once for all nodes: the others are told by the definition.
    glapi::PositionProgram position = definition->position;
    if (wants_reflection) {
        if (recognised != nullptr) {
            position = recognised->position;
            reflection.lookups = recognised->lookups;
        } else {
            RecognisedPosition found = recognise_position(*definition);
            position = std::move(found.program);
            reflection.lookups = std::move(found.lookups);
        }
        glapi::name_camera(position, definition->cameras, reflection.uniforms);
        reflection.position = position;
    }
    std::vector<glapi::UniformName> names = definition->uniforms;
    std::vector<std::string> blocks = definition->blocks, storage_blocks = definition->storage_blocks;
    if (!named) {
        auto numbered = glapi::number_uniforms(reflection.uniforms);
        if (!numbered) {
            driver_.gl().DeleteProgram(built.driver);
            return fail("more uniforms than a program may have");
        }
        names = *std::move(numbered);
        for (const auto& block : reflection.blocks) blocks.push_back(block.name);
        for (const auto& block : reflection.storage_blocks) storage_blocks.push_back(block.name);
    }
    release();
    name_ = built.driver;
    computes_ = std::ranges::find(definition->shaders, GLenum{GL_COMPUTE_SHADER}, &glapi::ShaderSource::type) !=
                definition->shaders.end();
    in_any_order_ = draws_each_alone(*definition);
    locations_ = map_locations(name_, names);
    find_blocks(blocks);
    find_storage_blocks(storage_blocks);
    find_counters();
    find_images();
    find_attributes();
    find_group();
    find_subroutines();
    follow_position(std::move(position), names);
    window_ = driver_.gl().GetUniformLocation(name_, kWindowUniform);
    upper_left_ = built.upper_left;
    whole_centers_ = built.whole_centers;
    window_value_ = {};
    view_.reset();
    renamed();
    if (!has_content(kProgramBytes + kBytesForEachOfSource * bytes.size())) return fail(too_much("programs"));
    return encode(reflection);
}

// ---- drawing ----

Result<void> Program::set_uniform(std::uint32_t location, GLenum type_name, std::uint32_t count,
                                  std::span<const std::byte> values) {
    const auto* type = glapi::find_uniform_type(type_name);
    if (type == nullptr) return fail("no such type");
    if (count == 0 || location >= locations_.size() || count > locations_.size() - location)
        return fail("no such location");
    if (values.size() != std::size_t{count} * type->words() * 4) return fail("size does not fit the values");
    camera_changed_ = true;
    if (type->base == glapi::UniformBase::real)
        position_.set(location, type->words(),
                      {reinterpret_cast<const std::uint32_t*>(values.data()), values.size() / sizeof(std::uint32_t)});
    const GLint here = locations_[location];
    if (here < 0) return {};
    if (type->base == glapi::UniformBase::double_real)
        set_doubles(driver_.gl(), name_, here, static_cast<GLsizei>(count), *type, values);
    else if (type->matrix())
        set_matrix(driver_.gl(), name_, here, static_cast<GLsizei>(count), *type,
                   reinterpret_cast<const GLfloat*>(values.data()));
    else set_vector(driver_.gl(), name_, here, static_cast<GLsizei>(count), *type, values.data());
    return {};
}

Result<void> Program::bind_block(std::uint32_t block, std::uint32_t binding) {
    if (block >= blocks_.size() || binding >= glstate::el::uniform_buffer::count) return fail("no such uniform block");
    const GLuint here = blocks_[block];
    if (here == GL_INVALID_INDEX) return {};
    block_bindings_[here] = binding;
    driver_.gl().UniformBlockBinding(name_, here, binding);
    return {};
}

Result<void> Program::bind_storage_block(std::uint32_t block, std::uint32_t binding) {
    if (block >= storage_blocks_.size() || binding >= glstate::el::storage_buffer::count)
        return fail("no such block of storage");
    const GLuint here = storage_blocks_[block];
    if (here >= storage_bindings_.size()) return {};
    storage_bindings_[here] = binding;
    driver_.gl().ShaderStorageBlockBinding(name_, here, binding);
    return {};
}

void Program::find_subroutines() {
    subroutines_.clear();
    for (const GLenum stage : glapi::kShaderStages) {
        GLint uniforms = 0, locations = 0;  // of a stage that is not there Mesa tells no locations
        driver_.gl().GetProgramStageiv(name_, stage, GL_ACTIVE_SUBROUTINE_UNIFORMS, &uniforms);
        if (uniforms > 0)
            driver_.gl().GetProgramStageiv(name_, stage, GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS, &locations);
        if (locations > 0) subroutines_.push_back({stage, static_cast<std::size_t>(locations), {}});
    }
}

/// Whether functions of these numbers are there, and may be named, the driver looks.
Result<void> Program::set_subroutines(GLenum stage, std::span<const std::byte> bytes) {
    const auto found = std::ranges::find(subroutines_, stage, &Subroutines::stage);
    if (found == subroutines_.end()) return {};  // the driver has removed them
    if (bytes.size() != found->locations * sizeof(GLuint)) return fail("not a function for each location");
    found->indices.resize(found->locations);
    std::memcpy(found->indices.data(), bytes.data(), bytes.size());
    return {};
}

std::optional<glstate::Projection> Program::project(const glstate::Projection& fixed_function,
                                                    const glstate::State& state) {
    const auto* transform = position_.transform(state.matrix.modelview, state.matrix.projection);
    if (transform == nullptr) return std::nullopt;
    auto out = glstate::make_projection(fixed_function, *transform, position_.program().depth);
    glstate::set_camera(out, position_.camera(state.matrix.projection));
    out.unknown_elsewhere = position_.camera_is_named();
    return out;
}

/// The matrix that the shader multiplies by last becomes that of a view; none: its own. A built-in one the driver has.
void Program::look(const std::optional<geom::EyeView>& view) {
    view_ = view;
    camera_changed_ = false;
    const auto camera = position_.uniform_camera();
    if (!camera || camera->location >= locations_.size()) return;
    glstate::Mat4 seen;
    std::ranges::copy(camera->matrix, seen.begin());
    if (const auto change = view ? glstate::view_change(*view, seen) : std::nullopt)
        seen = glstate::product(*change, seen);
    driver_.gl().ProgramUniformMatrix4fv(name_, locations_[camera->location], 1, GL_FALSE, seen.data());
}

void Program::prepare(const LayerGeometry& layer) {
    for (const Subroutines& each : subroutines_)  // the driver forgets them with every glUseProgram
        if (!each.indices.empty())
            driver_.gl().UniformSubroutinesuiv(each.stage, static_cast<GLsizei>(each.indices.size()),
                                               each.indices.data());
    if (view_ != layer.view || (layer.view && camera_changed_)) look(layer.view);
    if (window_ < 0) return;
    const auto value = window_of(layer, upper_left_, whole_centers_);
    if (std::exchange(window_value_, value) != value) driver_.gl().ProgramUniform4fv(name_, window_, 1, value.data());
}

}  // namespace wall::tileserver
