// SPDX-License-Identifier: MIT
// Vertex arrays (OpenGL 1.2.1, 2.8): what they are and drawing from them.
#include <algorithm>
#include <iterator>
#include <optional>

#include "client_lib/api/array_draws.h"
#include "client_lib/context/array_copies.h"
#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/based_instances.h"
#include "client_lib/context/bound_arrays.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/client_arrays.h"
#include "client_lib/context/copied_draw.h"
#include "client_lib/context/debug_state.h"
#include "client_lib/context/lists.h"
#include "client_lib/context/node_draw.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/sampled_parts.h"
#include "client_lib/context/select.h"
#include "client_lib/context/staged_draw.h"
#include "client_lib/context/vertex_array_objects.h"
#include "common/glapi/primitive.h"
#include "common/glstate/diff.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;
using glstate::ClientArray;

// ---- defining ----

/// Types that a pointer command takes, as bits: those from GL_BYTE on, the packed ones, and fixed point.
constexpr unsigned type_bit(GLenum type) {
    if (glstate::is_packed(type)) return 1u << 16;
    if (type == GL_FIXED) return 1u << 17;
    return type >= GL_BYTE && type <= GL_HALF_FLOAT ? 1u << (type - GL_BYTE) : 0;
}
constexpr unsigned kReal = type_bit(GL_FLOAT) | type_bit(GL_DOUBLE) | type_bit(GL_HALF_FLOAT);
constexpr unsigned kSigned = kReal | type_bit(GL_SHORT) | type_bit(GL_INT) | type_bit(GL_INT_2_10_10_10_REV);
constexpr unsigned kIndices =
    type_bit(GL_UNSIGNED_BYTE) | type_bit(GL_SHORT) | type_bit(GL_INT) | type_bit(GL_FLOAT) | type_bit(GL_DOUBLE);
constexpr unsigned kAny =
    kSigned | type_bit(GL_BYTE) | type_bit(GL_UNSIGNED_BYTE) | type_bit(GL_UNSIGNED_SHORT) | type_bit(GL_UNSIGNED_INT);
// Of OpenGL ES 1.1 (2.8, table 2.4; GL_OES_byte_coordinates).
constexpr unsigned kRealOfEs1 = type_bit(GL_FLOAT) | type_bit(GL_FIXED);
constexpr unsigned kSignedOfEs1 = kRealOfEs1 | type_bit(GL_BYTE) | type_bit(GL_SHORT);
constexpr unsigned kColorsOfEs1 = kRealOfEs1 | type_bit(GL_UNSIGNED_BYTE);

struct Allowed {
    GLint min_size, max_size;
    unsigned types;
    bool bgra = false;  ///< for a size (GL_ARB_vertex_array_bgra)
};

const Allowed& allowed_in(const Context& c, const Allowed& desktop, const Allowed& es1) {
    return c.profile.is_es1() ? es1 : desktop;
}

struct Given {
    GLint size;
    GLenum type;
    GLsizei stride;
    const void* pointer;
};

template <class E>
void define(Context& c, unsigned i, const Allowed& allowed, const Given& given) {
    if (!(allowed.types & type_bit(given.type))) return c.error(GL_INVALID_ENUM);
    if (!is_stride(c, given.stride)) return c.error(GL_INVALID_VALUE);
    const bool packed = glstate::is_packed(given.type);
    if (allowed.bgra && given.size == GL_BGRA) {
        if (!packed && given.type != GL_UNSIGNED_BYTE) return c.error(GL_INVALID_OPERATION);
    } else {
        if (given.size < allowed.min_size || given.size > allowed.max_size) return c.error(GL_INVALID_VALUE);
        if (packed && allowed.max_size == 4 && given.size != 4) return c.error(GL_INVALID_OPERATION);
    }
    ClientArray array = E::ref(c.state, i);
    array.pointer = reinterpret_cast<std::uintptr_t>(given.pointer);
    array.size = given.size;
    array.type = given.type;
    array.stride = given.stride;
    array.buffer = c.state.local.array_buffer;
    c.set<E>(i, array);
}

unsigned client_unit(const Context& c) { return c.state.local.client_active_texture - GL_TEXTURE0; }

