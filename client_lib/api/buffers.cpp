// SPDX-License-Identifier: MIT
// Buffer objects (OpenGL 4.5, 6), kept here whole: mapping gives the shadow itself, and reading back asks nobody.
#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/captured_content.h"
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
    else if (buffer->blocked()) c.error(GL_INVALID_OPERATION);
    else return buffer;
    return nullptr;
}

/// What only nodes have of the buffer that is bound there is here afterwards.
void fetch_bound(Context& c, GLenum target, const char* function) {
    fetch_captured(c, bound_buffer_id(c, target).value_or(ClientName()), function);
}

bool is_usage(GLenum usage) {
    const GLenum frequency = usage & ~GLenum{3}, nature = usage & 3;
    return (frequency == GL_STREAM_DRAW || frequency == GL_STATIC_DRAW || frequency == GL_DYNAMIC_DRAW) && nature <= 2;
}
static_assert((GL_STREAM_DRAW & 3) == 0 && (GL_STATIC_DRAW & 3) == 0 && (GL_DYNAMIC_DRAW & 3) == 0);

/// Largest buffer that can be named in the stream.
constexpr GLsizeiptr kMostBytes = std::numeric_limits<std::uint32_t>::max();

bool is_reserved(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().buffers.known(name);
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
    let_go_of_own_buffer(c, std::move(buffer));
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
    if (c.profile.core && name != 0 && !is_reserved(c, name)) return c.error(GL_INVALID_OPERATION);
    if (!c.buffers->holds_deleted && !buffers_were_deleted(c))
        if (const ClientName id = c.buffers->bound_lately.id_of(name)) return bind_buffer(c, target, id);
    bind_buffer(c, target, {});
    if (deleted_buffers_are_due(c)) let_go_of_deleted_buffers(c);
    if (name == 0) return;
    ShareGroup& share = c.share();
    std::lock_guard lock(share.mutex);
    auto buffer = share.buffers.find(name);
    if (!buffer) {
        buffer = std::make_shared<Buffer>(next_object_id(), name);
        if (c.profile.is_es()) buffer->access = GL_MAP_WRITE_BIT;  // OES_mapbuffer has no other
        share.buffers.put(name, buffer);
        share.by_id[buffer->id] = buffer;
    }
    bind_buffer(c, target, buffer->id);
    c.buffers->bound_lately.note(name, buffer->id);
    c.buffers->by_id.try_emplace(buffer->id, std::move(buffer));
}

void BufferData(Context& c, GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
    if (size < 0) return c.error(GL_INVALID_VALUE);
    if (!is_usage(usage)) return c.error(GL_INVALID_ENUM);
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    if (buffer->immutable()) return c.error(GL_INVALID_OPERATION);
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
    if (!buffer) return;
    if (!(buffer->storage_flags() & GL_DYNAMIC_STORAGE_BIT)) return c.error(GL_INVALID_OPERATION);
    if (size == 0) return;
    const auto first = static_cast<std::size_t>(offset);
    buffer->write({first, first + static_cast<std::size_t>(size)}, data);
}

void GetBufferSubData(Context& c, GLenum target, GLintptr offset, GLsizeiptr size, void* data) {
    fetch_bound(c, target, "glGetBufferSubData");
    std::lock_guard lock(c.share().mutex);
    Buffer* buffer = buffer_with(c, target, offset, size);
    if (buffer && size != 0) std::memcpy(data, buffer->data() + offset, static_cast<std::size_t>(size));
}

