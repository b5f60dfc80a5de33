// SPDX-License-Identifier: MIT
// glBindBufferBase and glBindBufferRange.
#include "client_lib/api/indexed_buffers.h"

#include <algorithm>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/object_name.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// The error of binding a part to a place of a target, whatever the buffer.
GLenum error_of_place(Context& c, GLenum target, GLuint index) {
    if (target == GL_UNIFORM_BUFFER) return index < el::uniform_buffer::count ? GL_NO_ERROR : GL_INVALID_VALUE;
    if (target == GL_SHADER_STORAGE_BUFFER) return index < el::storage_buffer::count ? GL_NO_ERROR : GL_INVALID_VALUE;
    if (target == GL_ATOMIC_COUNTER_BUFFER) return index < el::counter_buffer::count ? GL_NO_ERROR : GL_INVALID_VALUE;
    if (target != GL_TRANSFORM_FEEDBACK_BUFFER) return GL_INVALID_ENUM;
    if (c.captures->bound().active) return GL_INVALID_OPERATION;
    return index < kCaptureBuffers ? GL_NO_ERROR : GL_INVALID_VALUE;
}

/// Bytes that a part begins at a multiple of.
GLintptr alignment_of(Context& c, GLenum target) {
    if (target == GL_TRANSFORM_FEEDBACK_BUFFER || target == GL_ATOMIC_COUNTER_BUFFER) return 4;
    if (!c.attached()) return 1;
    const GLenum limit = target == GL_UNIFORM_BUFFER ? GLenum{GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT}
                                                     : GLenum{GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT};
    return std::max<GLintptr>(static_cast<GLintptr>(limit_of(c.session().caps(), limit, 1)), 1);
}

void set(Context& c, GLenum target, GLuint index, const glstate::BufferRange& range) {
    if (target == GL_UNIFORM_BUFFER) return c.set<el::uniform_buffer>(index, range);
    if (target == GL_TRANSFORM_FEEDBACK_BUFFER) return c.set<el::feedback_buffer>(index, range);
    c.memory->any = true;
    if (target == GL_SHADER_STORAGE_BUFFER) c.set<el::storage_buffer>(index, range);
    else c.set<el::counter_buffer>(index, range);
}

/// Whether a part may begin there and be as large, whatever the buffer.
bool fits_place(Context& c, GLenum target, GLintptr offset, GLsizeiptr bytes) {
    if (offset < 0 || bytes <= 0 || offset % alignment_of(c, target) != 0) return false;
    return target != GL_TRANSFORM_FEEDBACK_BUFFER || bytes % 4 == 0;
}

/// No buffer is as large: what begins behind its end is nothing, and what ends there is all of the rest.
std::uint32_t cut(std::uint64_t value) {
    static constexpr std::uint64_t kMost = ~std::uint32_t{0};
    return static_cast<std::uint32_t>(std::min(value, kMost));
}

/// `bytes` 0: as far as the buffer goes.
void bind(Context& c, GLenum target, GLuint index, GLuint name, std::uint64_t offset, std::uint64_t bytes) {
    BindBuffer(c, target, name);
    const ClientName id = bound_buffer_id(c, target).value_or(ClientName());
    if (!id) return set(c, target, index, {});
    set(c, target, index, {id.value, cut(offset), cut(bytes)});
}

}  // namespace

void BindBufferBase(Context& c, GLenum target, GLuint index, GLuint name) {
    if (const GLenum error = error_of_place(c, target, index)) return c.error(error);
    bind(c, target, index, name, 0, 0);
}

void BindBufferRange(Context& c, GLenum target, GLuint index, GLuint name, GLintptr offset, GLsizeiptr bytes) {
    if (const GLenum error = error_of_place(c, target, index)) return c.error(error);
    if (name == 0) return bind(c, target, index, 0, 0, 0);
    if (!fits_place(c, target, offset, bytes)) return c.error(GL_INVALID_VALUE);
    bind(c, target, index, name, static_cast<std::uint64_t>(offset), static_cast<std::uint64_t>(bytes));
}