template <class E>
void enable(Context& c, unsigned i, bool on) {
    ClientArray array = E::ref(c.state, i);
    array.enabled = on;
    c.set<E>(i, array);
}

void enable(Context& c, GLenum cap, bool on) {
    switch (cap) {
        case GL_VERTEX_ARRAY: return enable<el::vertex_array>(c, 0, on);
        case GL_NORMAL_ARRAY: return enable<el::normal_array>(c, 0, on);
        case GL_COLOR_ARRAY: return enable<el::color_array>(c, 0, on);
        case GL_INDEX_ARRAY: return enable<el::index_array>(c, 0, on);
        case GL_TEXTURE_COORD_ARRAY: return enable<el::texcoord_array>(c, client_unit(c), on);
        case GL_EDGE_FLAG_ARRAY: return enable<el::edge_flag_array>(c, 0, on);
        case GL_FOG_COORD_ARRAY: return enable<el::fog_coord_array>(c, 0, on);
        case GL_SECONDARY_COLOR_ARRAY: return enable<el::secondary_color_array>(c, 0, on);
        case GL_PRIMITIVE_RESTART_NV: return c.set<el::primitive_restart>(0, on);
        case GL_POINT_SIZE_ARRAY_OES:
            if (c.profile.is_es1()) return enable<el::point_size_array>(c, 0, on);
            [[fallthrough]];
        default: return c.error(GL_INVALID_ENUM);
    }
}

// OpenGL 1.2.1, table 2.5: sizes and offsets in bytes; 0: not in the format.
struct Interleaved {
    GLint texcoords, colors;
    GLenum color_type;
    bool normals;
    GLint vertices;
    unsigned color_at, normal_at, vertex_at, stride;
};
constexpr Interleaved kInterleaved[] = {
    {0, 0, 0, false, 2, 0, 0, 0, 8},                   // GL_V2F
    {0, 0, 0, false, 3, 0, 0, 0, 12},                  // GL_V3F
    {0, 4, GL_UNSIGNED_BYTE, false, 2, 0, 0, 4, 12},   // GL_C4UB_V2F
    {0, 4, GL_UNSIGNED_BYTE, false, 3, 0, 0, 4, 16},   // GL_C4UB_V3F
    {0, 3, GL_FLOAT, false, 3, 0, 0, 12, 24},          // GL_C3F_V3F
    {0, 0, 0, true, 3, 0, 0, 12, 24},                  // GL_N3F_V3F
    {0, 4, GL_FLOAT, true, 3, 0, 16, 28, 40},          // GL_C4F_N3F_V3F
    {2, 0, 0, false, 3, 0, 0, 8, 20},                  // GL_T2F_V3F
    {4, 0, 0, false, 4, 0, 0, 16, 32},                 // GL_T4F_V4F
    {2, 4, GL_UNSIGNED_BYTE, false, 3, 8, 0, 12, 24},  // GL_T2F_C4UB_V3F
    {2, 3, GL_FLOAT, false, 3, 8, 0, 20, 32},          // GL_T2F_C3F_V3F
    {2, 0, 0, true, 3, 0, 8, 20, 32},                  // GL_T2F_N3F_V3F
    {2, 4, GL_FLOAT, true, 3, 8, 24, 36, 48},          // GL_T2F_C4F_N3F_V3F
    {4, 4, GL_FLOAT, true, 4, 16, 32, 44, 60},         // GL_T4F_C4F_N3F_V4F
};

// ---- drawing ----

bool is_index_type(GLenum type) {
    return type == GL_UNSIGNED_BYTE || type == GL_UNSIGNED_SHORT || type == GL_UNSIGNED_INT;
}

}  // namespace

/// Without fixed function there are no quads and no polygons; a core profile draws from no arrays but those of an
/// object.
bool check_mode(Context& c, GLenum mode) {
    if (!glapi::is_primitive(mode) || (!c.profile.has_fixed_function() && mode >= GL_QUADS && mode <= GL_POLYGON))
        return c.error(GL_INVALID_ENUM), false;
    if (c.profile.core && c.state.vertex_arrays.vertex_array_object == 0) return c.error(GL_INVALID_OPERATION), false;
    return !c.at_once() || fits_program(c, mode);
}

