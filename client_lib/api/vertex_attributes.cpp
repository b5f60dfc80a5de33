// SPDX-License-Identifier: MIT
// Arrays of generic vertex attributes (OpenGL 2.1, 2.8) and what is asked about them.
#include <bit>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/object_name.h"
#include "client_lib/objects/es_formats.h"
#include "common/glstate/vertex_input.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;
using Array = el::attrib_array::type;

bool is_integer_type(GLenum type) { return type >= GL_BYTE && type <= GL_UNSIGNED_INT; }
bool is_array_type(GLenum type) {
    return is_integer_type(type) || type == GL_FLOAT || type == GL_DOUBLE || type == GL_HALF_FLOAT ||
           type == GL_FIXED || glstate::is_packed(type);
}

/// What OpenGL ES took over from OpenGL only later (OpenGL ES 2.0, 2.8; 3.0, 2.9).
bool is_array_type_of(const ContextProfile& profile, GLenum type) {
    if (profile.es == 0) return true;
    return type != GL_DOUBLE && (profile.es >= 30 || (type != GL_INT && type != GL_UNSIGNED_INT));
}

void enable(Context& c, GLuint index, bool enabled) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    Array array = c.get<el::attrib_array>(index);
    array.enabled = enabled;
    c.set<el::attrib_array>(index, array);
}

/// The number, or what an integer's bits stand for.
template <bool kBits, class Out>
Out as(float value) {
    if constexpr (kBits) return std::bit_cast<Out>(value);
    else return static_cast<Out>(value);
}

template <bool kBits, class Out>
void get(Context& c, GLuint index, GLenum pname, Out* params) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    const Array& array = c.get<el::attrib_array>(index);
    switch (pname) {
        case GL_VERTEX_ATTRIB_ARRAY_ENABLED: *params = static_cast<Out>(array.enabled); break;
        case GL_VERTEX_ATTRIB_ARRAY_SIZE: *params = static_cast<Out>(array.size); break;
        case GL_VERTEX_ATTRIB_ARRAY_STRIDE: *params = static_cast<Out>(array.stride); break;
        case GL_VERTEX_ATTRIB_ARRAY_TYPE: *params = static_cast<Out>(array.type); break;
        case GL_VERTEX_ATTRIB_ARRAY_NORMALIZED: *params = static_cast<Out>(array.normalized); break;
        case GL_VERTEX_ATTRIB_ARRAY_INTEGER: *params = static_cast<Out>(array.integer); break;
        case GL_VERTEX_ATTRIB_ARRAY_DIVISOR: *params = static_cast<Out>(array.divisor); break;
        case GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING:
            *params = static_cast<Out>(object_name(c, glstate::ValueKind::name_buffer, ClientName(array.buffer)));
            break;
        case GL_CURRENT_VERTEX_ATTRIB:
            if (index == 0 && c.profile.has_fixed_function()) return c.error(GL_INVALID_OPERATION);
            c.flush_block();
            for (const float value : c.get<el::vertex_attrib>(index)) *params++ = as<kBits, Out>(value);
            break;
        default: c.error(GL_INVALID_ENUM);
    }
}

/// A core profile has arrays in buffers and in array objects only; OpenGL ES has array objects of buffers only (OpenGL
/// ES 3.0.6, 2.9).
bool may_point(const Context& c, const void* pointer) {
    const bool in_object = c.state.vertex_arrays.vertex_array_object != 0,
               of_buffer = c.state.local.array_buffer != 0 || pointer == nullptr;
    if (c.profile.es != 0) return !in_object || of_buffer;
    return !c.profile.core || (in_object && of_buffer);
}

}  // namespace

namespace {

struct Given {
    GLint size;
    GLenum type;
    GLsizei stride;
    const void* pointer;
    bool normalized, integer;
};

void define(Context& c, GLuint index, const Given& given) {
    Array array = c.get<el::attrib_array>(index);
    array.pointer = reinterpret_cast<std::uintptr_t>(given.pointer);
    array.size = given.size;
    array.type = given.type;
    array.stride = given.stride;
    array.buffer = c.state.local.array_buffer;
    array.normalized = given.normalized;
    array.integer = given.integer;
    c.set<el::attrib_array>(index, array);
}

}  // namespace

void VertexAttribPointer(Context& c, GLuint index, GLint size, GLenum type, GLboolean normalized, GLsizei stride,
                         const void* pointer) {
    const bool es = c.profile.es != 0, bgra = !es && size == GL_BGRA;
    if (es) type = desktop_type(type);
    if (index >= kVertexAttributes || (!bgra && (size < 1 || size > 4)) || stride < 0) return c.error(GL_INVALID_VALUE);
    if (!is_array_type(type) || !is_array_type_of(c.profile, type)) return c.error(GL_INVALID_ENUM);
    const bool packed = glstate::is_packed(type);
    if (bgra && ((type != GL_UNSIGNED_BYTE && !packed) || !normalized)) return c.error(GL_INVALID_OPERATION);
    if (packed && !bgra && size != 4) return c.error(GL_INVALID_OPERATION);
    if (!may_point(c, pointer)) return c.error(GL_INVALID_OPERATION);
    define(c, index, {size, type, stride, pointer, normalized != GL_FALSE, false});
}

void VertexAttribIPointer(Context& c, GLuint index, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    if (index >= kVertexAttributes || size < 1 || size > 4 || stride < 0) return c.error(GL_INVALID_VALUE);
    if (!is_integer_type(type)) return c.error(GL_INVALID_ENUM);
    if (!may_point(c, pointer)) return c.error(GL_INVALID_OPERATION);
    define(c, index, {size, type, stride, pointer, false, true});
}

void VertexAttribDivisor(Context& c, GLuint index, GLuint divisor) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    Array array = c.get<el::attrib_array>(index);
    array.divisor = divisor;
    c.set<el::attrib_array>(index, array);
}

void EnableVertexAttribArray(Context& c, GLuint index) { enable(c, index, true); }
void DisableVertexAttribArray(Context& c, GLuint index) { enable(c, index, false); }

void GetVertexAttribfv(Context& c, GLuint index, GLenum pname, GLfloat* params) { get<false>(c, index, pname, params); }
void GetVertexAttribdv(Context& c, GLuint index, GLenum pname, GLdouble* params) {
    get<false>(c, index, pname, params);
}
void GetVertexAttribiv(Context& c, GLuint index, GLenum pname, GLint* params) { get<false>(c, index, pname, params); }
void GetVertexAttribIiv(Context& c, GLuint index, GLenum pname, GLint* params) { get<true>(c, index, pname, params); }
void GetVertexAttribIuiv(Context& c, GLuint index, GLenum pname, GLuint* params) { get<true>(c, index, pname, params); }

void GetVertexAttribPointerv(Context& c, GLuint index, GLenum pname, void** pointer) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (pname != GL_VERTEX_ATTRIB_ARRAY_POINTER) return c.error(GL_INVALID_ENUM);
    *pointer = reinterpret_cast<void*>(static_cast<std::uintptr_t>(c.get<el::attrib_array>(index).pointer));
}

}  // namespace wall::client::api