namespace {

constexpr GLbitfield kMapAccess = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT;
constexpr GLbitfield kMapStorage = kMapAccess | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
constexpr GLbitfield kMapFlags = kMapStorage | GL_MAP_INVALIDATE_RANGE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT |
                                 GL_MAP_FLUSH_EXPLICIT_BIT | GL_MAP_UNSYNCHRONIZED_BIT;

/// What is wrong with the flags of glMapBufferRange alone (OpenGL 4.5, 6.3).
GLenum error_of_access(GLbitfield access) {
    if (access & ~kMapFlags) return GL_INVALID_VALUE;
    if (!(access & kMapAccess)) return GL_INVALID_OPERATION;
    constexpr GLbitfield kNotToRead =
        GL_MAP_INVALIDATE_RANGE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT | GL_MAP_UNSYNCHRONIZED_BIT;
    if ((access & GL_MAP_READ_BIT) && (access & kNotToRead)) return GL_INVALID_OPERATION;
    if ((access & GL_MAP_FLUSH_EXPLICIT_BIT) && !(access & GL_MAP_WRITE_BIT)) return GL_INVALID_OPERATION;
    return GL_NO_ERROR;
}

/// The error of mapping these bytes of a buffer in this way; the share group's mutex is held.
GLenum error_of_mapping(const Buffer& buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    if (access & kMapStorage & ~buffer.storage_flags()) return GL_INVALID_OPERATION;
    const auto have = static_cast<GLsizeiptr>(buffer.size());
    if (offset > have || length > have - offset) return GL_INVALID_VALUE;
    return buffer.mapping() ? GL_INVALID_OPERATION : GL_NO_ERROR;
}

void* map(Context& c, GLenum target, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    const auto first = static_cast<std::size_t>(offset);
    fetch_bound(c, target, "glMapBuffer");
    Buffer* buffer = bound_buffer(c, target);
    if (access & GL_MAP_WRITE_BIT) before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    if (const GLenum error = error_of_mapping(*buffer, offset, length, access)) {
        c.error(error);
        return nullptr;
    }
    return buffer->map({{first, first + static_cast<std::size_t>(length)}, access});
}

GLbitfield access_bits(GLenum access) {
    switch (access) {
        case GL_READ_ONLY: return GL_MAP_READ_BIT;
        case GL_WRITE_ONLY: return GL_MAP_WRITE_BIT;
        case GL_READ_WRITE: return kMapAccess;
        default: return 0;
    }
}

/// GL_BUFFER_ACCESS.
GLenum access_word(GLbitfield access) {
    switch (access & kMapAccess) {
        case GL_MAP_READ_BIT: return GL_READ_ONLY;
        case GL_MAP_WRITE_BIT: return GL_WRITE_ONLY;
        default: return GL_READ_WRITE;
    }
}

}  // namespace

void* MapBuffer(Context& c, GLenum target, GLenum access) {
    const GLbitfield bits = access_bits(access);
    if (bits == 0) c.error(GL_INVALID_ENUM);
    Buffer* buffer = bits != 0 ? bound_buffer(c, target) : nullptr;
    if (!buffer) return nullptr;
    GLsizeiptr size = 0;
    {
        std::lock_guard lock(c.share().mutex);
        size = static_cast<GLsizeiptr>(buffer->size());
    }
    if (size != 0) return map(c, target, 0, size, bits);
    c.error(GL_OUT_OF_MEMORY);  // as Mesa
    return nullptr;
}

void* MapBufferRange(Context& c, GLenum target, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    const auto refused = [&](GLenum error) {
        c.error(error);
        return nullptr;
    };
    if (!bound_buffer(c, target)) return nullptr;
    if (offset < 0 || length < 0) return refused(GL_INVALID_VALUE);
    if (length == 0) return refused(GL_INVALID_OPERATION);
    if (const GLenum error = error_of_access(access)) return refused(error);
    return map(c, target, offset, length, access);
}

void FlushMappedBufferRange(Context& c, GLenum target, GLintptr offset, GLsizeiptr length) {
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    if (offset < 0 || length < 0) return c.error(GL_INVALID_VALUE);
    before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    const auto& mapping = buffer->mapping();
    if (!mapping || !mapping->tells()) return c.error(GL_INVALID_OPERATION);
    const auto have = static_cast<GLsizeiptr>(mapping->range.size());
    if (offset > have || length > have - offset) return c.error(GL_INVALID_VALUE);
    const std::size_t first = mapping->range.begin + static_cast<std::size_t>(offset);
    if (length != 0) buffer->flush({first, first + static_cast<std::size_t>(length)});
}

GLboolean UnmapBuffer(Context& c, GLenum target) {
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return GL_FALSE;
    std::lock_guard lock(c.share().mutex);
    if (!buffer->mapping()) {
        c.error(GL_INVALID_OPERATION);
        return GL_FALSE;
    }
    buffer->unmap();
    return GL_TRUE;
}

void BufferStorage(Context& c, GLenum target, GLsizeiptr size, const void* data, GLbitfield flags) {
    constexpr GLbitfield kFlags = kMapStorage | GL_DYNAMIC_STORAGE_BIT | GL_CLIENT_STORAGE_BIT;
    Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    if (size <= 0 || (flags & ~kFlags)) return c.error(GL_INVALID_VALUE);
    if ((flags & GL_MAP_PERSISTENT_BIT) && !(flags & kMapAccess)) return c.error(GL_INVALID_VALUE);
    if ((flags & GL_MAP_COHERENT_BIT) && !(flags & GL_MAP_PERSISTENT_BIT)) return c.error(GL_INVALID_VALUE);
    if (buffer->immutable()) return c.error(GL_INVALID_OPERATION);
    if (size > kMostBytes) return c.error(GL_OUT_OF_MEMORY);
    before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    buffer->define_storage(data, static_cast<std::size_t>(size), flags);
}

