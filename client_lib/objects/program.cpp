// SPDX-License-Identifier: MIT
#include "client_lib/objects/program.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>

#include "client_lib/objects/blend_support.h"
#include "client_lib/objects/texture.h"
#include "client_lib/process/options.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kMaxUniformElements = 1 << 16;       // of one array
constexpr std::uint32_t kMostSubroutineLocations = 1 << 16;  // of a stage

/// "name[3]" taken apart; without an index, element 0.
struct ElementName {
    std::string_view name;
    std::uint32_t element = 0;
    bool indexed = false;
};

std::optional<ElementName> parse_element(std::string_view text) {
    if (!text.ends_with(']')) return ElementName{text, 0, false};
    const std::size_t open = text.rfind('[');
    if (open == text.npos) return std::nullopt;
    const std::string_view digits = text.substr(open + 1, text.size() - open - 2);
    std::uint32_t element = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), element);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    if (digits.size() > 1 && digits[0] == '0') return std::nullopt;
    return ElementName{text.substr(0, open), element, true};
}

bool consistent(const glapi::ActiveUniform& u, const glapi::UniformType* type) {
    if (!type || u.size == 0 || u.size > kMaxUniformElements) return false;
    return !u.has_location() || u.initial.size() == std::size_t{u.size} * type->words();
}

/// Whether what others count in is there.
bool consistent(const glapi::ProgramReflection& reflection) {
    const auto below = [](std::int32_t index, std::size_t count) {
        return index >= 0 && static_cast<std::size_t>(index) < count;
    };
    return std::ranges::all_of(reflection.buffer_variables,
                               [&](const glapi::BufferVariable& v) {
                                   return below(v.place.block, reflection.storage_blocks.size());
                               }) &&
           std::ranges::all_of(reflection.captured, [&](const glapi::CapturedVarying& v) {
               return v.buffer == -1 || below(v.buffer, reflection.capture_buffers.size());
           });
}

/// Programs without shaders are fixed function.
bool takes_attributes(const glapi::ProgramDefinition& definition) {
    const auto& shaders = definition.shaders;
    return shaders.empty() ||
           std::ranges::find(shaders, GLenum{GL_VERTEX_SHADER}, &glapi::ShaderSource::type) != shaders.end();
}

/// What the variables of a stage name when a program comes into use.
std::vector<std::uint32_t> first_functions(const glapi::SubroutineStage& stage) {
    std::vector<std::uint32_t> out(stage.locations);
    for (const glapi::SubroutineUniform& uniform : stage.uniforms) {
        if (uniform.location < 0 || uniform.compatible.empty()) continue;
        const auto first = static_cast<std::size_t>(uniform.location);
        for (std::size_t at = first; at < std::min(first + uniform.size, out.size()); ++at)
            out[at] = uniform.compatible.front();
    }
    return out;
}

/// With the driver's choice of locations, so that all nodes make the same one.
std::vector<std::byte> final_definition(glapi::ProgramDefinition definition, const glapi::ProgramReflection& reflection,
                                        std::vector<glapi::UniformName> uniforms) {
    for (const auto& attribute : reflection.attributes) {
        if (attribute.location < 0 || !takes_attributes(definition)) continue;
        const auto named = [&](const glapi::AttributeBinding& b) { return b.name == attribute.name; };
        std::erase_if(definition.attributes, named);
        definition.attributes.push_back({static_cast<std::uint32_t>(attribute.location), attribute.name});
    }
    definition.uniforms = std::move(uniforms);
    definition.position = reflection.position;
    definition.blocks.clear();
    for (const auto& b : reflection.blocks) definition.blocks.push_back(b.name);
    definition.storage_blocks.clear();
    for (const auto& b : reflection.storage_blocks) definition.storage_blocks.push_back(b.name);
    for (const auto& o : reflection.outputs) {
        if (!o.color()) continue;
        std::erase_if(definition.outputs, [&](const glapi::OutputBinding& b) { return b.name == o.name; });
        definition.outputs.push_back(
            {static_cast<std::uint32_t>(o.location), static_cast<std::uint32_t>(o.index), o.name});
    }
    return encode(definition);
}

}  // namespace

