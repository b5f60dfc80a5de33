// SPDX-License-Identifier: MIT
#include "client_lib/objects/program.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>

#include "client_lib/objects/texture.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kMaxUniformElements = 1 << 16;  // of one array

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
    return u.built_in || u.initial.size() == std::size_t{u.size} * type->words();
}

/// With the driver's choice of locations, so that all nodes make the same one.
std::vector<std::byte> final_definition(glapi::ProgramDefinition definition,
                                        const glapi::ProgramReflection& reflection) {
    for (const auto& attribute : reflection.attributes) {
        if (attribute.location < 0) continue;
        const auto named = [&](const glapi::AttributeBinding& b) { return b.name == attribute.name; };
        std::erase_if(definition.attributes, named);
        definition.attributes.push_back({static_cast<std::uint32_t>(attribute.location), attribute.name});
    }
    definition.uniforms.clear();
    for (const auto& u : reflection.uniforms)
        if (!u.built_in) definition.uniforms.push_back({u.size, u.name});
    return encode(definition);
}

}  // namespace

std::unique_ptr<Executable> Executable::make(glapi::ProgramDefinition definition, glapi::ProgramReflection reflection) {
    auto made = std::make_unique<Executable>();
    made->definition = final_definition(std::move(definition), reflection);
    for (auto& active : reflection.uniforms) {
        const auto* type = glapi::find_uniform_type(active.type);
        if (!consistent(active, type)) return nullptr;
        Uniform uniform;
        uniform.name = std::move(active.name);
        uniform.type = type;
        uniform.size = static_cast<GLint>(active.size);
        uniform.array = active.array;
        if (!active.built_in) {
            uniform.location = static_cast<GLint>(made->places_.size());
            uniform.first = made->words_.size();
            made->words_.insert(made->words_.end(), active.initial.begin(), active.initial.end());
            const auto index = static_cast<std::uint32_t>(made->uniforms.size());
            for (std::uint32_t i = 0; i < active.size; ++i) made->places_.push_back({index, i});
        }
        made->uniforms.push_back(std::move(uniform));
    }
    made->attributes = std::move(reflection.attributes);
    made->stamp = made->last_change = next_stamp();
    made->check_samplers();
    return made;
}

GLint Executable::location_of(std::string_view text) const {
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

GLint Executable::attribute_location_of(std::string_view name) const {
    const auto found =
        std::find_if(attributes.begin(), attributes.end(), [name](const auto& a) { return a.name == name; });
    return found == attributes.end() ? -1 : found->location;
}

const UniformPlace* Executable::place_of(GLint location) const {
    return location < 0 || static_cast<std::size_t>(location) >= places_.size()
               ? nullptr
               : &places_[static_cast<std::size_t>(location)];
}

std::span<const std::uint32_t> Executable::words_of(const Uniform& uniform) const {
    if (uniform.location < 0) return {};
    return std::span(words_).subspan(uniform.first, static_cast<std::size_t>(uniform.size) * uniform.type->words());
}

bool Executable::holds(const Uniform& uniform, std::uint32_t first, std::span<const std::uint32_t> words) const {
    return std::memcmp(words_.data() + uniform.first + std::size_t{first} * uniform.type->words(), words.data(),
                       words.size_bytes()) == 0;
}

void Executable::store(Uniform& uniform, std::uint32_t first, std::span<const std::uint32_t> words) {
    std::memcpy(words_.data() + uniform.first + std::size_t{first} * uniform.type->words(), words.data(),
                words.size_bytes());
    uniform.stamp = last_change = next_stamp();
    if (uniform.type->base == glapi::UniformBase::sampler) check_samplers();
}

void Executable::check_samplers() {
    std::map<std::uint32_t, glapi::TextureTarget> targets;  // by unit
    samplers_conflict_ = false;
    for_each_sampler([&](std::uint32_t unit, glapi::TextureTarget target) {
        samplers_conflict_ |= targets.emplace(unit, target).first->second != target;
    });
}

glapi::ProgramDefinition Program::definition() const {
    glapi::ProgramDefinition out;
    for (const auto& shader : shaders)
        out.shaders.push_back({shader->type, shader->state != Shader::State::not_compiled, shader->compiled_source});
    for (const auto& [bound, index] : attribute_bindings) out.attributes.push_back({index, bound});
    return out;
}

namespace {

void pack_uniform(const Program& program, const Uniform& uniform, wire::PackBuffer& buffer) {
    glapi::pack::Uniform(buffer, program.id, static_cast<std::uint32_t>(uniform.location), uniform.type->type,
                         static_cast<std::uint32_t>(uniform.size),
                         std::as_bytes(program.executable->words_of(uniform)));
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
}

void Program::pack_values(std::uint64_t known, wire::PackBuffer& buffer) const {
    if (known != 0) return pack_changes(known, buffer, no_limit);
    for (const Uniform& uniform : executable->uniforms)
        if (uniform.location >= 0) pack_uniform(*this, uniform, buffer);
}

}  // namespace wall::client
