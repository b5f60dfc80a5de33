// SPDX-License-Identifier: MIT
// Compiling, linking and using programs, for the API functions. Application threads; none of these may be called with
// the share group's mutex held.
#pragma once

#include <memory>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

/// Asks a node, if nobody has yet, how the last glCompileShader or glLinkProgram went.
void learn_compile_result(Context& c, Shader& shader);
void learn_link_result(Context& c, Program& program);

/// The context draws with it from now on; null: with none.
void use_program(Context& c, std::shared_ptr<Program> program);

/// Whether the context's program counts vertices by itself: then they must be drawn as elements, with their numbers.
bool reads_numbers(const Context& c);

/// Generic attributes that the context's program takes as doubles and that have no array, a bit for each: no command of
/// the stream sets such values, so that they come as arrays.
std::uint32_t constant_doubles(const Context& c);

/// False, and an error, if the context's framebuffer is not complete, its program cannot run (may_run), or an advanced
/// equation of blending does not go with it.
bool may_draw(Context& c);

/// Whether the context's program can run as its samplers are set and, if it is a pipeline, its programs can run
/// together. The share group's mutex is held.
bool may_run(const Context& c);

/// Whether primitives of that mode can go through the context's program, to its tessellation and geometry shaders
/// and to transform feedback. False, and an error.
bool fits_program(Context& c, GLenum mode);

/// One user less; the object goes if it was to be deleted and nothing else uses it.
void drop_user(Context& c, const std::shared_ptr<GlslObject>& object);
/// glDeleteShader, glDeleteProgram.
void delete_object(Context& c, const std::shared_ptr<GlslObject>& object);

}  // namespace wall::client