namespace {

/// A bit for each location. Each column of a matrix and each element of an array has one.
std::uint32_t taken_as_doubles(const std::vector<glapi::ActiveAttribute>& attributes) {
    std::uint32_t out = 0;
    for (const glapi::ActiveAttribute& attribute : attributes) {
        const auto* type = glapi::find_uniform_type(attribute.type);
        if (type == nullptr || type->base != glapi::UniformBase::double_real || attribute.location < 0) continue;
        const std::uint64_t locations = std::uint64_t{attribute.size} * type->columns;
        for (std::uint64_t i = 0; i < locations && static_cast<std::uint64_t>(attribute.location) + i < 32; ++i)
            out |= 1u << (static_cast<unsigned>(attribute.location) + i);
    }
    return out;
}

/// Null: none.
const glapi::ActiveAttribute* find_input(const std::vector<glapi::ActiveAttribute>& inputs, std::string_view name) {
    const auto found = std::ranges::find(inputs, name, &glapi::ActiveAttribute::name);
    return found == inputs.end() ? nullptr : &*found;
}

/// An element of an array lies behind those before it, and a matrix takes a location for each column (OpenGL 3.2,
/// 2.11.3).
GLint location_in(const std::vector<glapi::ActiveAttribute>& inputs, std::string_view name) {
    if (const auto* found = find_input(inputs, name)) return found->location;
    const auto wanted = parse_element(name);
    if (!wanted) return -1;
    for (const glapi::ActiveAttribute& input : inputs) {
        const auto own = parse_element(input.name);
        if (!own || own->name != wanted->name || input.location < 0 || wanted->element >= input.size) continue;
        if (wanted->indexed && input.size == 1 && !own->indexed) continue;
        const auto* type = glapi::find_uniform_type(input.type);
        const std::uint32_t columns = type != nullptr && type->matrix() ? type->columns : 1;
        return input.location + static_cast<GLint>(wanted->element * columns);
    }
    return -1;
}

}  // namespace

std::unique_ptr<Executable> Executable::make(glapi::ProgramDefinition definition, glapi::ProgramReflection reflection) {
    auto made = std::make_unique<Executable>();
    made->capture_mode = definition.feedback.mode;
    for (std::size_t i = 0; i < std::size(glapi::kShaderStages); ++i)
        if (std::ranges::find(definition.shaders, glapi::kShaderStages[i], &glapi::ShaderSource::type) !=
            definition.shaders.end())
            made->stages |= 1u << i;
    for (const auto& shader : definition.shaders)
        if (shader.type == GL_FRAGMENT_SHADER) made->blend_support |= blend_support_of(shader.source);
    const bool counts_primitives = std::ranges::any_of(definition.shaders, [](const auto& shader) {
        return shader.source.find("gl_PrimitiveID") != std::string::npos;  // also in a comment: no harm
    });
    auto names = glapi::number_uniforms(reflection.uniforms);
    if (!names || !consistent(reflection)) return nullptr;
    for (const glapi::UniformName& name : *names)
        made->places_.resize(std::max<std::size_t>(made->places_.size(), name.location + name.size));
    auto numbered = names->begin();
    const bool has_attributes = takes_attributes(definition);
    for (auto& active : reflection.uniforms) {
        const auto* type = glapi::find_uniform_type(active.type);
        if (!consistent(active, type)) return nullptr;
        Uniform uniform;
        uniform.name = active.name;
        uniform.type = type;
        uniform.size = static_cast<GLint>(active.size);
        uniform.array = active.array;
        uniform.place = active.place;
        uniform.stages = active.stages;
        uniform.counter_buffer = active.counter_buffer;
        if (active.counter_buffer >= static_cast<std::int32_t>(reflection.counter_buffers.size())) return nullptr;
        made->has_images_ = made->has_images_ || type->base == glapi::UniformBase::image;
        if (active.in_block() && static_cast<std::size_t>(active.place.block) >= reflection.blocks.size())
            return nullptr;
        if (active.has_location()) {
            const std::uint32_t location = (numbered++)->location;
            uniform.location = static_cast<GLint>(location);
            uniform.first = made->words_.size();
            made->words_.insert(made->words_.end(), active.initial.begin(), active.initial.end());
            const auto index = static_cast<std::uint32_t>(made->uniforms.size());
            for (std::uint32_t i = 0; i < active.size; ++i) made->places_[location + i] = {index, i};
        }
        made->uniforms.push_back(std::move(uniform));
    }
    made->definition = final_definition(std::move(definition), reflection, *std::move(names));
    for (auto& block : reflection.blocks) made->blocks.push_back({std::move(block), 0});
    for (auto& block : reflection.storage_blocks) made->storage_blocks.push_back({std::move(block), 0});
    made->counter_buffers = std::move(reflection.counter_buffers);
    made->group_size = reflection.group_size;
    (has_attributes ? made->attributes : made->inputs) = std::move(reflection.attributes);
    made->buffer_variables = std::move(reflection.buffer_variables);
    made->capture_buffers = std::move(reflection.capture_buffers);
    made->unused_locations_ = std::move(reflection.unused_locations);
    made->double_attributes_ = taken_as_doubles(made->attributes);
    made->outputs = std::move(reflection.outputs);
    made->captured = std::move(reflection.captured);
    made->geometry = reflection.geometry;
    made->tessellation = reflection.tessellation;
    for (auto& stage : reflection.subroutines) {
        if (stage.locations > kMostSubroutineLocations) return nullptr;
        made->subroutines.push_back({std::move(stage), {}, 0});
        made->subroutines.back().chosen = first_functions(made->subroutines.back());
    }
    made->reads_numbers_ = counts_primitives || find_input(made->attributes, "gl_VertexID") != nullptr;
    made->stamp = made->last_change = next_stamp();
    // In parts of a draw primitives would have other numbers; the camera may be named all the same.
    if (counts_primitives) reflection.position.steps.clear();
    if (!made->touches_memory()) made->follow_position(std::move(reflection.position));
    made->follow_lookups(std::move(reflection.lookups));
    made->check_samplers();
    return made;
}

