// SPDX-License-Identifier: MIT
// Buffer objects (OpenGL 2.1, 2.9), kept here whole: mapping gives the shadow itself, and reading back asks nobody.
#include <algorithm>
#include <cstring>
#include <limits>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

/// The buffer bound to a target, or null and the error.
Buffer* bound_buffer(Context& c, GLenum target) {
    const auto id = bound_buffer_id(c, target);
    if (!id) {
        c.error(GL_INVALID_ENUM);
        return nullptr;
    }
    Buffer* buffer = buffer_of(c, *id);
    if (!buffer) c.error(GL_INVALID_OPERATION);
    return buffer;
}

/// The same if it holds `size` bytes from `offset` on and is not mapped. The share group's mutex is held.
Buffer* buffer_with(Context& c, GLenum target, GLintptr offset, GLsizeiptr size) {
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return nullptr;
    const auto have = static_cast<GLsizeiptr>(buffer->size());
    if (offset < 0 || size < 0 || offset > have || size > have - offset) c.error(GL_INVALID_VALUE);
    else if (buffer->mapped) c.error(GL_INVALID_OPERATION);
    else return buffer;
    return nullptr;
}

bool is_usage(GLenum usage) {
    const GLenum frequency = usage & ~GLenum{3}, nature = usage & 3;
    return (frequency == GL_STREAM_DRAW || frequency == GL_STATIC_DRAW || frequency == GL_DYNAMIC_DRAW) && nature <= 2;
}
static_assert((GL_STREAM_DRAW & 3) == 0 && (GL_STATIC_DRAW & 3) == 0 && (GL_DYNAMIC_DRAW & 3) == 0);

/// Largest buffer that can be named in the stream.
constexpr GLsizeiptr kMostBytes = std::numeric_limits<std::uint32_t>::max();

/// A deleted buffer leaves the bindings of the context that deletes it (OpenGL 2.1, 2.9).
void unbind(Context& c, ClientName id) {
    for (const GLenum target : {GL_ARRAY_BUFFER, GL_ELEMENT_ARRAY_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER})
        if (bound_buffer_id(c, target) == id) bind_buffer(c, target, {});
}

void delete_buffer(Context& c, GLuint name) {
    std::shared_ptr<Buffer> buffer;
    {
        std::lock_guard lock(c.share().mutex);
        buffer = name == 0 ? nullptr : c.share().buffers.erase(name);
        if (!buffer) return;
        buffer->deleted = true;
        c.share().buffer_deletions.fetch_add(1, std::memory_order_release);
    }
    unbind(c, buffer->id);
    let_go_of_buffer(c, std::move(buffer));
}

}  // namespace

void GenBuffers(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    const GLuint first = c.share().buffers.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteBuffers(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    c.flush_block();
    for (GLsizei i = 0; i < count; ++i) delete_buffer(c, names[i]);
}

GLboolean IsBuffer(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return name != 0 && c.share().buffers.find(name) != nullptr;
}

void BindBuffer(Context& c, GLenum target, GLuint name) {
    if (!bound_buffer_id(c, target)) return c.error(GL_INVALID_ENUM);
    bind_buffer(c, target, {});
    if (c.buffers->holds_deleted || buffers_were_deleted(c)) let_go_of_deleted_buffers(c);
    if (name == 0) return;
    ShareGroup& share = c.share();
    std::lock_guard lock(share.mutex);
    auto buffer = share.buffers.find(name);
    if (!buffer) {
        buffer = std::make_shared<Buffer>(next_object_id(), name);
        share.buffers.put(name, buffer);
        share.by_id[buffer->id] = buffer;
    }
    bind_buffer(c, target, buffer->id);
    c.buffers->by_id.try_emplace(buffer->id, std::move(buffer));
}

void BufferData(Context& c, GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
    if (size < 0) return c.error(GL_INVALID_VALUE);
    if (!is_usage(usage)) return c.error(GL_INVALID_ENUM);
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    if (size > kMostBytes) return c.error(GL_OUT_OF_MEMORY);
    before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    buffer->define(data, static_cast<std::size_t>(size), usage);
}

void BufferSubData(Context& c, GLenum target, GLintptr offset, GLsizeiptr size, const void* data) {
    if (Buffer* bound = bound_buffer(c, target)) before_writing(c, *bound);
    else return;
    std::lock_guard lock(c.share().mutex);
    Buffer* buffer = buffer_with(c, target, offset, size);
    if (!buffer || size == 0) return;
    const auto first = static_cast<std::size_t>(offset);
    buffer->write({first, first + static_cast<std::size_t>(size)}, data);
}

void GetBufferSubData(Context& c, GLenum target, GLintptr offset, GLsizeiptr size, void* data) {
    std::lock_guard lock(c.share().mutex);
    Buffer* buffer = buffer_with(c, target, offset, size);
    if (buffer && size != 0) std::memcpy(data, buffer->data() + offset, static_cast<std::size_t>(size));
}

void* MapBuffer(Context& c, GLenum target, GLenum access) {
    if (access != GL_READ_ONLY && access != GL_WRITE_ONLY && access != GL_READ_WRITE) {
        c.error(GL_INVALID_ENUM);
        return nullptr;
    }
    Buffer* bound = bound_buffer(c, target);
    if (!bound) return nullptr;
    if (access != GL_READ_ONLY) before_writing(c, *bound);
    std::lock_guard lock(c.share().mutex);
    Buffer* buffer = buffer_with(c, target, 0, 0);
    if (!buffer) return nullptr;
    if (buffer->size() == 0) {
        c.error(GL_OUT_OF_MEMORY);
        return nullptr;
    }
    buffer->mapped = true;
    buffer->access = access;
    return access == GL_READ_ONLY ? const_cast<std::byte*>(buffer->data()) : buffer->begin_writing();
}

GLboolean UnmapBuffer(Context& c, GLenum target) {
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return GL_FALSE;
    std::lock_guard lock(c.share().mutex);
    if (!buffer->mapped) {
        c.error(GL_INVALID_OPERATION);
        return GL_FALSE;
    }
    buffer->mapped = false;
    if (buffer->access != GL_READ_ONLY) buffer->wrote({0, buffer->size()});
    return GL_TRUE;
}

void GetBufferParameteriv(Context& c, GLenum target, GLenum pname, GLint* params) {
    std::lock_guard lock(c.share().mutex);
    const Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    switch (pname) {
        case GL_BUFFER_SIZE: *params = static_cast<GLint>(std::min<std::size_t>(buffer->size(), 0x7fffffff)); break;
        case GL_BUFFER_USAGE: *params = static_cast<GLint>(buffer->usage()); break;
        case GL_BUFFER_ACCESS: *params = static_cast<GLint>(buffer->access); break;
        case GL_BUFFER_MAPPED: *params = buffer->mapped; break;
        default: c.error(GL_INVALID_ENUM);
    }
}

void GetBufferPointerv(Context& c, GLenum target, GLenum pname, void** params) {
    if (pname != GL_BUFFER_MAP_POINTER) return c.error(GL_INVALID_ENUM);
    std::lock_guard lock(c.share().mutex);
    if (Buffer* buffer = bound_buffer(c, target))
        *params = buffer->mapped ? const_cast<std::byte*>(buffer->data()) : nullptr;
}

}  // namespace wall::client::api