namespace {

/// The index at which primitives begin anew, if there is one: the program's, or the last of the type, which goes first
/// (OpenGL 4.6, 10.3.6).
std::optional<GLuint> restart_index(const Context& c, GLenum type) {
    const auto& local = c.state.local;
    if (local.primitive_restart_fixed_index) {
        const unsigned unused_bits = type == GL_UNSIGNED_BYTE ? 24 : type == GL_UNSIGNED_SHORT ? 16 : 0;
        return ~GLuint{0} >> unused_bits;
    }
    return local.primitive_restart ? std::optional(local.primitive_restart_index) : std::nullopt;
}

/// A block of vertices has no doubles.
bool has_arrays_of_doubles(const Context& c) {
    return std::ranges::any_of(c.state.vertex_arrays.attrib_array, [](const ClientArray& array) {
        return array.enabled && array.reaches_as == glstate::kAsDoubles;
    });
}

/// Types that only OpenGL ES 1.1 has for an array of fixed function: a node's driver, of OpenGL, refuses them.
bool has_arrays_of_es1(const Context& c) {
    const auto& arrays = c.state.vertex_arrays;
    const auto of_bytes = [](const ClientArray& array) { return array.enabled && array.type == GL_BYTE; };
    bool found = arrays.vertex_array.enabled && arrays.vertex_array.type == GL_FIXED;
    found = found || of_bytes(arrays.vertex_array) || std::ranges::any_of(arrays.texcoord_array, of_bytes);
    glstate::for_each_attribute_array(c.state, [&](glstate::Attribute, const ClientArray& array) {
        found = found || (array.enabled && array.type == GL_FIXED);
    });
    return found;
}

/// Draws one instance into the block or the list.
void draw_inline(Context& c, const ArrayDraw& draw, GLsizei instance) {
    BufferReading reading;
    const ElementRange elements = elements_of(c, draw, instance, reading);
    if (draw.index_type == 0 || elements.indices) draw_elements(c, draw.mode, elements);
}

}  // namespace

void draw(Context& c, const ArrayDraw& draw) {
    if (c.profile.is_es1() && draw_by_sizes(c, draw)) return;
    if (!DrawOfParts::may_copy(c, draw)) return draw_of_one_size(c, draw);
    DrawOfParts of_parts(c, draw);
    draw_of_one_size(c, draw);
    of_parts.finish();
}

void draw_of_one_size(Context& c, const ArrayDraw& draw) {
    const auto elements = static_cast<std::uint64_t>(draw.count) * static_cast<std::uint64_t>(draw.instances);
    if (draw.instances > 1 && elements > wire::kMostInstancedElements) return c.error(GL_OUT_OF_MEMORY);
    std::optional<BasedInstances> based;
    if (draw.base_instance != 0) based.emplace(c.state, draw.base_instance);
    const bool at_once = c.at_once();
    if (c.profile.is_es1() && has_arrays_of_es1(c)) return draw_inline(c, draw, 0);
    if (at_once && constant_doubles(c) != 0) return draw_staged(c, draw);
    if (draw_on_nodes(c, draw)) return;
    if (draw_copied(c, draw)) return;
    if (at_once && has_arrays_of_doubles(c)) return draw_staged(c, draw);
    if (draw.instances == 1 && !(at_once && reads_numbers(c))) return draw_inline(c, draw, 0);
    if (at_once) return draw_staged(c, draw);
    // As Mesa: all that a list knows of instances are the arrays that go on with them.
    for (GLsizei i = 0; i < draw.instances; ++i) draw_inline(c, draw, i);
}

void draw_indexed(Context& c, ArrayDraw with_indices) {
    with_indices.restart = restart_index(c, with_indices.index_type);
    draw(c, with_indices);
}

