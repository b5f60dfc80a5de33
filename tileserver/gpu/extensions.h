// SPDX-License-Identifier: MIT
// Extensions of the driver that the node makes use of where they are. Render thread.
#pragma once

#include <string_view>

#include "common/glapi/assembly_format.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

bool has_extension(const Gl& gl, std::string_view wanted);

/// Whether the driver has assembly programs of both stages.
bool has_assembly(const Gl& gl);
/// What glGetProgramivARB answers about the program that is bound, or about all of the stage.
GLint assembly_value(const Gl& gl, glapi::AssemblyStage stage, GLenum word);

/// Environment parameters of fragments that are the node's own: the driver's last ones. window = layer * the first of
/// them + the second (objects/assembly_patch.h).
inline constexpr unsigned kWindowParameters = 2;
/// How many environment parameters are left to the programs.
unsigned environment_parameters(const Gl& gl, glapi::AssemblyStage stage);

}  // namespace wall::tileserver
