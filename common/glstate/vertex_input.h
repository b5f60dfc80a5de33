// SPDX-License-Identifier: MIT
// A vertex input: which arrays of which buffer objects a draw reads, and where its indices lie. Never changes; a draw
// from arrays names one (wire.toml, VertexInput). What travels of it is the index buffer, the number of arrays, and
// nine words for each. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/ids.h"
#include "common/glapi/gl_types.h"
#include "gen/glstate/attributes.gen.h"

namespace wall::glstate {

/// The place of glVertexPointer's array among those of attributes.
inline constexpr std::uint32_t kPositionArray = kAttributes;
inline constexpr std::size_t kInputPlaces = kAttributes + 1;

/// What an array's values are to a vertex shader.
inline constexpr std::uint32_t kAsFloats = 0, kAsIntegers = 1, kAsDoubles = 2;
/// The divisor of an array that never goes on: the first element is there for all vertices and instances.
inline constexpr std::uint32_t kNeverSteps = ~std::uint32_t{0};

/// One array, as it travels.
struct InputArray {
    std::uint32_t place = 0;  ///< of the attribute that it has the values of (Attribute), or kPositionArray
    ClientName buffer;
    std::uint32_t offset = 0;  ///< bytes into the buffer
    std::int32_t stride = 0;   ///< bytes from one element to the next, as the program gave it; 0: they lie close
    GLenum type = GL_FLOAT;
    std::int32_t size = 4;  ///< components; or GL_BGRA: four, of which the first and the third change places
    std::uint32_t normalized = 0;
    std::uint32_t divisor = 0;
    std::uint32_t reaches_as = kAsFloats;  ///< what its values are in the shader: kAsFloats, ...
    bool operator==(const InputArray&) const = default;

    /// Of one element.
    std::size_t element_bytes() const;
    /// From one element to the next.
    std::size_t step() const { return stride != 0 ? static_cast<std::size_t>(stride) : element_bytes(); }
    /// How many elements lie in a buffer of that size.
    std::uint64_t elements_in(std::uint64_t buffer_bytes) const;
};
static_assert(sizeof(InputArray) == 9 * sizeof(std::uint32_t));

struct VertexInputDefinition {
    ClientName indices;  ///< the element array buffer; 0: none
    std::vector<InputArray> arrays;
    bool operator==(const VertexInputDefinition&) const = default;
};

/// Bytes of one component; 0: no type of an array. Of a packed type, those of all.
std::size_t component_bytes(GLenum type);
/// Whether one word holds all four components (GL_ARB_vertex_type_2_10_10_10_rev).
constexpr bool is_packed(GLenum type) {
    return type == GL_INT_2_10_10_10_REV || type == GL_UNSIGNED_INT_2_10_10_10_REV;
}
/// Whether one word holds all components, however many they are.
constexpr bool is_one_word(GLenum type) { return is_packed(type) || type == GL_UNSIGNED_INT_10F_11F_11F_REV; }
/// How many components a size, as the program gave it, stands for.
constexpr std::int32_t components(std::int32_t size) { return size == GL_BGRA ? 4 : size; }
/// Of one element.
inline std::size_t element_bytes(GLenum type, std::int32_t size) {
    return component_bytes(type) * (is_one_word(type) ? 1 : static_cast<std::size_t>(components(size)));
}
/// Bytes of one index; 0: no type of indices.
std::size_t index_bytes(GLenum type);

std::vector<std::byte> encode(const VertexInputDefinition& definition);
/// Nothing if a definition does not look so, or says what no OpenGL command can: then the driver never sees it.
std::optional<VertexInputDefinition> decode_vertex_input(std::span<const std::byte> bytes);

}  // namespace wall::glstate
