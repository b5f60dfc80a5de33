// SPDX-License-Identifier: MIT
// Arrays of generic vertex attributes (OpenGL 2.1, 2.8), which buffers they are bound to (OpenGL 4.3, 2.8), and what is
// asked about them.
#include <bit>
#include <memory>
#include <mutex>
#include <optional>

#include "client_lib/context/bound_arrays.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/object_name.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/objects/es_formats.h"
#include "common/glstate/vertex_input.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;
using Array = el::attrib_array::type;

/// What of it is asked for as if it were one array, which the attribute's binding may say now.
struct Answer {
    GLint stride;
    GLuint divisor;
    std::uint64_t pointer;
};
Answer answer_of(const Context& c, GLuint index) {
    const Array& array = c.get<el::attrib_array>(index);
    const auto* bindings = c.vertex_array_objects->bindings.get();
    if (!bindings) return {array.stride, array.divisor, array.pointer};
    const AttributeBinding& attribute = bindings->attributes[index];
    return {attribute.stride, bindings->bindings[attribute.binding].divisor, attribute.pointer};
}

/// Where it takes its values from: a place for buffers, and how far behind its beginning.
AttributeBinding binding_of(const Context& c, GLuint index) {
    const auto* bindings = c.vertex_array_objects->bindings.get();
    return bindings ? bindings->attributes[index] : AttributeBinding{.binding = index};
}

bool is_integer_type(GLenum type) { return type >= GL_BYTE && type <= GL_UNSIGNED_INT; }
bool is_array_type(GLenum type) {
    return is_integer_type(type) || type == GL_FLOAT || type == GL_DOUBLE || type == GL_HALF_FLOAT ||
           type == GL_FIXED || glstate::is_one_word(type);
}

/// What OpenGL ES took over from OpenGL only later (OpenGL ES 2.0, 2.8; 3.0, 2.9).
bool is_array_type_of(const ContextProfile& profile, GLenum type) {
    if (!profile.is_es()) return true;
    if (type == GL_UNSIGNED_INT_10F_11F_11F_REV) return false;
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
        case GL_VERTEX_ATTRIB_ARRAY_STRIDE: *params = static_cast<Out>(answer_of(c, index).stride); break;
        case GL_VERTEX_ATTRIB_ARRAY_TYPE: *params = static_cast<Out>(array.type); break;
        case GL_VERTEX_ATTRIB_ARRAY_NORMALIZED: *params = static_cast<Out>(array.normalized); break;
        case GL_VERTEX_ATTRIB_ARRAY_INTEGER:
            *params = static_cast<Out>(array.reaches_as == glstate::kAsIntegers);
            break;
        case GL_VERTEX_ATTRIB_ARRAY_LONG: *params = static_cast<Out>(array.reaches_as == glstate::kAsDoubles); break;
        case GL_VERTEX_ATTRIB_ARRAY_DIVISOR: *params = static_cast<Out>(answer_of(c, index).divisor); break;
        case GL_VERTEX_ATTRIB_BINDING: *params = static_cast<Out>(binding_of(c, index).binding); break;
        case GL_VERTEX_ATTRIB_RELATIVE_OFFSET: *params = static_cast<Out>(binding_of(c, index).offset); break;
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
    if (c.profile.is_es()) return !in_object || of_buffer;
    return !c.profile.core || (in_object && of_buffer);
}

}  // namespace

