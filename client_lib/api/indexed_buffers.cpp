// SPDX-License-Identifier: MIT
// glBindBufferBase and glBindBufferRange.
#include "client_lib/api/indexed_buffers.h"

#include <algorithm>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/object_name.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// The error of binding a part to a place of GL_UNIFORM_BUFFER, whatever the buffer.
GLenum error_of_place(GLenum target, GLuint index) {
    if (target != GL_UNIFORM_BUFFER) return GL_INVALID_ENUM;
    return index < el::uniform_buffer::count ? GL_NO_ERROR : GL_INVALID_VALUE;
}

bool may_begin_at(Context& c, GLintptr offset) {
    if (!c.attached()) return true;
    const auto alignment = static_cast<GLintptr>(limit_of(c.session().caps(), GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, 1));
    return alignment <= 1 || offset % alignment == 0;
}

/// `bytes` 0: as far as the buffer goes.
void bind(Context& c, GLenum target, GLuint index, GLuint name, std::uint64_t offset, std::uint64_t bytes) {
    BindBuffer(c, target, name);
    const ClientName id = bound_buffer_id(c, target).value_or(ClientName());
    if (!id) return c.set<el::uniform_buffer>(index, {});
    // No buffer is as large: what begins behind its end is nothing, and what ends there is all of the rest.
    static constexpr std::uint64_t kMost = ~std::uint32_t{0};
    const auto cut = [](std::uint64_t value) { return static_cast<std::uint32_t>(std::min(value, kMost)); };
    c.set<el::uniform_buffer>(index, {id.value, cut(offset), cut(bytes)});
}

}  // namespace

void BindBufferBase(Context& c, GLenum target, GLuint index, GLuint name) {
    if (const GLenum error = error_of_place(target, index)) return c.error(error);
    bind(c, target, index, name, 0, 0);
}

void BindBufferRange(Context& c, GLenum target, GLuint index, GLuint name, GLintptr offset, GLsizeiptr bytes) {
    if (const GLenum error = error_of_place(target, index)) return c.error(error);
    if (name == 0) return bind(c, target, index, 0, 0, 0);
    if (offset < 0 || bytes <= 0 || !may_begin_at(c, offset)) return c.error(GL_INVALID_VALUE);
    bind(c, target, index, name, static_cast<std::uint64_t>(offset), static_cast<std::uint64_t>(bytes));
}

}  // namespace wall::client::api

namespace wall::client {

bool get_indexed_buffer(Context& c, GLenum pname, GLuint index, GLint64& value) {
    const bool name = pname == GL_UNIFORM_BUFFER_BINDING, start = pname == GL_UNIFORM_BUFFER_START;
    if (!name && !start && pname != GL_UNIFORM_BUFFER_SIZE) return false;
    if (index >= glstate::el::uniform_buffer::count) return c.error(GL_INVALID_VALUE), true;
    const glstate::BufferRange& range = c.get<glstate::el::uniform_buffer>(index);
    if (name) value = object_name(c, glstate::ValueKind::name_buffer, ClientName(range.buffer));
    else value = start ? range.offset : range.size;
    return true;
}

}  // namespace wall::client
