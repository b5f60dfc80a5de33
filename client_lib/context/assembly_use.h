// SPDX-License-Identifier: MIT
// Assembly programs (GL_ARB_vertex_program, GL_ARB_fragment_program) of a context: which it has bound, and which of
// them it draws with. A shader takes the place of one (GL_ARB_shader_objects). Used by the one thread that has the
// context current; the share group's mutex is held.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "client_lib/objects/assembly_program.h"
#include "common/glapi/gl_types.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

struct Program;     // objects/program.h
struct ShareGroup;  // objects/share_group.h

struct AssemblyUse {
    /// Null: the default program of the target.
    std::array<std::shared_ptr<AssemblyProgram>, glapi::kAssemblyStages> bound;
    GLint error_position = -1;  ///< GL_PROGRAM_ERROR_POSITION_ARB
    std::string message;        ///< GL_PROGRAM_ERROR_STRING_ARB

    /// What is bound to the target; null: its default program, which has not been made yet.
    AssemblyProgram* program(const ShareGroup& share, glapi::AssemblyStage stage) const;
};

/// The target's programs are switched on.
bool enables_assembly(const glstate::State& state, glapi::AssemblyStage stage);
/// Whether a context of that state draws the stage with what is bound to its target, and not with `program`.
bool draws_with_assembly(const glstate::State& state, const Program* program, glapi::AssemblyStage stage);

}  // namespace wall::client
