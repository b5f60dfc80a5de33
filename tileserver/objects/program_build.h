// SPDX-License-Identifier: MIT
// The driver's compiler and linker, and what it says of their work. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/glapi/program_format.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

/// Tries to compile; the encoded CompileResult. An error: no such kind of shader.
Result<std::vector<std::byte>> compile_shader(const Gl& gl, GLenum type, std::span<const std::byte> source);

/// Of bytes that a client sent. An error: bad bytes, or no such kind of shader.
Result<glapi::ProgramDefinition> read_definition(std::span<const std::byte> bytes);

/// A program of the driver, linked or not, which is the caller's.
struct BuiltProgram {
    GLuint driver = 0;
    bool upper_left = false;     ///< gl_FragCoord begins at the window's top
    bool whole_centers = false;  ///< and with the middle of a pixel
};
BuiltProgram build_program(const Gl& gl, const glapi::ProgramDefinition& definition);

/// How linking went, and what is active if it went well; kWindowUniform is not told.
glapi::ProgramReflection reflect_program(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition);

/// The functions of each stage that variables may name, and those variables.
void read_subroutines(const Gl& gl, GLuint program, glapi::ProgramReflection& out);

/// What goes into the program and comes out of it, is captured, and lies in buffers that shaders may write.
void read_interfaces(const Gl& gl, GLuint program, const glapi::ProgramDefinition& definition,
                     glapi::ProgramReflection& out);
/// Those that a uniform is active in, a bit for each of glapi::kShaderStages. `index` is the driver's.
std::uint32_t uniform_stages(const Gl& gl, GLuint program, GLuint index);

/// "name[0]" is told as an array of that name: true, and the name without it.
bool take_array_suffix(std::string& name);

/// The driver's location of one element of a uniform; -1: it is not active.
GLint element_location(const Gl& gl, GLuint program, const std::string& name, std::uint32_t element);

}  // namespace wall::tileserver
