// SPDX-License-Identifier: MIT
// Assembly programs (GL_ARB_vertex_program, GL_ARB_fragment_program): their targets, the words that are asked of them,
// and how they travel. What a node needs of one is an AssemblyDefinition (AssemblyDefine); what the driver found out
// about its text, and the node about its tokens, is an AssemblyReflection, the reply to ShaderCompile. Both are
// written as programs are (program_format.h). Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/glapi/gl_types.h"
#include "common/glapi/position_program.h"
#include "gen/glapi/texture_targets.gen.h"

namespace wall::glapi {

enum class AssemblyStage : std::uint8_t { vertex, fragment };
inline constexpr std::size_t kAssemblyStages = 2;
inline constexpr std::array<GLenum, kAssemblyStages> kAssemblyTargets = {GL_VERTEX_PROGRAM_ARB,
                                                                         GL_FRAGMENT_PROGRAM_ARB};
inline constexpr std::size_t index_of(AssemblyStage stage) { return static_cast<std::size_t>(stage); }
inline constexpr GLenum target_of(AssemblyStage stage) { return kAssemblyTargets[index_of(stage)]; }
/// Nothing: it is no target of assembly programs.
inline constexpr std::optional<AssemblyStage> assembly_stage(GLenum target) {
    if (target == GL_VERTEX_PROGRAM_ARB) return AssemblyStage::vertex;
    return target == GL_FRAGMENT_PROGRAM_ARB ? std::optional(AssemblyStage::fragment) : std::nullopt;
}

/// What glGetProgramivARB counts in a program's string, how much of it there may be, and how much every driver takes;
/// 0: programs of the target have none of it.
struct AssemblyWord {
    GLenum count, most;
    GLint least_of_vertices, least_of_fragments;
    GLint least(AssemblyStage stage) const {
        return stage == AssemblyStage::vertex ? least_of_vertices : least_of_fragments;
    }
    bool of(AssemblyStage stage) const { return least(stage) != 0; }
};
inline constexpr AssemblyWord kAssemblyWords[] = {
    {GL_PROGRAM_INSTRUCTIONS_ARB, GL_MAX_PROGRAM_INSTRUCTIONS_ARB, 128, 72},
    {GL_PROGRAM_NATIVE_INSTRUCTIONS_ARB, GL_MAX_PROGRAM_NATIVE_INSTRUCTIONS_ARB, 128, 72},
    {GL_PROGRAM_TEMPORARIES_ARB, GL_MAX_PROGRAM_TEMPORARIES_ARB, 12, 16},
    {GL_PROGRAM_NATIVE_TEMPORARIES_ARB, GL_MAX_PROGRAM_NATIVE_TEMPORARIES_ARB, 12, 16},
    {GL_PROGRAM_PARAMETERS_ARB, GL_MAX_PROGRAM_PARAMETERS_ARB, 96, 24},
    {GL_PROGRAM_NATIVE_PARAMETERS_ARB, GL_MAX_PROGRAM_NATIVE_PARAMETERS_ARB, 96, 24},
    {GL_PROGRAM_ATTRIBS_ARB, GL_MAX_PROGRAM_ATTRIBS_ARB, 16, 10},
    {GL_PROGRAM_NATIVE_ATTRIBS_ARB, GL_MAX_PROGRAM_NATIVE_ATTRIBS_ARB, 16, 10},
    {GL_PROGRAM_ADDRESS_REGISTERS_ARB, GL_MAX_PROGRAM_ADDRESS_REGISTERS_ARB, 1, 0},
    {GL_PROGRAM_NATIVE_ADDRESS_REGISTERS_ARB, GL_MAX_PROGRAM_NATIVE_ADDRESS_REGISTERS_ARB, 1, 0},
    {GL_PROGRAM_ALU_INSTRUCTIONS_ARB, GL_MAX_PROGRAM_ALU_INSTRUCTIONS_ARB, 0, 48},
    {GL_PROGRAM_NATIVE_ALU_INSTRUCTIONS_ARB, GL_MAX_PROGRAM_NATIVE_ALU_INSTRUCTIONS_ARB, 0, 48},
    {GL_PROGRAM_TEX_INSTRUCTIONS_ARB, GL_MAX_PROGRAM_TEX_INSTRUCTIONS_ARB, 0, 24},
    {GL_PROGRAM_NATIVE_TEX_INSTRUCTIONS_ARB, GL_MAX_PROGRAM_NATIVE_TEX_INSTRUCTIONS_ARB, 0, 24},
    {GL_PROGRAM_TEX_INDIRECTIONS_ARB, GL_MAX_PROGRAM_TEX_INDIRECTIONS_ARB, 0, 4},
    {GL_PROGRAM_NATIVE_TEX_INDIRECTIONS_ARB, GL_MAX_PROGRAM_NATIVE_TEX_INDIRECTIONS_ARB, 0, 4},
};
/// The same of parameters, of which a string's are not counted.
inline constexpr AssemblyWord kAssemblyParameters[] = {
    {0, GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB, 96, 24},
    {0, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, 96, 24},
};

// How a program's position (position_program.h) names what it takes: these as uniforms of four components, and as its
// attribute "gl_Vertex" or the number of a generic one.
inline constexpr const char* kLocalParameter = "local";
inline constexpr const char* kEnvParameter = "env";

/// Local parameters that a program may have, whatever the nodes' drivers say.
inline constexpr std::uint32_t kMostLocalParameters = 4096;
/// Where a LinkedPosition has parameters: the local ones from 0 on, those of the environment from here on.
inline constexpr std::uint32_t kEnvLocations = kMostLocalParameters;
/// With all parameters 0. One that is not known if it takes something that is no parameter.
LinkedPosition link_position(PositionProgram position);
/// The generic attribute that the position is made of; 0 is also glVertex's. -1: it is not known.
std::int32_t position_attribute(const PositionProgram& position);

/// A texture that a program looks up.
struct AssemblyTexture {
    std::uint32_t unit = 0;
    TextureTarget target{};
    bool operator==(const AssemblyTexture&) const = default;
};

struct AssemblyReflection {
    bool compiled = false;
    std::int32_t error_position = -1;   ///< in the text; -1: there is no error
    std::string message;                ///< of the compiler
    std::vector<std::uint32_t> counts;  ///< of each of kAssemblyWords; empty: it did not compile
    bool native = false;                ///< GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB
    std::vector<AssemblyTexture> textures;
    bool invariant = false;  ///< ARB_position_invariant: vertices are where fixed function puts them
    PositionProgram position;
};

/// What a node draws with.
struct AssemblyDefinition {
    std::string source;
    bool invariant = false;  ///< both as the node that was asked first found them
    PositionProgram position;
};

std::vector<std::byte> encode(const AssemblyReflection& reflection);
std::vector<std::byte> encode(const AssemblyDefinition& definition);
/// Nothing if the bytes are not exactly one value, or say what has no meaning.
std::optional<AssemblyReflection> decode_assembly_reflection(std::span<const std::byte> bytes);
std::optional<AssemblyDefinition> decode_assembly_definition(std::span<const std::byte> bytes);

}  // namespace wall::glapi