std::optional<glapi::LinkedPosition> Executable::link(glapi::PositionProgram position) const {
    std::vector<std::uint32_t> locations;
    for (const glapi::PositionUniform& wanted : position.uniforms) {
        const auto found = std::ranges::find(uniforms, wanted.name, &Uniform::name);
        if (found == uniforms.end() || found->location < 0) return std::nullopt;
        if (wanted.element >= static_cast<std::uint32_t>(found->size)) return std::nullopt;
        locations.push_back(static_cast<std::uint32_t>(found->location) + wanted.element);
    }
    glapi::LinkedPosition linked(std::move(position), std::move(locations));
    for (const Uniform& uniform : uniforms)
        if (uniform.location >= 0)
            linked.set(static_cast<std::uint32_t>(uniform.location), uniform.type->words(), words_of(uniform));
    return linked;
}

/// One that takes a uniform or an attribute which is not active is not followed.
void Executable::follow_position(glapi::PositionProgram position) {
    auto linked = link(std::move(position));
    if (!linked) return;
    position_ = *std::move(linked);
    const std::string& attribute = position_.program().attribute;
    if (position_.program().known())
        position_attribute_ = attribute == "gl_Vertex" ? 0 : attribute_location_of(attribute);
}

void Executable::follow_lookups(std::vector<glapi::TextureLookup> lookups) {
    for (glapi::TextureLookup& lookup : lookups) {
        const auto sampler = std::ranges::find(uniforms, lookup.sampler, &Uniform::name);
        if (sampler == uniforms.end() || sampler->location < 0 || sampler->array) continue;
        if (sampler->type->base != glapi::UniformBase::sampler) continue;
        if (auto coordinates = link(std::move(lookup.coordinates)))
            lookups_.push_back({static_cast<std::size_t>(sampler - uniforms.begin()), *std::move(coordinates)});
    }
}

GLint Executable::location_of(std::string_view text) const {
    // Of arrays of arrays, "name[1]" is both an element and an array.
    for (const Uniform& uniform : uniforms)
        if (uniform.name == text) return uniform.location;
    const auto wanted = parse_element(text);
    if (!wanted) return -1;
    for (const Uniform& uniform : uniforms) {
        if (uniform.name != wanted->name || uniform.location < 0) continue;
        if (wanted->element >= static_cast<std::uint32_t>(uniform.size) || (wanted->indexed && !uniform.array))
            return -1;
        return uniform.location + static_cast<GLint>(wanted->element);
    }
    return -1;
}

std::optional<GLuint> Executable::uniform_index_of(std::string_view text) const {
    const auto exact = std::ranges::find(uniforms, text, &Uniform::name);
    if (exact != uniforms.end()) return static_cast<GLuint>(exact - uniforms.begin());
    const auto wanted = parse_element(text);
    if (!wanted || wanted->element != 0) return std::nullopt;
    for (std::size_t i = 0; i < uniforms.size(); ++i)
        if (uniforms[i].name == wanted->name && (uniforms[i].array || !wanted->indexed)) return static_cast<GLuint>(i);
    return std::nullopt;
}

namespace {

/// An array's name is that of its first block (OpenGL 3.1, 2.11.4).
template <class Blocks>
std::optional<GLuint> index_of(const Blocks& blocks, std::string_view name) {
    const std::string first = std::string(name) + "[0]";
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (blocks[i].name == name || blocks[i].name == first) return static_cast<GLuint>(i);
    return std::nullopt;
}

}  // namespace

