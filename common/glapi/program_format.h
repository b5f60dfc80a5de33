// SPDX-License-Identifier: MIT
// How programs travel: what a node needs to link one (ProgramLink), and what the driver found out about it (the reply).
// Both are sequences of u32 and of strings (u32 count, bytes, padding to 4), in the order of the members here; a list
// is its length and then its items. Pure.
//
// A client's uniform locations are those that the shaders say or the driver of the node that was asked first chose
// (number_uniforms). A node maps them to its own driver's.
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

struct ShaderSource {
    GLenum type = 0;
    bool compiled = false;  ///< glCompileShader was called; a program does not link otherwise
    std::string source;
};

struct AttributeBinding {
    std::uint32_t index = 0;
    std::string name;
};

/// Which location each has at the client.
struct UniformName {
    std::uint32_t size = 1;      ///< elements; 1 if no array
    std::string name;            ///< without "[0]"
    std::uint32_t location = 0;  ///< of its first element; the others' follow
    bool operator==(const UniformName&) const = default;
};

/// glBindFragDataLocationIndexed.
struct OutputBinding {
    std::uint32_t color = 0;
    std::uint32_t index = 0;  ///< of the two colours that blending may take
    std::string name;
    bool operator==(const OutputBinding&) const = default;
};

/// glTransformFeedbackVaryings; no names: nothing is captured.
struct FeedbackDefinition {
    GLenum mode = GL_INTERLEAVED_ATTRIBS;
    std::vector<std::string> names;
};

/// Everything that linking a program depends on.
struct ProgramDefinition {
    std::vector<ShaderSource> shaders;
    std::vector<AttributeBinding> attributes;
    /// Empty: as the driver lists them (of the node that is asked first). The same for the blocks.
    std::vector<UniformName> uniforms;
    std::vector<std::string> blocks = {};  ///< of uniforms, in the order that gives indices
    std::vector<OutputBinding> outputs = {};
    FeedbackDefinition feedback = {};
    PositionProgram position = {};                 ///< as the node that was asked first found it
    bool separable = false;                        ///< it may be one of several that are drawn with together
    std::vector<std::string> storage_blocks = {};  ///< in the order that gives indices
    std::vector<std::string> cameras = {};         ///< uniforms that may be the camera (named_camera.h)
};

/// Where a member of a uniform block lies in it (OpenGL 3.1, 2.11.4), or an atomic counter in its buffer, which is no
/// block; -1 throughout for any other uniform.
struct BlockPlace {
    std::int32_t block = -1;   ///< index
    std::int32_t offset = -1;  ///< bytes, like the strides; -1: no array, no matrix
    std::int32_t array_stride = -1, matrix_stride = -1;
    bool row_major = false;
    bool operator==(const BlockPlace&) const = default;
};

struct ActiveUniform {
    GLenum type = 0;
    std::uint32_t size = 1;
    bool built_in = false;               ///< gl_ModelViewMatrix and the like: no location
    bool array = false;                  ///< declared as one: its name is told with "[0]"
    std::string name;                    ///< without "[0]"
    std::vector<std::uint32_t> initial;  ///< words of all elements: uniform_words() each; of a block's members none
    BlockPlace place = {};
    std::int32_t counter_buffer = -1;  ///< of an atomic counter: index in ProgramReflection::counter_buffers
    std::int32_t location = -1;        ///< of its first element, the others' follow; -1: the client chooses
    std::uint32_t stages = 0;          ///< that it is active in, a bit for each of kShaderStages
    bool in_block() const { return place.block >= 0; }
    bool has_location() const { return !built_in && !in_block() && counter_buffer < 0; }
};

/// What the first stage takes: vertex attributes, if that is the vertex shader.
struct ActiveAttribute {
    GLenum type = 0;
    std::uint32_t size = 1;
    std::int32_t location = -1;
    std::string name;             ///< of an array with "[0]"
    std::uint32_t stages = 0;     ///< a bit for each of kShaderStages
    bool patch = false;           ///< one for all vertices of a patch
    std::uint32_t component = 0;  ///< of the location, that it begins with (GL_ARB_enhanced_layouts)
};