namespace {

struct Given {
    GLint size;
    GLenum type;
    GLsizei stride;
    const void* pointer;
    bool normalized;
    std::uint32_t reaches_as;
};

void define(Context& c, GLuint index, const Given& given) {
    Array array = c.get<el::attrib_array>(index);
    array.pointer = reinterpret_cast<std::uintptr_t>(given.pointer);
    array.size = given.size;
    array.type = given.type;
    array.stride = given.stride;
    array.buffer = c.state.local.array_buffer;
    array.normalized = given.normalized;
    array.reaches_as = given.reaches_as;
    c.set<el::attrib_array>(index, array);
    if (c.vertex_array_objects->bindings) bind_as_array(c, index);
}

/// The error of a format of floats, or of integers that become such (OpenGL 4.6, 10.3.2).
GLenum error_of_format(const Context& c, GLint size, GLenum type, bool normalized) {
    const bool bgra = !c.profile.is_es() && size == GL_BGRA;
    if (!bgra && (size < 1 || size > 4)) return GL_INVALID_VALUE;
    if (!is_array_type(type) || !is_array_type_of(c.profile, type)) return GL_INVALID_ENUM;
    const bool packed = glstate::is_packed(type);
    if (bgra && ((type != GL_UNSIGNED_BYTE && !packed) || !normalized)) return GL_INVALID_OPERATION;
    if (packed && !bgra && size != 4) return GL_INVALID_OPERATION;
    if (type == GL_UNSIGNED_INT_10F_11F_11F_REV && size != 3) return GL_INVALID_OPERATION;
    return GL_NO_ERROR;
}
GLenum error_of_integers(GLint size, GLenum type) {
    if (size < 1 || size > 4) return GL_INVALID_VALUE;
    return is_integer_type(type) ? GL_NO_ERROR : GLenum{GL_INVALID_ENUM};
}
GLenum error_of_doubles(GLint size, GLenum type) {
    if (size < 1 || size > 4) return GL_INVALID_VALUE;
    return type == GL_DOUBLE ? GL_NO_ERROR : GLenum{GL_INVALID_ENUM};
}

/// Nothing but an array object has bindings in a core profile, and in OpenGL ES.
bool may_bind(Context& c) {
    const bool may = c.state.vertex_arrays.vertex_array_object != 0 || (!c.profile.core && !c.profile.is_es());
    if (!may) c.error(GL_INVALID_OPERATION);
    return may;
}

/// One of the commands that say how the values of an attribute lie, wherever that may be.
void set_format(Context& c, GLuint index, const Given& format, GLuint offset, GLenum error) {
    if (!may_bind(c)) return;
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (error != GL_NO_ERROR) return c.error(error);
    if (offset > kFarthestAttribute) return c.error(GL_INVALID_VALUE);
    VertexBindings& bindings = own_bindings(c);
    Array array = c.get<el::attrib_array>(index);
    array.size = format.size;
    array.type = format.type;
    array.normalized = format.normalized;
    array.reaches_as = format.reaches_as;
    bindings.attributes[index].offset = offset;
    set_bound_array(c, index, array);
}

/// The id of a buffer that is going to be in arrays; 0: of none. Nothing, and an error: there cannot be one.
std::optional<ClientName> buffer_for_arrays(Context& c, GLuint name) {
    if (name == 0) return ClientName();
    std::lock_guard lock(c.share().mutex);
    auto buffer = c.share().buffers.find(name);
    if (!buffer) {
        if (!c.share().buffers.known(name)) return c.error(GL_INVALID_OPERATION), std::nullopt;
        buffer = std::make_shared<Buffer>(next_object_id(), name);
        c.share().buffers.put(name, buffer);
        c.share().by_id[buffer->id] = buffer;
    }
    const ClientName id = buffer->id;
    c.buffers->by_id.try_emplace(id, std::move(buffer));
    return id;
}

bool is_buffer(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().buffers.find(name) != nullptr;
}

GLenum error_of_place(GLintptr offset, GLsizei stride) {
    return offset < 0 || stride < 0 || stride > kLongestStride ? GL_INVALID_VALUE : GL_NO_ERROR;
}

void bind_at(Context& c, GLuint place, ClientName buffer, GLintptr offset, GLsizei stride) {
    VertexBinding& binding = own_bindings(c).bindings[place];
    binding = {static_cast<std::uint64_t>(offset), buffer.value, stride, binding.divisor, false};
    set_arrays_of(c, place);
}

}  // namespace

void VertexAttribPointer(Context& c, GLuint index, GLint size, GLenum type, GLboolean normalized, GLsizei stride,
                         const void* pointer) {
    if (c.profile.is_es()) type = desktop_type(type);
    if (index >= kVertexAttributes || !is_stride(c, stride)) return c.error(GL_INVALID_VALUE);
    if (const GLenum error = error_of_format(c, size, type, normalized != GL_FALSE)) return c.error(error);
    if (!may_point(c, pointer)) return c.error(GL_INVALID_OPERATION);
    define(c, index, {size, type, stride, pointer, normalized != GL_FALSE, glstate::kAsFloats});
}

void VertexAttribIPointer(Context& c, GLuint index, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    if (index >= kVertexAttributes || !is_stride(c, stride)) return c.error(GL_INVALID_VALUE);
    if (const GLenum error = error_of_integers(size, type)) return c.error(error);
    if (!may_point(c, pointer)) return c.error(GL_INVALID_OPERATION);
    define(c, index, {size, type, stride, pointer, false, glstate::kAsIntegers});
}

void VertexAttribLPointer(Context& c, GLuint index, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    if (index >= kVertexAttributes || !is_stride(c, stride)) return c.error(GL_INVALID_VALUE);
    if (const GLenum error = error_of_doubles(size, type)) return c.error(error);
    if (!may_point(c, pointer)) return c.error(GL_INVALID_OPERATION);
    define(c, index, {size, type, stride, pointer, false, glstate::kAsDoubles});
}

