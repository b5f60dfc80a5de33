// SPDX-License-Identifier: MIT
#include "client_lib/context/vertex_bindings.h"

#include <limits>
#include <utility>

#include "common/glstate/vertex_input.h"

namespace wall::client {

using glstate::ClientArray;

std::int32_t longest_stride_of_pointers(bool es, int major, int minor) {
    const std::pair first = es ? std::pair(3, 1) : std::pair(4, 4);
    return std::pair(major, minor) < first ? std::numeric_limits<std::int32_t>::max() : kLongestStride;
}

VertexBinding binding_of(const ClientArray& array) {
    const auto tight = static_cast<std::int32_t>(glstate::element_bytes(array.type, array.size));
    return {.offset = array.pointer,
            .buffer = array.buffer,
            .stride = array.stride != 0 ? array.stride : tight,
            .divisor = array.divisor,
            .in_memory = array.buffer == 0 && array.pointer != 0};
}

VertexBindings bindings_of(const glstate::VertexArraysState& arrays) {
    VertexBindings out;
    for (unsigned i = 0; i < kVertexBindings; ++i) {
        const ClientArray& array = arrays.attrib_array[i];
        out.attributes[i] = {.binding = i, .offset = 0, .stride = array.stride, .pointer = array.pointer};
        out.bindings[i] = binding_of(array);
    }
    return out;
}

// A stride of 0 means to an array that its elements lie close; that there is only one, it says by its divisor.
ClientArray bound_array(const VertexBindings& bindings, unsigned attribute, ClientArray array) {
    const AttributeBinding& bound = bindings.attributes[attribute];
    const VertexBinding& binding = bindings.bindings[bound.binding];
    const bool there = binding.buffer != 0 || binding.in_memory;
    array.pointer = there ? binding.offset + bound.offset : 0;
    array.buffer = binding.buffer;
    array.stride = binding.stride;
    array.divisor = binding.stride == 0 ? glstate::kNeverSteps : binding.divisor;
    return array;
}

}  // namespace wall::client