/// A block of uniforms.
struct ActiveBlock {
    std::string name;
    std::uint32_t bytes = 0;    ///< that a buffer for it must have
    std::uint32_t binding = 0;  ///< as the shader says
    std::uint32_t stages = 0;   ///< that it is active in, a bit for each of kShaderStages
};

/// A block of variables that lie in a buffer, which shaders may write (OpenGL 4.3, 7.8).
struct ActiveStorageBlock : ActiveBlock {
    bool written = true;  ///< its shaders do not all say that they only read it
};

/// A buffer that atomic counters lie in (OpenGL 4.2, 2.14.7).
struct ActiveCounterBuffer {
    std::uint32_t binding = 0;
    std::uint32_t bytes = 0;   ///< that a buffer for it must have
    std::uint32_t stages = 0;  ///< that it is active in, a bit for each of kShaderStages
};

/// A variable of a block that lies in a buffer which shaders may write (OpenGL 4.3, 7.3.1).
struct BufferVariable {
    GLenum type = 0;
    std::uint32_t size = 1;  ///< elements; 0: as many as the buffer has room for
    bool array = false;
    std::string name;       ///< without "[0]"
    BlockPlace place = {};  ///< `block` counts in ProgramReflection::storage_blocks
    /// Of the block's member that it is a part of: elements, and bytes from one to the next; 1 and 0 of no array.
    std::uint32_t top_size = 1, top_stride = 0;
    std::uint32_t stages = 0;  ///< that it is active in, a bit for each of kShaderStages
};

/// What the last stage gives away: colours, if that is the fragment shader.
struct ActiveOutput {
    std::int32_t location = -1;
    std::int32_t index = 0;  ///< of the two colours that blending may take; -1: it is no colour
    std::uint32_t size = 1;  ///< elements
    bool array = false;
    std::string name;  ///< without "[0]"
    GLenum type = 0;
    std::uint32_t stages = 0;     ///< a bit for each of kShaderStages
    bool patch = false;           ///< one for all vertices of a patch
    std::uint32_t component = 0;  ///< of the location, that it begins with
    bool color() const { return location >= 0 && index >= 0; }
};

/// What transform feedback captures of a vertex.
struct CapturedVarying {
    GLenum type = 0;
    std::uint32_t size = 1;
    std::string name;
    std::uint32_t offset = 0;  ///< bytes, in what its buffer has of a vertex
    std::int32_t buffer = -1;  ///< index in ProgramReflection::capture_buffers; -1: gl_NextBuffer
};

/// A buffer that transform feedback writes to.
struct CaptureBuffer {
    std::uint32_t binding = 0;
    std::uint32_t stride = 0;  ///< bytes from one vertex to the next
    bool operator==(const CaptureBuffer&) const = default;
};

/// Of a geometry shader; 0 throughout: there is none.
struct GeometryStage {
    GLenum input = 0, output = 0;   ///< primitives
    std::uint32_t vertices = 0;     ///< at most
    std::uint32_t invocations = 0;  ///< 0: there is no geometry shader
    bool exists() const { return invocations != 0; }
    bool operator==(const GeometryStage&) const = default;
};

/// Of tessellation shaders; 0 throughout: there are none.
struct TessellationStage {
    std::uint32_t vertices = 0;     ///< of a patch, that the control shader makes; 0: there is no control shader
    GLenum mode = 0;                ///< GL_TRIANGLES, GL_QUADS or GL_ISOLINES; 0: there is no evaluation shader
    GLenum spacing = 0, order = 0;  ///< of the vertices
    std::uint32_t point_mode = 0;   ///< not 0: it makes points
    bool exists() const { return mode != 0; }
    /// What single primitives it makes.
    GLenum output() const { return point_mode != 0 ? GL_POINTS : mode == GL_ISOLINES ? GL_LINES : GL_TRIANGLES; }
    bool operator==(const TessellationStage&) const = default;
};

/// A variable that names one of several functions (OpenGL 4.0, 2.11.5).
struct SubroutineUniform {
    std::string name;        ///< without "[0]"
    std::uint32_t size = 1;  ///< elements, in a row of locations
    bool array = false;
    std::int32_t location = -1;
    std::vector<std::uint32_t> compatible;  ///< indices of the functions that it may name
};