namespace {

/// Of glBindBuffersBase and glBindBuffersRange: whether so many places are there; else GL_INVALID_OPERATION.
bool check_places(Context& c, GLenum target, GLuint first, GLsizei count) {
    if (count < 0) return c.error(GL_INVALID_VALUE), false;
    if (const GLenum error = error_of_place(c, target, 0)) return c.error(error), false;
    if (count == 0) return true;
    const std::uint64_t last = std::uint64_t{first} + static_cast<std::uint64_t>(count) - 1;
    const bool there = last <= ~GLuint{0} && error_of_place(c, target, static_cast<GLuint>(last)) == GL_NO_ERROR;
    if (!there) c.error(GL_INVALID_OPERATION);
    return there;
}

/// One of several: what is bound besides to the target itself stays. False: there is no such buffer.
bool bind_one(Context& c, GLenum target, GLuint index, GLuint name, GLintptr offset, GLsizeiptr bytes) {
    if (name == 0) return set(c, target, index, {}), true;
    std::shared_ptr<Buffer> buffer;
    {
        std::lock_guard lock(c.share().mutex);
        buffer = c.share().buffers.find(name);
    }
    if (!buffer) return false;
    const ClientName id = buffer->id;
    c.buffers->by_id.try_emplace(id, std::move(buffer));
    set(c, target, index, {id.value, cut(static_cast<std::uint64_t>(offset)), cut(static_cast<std::uint64_t>(bytes))});
    return true;
}

}  // namespace

// What is wrong with one leaves the others alone (OpenGL 4.4, 6.1.1).
void BindBuffersBase(Context& c, GLenum target, GLuint first, GLsizei count, const GLuint* names) {
    if (!check_places(c, target, first, count)) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i)
        if (!bind_one(c, target, first + i, names ? names[i] : 0, 0, 0)) c.error(GL_INVALID_OPERATION);
}

void BindBuffersRange(Context& c, GLenum target, GLuint first, GLsizei count, const GLuint* names,
                      const GLintptr* offsets, const GLsizeiptr* sizes) {
    if (!check_places(c, target, first, count)) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        const GLuint name = names ? names[i] : 0;
        if (name != 0 && !fits_place(c, target, offsets[i], sizes[i])) {
            c.error(GL_INVALID_VALUE);
            continue;
        }
        const bool bound = bind_one(c, target, first + i, name, name ? offsets[i] : 0, name ? sizes[i] : 0);
        if (!bound) c.error(GL_INVALID_OPERATION);
    }
}

/// GL_EXT_transform_feedback's own.
void BindBufferOffsetEXT(Context& c, GLenum target, GLuint index, GLuint name, GLintptr offset) {
    if (target != GL_TRANSFORM_FEEDBACK_BUFFER) return c.error(GL_INVALID_ENUM);
    if (const GLenum error = error_of_place(c, target, index)) return c.error(error);
    if (offset < 0 || offset % 4 != 0) return c.error(GL_INVALID_VALUE);
    bind(c, target, index, name, static_cast<std::uint64_t>(offset), 0);
}

}  // namespace wall::client::api

namespace wall::client {
namespace {

struct Words {
    GLenum name, start, size;
};

/// False: none of these words.
template <class E>
bool answer(Context& c, const Words& words, GLenum pname, GLuint index, GLint64& value) {
    if (pname != words.name && pname != words.start && pname != words.size) return false;
    if (index >= E::count) return c.error(GL_INVALID_VALUE), true;
    const glstate::BufferRange& range = c.get<E>(index);
    if (pname == words.name) value = object_name(c, glstate::ValueKind::name_buffer, ClientName(range.buffer));
    else value = pname == words.start ? range.offset : range.size;
    return true;
}

}  // namespace

bool get_indexed_buffer(Context& c, GLenum pname, GLuint index, GLint64& value) {
    namespace el = glstate::el;
    constexpr Words kUniform{GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE};
    constexpr Words kFeedback{GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                              GL_TRANSFORM_FEEDBACK_BUFFER_SIZE};
    constexpr Words kStorage{GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                             GL_SHADER_STORAGE_BUFFER_SIZE};
    constexpr Words kCounters{GL_ATOMIC_COUNTER_BUFFER_BINDING, GL_ATOMIC_COUNTER_BUFFER_START,
                              GL_ATOMIC_COUNTER_BUFFER_SIZE};
    return answer<el::storage_buffer>(c, kStorage, pname, index, value) ||
           answer<el::counter_buffer>(c, kCounters, pname, index, value) ||
           answer<el::uniform_buffer>(c, kUniform, pname, index, value) ||
           answer<el::feedback_buffer>(c, kFeedback, pname, index, value);
}

}  // namespace wall::client