bool check_indices(Context& c, GLenum mode, GLsizei count, GLenum type, GLsizei instances) {
    if (count < 0 || instances < 0) return c.error(GL_INVALID_VALUE), false;
    if (!check_mode(c, mode)) return false;
    if (!is_index_type(type)) return c.error(GL_INVALID_ENUM), false;
    // OpenGL ES 3.0.6, 2.15.2; not where geometry shaders are (GL_EXT_geometry_shader).
    if (c.profile.is_es() && c.profile.es < 31 && c.captures->captures()) return c.error(GL_INVALID_OPERATION), false;
    return true;
}

namespace {

void draw_range(Context& c, GLenum mode, GLint first, GLsizei count, GLsizei instances = 1) {
    draw(c, {.mode = mode, .first = first, .count = count, .instances = instances});
}

void draw_indices(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices, GLint base_vertex = 0,
                  GLsizei instances = 1) {
    draw_indexed(c, {.mode = mode,
                     .count = count,
                     .index_type = type,
                     .indices = indices,
                     .base_vertex = base_vertex,
                     .instances = instances});
}

template <class Named>
const void* pointer_of(const Named& array) {
    return reinterpret_cast<const void*>(static_cast<std::uintptr_t>(array.pointer));
}

}  // namespace

void VertexPointer(Context& c, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    define<el::vertex_array>(c, 0, allowed_in(c, {2, 4, kSigned}, {2, 4, kSignedOfEs1}), {size, type, stride, pointer});
}
void NormalPointer(Context& c, GLenum type, GLsizei stride, const void* pointer) {
    const Allowed allowed = allowed_in(c, {3, 3, kSigned | type_bit(GL_BYTE)}, {3, 3, kSignedOfEs1});
    define<el::normal_array>(c, 0, allowed, {3, type, stride, pointer});
}
void ColorPointer(Context& c, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    const Allowed allowed = allowed_in(c, {3, 4, kAny, true}, {4, 4, kColorsOfEs1, true});
    define<el::color_array>(c, 0, allowed, {size, type, stride, pointer});
}
void SecondaryColorPointer(Context& c, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    define<el::secondary_color_array>(c, 0, {3, 3, kAny, true}, {size, type, stride, pointer});
}
void FogCoordPointer(Context& c, GLenum type, GLsizei stride, const void* pointer) {
    define<el::fog_coord_array>(c, 0, {1, 1, kReal}, {1, type, stride, pointer});
}
void IndexPointer(Context& c, GLenum type, GLsizei stride, const void* pointer) {
    define<el::index_array>(c, 0, {1, 1, kIndices}, {1, type, stride, pointer});
}
void EdgeFlagPointer(Context& c, GLsizei stride, const void* pointer) {
    define<el::edge_flag_array>(c, 0, {1, 1, type_bit(GL_UNSIGNED_BYTE)}, {1, GL_UNSIGNED_BYTE, stride, pointer});
}
void TexCoordPointer(Context& c, GLint size, GLenum type, GLsizei stride, const void* pointer) {
    const Allowed allowed = allowed_in(c, {1, 4, kSigned}, {2, 4, kSignedOfEs1});
    define<el::texcoord_array>(c, client_unit(c), allowed, {size, type, stride, pointer});
}
void PointSizePointerOES(Context& c, GLenum type, GLsizei stride, const void* pointer) {
    define<el::point_size_array>(c, 0, {1, 1, kRealOfEs1}, {1, type, stride, pointer});
}

void EnableClientState(Context& c, GLenum cap) { enable(c, cap, true); }
void DisableClientState(Context& c, GLenum cap) { enable(c, cap, false); }

void InterleavedArrays(Context& c, GLenum format, GLsizei stride, const void* pointer) {
    if (stride < 0) return c.error(GL_INVALID_VALUE);
    if (format < GL_V2F || format - GL_V2F >= std::size(kInterleaved)) return c.error(GL_INVALID_ENUM);
    const Interleaved& f = kInterleaved[format - GL_V2F];
    const GLsizei step = stride ? stride : static_cast<GLsizei>(f.stride);
    const auto* at = static_cast<const std::byte*>(pointer);
    DisableClientState(c, GL_EDGE_FLAG_ARRAY);
    DisableClientState(c, GL_INDEX_ARRAY);
    const auto part = [&](GLenum cap, bool on, auto&& set) {
        enable(c, cap, on);
        if (on) set();
    };
    part(GL_TEXTURE_COORD_ARRAY, f.texcoords != 0, [&] { TexCoordPointer(c, f.texcoords, GL_FLOAT, step, at); });
    part(GL_COLOR_ARRAY, f.colors != 0, [&] { ColorPointer(c, f.colors, f.color_type, step, at + f.color_at); });
    part(GL_NORMAL_ARRAY, f.normals, [&] { NormalPointer(c, GL_FLOAT, step, at + f.normal_at); });
    part(GL_VERTEX_ARRAY, true, [&] { VertexPointer(c, f.vertices, GL_FLOAT, step, at + f.vertex_at); });
}