// ---- bindings (OpenGL 4.3, 2.8) ----

void VertexAttribFormat(Context& c, GLuint index, GLint size, GLenum type, GLboolean normalized, GLuint offset) {
    const bool fractions = normalized != GL_FALSE;
    set_format(c, index, {size, type, 0, nullptr, fractions, glstate::kAsFloats}, offset,
               error_of_format(c, size, type, fractions));
}
void VertexAttribIFormat(Context& c, GLuint index, GLint size, GLenum type, GLuint offset) {
    set_format(c, index, {size, type, 0, nullptr, false, glstate::kAsIntegers}, offset, error_of_integers(size, type));
}
void VertexAttribLFormat(Context& c, GLuint index, GLint size, GLenum type, GLuint offset) {
    set_format(c, index, {size, type, 0, nullptr, false, glstate::kAsDoubles}, offset, error_of_doubles(size, type));
}

void VertexAttribBinding(Context& c, GLuint index, GLuint place) {
    if (!may_bind(c)) return;
    if (index >= kVertexAttributes || place >= kVertexBindings) return c.error(GL_INVALID_VALUE);
    own_bindings(c).attributes[index].binding = place;
    set_bound_array(c, index, c.get<el::attrib_array>(index));
}

void VertexBindingDivisor(Context& c, GLuint place, GLuint divisor) {
    if (!may_bind(c)) return;
    if (place >= kVertexBindings) return c.error(GL_INVALID_VALUE);
    own_bindings(c).bindings[place].divisor = divisor;
    set_arrays_of(c, place);
}

void BindVertexBuffer(Context& c, GLuint place, GLuint name, GLintptr offset, GLsizei stride) {
    if (!may_bind(c)) return;
    if (place >= kVertexBindings) return c.error(GL_INVALID_VALUE);
    if (const GLenum error = error_of_place(offset, stride)) return c.error(error);
    if (const auto buffer = buffer_for_arrays(c, name)) bind_at(c, place, *buffer, offset, stride);
}

/// Each is bound for itself: what is wrong with one leaves the others alone. No names: all are as at first.
void BindVertexBuffers(Context& c, GLuint first, GLsizei count, const GLuint* names, const GLintptr* offsets,
                       const GLsizei* strides) {
    if (!may_bind(c)) return;
    if (count < 0) return c.error(GL_INVALID_VALUE);
    if (std::uint64_t{first} + static_cast<std::uint64_t>(count) > kVertexBindings)
        return c.error(GL_INVALID_OPERATION);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        constexpr GLsizei kFirstStride = 16;
        if (!names) {
            bind_at(c, first + i, {}, 0, kFirstStride);
        } else if (const GLenum error = error_of_place(offsets[i], strides[i])) {
            c.error(error);
        } else if (names[i] != 0 && !is_buffer(c, names[i])) {
            c.error(GL_INVALID_OPERATION);  // these must have been made
        } else if (const auto buffer = buffer_for_arrays(c, names[i])) {
            bind_at(c, first + i, *buffer, offsets[i], strides[i]);
        }
    }
}

void VertexAttribDivisor(Context& c, GLuint index, GLuint divisor) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (const auto& bindings = c.vertex_array_objects->bindings) {
        bindings->attributes[index].binding = index;
        bindings->bindings[index].divisor = divisor;
        return set_arrays_of(c, index);
    }
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
    *pointer = reinterpret_cast<void*>(static_cast<std::uintptr_t>(answer_of(c, index).pointer));
}

// ---- doubles ----

/// A shader that takes floats has them as such.
void VertexAttribL4d(Context& c, GLuint index, GLdouble x, GLdouble y, GLdouble z, GLdouble w) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (!c.packer.inside()) c.set<el::attrib_doubles>(index, {x, y, z, w});
    VertexAttrib4f(c, index, static_cast<GLfloat>(x), static_cast<GLfloat>(y), static_cast<GLfloat>(z),
                   static_cast<GLfloat>(w));
}

void GetVertexAttribLdv(Context& c, GLuint index, GLenum pname, GLdouble* params) {
    if (pname != GL_CURRENT_VERTEX_ATTRIB) return get<false>(c, index, pname, params);
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (index == 0 && c.profile.has_fixed_function()) return c.error(GL_INVALID_OPERATION);
    const auto& v = c.get<el::attrib_doubles>(index);
    params[0] = v.x, params[1] = v.y, params[2] = v.z, params[3] = v.w;
}

}  // namespace wall::client::api
