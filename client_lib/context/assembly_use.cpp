// SPDX-License-Identifier: MIT
#include "client_lib/context/assembly_use.h"

#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

using glapi::AssemblyStage;

constexpr std::uint32_t shader_bit(AssemblyStage stage) {
    static_assert(glapi::kShaderStages[0] == GL_VERTEX_SHADER && glapi::kShaderStages[1] == GL_FRAGMENT_SHADER);
    return stage == AssemblyStage::vertex ? 1 : 2;
}

}  // namespace

AssemblyProgram* AssemblyUse::program(const ShareGroup& share, AssemblyStage stage) const {
    const auto& own = bound[glapi::index_of(stage)];
    return own ? own.get() : share.default_assembly_programs[glapi::index_of(stage)].get();
}

bool enables_assembly(const glstate::State& state, AssemblyStage stage) {
    const auto& objects = state.objects;
    return (stage == AssemblyStage::vertex ? objects.vertex_program_enabled : objects.fragment_program_enabled) != 0;
}

bool draws_with_assembly(const glstate::State& state, const Program* program, AssemblyStage stage) {
    if (!enables_assembly(state, stage)) return false;
    return program == nullptr || (program->executable->stages & shader_bit(stage)) == 0;
}

}  // namespace wall::client