/// GL_EXT_compiled_vertex_array: what the program promises of its memory.
void LockArraysEXT(Context& c, GLint first, GLsizei count) {
    if (first < 0 || count <= 0) return c.error(GL_INVALID_VALUE);
    if (c.state.local.array_element_lock_count != 0) return c.error(GL_INVALID_OPERATION);
    c.set<el::array_element_lock_first>(0, first);
    c.set<el::array_element_lock_count>(0, count);
    c.copies->lock();
}

void UnlockArraysEXT(Context& c) {
    if (c.state.local.array_element_lock_count == 0) return c.error(GL_INVALID_OPERATION);
    c.set<el::array_element_lock_first>(0, 0);
    c.set<el::array_element_lock_count>(0, 0);
    c.copies->unlock();
}

void ArrayElement(Context& c, GLint element) {
    if (element < 0) return c.error(GL_INVALID_VALUE);
    const auto& local = c.state.local;
    if (local.primitive_restart && static_cast<GLuint>(element) == local.primitive_restart_index)
        return c.table->PrimitiveRestartNV(c);
    send_element(c, ArraySet(c, true), static_cast<GLuint>(element));
}

void DrawArrays(Context& c, GLenum mode, GLint first, GLsizei count) {
    if (first < 0 || count < 0) return c.error(GL_INVALID_VALUE);
    if (check_mode(c, mode)) draw_range(c, mode, first, count);
}

void DrawArraysInstanced(Context& c, GLenum mode, GLint first, GLsizei count, GLsizei instances) {
    if (first < 0 || count < 0 || instances < 0) return c.error(GL_INVALID_VALUE);
    if (check_mode(c, mode)) draw_range(c, mode, first, count, instances);
}

void DrawElements(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices) {
    if (check_indices(c, mode, count, type)) draw_indices(c, mode, count, type, indices);
}

void DrawElementsBaseVertex(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices,
                            GLint base_vertex) {
    if (check_indices(c, mode, count, type)) draw_indices(c, mode, count, type, indices, base_vertex);
}

void DrawElementsInstanced(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices,
                           GLsizei instances) {
    if (check_indices(c, mode, count, type, instances)) draw_indices(c, mode, count, type, indices, 0, instances);
}

void DrawElementsInstancedBaseVertex(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices,
                                     GLsizei instances, GLint base_vertex) {
    if (check_indices(c, mode, count, type, instances))
        draw_indices(c, mode, count, type, indices, base_vertex, instances);
}

void DrawArraysInstancedBaseInstance(Context& c, GLenum mode, GLint first, GLsizei count, GLsizei instances,
                                     GLuint base_instance) {
    if (first < 0 || count < 0 || instances < 0) return c.error(GL_INVALID_VALUE);
    if (!c.at_once()) return c.error(GL_INVALID_OPERATION);
    if (check_mode(c, mode))
        draw(c, {.mode = mode, .first = first, .count = count, .instances = instances, .base_instance = base_instance});
}

void DrawElementsInstancedBaseVertexBaseInstance(Context& c, GLenum mode, GLsizei count, GLenum type,
                                                 const void* indices, GLsizei instances, GLint base_vertex,
                                                 GLuint base_instance) {
    if (!c.at_once()) return c.error(GL_INVALID_OPERATION);
    if (check_indices(c, mode, count, type, instances))
        draw_indexed(c, {.mode = mode,
                         .count = count,
                         .index_type = type,
                         .indices = indices,
                         .base_vertex = base_vertex,
                         .instances = instances,
                         .base_instance = base_instance});
}