std::optional<GLuint> Executable::block_index_of(std::string_view name) const { return index_of(blocks, name); }

const glapi::ActiveOutput* Executable::output_of(std::string_view text, GLint& element) const {
    const auto wanted = parse_element(text);
    if (!wanted) return nullptr;
    for (const auto& output : outputs) {
        if (output.name != wanted->name || wanted->element >= output.size) continue;
        if (wanted->indexed && !output.array) continue;
        element = static_cast<GLint>(wanted->element);
        return &output;
    }
    return nullptr;
}

GLint Executable::attribute_location_of(std::string_view name) const { return location_in(attributes, name); }

GLint Executable::input_location_of(std::string_view name) const { return location_in(taken(), name); }

const UniformPlace* Executable::place_of(GLint location) const {
    if (location < 0 || static_cast<std::size_t>(location) >= places_.size()) return nullptr;
    const UniformPlace& place = places_[static_cast<std::size_t>(location)];
    return place.uniform == UniformPlace::kNone ? nullptr : &place;
}

bool Executable::ignores(GLint location) const {
    return location >= 0 &&
           std::ranges::find(unused_locations_, static_cast<std::uint32_t>(location)) != unused_locations_.end();
}

std::span<const std::uint32_t> Executable::words_of(const Uniform& uniform) const {
    if (uniform.location < 0) return {};
    return std::span(words_).subspan(uniform.first, static_cast<std::size_t>(uniform.size) * uniform.type->words());
}

bool Executable::holds(const Uniform& uniform, std::uint32_t first, std::span<const std::uint32_t> words) const {
    const std::size_t begin = uniform.first + std::size_t{first} * uniform.type->words();
    if (std::memcmp(words_.data() + begin, words.data(), words.size_bytes()) != 0) return false;
    if (uniform.type->base != glapi::UniformBase::sampler) return true;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (!was_given(begin + i)) return false;
    return true;
}

void Executable::store(Uniform& uniform, std::uint32_t first, std::span<const std::uint32_t> words) {
    std::memcpy(words_.data() + uniform.first + std::size_t{first} * uniform.type->words(), words.data(),
                words.size_bytes());
    uniform.stamp = last_change = next_stamp();
    const auto location = static_cast<std::uint32_t>(uniform.location) + first;
    position_.set(location, uniform.type->words(), words);
    for (Lookup& lookup : lookups_) lookup.coordinates.set(location, uniform.type->words(), words);
    if (uniform.type->base != glapi::UniformBase::sampler) return;
    given_.resize(words_.size());
    std::fill_n(given_.begin() + static_cast<std::ptrdiff_t>(uniform.first + first), words.size(), true);
    check_samplers();
}

void Executable::bind_block(UniformBlock& block, std::uint32_t binding) {
    block.binding = binding;
    block.stamp = last_change = next_stamp();
}

void Executable::bind_block(StorageBlock& block, std::uint32_t binding) {
    block.binding = binding;
    block.stamp = last_change = next_stamp();
}

bool Executable::touches_memory() const {
    bool touches = false;
    for_each_part([&](const Executable& part) {
        touches = touches || part.has_images_ || !part.storage_blocks.empty() || !part.counter_buffers.empty();
    });
    return touches;
}

Subroutines* Executable::subroutines_of(GLenum stage) {
    const auto found = std::ranges::find(subroutines, stage, &Subroutines::stage);
    return found == subroutines.end() ? nullptr : &*found;
}

void Executable::choose(Subroutines& stage, std::span<const std::uint32_t> indices) {
    if (std::ranges::equal(stage.chosen, indices)) return;
    stage.chosen.assign(indices.begin(), indices.end());
    stage.stamp = last_change = next_stamp();
}

void Executable::reset_subroutines() {
    for (Subroutines& stage : subroutines) choose(stage, first_functions(stage));
}

void Executable::check_samplers() {
    samplers_conflict_ = parts_conflict();
    for_each_sampler([&](std::uint32_t, glapi::TextureTarget target) {
        samples_buffers_ |= target == glapi::TextureTarget::buffer;
    });
}

