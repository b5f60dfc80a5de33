// SPDX-License-Identifier: MIT
#include "client_lib/objects/assembly_program.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

std::vector<std::uint32_t> words_of(std::span<const AssemblyProgram::Parameter> values) {
    std::vector<std::uint32_t> words(values.size() * 4);
    if (!values.empty()) std::memcpy(words.data(), values.data(), values.size_bytes());
    return words;
}

}  // namespace

AssemblyProgram::AssemblyProgram(GLuint own_name, glapi::AssemblyStage own_stage)
    : Object(next_object_id(), own_name), stage(own_stage) {}

void AssemblyProgram::load(std::string source, glapi::AssemblyReflection reflection) {
    source_ = std::move(source);
    reflection_ = std::move(reflection);
    position_ = glapi::link_position(reflection_.position);
    position_.set(0, 4, words_of(locals_));
    load_stamp_ = last_change_ = next_stamp();
}

bool AssemblyProgram::holds(std::size_t first, std::span<const Parameter> values) const {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (const Parameter known = local(first + i); std::memcmp(&known, &values[i], sizeof known) != 0) return false;
    return true;
}

void AssemblyProgram::set_locals(std::size_t first, std::span<const Parameter> values) {
    const std::size_t behind = first + values.size();
    locals_.resize(std::max(locals_.size(), behind));
    stamps_.resize(locals_.size());
    last_change_ = next_stamp();
    std::ranges::copy(values, locals_.begin() + static_cast<std::ptrdiff_t>(first));
    std::fill_n(stamps_.begin() + static_cast<std::ptrdiff_t>(first), values.size(), last_change_);
    position_.set(static_cast<std::uint32_t>(first), 4, words_of(values));
}

/// Those in a row as one command.
void AssemblyProgram::pack_locals(std::uint64_t known, wire::PackBuffer& buffer) const {
    for (std::size_t first = 0; first < locals_.size(); ++first) {
        std::size_t behind = first;
        while (behind < locals_.size() && stamps_[behind] > known) ++behind;
        if (behind == first) continue;
        glapi::pack::AssemblyLocals(buffer, id, static_cast<std::uint32_t>(first),
                                    std::as_bytes(std::span(locals_).subspan(first, behind - first)));
        first = behind;
    }
}

void AssemblyProgram::pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                                   const std::function<void()>& packed) const {
    if (known < load_stamp_) {
        const glapi::AssemblyDefinition definition{source_, reflection_.invariant, reflection_.position};
        glapi::pack::AssemblyDefine(buffer, id, glapi::target_of(stage), encode(definition));
        packed();
    }
    pack_locals(known, buffer);
}

void AssemblyProgram::pack_values(std::uint64_t known, wire::PackBuffer& buffer) const {
    if (known != 0) return pack_changes(known, buffer, no_limit);
    pack_locals(0, buffer);
}

}  // namespace wall::client
