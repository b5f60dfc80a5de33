// SPDX-License-Identifier: MIT
// Vertex attributes and the buffers that they are bound to, apart from each other (GL_ARB_vertex_attrib_binding; OpenGL
// 4.3, 2.8). What is drawn with are the arrays of the state, as glVertexAttribPointer sets them: a vertex array object
// has these here only from the first command on that tells the two apart, and they are made of its arrays then. Every
// change of them sets the arrays that follow from it (bound_arrays.h). Pure.
#pragma once

#include <array>
#include <cstdint>

#include "common/glapi/gl_types.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Places for buffers.
inline constexpr unsigned kVertexBindings = glstate::el::attrib_array::count;

inline constexpr std::uint32_t kFarthestAttribute = 2047;  ///< bytes behind the beginning of an element, at most
inline constexpr std::int32_t kLongestStride = 2048;       ///< bytes from one element to the next, at most
/// The same of arrays that are set by pointers: the older versions know no limit (OpenGL 4.4, 10.3.1; ES 3.1, 10.3.1).
std::int32_t longest_stride_of_pointers(bool es, int major, int minor);

/// What an attribute takes its values from. How they lie there (size, type, ...) stands in its array.
struct AttributeBinding {
    std::uint32_t binding = 0;  ///< the place
    std::uint32_t offset = 0;   ///< bytes behind the beginning of an element
    // As glVertexAttribPointer was called, which is asked for:
    std::int32_t stride = 0;
    std::uint64_t pointer = 0;
};

struct VertexBinding {
    std::uint64_t offset = 0;  ///< bytes into the buffer
    std::uint32_t buffer = 0;  ///< id; 0: none
    std::int32_t stride = 16;  ///< bytes from one element to the next; 0: it is the same one
    std::uint32_t divisor = 0;
    bool in_memory = false;  ///< the offset is a pointer into the program's memory
};

struct VertexBindings {
    std::array<AttributeBinding, glstate::el::attrib_array::count> attributes{};
    std::array<VertexBinding, kVertexBindings> bindings{};
};

/// The place that an array is in which was set by itself.
VertexBinding binding_of(const glstate::ClientArray& array);
/// What arrays that were set one by one mean: each has a place of its own.
VertexBindings bindings_of(const glstate::VertexArraysState& arrays);
/// The array that follows from how an attribute is bound; its format and whether it is enabled are those of `array`.
glstate::ClientArray bound_array(const VertexBindings& bindings, unsigned attribute, glstate::ClientArray array);

}  // namespace wall::client