bool Executable::parts_conflict() const {
    std::map<std::uint32_t, glapi::TextureTarget> targets;  // by unit
    bool conflict = false;
    for_each_part([&](const Executable& part) {
        for (const Uniform& uniform : part.uniforms) {
            if (uniform.type->base != glapi::UniformBase::sampler) continue;
            const auto units = part.words_of(uniform);
            for (std::size_t i = 0; i < units.size(); ++i) {
                if (uniform.array && !part.was_given(uniform.first + i)) continue;
                const glapi::TextureTarget target = uniform.type->texture_target;
                conflict |= targets.emplace(units[i], target).first->second != target;
            }
        }
    });
    return conflict;
}

bool Executable::reads_buffers() const {
    bool reads = false;
    for_each_part([&](const Executable& part) { reads = reads || !part.blocks.empty() || part.samples_buffers_; });
    return reads || touches_memory();
}

void Executable::for_each_combined(const std::function<void(const Executable&)>& use) const {
    for (const auto& part : parts) use(*part->executable);
}

/// What leaves the last stage before that of fragments is captured; the first takes attributes.
std::unique_ptr<Executable> Executable::combine(const std::vector<std::shared_ptr<Program>>& parts) {
    auto made = std::make_unique<Executable>();
    made->parts = parts;
    made->stamp = made->last_change = next_stamp();
    for (const auto& program : parts) {
        const Executable& part = *program->executable;
        made->stages |= part.stages;
        made->blend_support |= part.blend_support;
        made->reads_numbers_ = made->reads_numbers_ || part.reads_numbers_;
        if (part.geometry.exists()) made->geometry = part.geometry;
        if (part.tessellation.exists()) made->tessellation = part.tessellation;
        if (made->captured.empty()) {
            made->captured = part.captured;
            made->capture_buffers = part.capture_buffers;
            made->capture_mode = part.capture_mode;
        }
        if (part.computes()) made->group_size = part.group_size;
        if ((part.stages & 1) != 0) {
            made->attributes = part.attributes;
            made->double_attributes_ = part.double_attributes_;
        }
    }
    return made;
}

glapi::ProgramDefinition Program::definition() const {
    glapi::ProgramDefinition out;
    for (const auto& shader : shaders)
        out.shaders.push_back({shader->type, shader->state != Shader::State::not_compiled, shader->compiled_source});
    for (const auto& [bound, index] : attribute_bindings) out.attributes.push_back({index, bound});
    out.outputs = output_bindings;
    out.feedback = feedback;
    out.separable = separable;
    out.cameras = options().cameras;
    return out;
}

namespace {

void pack_uniform(const Program& program, const Uniform& uniform, wire::PackBuffer& buffer) {
    glapi::pack::Uniform(buffer, program.id, static_cast<std::uint32_t>(uniform.location), uniform.type->type,
                         static_cast<std::uint32_t>(uniform.size),
                         std::as_bytes(program.executable->words_of(uniform)));
}

/// Those that were bound since `known`.
void pack_blocks(const Program& program, std::uint64_t known, wire::PackBuffer& buffer) {
    const auto& blocks = program.executable->blocks;
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (blocks[i].stamp > known)
            glapi::pack::UniformBlock(buffer, program.id, static_cast<std::uint32_t>(i), blocks[i].binding);
    const auto& storage = program.executable->storage_blocks;
    for (std::size_t i = 0; i < storage.size(); ++i)
        if (storage[i].stamp > known)
            glapi::pack::StorageBlock(buffer, program.id, static_cast<std::uint32_t>(i), storage[i].binding);
}

void pack_subroutines(const Program& program, std::uint64_t known, wire::PackBuffer& buffer) {
    for (const Subroutines& stage : program.executable->subroutines)
        if (stage.stamp > known)
            glapi::pack::Subroutines(buffer, program.id, stage.stage, std::as_bytes(std::span(stage.chosen)));
}

}  // namespace

void Program::pack_changes(std::uint64_t known, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    if (known < executable->stamp) {
        glapi::pack::ProgramLink(buffer, RequestId(), id, executable->definition);
        packed();
        known = executable->stamp;
    }
    for (const Uniform& uniform : executable->uniforms)
        if (uniform.stamp > known) pack_uniform(*this, uniform, buffer);
    pack_blocks(*this, known, buffer);
    pack_subroutines(*this, known, buffer);
}

void Program::pack_values(std::uint64_t known, wire::PackBuffer& buffer) const {
    if (known != 0) return pack_changes(known, buffer, no_limit);
    for (const Uniform& uniform : executable->uniforms)
        if (uniform.location >= 0) pack_uniform(*this, uniform, buffer);
    pack_blocks(*this, 0, buffer);
    pack_subroutines(*this, 0, buffer);
}

}  // namespace wall::client