/// What a stage has of them.
struct SubroutineStage {
    GLenum stage = 0;
    std::vector<std::string> functions;
    std::vector<SubroutineUniform> uniforms;
    std::uint32_t locations = 0;
    std::vector<std::uint32_t> indices = {};  ///< of the functions; empty: 0 and so on
    std::uint32_t index_of(std::size_t function) const {
        return indices.empty() ? static_cast<std::uint32_t>(function) : indices[function];
    }
};

/// A sampler that a fragment shader looks up at one place and nowhere else, where no other shader does: at x and y of
/// what this gives, whose z and w mean nothing (tileserver/objects/lookup_finder.h).
struct TextureLookup {
    std::string sampler;  ///< a uniform that is no array
    PositionProgram coordinates;
    bool operator==(const TextureLookup&) const = default;
};

struct ProgramReflection {
    bool linked = false;
    std::string log;
    std::vector<ActiveUniform> uniforms;
    std::vector<ActiveAttribute> attributes;
    std::vector<ActiveBlock> blocks = {};
    std::vector<ActiveOutput> outputs = {};
    std::vector<CapturedVarying> captured = {};
    GeometryStage geometry = {};
    TessellationStage tessellation = {};
    std::vector<SubroutineStage> subroutines = {};  ///< of stages that have functions
    PositionProgram position = {};
    std::vector<TextureLookup> lookups = {};
    std::vector<ActiveStorageBlock> storage_blocks = {};
    std::vector<ActiveCounterBuffer> counter_buffers = {};
    std::array<std::uint32_t, 3> group_size = {};  ///< of the compute shader; 0 throughout: there is none
    std::vector<BufferVariable> buffer_variables = {};
    std::vector<CaptureBuffer> capture_buffers = {};
    /// That shaders give to uniforms which are not active, as far as they were looked for: nothing happens when such a
    /// one is set (GL_ARB_explicit_uniform_location).
    std::vector<std::uint32_t> unused_locations = {};
};

/// The stages that programs may have, in the order of ActiveBlock::stages.
inline constexpr GLenum kShaderStages[] = {GL_VERTEX_SHADER,       GL_FRAGMENT_SHADER,        GL_GEOMETRY_SHADER,
                                           GL_TESS_CONTROL_SHADER, GL_TESS_EVALUATION_SHADER, GL_COMPUTE_SHADER};

/// That a program may have, as locations (elements) of uniforms.
inline constexpr std::uint32_t kMostUniformLocations = 1 << 18;

/// The locations of those that have one, in their order: those that were told, and for the others free ones behind
/// all of these. Nothing: two have one in common, or one lies behind kMostUniformLocations.
std::optional<std::vector<UniformName>> number_uniforms(const std::vector<ActiveUniform>& uniforms);

struct CompileResult {
    bool compiled = false;
    std::string log;
};

std::vector<std::byte> encode(const ProgramDefinition& definition);
std::vector<std::byte> encode(const ProgramReflection& reflection);
std::vector<std::byte> encode(const CompileResult& result);
/// Nothing if the bytes are not exactly one value, or the steps of a position or of coordinates have no meaning.
std::optional<ProgramDefinition> decode_definition(std::span<const std::byte> bytes);
std::optional<ProgramReflection> decode_reflection(std::span<const std::byte> bytes);
std::optional<CompileResult> decode_compile_result(std::span<const std::byte> bytes);

// ---- uniform types ----

enum class UniformBase : std::uint8_t {
    real,
    integer,
    unsigned_integer,
    boolean,
    sampler,
    double_real,
    image,
    counter
};

/// A type of GLSL up to 4.30 that a uniform may have; a vector has one column. Every component is a 4-byte word, of
/// doubles two, the lower one first.
struct UniformType {
    GLenum type;
    UniformBase base;
    std::uint8_t columns, rows;
    TextureTarget texture_target;  ///< of a sampler or an image
    unsigned components() const { return unsigned{columns} * rows; }
    unsigned words() const { return components() * (base == UniformBase::double_real ? 2 : 1); }
    bool matrix() const { return columns > 1; }
};

/// Null: no such type.
const UniformType* find_uniform_type(GLenum type);

}  // namespace wall::glapi