void DrawRangeElements(Context& c, GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                       const void* indices) {
    if (end < start) return c.error(GL_INVALID_VALUE);
    DrawElements(c, mode, count, type, indices);
}

void DrawRangeElementsBaseVertex(Context& c, GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                                 const void* indices, GLint base_vertex) {
    if (end < start) return c.error(GL_INVALID_VALUE);
    DrawElementsBaseVertex(c, mode, count, type, indices, base_vertex);
}

void MultiDrawArrays(Context& c, GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws) {
    if (draws < 0) return c.error(GL_INVALID_VALUE);
    if (!check_mode(c, mode)) return;
    for (GLsizei i = 0; i < draws; ++i)
        if (first[i] < 0 || count[i] < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < draws; ++i) draw_range(c, mode, first[i], count[i]);
}

void MultiDrawElementsBaseVertex(Context& c, GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                                 GLsizei draws, const GLint* base_vertex) {
    if (draws < 0) return c.error(GL_INVALID_VALUE);
    if (!check_mode(c, mode)) return;
    if (!is_index_type(type)) return c.error(GL_INVALID_ENUM);
    for (GLsizei i = 0; i < draws; ++i)
        if (count[i] < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < draws; ++i)
        draw_indices(c, mode, count[i], type, indices[i], base_vertex ? base_vertex[i] : 0);
}

void MultiDrawElements(Context& c, GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                       GLsizei draws) {
    MultiDrawElementsBaseVertex(c, mode, count, type, indices, draws, nullptr);
}

void GetPointerv(Context& c, GLenum pname, void** params) {
    if (!params) return;
    const auto& l = c.state.vertex_arrays;
    const auto answer = [&](const void* pointer) { *params = const_cast<void*>(pointer); };
    switch (pname) {
        case GL_VERTEX_ARRAY_POINTER: return answer(pointer_of(l.vertex_array));
        case GL_NORMAL_ARRAY_POINTER: return answer(pointer_of(l.normal_array));
        case GL_COLOR_ARRAY_POINTER: return answer(pointer_of(l.color_array));
        case GL_INDEX_ARRAY_POINTER: return answer(pointer_of(l.index_array));
        case GL_TEXTURE_COORD_ARRAY_POINTER: return answer(pointer_of(l.texcoord_array[client_unit(c)]));
        case GL_EDGE_FLAG_ARRAY_POINTER: return answer(pointer_of(l.edge_flag_array));
        case GL_FOG_COORD_ARRAY_POINTER: return answer(pointer_of(l.fog_coord_array));
        case GL_SECONDARY_COLOR_ARRAY_POINTER: return answer(pointer_of(l.secondary_color_array));
        case GL_FEEDBACK_BUFFER_POINTER: return answer(c.select->feedback_buffer);
        case GL_POINT_SIZE_ARRAY_POINTER_OES: return answer(pointer_of(l.point_size_array));
        case GL_DEBUG_CALLBACK_FUNCTION: return void(*params = reinterpret_cast<void*>(c.debug->log.callback));
        case GL_DEBUG_CALLBACK_USER_PARAM: return answer(c.debug->log.user);
        case GL_SELECTION_BUFFER_POINTER: return answer(c.select->select_buffer);
        default: return c.error(GL_INVALID_ENUM);
    }
}

void PushClientAttrib(Context& c, GLbitfield mask) {
    auto& stack = c.attributes->client;
    if (stack.size() >= kAttributeStackLimit) return c.error(GL_STACK_OVERFLOW);
    stack.push_back(std::make_unique<SavedAttributes>(SavedAttributes{mask, c.state, {}}));
    if (const auto& bindings = c.vertex_array_objects->bindings; bindings && (mask & GL_CLIENT_VERTEX_ARRAY_BIT))
        stack.back()->bindings = std::make_unique<VertexBindings>(*bindings);
}

