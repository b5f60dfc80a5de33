// SPDX-License-Identifier: MIT
#include "tileserver/objects/vertex_input.h"

#include <algorithm>

#include "tileserver/objects/buffer.h"

namespace wall::tileserver {
namespace {

using glstate::Attribute;
using glstate::InputArray;

/// Elements of a draw whose arrays all go on from instance to instance.
constexpr std::uint64_t kMostWithoutArrays = std::uint64_t{1} << 31;

/// An array of fixed function; the buffer is bound.
void define_array(const Gl& gl, const InputArray& array, const void* at) {
    const auto enable = [&](GLenum which) { gl.EnableClientState(which); };
    if (array.place == glstate::kPositionArray)
        return enable(GL_VERTEX_ARRAY), gl.VertexPointer(array.size, array.type, array.stride, at);
    switch (static_cast<Attribute>(array.place)) {
        case Attribute::color: return enable(GL_COLOR_ARRAY), gl.ColorPointer(array.size, array.type, array.stride, at);
        case Attribute::normal: return enable(GL_NORMAL_ARRAY), gl.NormalPointer(array.type, array.stride, at);
        case Attribute::secondary_color:
            enable(GL_SECONDARY_COLOR_ARRAY);
            return gl.SecondaryColorPointer(array.size, array.type, array.stride, at);
        case Attribute::fog_coord: return enable(GL_FOG_COORD_ARRAY), gl.FogCoordPointer(array.type, array.stride, at);
        case Attribute::edge_flag: return enable(GL_EDGE_FLAG_ARRAY), gl.EdgeFlagPointer(array.stride, at);
        case Attribute::color_index: return enable(GL_INDEX_ARRAY), gl.IndexPointer(array.type, array.stride, at);
        default: break;  // of several
    }
}

/// One of several of a kind: a texture unit's, a generic one.
bool define_numbered_array(const Gl& gl, const InputArray& array, const void* at) {
    const auto number_from = [&](Attribute first, unsigned count) {
        const std::uint32_t number = array.place - static_cast<std::uint32_t>(place_of(first));
        return number < count ? static_cast<int>(number) : -1;
    };
    if (const int unit = number_from(Attribute::texcoord, glstate::el::texcoord_array::count); unit >= 0) {
        gl.ClientActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        gl.EnableClientState(GL_TEXTURE_COORD_ARRAY);
        gl.TexCoordPointer(array.size, array.type, array.stride, at);
        return true;
    }
    const int generic = number_from(Attribute::vertex_attrib, glstate::el::attrib_array::count);
    if (generic < 0) return false;
    const auto index = static_cast<GLuint>(generic);
    gl.EnableVertexAttribArray(index);
    if (array.reaches_as == glstate::kAsIntegers)
        gl.VertexAttribIPointer(index, array.size, array.type, array.stride, at);
    else if (array.reaches_as == glstate::kAsDoubles)
        gl.VertexAttribLPointer(index, array.size, array.type, array.stride, at);
    else gl.VertexAttribPointer(index, array.size, array.type, array.normalized != 0, array.stride, at);
    if (array.divisor != 0) gl.VertexAttribDivisor(index, array.divisor);
    return true;
}

}  // namespace

VertexInput::VertexInput(ObjectAccount& account, Driver& driver) : ObjectOf(account), driver_(driver) {}

VertexInput::~VertexInput() {
    driver_.forget_vertex_array(name_);
    driver_.gl().DeleteVertexArrays(1, &name_);
}

bool VertexInput::define(const glstate::VertexInputDefinition& definition, std::span<const GLuint> buffers) {
    const Gl& gl = driver_.gl();
    driver_.drain_errors();
    gl.CreateVertexArrays(1, &name_);
    driver_.bind_vertex_array(name_);
    for (std::size_t i = 0; i < definition.arrays.size(); ++i) {
        const InputArray& array = definition.arrays[i];
        const auto* at = reinterpret_cast<const void*>(static_cast<std::uintptr_t>(array.offset));
        gl.BindBuffer(GL_ARRAY_BUFFER, buffers[i]);
        if (!define_numbered_array(gl, array, at)) define_array(gl, array, at);
    }
    gl.BindBuffer(GL_ARRAY_BUFFER, 0);
    if (definition.indices) gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers.back());
    definition_ = definition;
    return driver_.drain_errors() == 0;
}

const VertexInput::Facts& VertexInput::facts(const ObjectTable& objects) {
    const std::uint64_t version = objects.version(ObjectKind::buffer);
    if (buffers_ == version) return facts_;
    buffers_ = version;
    facts_ = {.elements = kMostWithoutArrays, .index_bytes = std::nullopt};
    for (const InputArray& array : definition_.arrays) {
        if (array.divisor != 0) continue;
        const Buffer* buffer = objects.find<Buffer>(array.buffer);
        facts_.elements = std::min(facts_.elements, buffer != nullptr ? array.elements_in(buffer->size()) : 0);
    }
    const Buffer* indices = definition_.indices ? objects.find<Buffer>(definition_.indices) : nullptr;
    if (indices != nullptr) facts_.index_bytes = indices->size();
    return facts_;
}

}  // namespace wall::tileserver
