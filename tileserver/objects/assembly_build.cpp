// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_build.h"

#include <algorithm>
#include <string>
#include <utility>

#include "tileserver/gpu/extensions.h"
#include "tileserver/objects/assembly_position.h"
#include "tileserver/objects/assembly_tokens.h"
#include "tileserver/objects/assembly_uses.h"

namespace wall::tileserver {
namespace {

using glapi::AssemblyReflection;
using glapi::AssemblyStage;

void forget_errors(const Gl& gl) {
    for (int i = 0; i < 64 && gl.GetError() != GL_NO_ERROR; ++i) {
    }
}

/// Of the string that was given last.
void read_outcome(const Gl& gl, AssemblyStage stage, AssemblyReflection& out) {
    GLint position = -1;
    gl.GetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
    out.error_position = position;
    const GLubyte* message = gl.GetString(GL_PROGRAM_ERROR_STRING_ARB);
    if (message != nullptr) out.message = reinterpret_cast<const char*>(message);
    if (!out.compiled) return;
    for (const glapi::AssemblyWord& word : glapi::kAssemblyWords)
        out.counts.push_back(
            word.of(stage) ? static_cast<std::uint32_t>(std::max(assembly_value(gl, stage, word.count), 0)) : 0);
    out.native = assembly_value(gl, stage, GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB) != 0;
}

void read_tokens(AssemblyStage stage, std::string_view source, AssemblyReflection& out) {
    if (stage == AssemblyStage::fragment) {
        out.textures = find_textures(assembly_tokens(source));
        return;
    }
    AssemblyPosition found = recognise_assembly_position(source);
    out.invariant = found.invariant;
    out.position = std::move(found.program);
}

}  // namespace

bool load_assembly(const Gl& gl, AssemblyStage stage, std::string_view source) {
    forget_errors(gl);
    const std::string ended(source);  // Mesa 22.3 looks for a zero byte behind it, whatever length it is told
    gl.ProgramStringARB(glapi::target_of(stage), GL_PROGRAM_FORMAT_ASCII_ARB, static_cast<GLsizei>(ended.size()),
                        ended.c_str());
    const bool compiled = gl.GetError() == GL_NO_ERROR;
    forget_errors(gl);
    return compiled;
}

std::vector<std::byte> compile_assembly(const Gl& gl, AssemblyStage stage, std::span<const std::byte> bytes) {
    const std::string_view source(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    AssemblyReflection out;
    if (!has_assembly(gl)) {
        out.message = "the driver has no assembly programs";
        return encode(out);
    }
    GLuint program = 0;
    gl.GenProgramsARB(1, &program);
    gl.BindProgramARB(glapi::target_of(stage), program);
    out.compiled = load_assembly(gl, stage, source);
    read_outcome(gl, stage, out);
    if (out.compiled) read_tokens(stage, source, out);
    gl.BindProgramARB(glapi::target_of(stage), 0);
    gl.DeleteProgramsARB(1, &program);
    return encode(out);
}

}  // namespace wall::tileserver
