// SPDX-License-Identifier: MIT
// Binding assembly programs (GL_ARB_vertex_program, GL_ARB_fragment_program) and finding out about them, for the API
// functions. Application threads; none of these may be called with the share group's mutex held, but where it is said.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "client_lib/context/assembly_use.h"
#include "client_lib/context/context.h"

namespace wall::client {

/// What is bound to the target. The share group's mutex is held.
AssemblyProgram* bound_assembly(const Context& c, glapi::AssemblyStage stage);
/// The same, with the default program made if there is none yet.
std::shared_ptr<AssemblyProgram> make_bound_assembly(Context& c, glapi::AssemblyStage stage);
/// The context's bound program of the target; null: the default one.
void bind_assembly(Context& c, glapi::AssemblyStage stage, std::shared_ptr<AssemblyProgram> program);
/// It has lost its name.
void forget_assembly(Context& c, const std::shared_ptr<AssemblyProgram>& program);

/// Whether the context draws a stage with what is bound to its target. The share group's mutex is held.
bool draws_with_assembly(const Context& c, glapi::AssemblyStage stage);
/// Whether what it draws the stage with, if that is such a program, has a string.
bool may_use_assembly(const Context& c, glapi::AssemblyStage stage);
/// Both.
inline bool may_use_assembly(const Context& c) {
    return may_use_assembly(c, glapi::AssemblyStage::vertex) && may_use_assembly(c, glapi::AssemblyStage::fragment);
}

/// What one node says of a string; it is kept if it compiles. Nothing: no node answers.
std::optional<glapi::AssemblyReflection> learn_assembly(Context& c, glapi::AssemblyStage stage,
                                                        const std::string& source);

/// A word of these extensions, which only contexts with fixed function of OpenGL have, and gl.xml calls no part of any
/// version.
bool is_assembly_word(GLenum word);
/// One that nodes tell as limits, and glGetProgramivARB alone answers.
bool is_assembly_limit(GLenum word);

}  // namespace wall::client
