// SPDX-License-Identifier: MIT
// Changing how the attributes of a context's bound vertex array object are bound to buffers (vertex_bindings.h), and
// the arrays that follow from that. The context's thread.
#pragma once

#include "client_lib/context/context.h"
#include "client_lib/context/vertex_bindings.h"

namespace wall::client {

/// Of the bound vertex array object; from now on it has some.
VertexBindings& own_bindings(Context& c);
/// Sets an attribute's array, of which only the format counts and whether it is enabled. The object has bindings.
void set_bound_array(Context& c, unsigned attribute, const glstate::ClientArray& format);
/// After a change of a place: all arrays that are bound to it.
void set_arrays_of(Context& c, unsigned place);
/// After glVertexAttribPointer has set an attribute's array: it has its own place again, which is as the array says.
void bind_as_array(Context& c, unsigned attribute);
/// Whether an array that is set by a pointer may have it in the context's version.
bool is_stride(const Context& c, GLsizei stride);

}  // namespace wall::client
