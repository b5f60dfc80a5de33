// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_program.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/glstate/program_environment.h"
#include "tileserver/objects/assembly_build.h"
#include "tileserver/objects/assembly_patch.h"
#include "tileserver/objects/assembly_tokens.h"
#include "tileserver/objects/assembly_uses.h"
#include "tileserver/objects/window_coordinates.h"

namespace wall::tileserver {
namespace {

// Intermediate code and machine code, besides the string.
constexpr std::uint64_t kProgramBytes = 16 << 10, kBytesForEachOfSource = 8;

}  // namespace

AssemblyProgram::AssemblyProgram(ObjectAccount& account, Driver& driver, glapi::AssemblyStage stage)
    : ObjectOf(account), driver_(driver), stage_(stage) {
    if (driver_.has_assembly()) driver_.gl().GenProgramsARB(1, &name_);
}

AssemblyProgram::~AssemblyProgram() {
    if (name_ == 0) return;
    driver_.forget_assembly(stage_, name_);
    driver_.gl().DeleteProgramsARB(1, &name_);
}

Result<void> AssemblyProgram::define(std::span<const std::byte> bytes) {
    auto definition = glapi::decode_assembly_definition(bytes);
    if (!definition) return fail("bad definition of an assembly program");
    if (name_ == 0) return {};
    PatchedAssembly patched{definition->source};
    if (stage_ == glapi::AssemblyStage::fragment)
        patched = patch_fragment_program(std::move(patched.source), driver_.window_parameter());
    driver_.edit_assembly(stage_, name_);
    if (!load_assembly(driver_.gl(), stage_, patched.source)) return {};
    loaded_ = true;
    reads_window_ = patched.reads_window;
    upper_left_ = patched.upper_left;
    whole_centers_ = patched.whole_centers;
    if (stage_ == glapi::AssemblyStage::vertex)
        attributes_ = find_generic_attributes(assembly_tokens(definition->source));
    invariant_ = definition->invariant;
    follow_position(std::move(definition->position));
    renamed();
    if (!has_content(kProgramBytes + kBytesForEachOfSource * bytes.size())) return fail(too_much("programs"));
    return {};
}

void AssemblyProgram::follow_position(glapi::PositionProgram position) {
    position_ = glapi::link_position(std::move(position));
    if (locals_.empty()) return;
    position_.set(0, 4, {locals_.front().data(), locals_.size() * 4});
}

Result<void> AssemblyProgram::set_locals(std::uint32_t first, std::span<const std::byte> values) {
    constexpr std::size_t kBytes = 4 * sizeof(std::uint32_t);
    const std::size_t count = values.size() / kBytes;
    if (values.size() % kBytes != 0) return fail("half of a local parameter");
    if (first > glapi::kMostLocalParameters || count > glapi::kMostLocalParameters - first)
        return fail("no such local parameter");
    if (count == 0) return {};
    locals_.resize(std::max(locals_.size(), first + count));
    std::memcpy(&locals_[first], values.data(), values.size());
    position_.set(first, 4, {locals_[first].data(), count * 4});
    if (name_ == 0) return {};
    driver_.edit_assembly(stage_, name_);
    for (std::size_t i = first; i < first + count; ++i) {
        std::array<GLfloat, 4> value;
        std::memcpy(value.data(), locals_[i].data(), sizeof value);
        driver_.gl().ProgramLocalParameter4fvARB(glapi::target_of(stage_), static_cast<GLuint>(i), value.data());
    }
    return {};
}

void AssemblyProgram::use(const LayerGeometry& layer) {
    driver_.use_assembly(stage_, loaded_ ? name_ : 0);
    if (loaded_ && reads_window_) driver_.set_fragment_window(window_of(layer, upper_left_, whole_centers_));
}

std::optional<glstate::Projection> AssemblyProgram::project(const glstate::Projection& fixed_function,
                                                            const glstate::State& state) {
    if (invariant_) return fixed_function;
    glstate::set_environment(position_, state);
    const auto* transform = position_.transform(state.matrix.modelview, state.matrix.projection);
    if (transform == nullptr) return std::nullopt;
    auto out = glstate::make_projection(fixed_function, *transform, position_.program().depth);
    glstate::set_camera(out, position_.camera(state.matrix.projection));
    return out;
}

}  // namespace wall::tileserver