void CopyBufferSubData(Context& c, GLenum from_target, GLenum to_target, GLintptr from_offset, GLintptr to_offset,
                       GLsizeiptr size) {
    Buffer* const from = bound_buffer(c, from_target);
    Buffer* const to = from ? bound_buffer(c, to_target) : nullptr;
    if (!to) return;
    fetch_bound(c, from_target, "glCopyBufferSubData");
    before_writing(c, *to);
    std::lock_guard lock(c.share().mutex);
    if (from->blocked() || to->blocked()) return c.error(GL_INVALID_OPERATION);
    const auto lies_in = [&](const Buffer& buffer, GLintptr offset) {
        const auto have = static_cast<GLsizeiptr>(buffer.size());
        return offset >= 0 && size >= 0 && offset <= have && size <= have - offset;
    };
    if (!lies_in(*from, from_offset) || !lies_in(*to, to_offset)) return c.error(GL_INVALID_VALUE);
    const bool overlap = from == to && from_offset < to_offset + size && to_offset < from_offset + size;
    if (overlap) return c.error(GL_INVALID_VALUE);
    if (size == 0) return;
    const BufferReading reading = from->read(static_cast<std::size_t>(from_offset));
    const auto first = static_cast<std::size_t>(to_offset);
    to->write({first, first + static_cast<std::size_t>(size)}, reading.bytes().data());
}

// What the program writes into a persistent mapping is looked for whenever it is used. What shaders write is seen by
// whatever comes behind a block, so that one ends here.
void MemoryBarrier(Context& c, GLbitfield barriers) {
    constexpr GLbitfield kKnown =
        GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT |
        GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
        GL_PIXEL_BUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
        GL_FRAMEBUFFER_BARRIER_BIT | GL_TRANSFORM_FEEDBACK_BARRIER_BIT | GL_ATOMIC_COUNTER_BARRIER_BIT |
        GL_SHADER_STORAGE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT | GL_QUERY_BUFFER_BARRIER_BIT;
    if (barriers != GL_ALL_BARRIER_BITS && (barriers & ~kKnown)) return c.error(GL_INVALID_VALUE);
    c.flush_block();
}

void MemoryBarrierByRegion(Context& c, GLbitfield barriers) {
    constexpr GLbitfield kKnown = GL_ATOMIC_COUNTER_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                                  GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                                  GL_TEXTURE_FETCH_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT;
    if (barriers != GL_ALL_BARRIER_BITS && (barriers & ~kKnown)) return c.error(GL_INVALID_VALUE);
    c.flush_block();
}

namespace {

/// Nothing: no such word.
std::optional<GLint64> parameter(const Buffer& buffer, GLenum pname) {
    const auto& mapping = buffer.mapping();
    switch (pname) {
        case GL_BUFFER_SIZE: return static_cast<GLint64>(buffer.size());
        case GL_BUFFER_USAGE: return buffer.usage();
        case GL_BUFFER_ACCESS: return access_word(mapping ? mapping->access : buffer.access);
        case GL_BUFFER_MAPPED: return mapping.has_value();
        case GL_BUFFER_ACCESS_FLAGS: return mapping ? mapping->access : 0;
        case GL_BUFFER_MAP_OFFSET: return mapping ? static_cast<GLint64>(mapping->range.begin) : 0;
        case GL_BUFFER_MAP_LENGTH: return mapping ? static_cast<GLint64>(mapping->range.size()) : 0;
        case GL_BUFFER_IMMUTABLE_STORAGE: return buffer.immutable();
        case GL_BUFFER_STORAGE_FLAGS: return buffer.storage_flags();
        default: return std::nullopt;
    }
}

template <class Out>
void get_parameter(Context& c, GLenum target, GLenum pname, Out* params) {
    std::lock_guard lock(c.share().mutex);
    const Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    const auto value = parameter(*buffer, pname);
    if (!value) return c.error(GL_INVALID_ENUM);
    *params = static_cast<Out>(std::min<GLint64>(*value, std::numeric_limits<Out>::max()));
}

}  // namespace

void GetBufferParameteriv(Context& c, GLenum target, GLenum pname, GLint* params) {
    get_parameter(c, target, pname, params);
}
void GetBufferParameteri64v(Context& c, GLenum target, GLenum pname, GLint64* params) {
    get_parameter(c, target, pname, params);
}

void GetBufferPointerv(Context& c, GLenum target, GLenum pname, void** params) {
    if (pname != GL_BUFFER_MAP_POINTER) return c.error(GL_INVALID_ENUM);
    std::lock_guard lock(c.share().mutex);
    const Buffer* buffer = bound_buffer(c, target);
    if (!buffer) return;
    *params = buffer->mapping() ? const_cast<std::byte*>(buffer->data() + buffer->mapping()->range.begin) : nullptr;
}

}  // namespace wall::client::api
