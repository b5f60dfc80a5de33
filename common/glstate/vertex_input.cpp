// SPDX-License-Identifier: MIT
#include "common/glstate/vertex_input.h"

#include <bitset>
#include <cstring>

#include "common/wire/operand_reader.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {
namespace {

constexpr std::int32_t kMostComponents = 4;

/// Integers that may stay such.
bool is_integer(GLenum type) { return type >= GL_BYTE && type <= GL_UNSIGNED_INT; }

bool has_plausible_size(const InputArray& array) {
    if (array.size == GL_BGRA) return array.type == GL_UNSIGNED_BYTE || is_packed(array.type);
    if (array.type == GL_UNSIGNED_INT_10F_11F_11F_REV) return array.size == 3;
    return array.size >= 1 && array.size <= kMostComponents;
}

/// Fixed function has no doubles.
bool is_generic(std::uint32_t place) {
    const auto first = static_cast<std::uint32_t>(place_of(Attribute::vertex_attrib));
    return place >= first && place - first < el::attrib_array::count;
}

/// Each place may have one array.
bool plausible(const InputArray& array, std::bitset<kInputPlaces>& taken) {
    if (array.place >= kInputPlaces || taken[array.place]) return false;
    taken.set(array.place);
    if (array.normalized > 1 || array.reaches_as > kAsDoubles) return false;
    if (array.reaches_as == kAsIntegers && !is_integer(array.type)) return false;
    if (array.reaches_as == kAsDoubles && (array.type != GL_DOUBLE || !is_generic(array.place))) return false;
    return array.buffer && array.stride >= 0 && component_bytes(array.type) != 0 && has_plausible_size(array);
}

}  // namespace

std::size_t InputArray::element_bytes() const { return glstate::element_bytes(type, size); }

std::uint64_t InputArray::elements_in(std::uint64_t buffer_bytes) const {
    const std::uint64_t behind_first = std::uint64_t{offset} + element_bytes();
    return buffer_bytes < behind_first ? 0 : (buffer_bytes - behind_first) / step() + 1;
}

std::size_t component_bytes(GLenum type) {
    switch (type) {
        case GL_BYTE:
        case GL_UNSIGNED_BYTE: return 1;
        case GL_SHORT:
        case GL_UNSIGNED_SHORT:
        case GL_HALF_FLOAT: return 2;
        case GL_INT:
        case GL_UNSIGNED_INT:
        case GL_INT_2_10_10_10_REV:
        case GL_UNSIGNED_INT_2_10_10_10_REV:
        case GL_UNSIGNED_INT_10F_11F_11F_REV:
        case GL_FIXED:
        case GL_FLOAT: return 4;
        case GL_DOUBLE: return 8;
        default: return 0;
    }
}

std::size_t index_bytes(GLenum type) {
    const bool index = type == GL_UNSIGNED_BYTE || type == GL_UNSIGNED_SHORT || type == GL_UNSIGNED_INT;
    return index ? component_bytes(type) : 0;
}

std::vector<std::byte> encode(const VertexInputDefinition& definition) {
    const std::size_t arrays = definition.arrays.size() * sizeof(InputArray);
    const std::uint32_t head[2] = {definition.indices.value, static_cast<std::uint32_t>(definition.arrays.size())};
    std::vector<std::byte> out(sizeof head + arrays);
    std::memcpy(out.data(), head, sizeof head);
    if (arrays != 0) std::memcpy(out.data() + sizeof head, definition.arrays.data(), arrays);
    return out;
}

std::optional<VertexInputDefinition> decode_vertex_input(std::span<const std::byte> bytes) {
    wire::OperandReader in(bytes);
    VertexInputDefinition out{ClientName(in.get<std::uint32_t>()), {}};
    const std::size_t count = in.get<std::uint32_t>();
    if (!in.ok() || count > kInputPlaces || in.remaining() != count * sizeof(InputArray)) return std::nullopt;
    std::bitset<kInputPlaces> taken;
    for (std::size_t i = 0; i < count; ++i) {
        out.arrays.push_back(wire::load<InputArray>(in.raw(sizeof(InputArray)).data()));
        if (!plausible(out.arrays.back(), taken)) return std::nullopt;
    }
    return out;
}

}  // namespace wall::glstate
