// SPDX-License-Identifier: MIT
// Vertex array objects (GL_ARB_vertex_array_object; OpenGL 3.0, 2.10). They name arrays of this context; the nodes are
// told by draws what those read.
#include "client_lib/context/vertex_array_objects.h"

#include "client_lib/context/buffer_binding.h"

namespace wall::client::api {

void GenVertexArrays(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = c.vertex_array_objects->reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteVertexArrays(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    bool any = false;
    for (GLsizei i = 0; i < count; ++i) any |= c.vertex_array_objects->erase(c.state, names[i]);
    if (any && c.buffers->holds_deleted) let_go_of_deleted_buffers(c);
}

void BindVertexArray(Context& c, GLuint name) {
    if (!c.vertex_array_objects->may_be_bound(name)) return c.error(GL_INVALID_OPERATION);
    c.vertex_array_objects->bind(c.state, name);
}

GLboolean IsVertexArray(Context& c, GLuint name) { return c.vertex_array_objects->exists(name); }

}  // namespace wall::client::api
