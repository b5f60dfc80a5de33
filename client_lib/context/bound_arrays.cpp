// SPDX-License-Identifier: MIT
#include "client_lib/context/bound_arrays.h"

#include <memory>

#include "client_lib/context/es_version.h"
#include "client_lib/context/vertex_array_objects.h"

namespace wall::client {

namespace el = glstate::el;
using glstate::ClientArray;

VertexBindings& own_bindings(Context& c) {
    auto& own = c.vertex_array_objects->bindings;
    if (!own) own = std::make_unique<VertexBindings>(bindings_of(c.state.vertex_arrays));
    return *own;
}

void set_bound_array(Context& c, unsigned attribute, const ClientArray& format) {
    c.set<el::attrib_array>(attribute, bound_array(*c.vertex_array_objects->bindings, attribute, format));
}

void set_arrays_of(Context& c, unsigned place) {
    const VertexBindings& bindings = *c.vertex_array_objects->bindings;
    for (unsigned i = 0; i < kVertexBindings; ++i)
        if (bindings.attributes[i].binding == place) set_bound_array(c, i, c.get<el::attrib_array>(i));
}

void bind_as_array(Context& c, unsigned attribute) {
    VertexBindings& bindings = *c.vertex_array_objects->bindings;
    const ClientArray& array = c.get<el::attrib_array>(attribute);
    const std::uint32_t divisor = bindings.bindings[attribute].divisor;
    bindings.attributes[attribute] = {
        .binding = attribute, .offset = 0, .stride = array.stride, .pointer = array.pointer};
    bindings.bindings[attribute] = binding_of(array);
    bindings.bindings[attribute].divisor = divisor;
    set_arrays_of(c, attribute);
}

bool is_stride(const Context& c, GLsizei stride) {
    if (stride <= kLongestStride) return stride >= 0;
    const auto [major, minor, language] = version_in(c.profile, c.caps());
    return stride <= longest_stride_of_pointers(c.profile.is_es(), major, minor);
}

}  // namespace wall::client
