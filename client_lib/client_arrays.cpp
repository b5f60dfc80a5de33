// SPDX-License-Identifier: MIT
#include "client_lib/client_arrays.h"

#include <algorithm>
#include <cstring>

#include "client_lib/block_sender.h"
#include "client_lib/buffer_binding.h"

namespace wall::client {
namespace {

using glapi::Op;

// ---- loading ----

template <class T>
T load_one(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <class T, bool kNormalized>
float to_float(T value) {
    if constexpr (!kNormalized || std::is_floating_point_v<T>) return static_cast<float>(value);
    else if constexpr (std::is_signed_v<T>)
        return std::max(static_cast<float>(value / static_cast<double>(std::numeric_limits<T>::max())), -1.0f);
    else return static_cast<float>(value / static_cast<double>(std::numeric_limits<T>::max()));
}

template <class T, bool kNormalized>
void load_values(const std::byte* from, GLint size, float* out) {
    for (GLint i = 0; i < size; ++i) out[i] = to_float<T, kNormalized>(load_one<T>(from + static_cast<std::size_t>(i) * sizeof(T)));
}

using Load = void (*)(const std::byte*, GLint, float*);

template <class T>
Load loader(bool normalized) {
    return normalized ? &load_values<T, true> : &load_values<T, false>;
}

Load loader_of(GLenum type, bool normalized) {
    switch (type) {
        case GL_BYTE: return loader<GLbyte>(normalized);
        case GL_UNSIGNED_BYTE: return loader<GLubyte>(normalized);
        case GL_SHORT: return loader<GLshort>(normalized);
        case GL_UNSIGNED_SHORT: return loader<GLushort>(normalized);
        case GL_INT: return loader<GLint>(normalized);
        case GL_UNSIGNED_INT: return loader<GLuint>(normalized);
        case GL_DOUBLE: return loader<GLdouble>(false);
        default: return loader<GLfloat>(false);
    }
}

std::size_t bytes_of(GLenum type) {
    switch (type) {
        case GL_BYTE: case GL_UNSIGNED_BYTE: return 1;
        case GL_SHORT: case GL_UNSIGNED_SHORT: case GL_HALF_FLOAT: return 2;
        case GL_DOUBLE: return 8;
        default: return 4;
    }
}

const std::byte* place(const ArraySource& source, GLuint element) {
    static constexpr std::byte kNothing[32]{};
    return element < source.count ? source.base + source.stride * element : kNothing;
}

// ---- straight into the packer ----

/// An array whose elements are an operand as they stand.
struct DirectArray {
    const ArraySource* source;
    Op op;
    std::size_t bytes;
    std::size_t slot;  ///< in Packer::last; kNoSlot: the vertex
};
constexpr std::size_t kNoSlot = kAttributes;

struct DirectLayout {
    std::array<DirectArray, 4> arrays;
    std::size_t count = 0;
};

std::size_t slot_of(Attribute attribute) { return static_cast<std::size_t>(attribute); }

bool direct(const ArraySource& source, DirectArray& out) {
    static constexpr Op kVertices[] = {Op::Vertex2f, Op::Vertex3f, Op::Vertex4f};
    static constexpr Op kTexCoords[] = {Op::TexCoord1f, Op::TexCoord2f, Op::TexCoord3f, Op::TexCoord4f};
    out = {&source, Op::Vertex3f, static_cast<std::size_t>(source.size) * 4, kNoSlot};
    const bool floats = source.type == GL_FLOAT;
    if (source.count != ~std::size_t{0}) return false;
    switch (source.kind) {
        case ArrayKind::vertex: out.op = kVertices[source.size - 2]; return floats && source.size <= 3;
        case ArrayKind::normal: out.op = Op::Normal3f, out.slot = slot_of(Attribute::normal); return floats;
        case ArrayKind::texcoord:
            out.op = kTexCoords[source.size - 1], out.slot = slot_of(Attribute::texcoord0);
            return floats && source.index == 0;
        case ArrayKind::color:
            out.slot = slot_of(Attribute::color);
            out.op = !floats ? Op::Color4ub : source.size == 3 ? Op::Color3f : Op::Color4f;
            if (!floats) out.bytes = 4;
            return floats || (source.type == GL_UNSIGNED_BYTE && source.size == 4);
        default: return false;
    }
}

/// False if some array needs conversion or a rarer command.
bool direct_layout(const ArraySet& arrays, DirectLayout& layout) {
    for (const ArraySource& source : arrays.sources()) {
        if (layout.count == layout.arrays.size() || !direct(source, layout.arrays[layout.count])) return false;
        ++layout.count;
    }
    return true;
}

void add_to_box(Packer& packer, const std::byte* at, std::size_t bytes) {
    float v[3] = {0, 0, 0};
    std::memcpy(v, at, bytes);
    packer.box.add(_mm_setr_ps(v[0], v[1], v[2], 0));
}

// A vertex takes at most 16 + 12 + 16 + 12 bytes: it fits into what the packer keeps beyond its limit.
void pack_direct(Packer& packer, const DirectLayout& layout, GLuint element) {
    if (packer.next_operand() >= packer.limit) [[unlikely]] packer.make_room();
    for (std::size_t k = 0; k < layout.count; ++k) {
        const DirectArray& array = layout.arrays[k];
        const std::byte* from = array.source->base + array.source->stride * element;
        std::byte* at = packer.next_operand();
        std::memcpy(at, from, array.bytes);
        *--packer.next_opcode() = static_cast<std::byte>(array.op);
        packer.next_operand() = at + array.bytes;
        if (array.slot == kNoSlot) {
            add_to_box(packer, from, array.bytes);
        } else {
            packer.last[array.slot] = at;
            packer.last_op[array.slot] = array.op;
        }
    }
}

// ---- current attributes ----

/// OpenGL leaves the current attributes undefined after a draw from arrays; Mesa leaves them alone, and programs rely
/// on it.
class SavedCurrent {
public:
    SavedCurrent(Context& c, const ArraySet& arrays) : c_(c), arrays_(arrays) {
        const Packer& packer = c.packer;
        if (packer.has_rare() || needs_rare()) c.flush_block();
        current_ = c.state.current;
        // What stands in the block is newer than the state.
        for (std::size_t i = 0; i < kAttributes; ++i) {
            if (!packer.last[i]) continue;
            ops_[i] = packer.last_op[i];
            std::memcpy(operands_[i].data(), packer.last[i], glapi::kOpFixedBytes[static_cast<std::size_t>(ops_[i])]);
            packed_[i] = true;
        }
    }
    void restore() {
        for (const ArraySource& source : arrays_.sources()) restore(source);
    }

private:
    bool needs_rare() const {
        return std::any_of(arrays_.sources().begin(), arrays_.sources().end(), [](const ArraySource& s) {
            return s.kind == ArrayKind::index || s.kind == ArrayKind::attrib || (s.kind == ArrayKind::texcoord && s.index != 0);
        });
    }
    /// True if the value stood in the block.
    bool restore_packed(Attribute attribute) {
        const auto i = static_cast<std::size_t>(attribute);
        if (!packed_[i]) return false;
        Packer& packer = c_.packer;
        if (packer.next_operand() >= packer.limit) packer.make_room();
        const std::size_t bytes = glapi::kOpFixedBytes[static_cast<std::size_t>(ops_[i])];
        std::byte* at = packer.next_operand();
        std::memcpy(at, operands_[i].data(), bytes);
        *--packer.next_opcode() = static_cast<std::byte>(ops_[i]);
        packer.next_operand() = at + bytes;
        packer.last[i] = at;
        packer.last_op[i] = ops_[i];
        return true;
    }
    void restore(const ArraySource& source) {
        const auto& now = current_;
        switch (source.kind) {
            case ArrayKind::edge_flag:
                if (!restore_packed(Attribute::edge_flag)) api::EdgeFlag(c_, now.edge_flag ? GL_TRUE : GL_FALSE);
                break;
            case ArrayKind::fog_coord:
                if (!restore_packed(Attribute::fog_coord)) api::FogCoordf(c_, now.fog_coord);
                break;
            case ArrayKind::secondary_color: {
                const auto& v = now.secondary_color;
                if (!restore_packed(Attribute::secondary_color)) api::SecondaryColor3f(c_, v[0], v[1], v[2]);
                break;
            }
            case ArrayKind::color:
                if (!restore_packed(Attribute::color)) api::Color4f(c_, now.color[0], now.color[1], now.color[2], now.color[3]);
                break;
            case ArrayKind::normal:
                if (!restore_packed(Attribute::normal)) api::Normal3f(c_, now.normal[0], now.normal[1], now.normal[2]);
                break;
            case ArrayKind::texcoord: {
                const auto& v = now.texcoord[source.index];
                if (source.index != 0) api::MultiTexCoord4f(c_, GL_TEXTURE0 + source.index, v[0], v[1], v[2], v[3]);
                else if (!restore_packed(Attribute::texcoord0)) api::TexCoord4f(c_, v[0], v[1], v[2], v[3]);
                break;
            }
            case ArrayKind::index: api::Indexf(c_, now.color_index); break;
            case ArrayKind::attrib: {
                const auto& v = now.vertex_attrib[source.index];
                api::VertexAttrib4f(c_, source.index, v[0], v[1], v[2], v[3]);
                break;
            }
            case ArrayKind::vertex: break;
        }
    }

    Context& c_;
    const ArraySet& arrays_;
    glstate::CurrentState current_;
    std::array<std::array<std::byte, 16>, kAttributes> operands_{};
    std::array<Op, kAttributes> ops_{};
    std::array<bool, kAttributes> packed_{};
};

// ---- through the table ----

void send(Context& c, const ArraySource& source, GLuint element) {
    const std::byte* at = place(source, element);
    if (source.kind == ArrayKind::color && source.type == GL_UNSIGNED_BYTE) {
        const auto byte = [&](GLint i) { return std::to_integer<GLubyte>(at[i]); };
        return c.table->Color4ub(c, byte(0), byte(1), byte(2), source.size == 4 ? byte(3) : GLubyte{255});
    }
    float v[4] = {0, 0, 0, 1};
    source.load(at, source.size, v);
    switch (source.kind) {
        case ArrayKind::edge_flag: return c.table->EdgeFlag(c, at[0] != std::byte{0});
        case ArrayKind::index: return c.table->Indexf(c, v[0]);
        case ArrayKind::fog_coord: return c.table->FogCoordf(c, v[0]);
        case ArrayKind::secondary_color: return c.table->SecondaryColor3f(c, v[0], v[1], v[2]);
        case ArrayKind::color:
            if (source.size == 3) return c.table->Color3f(c, v[0], v[1], v[2]);
            return c.table->Color4f(c, v[0], v[1], v[2], v[3]);
        case ArrayKind::normal: return c.table->Normal3f(c, v[0], v[1], v[2]);
        case ArrayKind::texcoord:
            if (source.index != 0) return c.table->MultiTexCoord4f(c, GL_TEXTURE0 + source.index, v[0], v[1], v[2], v[3]);
            if (source.size == 2) return c.table->TexCoord2f(c, v[0], v[1]);
            return c.table->TexCoord4f(c, v[0], v[1], v[2], v[3]);
        case ArrayKind::attrib: return c.table->VertexAttrib4f(c, source.index, v[0], v[1], v[2], v[3]);
        case ArrayKind::vertex:
            if (source.size == 2) return c.table->Vertex2f(c, v[0], v[1]);
            if (source.size == 3) return c.table->Vertex3f(c, v[0], v[1], v[2]);
            return c.table->Vertex4f(c, v[0], v[1], v[2], v[3]);
    }
}

/// Calls `each(element)` for every element, and `restart()` where the index says so.
template <class Each, class Restart>
void walk(Context& c, const ElementRange& elements, Each&& each, Restart&& restart) {
    const bool restarts = elements.type != 0 && c.state.local.primitive_restart;
    const GLuint restart_index = c.state.local.primitive_restart_index;
    for (GLsizei i = 0; i < elements.count; ++i) {
        const GLuint element = elements.at(i);
        if (restarts && element == restart_index) restart();
        else each(element);
    }
}

}  // namespace

ArraySet::ArraySet(Context& c) {
    const auto& l = c.state.local;
    add(c, ArrayKind::edge_flag, 0, l.edge_flag_array);
    add(c, ArrayKind::index, 0, l.index_array);
    add(c, ArrayKind::fog_coord, 0, l.fog_coord_array);
    add(c, ArrayKind::secondary_color, 0, l.secondary_color_array);
    add(c, ArrayKind::color, 0, l.color_array);
    add(c, ArrayKind::normal, 0, l.normal_array);
    for (unsigned unit = 0; unit < kTextureUnits; ++unit) add(c, ArrayKind::texcoord, unit, l.texcoord_array[unit]);
    for (unsigned i = 1; i < kVertexAttributes; ++i) add(c, ArrayKind::attrib, i, l.attrib_array[i]);
    add(c, ArrayKind::vertex, 0, l.attrib_array[0].enabled ? l.attrib_array[0] : l.vertex_array);
}

void ArraySet::add(Context& c, ArrayKind kind, unsigned index, const glstate::ClientArray& array) {
    if (!array.enabled) return;
    ArraySource source;
    source.kind = kind;
    source.index = index;
    source.size = array.size;
    source.type = array.type;
    const std::size_t bytes = bytes_of(array.type) * static_cast<std::size_t>(array.size);
    source.stride = array.stride ? static_cast<std::size_t>(array.stride) : bytes;
    source.load = loader_of(array.type, array.normalized != 0);
    if (array.buffer) {
        const auto content = buffer_content(c, array.buffer, static_cast<std::uintptr_t>(array.pointer));
        source.base = content.data();
        source.count = content.size() < bytes ? 0 : (content.size() - bytes) / source.stride + 1;
    } else {
        source.base = reinterpret_cast<const std::byte*>(static_cast<std::uintptr_t>(array.pointer));
        if (!source.base) return;
    }
    sources_[count_++] = source;
}

void send_element(Context& c, const ArraySet& arrays, GLuint element) {
    for (const ArraySource& source : arrays.sources()) send(c, source, element);
}

void draw_elements(Context& c, GLenum mode, const ElementRange& elements) {
    const ArraySet arrays(c);
    if (!arrays.has_vertex() || elements.count <= 0) return;
    if (c.table != &tables::immediate) {  // into a list
        c.table->Begin(c, mode);
        walk(c, elements, [&](GLuint e) { send_element(c, arrays, e); }, [&] { c.table->End(c), c.table->Begin(c, mode); });
        return c.table->End(c);
    }
    SavedCurrent current(c, arrays);
    c.begin_primitive(mode);
    const auto restart = [&] { c.end_primitive(), c.begin_primitive(mode); };
    if (DirectLayout layout; direct_layout(arrays, layout))
        walk(c, elements, [&](GLuint e) { pack_direct(c.packer, layout, e); }, restart);
    else
        walk(c, elements, [&](GLuint e) { send_element(c, arrays, e); }, restart);
    c.end_primitive();
    current.restore();
}

}  // namespace wall::client