void PopClientAttrib(Context& c) {
    auto& stack = c.attributes->client;
    if (stack.empty()) return c.error(GL_STACK_UNDERFLOW);
    const auto saved = std::move(stack.back());
    stack.pop_back();
    GLbitfield mask = saved->mask;
    if (mask & GL_CLIENT_VERTEX_ARRAY_BIT) {
        const GLuint object = saved->state.vertex_arrays.vertex_array_object;
        // A deleted one does not come back (GL_ARB_vertex_array_object, issue 3); there is nowhere to put the arrays.
        if (c.vertex_array_objects->may_be_bound(object)) {
            c.vertex_array_objects->bind(c.state, object);
            c.vertex_array_objects->bindings = std::move(saved->bindings);
        } else {
            mask &= ~GLbitfield{GL_CLIENT_VERTEX_ARRAY_BIT};
        }
    }
    glstate::for_each_in_client_group(
        mask, [&]<class E>(unsigned i) { c.set<E>(i, E::ref(std::as_const(saved->state), i)); });
}

}  // namespace wall::client::api

// A list holds what the arrays contain when it is compiled: a DrawArrays without arguments that marks what follows as
// one command, then Begin, attributes, vertices, End (draw_elements).
namespace wall::client::compile {

void ArrayElement(Context& c, GLint element) { api::ArrayElement(c, element); }
void DrawArrays(Context& c, GLenum mode, GLint first, GLsizei count) { api::DrawArrays(c, mode, first, count); }
void DrawElements(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices) {
    api::DrawElements(c, mode, count, type, indices);
}
void DrawRangeElements(Context& c, GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                       const void* indices) {
    api::DrawRangeElements(c, mode, start, end, count, type, indices);
}
void MultiDrawArrays(Context& c, GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws) {
    api::MultiDrawArrays(c, mode, first, count, draws);
}
void MultiDrawElements(Context& c, GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                       GLsizei draws) {
    api::MultiDrawElements(c, mode, count, type, indices, draws);
}

// Of several instances no list can be made (GL_ARB_draw_instanced).
void DrawArraysInstanced(Context& c, GLenum, GLint, GLsizei, GLsizei) { c.error(GL_INVALID_OPERATION); }
void DrawElementsInstanced(Context& c, GLenum, GLsizei, GLenum, const void*, GLsizei) { c.error(GL_INVALID_OPERATION); }
void DrawElementsInstancedBaseVertex(Context& c, GLenum, GLsizei, GLenum, const void*, GLsizei, GLint) {
    c.error(GL_INVALID_OPERATION);
}
void DrawElementsBaseVertex(Context& c, GLenum mode, GLsizei count, GLenum type, const void* indices,
                            GLint base_vertex) {
    api::DrawElementsBaseVertex(c, mode, count, type, indices, base_vertex);
}
void DrawRangeElementsBaseVertex(Context& c, GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                                 const void* indices, GLint base_vertex) {
    api::DrawRangeElementsBaseVertex(c, mode, start, end, count, type, indices, base_vertex);
}
void MultiDrawElementsBaseVertex(Context& c, GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                                 GLsizei draws, const GLint* base_vertex) {
    api::MultiDrawElementsBaseVertex(c, mode, count, type, indices, draws, base_vertex);
}

}  // namespace wall::client::compile

namespace wall::client::replay {

void ArrayElement(Context&, std::span<const std::byte>) {}
void DrawArrays(Context& c, std::span<const std::byte> payload) { replay_array_draw(c, payload); }
void DrawElements(Context&, std::span<const std::byte>) {}
void DrawRangeElements(Context&, std::span<const std::byte>) {}
void MultiDrawArrays(Context&, std::span<const std::byte>) {}
void MultiDrawElements(Context&, std::span<const std::byte>) {}

void DrawArraysInstanced(Context&, std::span<const std::byte>) {}
void DrawElementsBaseVertex(Context&, std::span<const std::byte>) {}
void DrawElementsInstanced(Context&, std::span<const std::byte>) {}
void DrawElementsInstancedBaseVertex(Context&, std::span<const std::byte>) {}
void DrawRangeElementsBaseVertex(Context&, std::span<const std::byte>) {}
void MultiDrawElementsBaseVertex(Context&, std::span<const std::byte>) {}

}  // namespace wall::client::replay
