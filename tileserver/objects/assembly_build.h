// SPDX-License-Identifier: MIT
// The driver's compiler of assembly programs, and what it says of its work. Render thread, and that of a compiler
// process.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "common/glapi/assembly_format.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

/// Gives the program that is bound its string. False: it does not compile, and the program has that of before.
bool load_assembly(const Gl& gl, glapi::AssemblyStage stage, std::string_view source);

/// Tries to compile; the encoded AssemblyReflection. No program of the stage is bound behind it.
std::vector<std::byte> compile_assembly(const Gl& gl, glapi::AssemblyStage stage, std::span<const std::byte> source);

}  // namespace wall::tileserver
