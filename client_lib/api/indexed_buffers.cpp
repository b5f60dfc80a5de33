// SPDX-License-Identifier: MIT
// glBindBufferBase and glBindBufferRange.
#include "client_lib/api/indexed_buffers.h"

#include <algorithm>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/object_name.h"

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

/// `bytes` 0: as far as the buffer goes.
void bind(Context& c, GLenum target, GLuint index, GLuint name, std::uint64_t offset, std::uint64_t bytes) {
    BindBuffer(c, target, name);
    const ClientName id = bound_buffer_id(c, target).value_or(ClientName());
    if (!id) return set(c, target, index, {});
    // No buffer is as large: what begins behind its end is nothing, and what ends there is all of the rest.
    static constexpr std::uint64_t kMost = ~std::uint32_t{0};
    const auto cut = [](std::uint64_t value) { return static_cast<std::uint32_t>(std::min(value, kMost)); };
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
    if (offset < 0 || bytes <= 0 || offset % alignment_of(c, target) != 0) return c.error(GL_INVALID_VALUE);
    if (target == GL_TRANSFORM_FEEDBACK_BUFFER && bytes % 4 != 0) return c.error(GL_INVALID_VALUE);
    bind(c, target, index, name, static_cast<std::uint64_t>(offset), static_cast<std::uint64_t>(bytes));
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
