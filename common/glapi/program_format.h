// SPDX-License-Identifier: MIT
// How programs travel: what a node needs to link one (ProgramLink), and what the driver found out about it (the reply).
// Both are sequences of u32 and of strings (u32 count, bytes, padding to 4), in the order of the members here; a list
// is its length and then its items. Pure.
//
// A client gives its own numbers to uniform locations: those of the uniforms in `uniforms`' order, one for each
// element, from 0. A node maps them to its driver's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/glapi/gl_types.h"
#include "gen/glapi/texture_targets.gen.h"

namespace wall::glapi {

struct ShaderSource {
    GLenum type = 0;
    bool compiled = false;  ///< glCompileShader was called; a program does not link otherwise
    std::string source;
};

struct AttributeBinding {
    std::uint32_t index = 0;
    std::string name;
};

/// Names and lengths, in the order that gives locations.
struct UniformName {
    std::uint32_t size = 1;  ///< elements; 1 if no array
    std::string name;        ///< without "[0]"
};

/// Everything that linking a program depends on.
struct ProgramDefinition {
    std::vector<ShaderSource> shaders;
    std::vector<AttributeBinding> attributes;
    /// Empty: as the driver lists them (of the node that is asked first).
    std::vector<UniformName> uniforms;
};

struct ActiveUniform {
    GLenum type = 0;
    std::uint32_t size = 1;
    bool built_in = false;               ///< gl_ModelViewMatrix and the like: no location
    bool array = false;                  ///< declared as one: its name is told with "[0]"
    std::string name;                    ///< without "[0]"
    std::vector<std::uint32_t> initial;  ///< words of all elements: uniform_words() each
};

struct ActiveAttribute {
    GLenum type = 0;
    std::uint32_t size = 1;
    std::int32_t location = -1;
    std::string name;
};

struct ProgramReflection {
    bool linked = false;
    std::string log;
    std::vector<ActiveUniform> uniforms;
    std::vector<ActiveAttribute> attributes;
};

struct CompileResult {
    bool compiled = false;
    std::string log;
};

std::vector<std::byte> encode(const ProgramDefinition& definition);
std::vector<std::byte> encode(const ProgramReflection& reflection);
std::vector<std::byte> encode(const CompileResult& result);
/// Nothing if the bytes are not exactly one value.
std::optional<ProgramDefinition> decode_definition(std::span<const std::byte> bytes);
std::optional<ProgramReflection> decode_reflection(std::span<const std::byte> bytes);
std::optional<CompileResult> decode_compile_result(std::span<const std::byte> bytes);

// ---- uniform types ----

enum class UniformBase : std::uint8_t { real, integer, unsigned_integer, boolean, sampler };

/// A type of GLSL up to 3.30 that a uniform may have; a vector has one column. Every component is a 4-byte word.
struct UniformType {
    GLenum type;
    UniformBase base;
    std::uint8_t columns, rows;
    TextureTarget texture_target;  ///< of a sampler
    unsigned words() const { return unsigned{columns} * rows; }
    bool matrix() const { return columns > 1; }
};

/// Null: no such type.
const UniformType* find_uniform_type(GLenum type);

}  // namespace wall::glapi
