// SPDX-License-Identifier: MIT
// Arrays of generic vertex attributes (OpenGL 2.1, 2.8) and what is asked about them.
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/object_name.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;
using Array = el::attrib_array::type;

bool is_array_type(GLenum type) { return (type >= GL_BYTE && type <= GL_FLOAT) || type == GL_DOUBLE; }

void enable(Context& c, GLuint index, bool enabled) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    Array array = c.get<el::attrib_array>(index);
    array.enabled = enabled;
    c.set<el::attrib_array>(index, array);
}

template <class Out>
void get(Context& c, GLuint index, GLenum pname, Out* params) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    const Array& array = c.get<el::attrib_array>(index);
    switch (pname) {
        case GL_VERTEX_ATTRIB_ARRAY_ENABLED: *params = static_cast<Out>(array.enabled); break;
        case GL_VERTEX_ATTRIB_ARRAY_SIZE: *params = static_cast<Out>(array.size); break;
        case GL_VERTEX_ATTRIB_ARRAY_STRIDE: *params = static_cast<Out>(array.stride); break;
        case GL_VERTEX_ATTRIB_ARRAY_TYPE: *params = static_cast<Out>(array.type); break;
        case GL_VERTEX_ATTRIB_ARRAY_NORMALIZED: *params = static_cast<Out>(array.normalized); break;
        case GL_VERTEX_ATTRIB_ARRAY_DIVISOR: *params = static_cast<Out>(array.divisor); break;
        case GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING:
            *params = static_cast<Out>(object_name(c, glstate::ValueKind::name_buffer, ClientName(array.buffer)));
            break;
        case GL_CURRENT_VERTEX_ATTRIB:
            if (index == 0) return c.error(GL_INVALID_OPERATION);
            c.flush_block();
            for (const float value : c.get<el::vertex_attrib>(index)) *params++ = static_cast<Out>(value);
            break;
        default: c.error(GL_INVALID_ENUM);
    }
}

/// A core profile has arrays in buffers and in array objects only.
bool may_point(const Context& c, const void* pointer) {
    if (!c.profile.core) return true;
    return c.state.vertex_arrays.vertex_array_object != 0 && (c.state.local.array_buffer != 0 || pointer == nullptr);
}

}  // namespace

void VertexAttribPointer(Context& c, GLuint index, GLint size, GLenum type, GLboolean normalized, GLsizei stride,
                         const void* pointer) {
    if (index >= kVertexAttributes || size < 1 || size > 4 || stride < 0) return c.error(GL_INVALID_VALUE);
    if (!is_array_type(type)) return c.error(GL_INVALID_ENUM);
    if (!may_point(c, pointer)) return c.error(GL_INVALID_OPERATION);
    Array array = c.get<el::attrib_array>(index);
    array.pointer = reinterpret_cast<std::uintptr_t>(pointer);
    array.size = size;
    array.type = type;
    array.stride = stride;
    array.buffer = c.state.local.array_buffer;
    array.normalized = normalized != GL_FALSE;
    array.integer = false;
    c.set<el::attrib_array>(index, array);
}

void VertexAttribDivisor(Context& c, GLuint index, GLuint divisor) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    Array array = c.get<el::attrib_array>(index);
    array.divisor = divisor;
    c.set<el::attrib_array>(index, array);
}

void EnableVertexAttribArray(Context& c, GLuint index) { enable(c, index, true); }
void DisableVertexAttribArray(Context& c, GLuint index) { enable(c, index, false); }

void GetVertexAttribfv(Context& c, GLuint index, GLenum pname, GLfloat* params) { get(c, index, pname, params); }
void GetVertexAttribdv(Context& c, GLuint index, GLenum pname, GLdouble* params) { get(c, index, pname, params); }
void GetVertexAttribiv(Context& c, GLuint index, GLenum pname, GLint* params) { get(c, index, pname, params); }

void GetVertexAttribPointerv(Context& c, GLuint index, GLenum pname, void** pointer) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (pname != GL_VERTEX_ATTRIB_ARRAY_POINTER) return c.error(GL_INVALID_ENUM);
    *pointer = reinterpret_cast<void*>(static_cast<std::uintptr_t>(c.get<el::attrib_array>(index).pointer));
}

}  // namespace wall::client::api
