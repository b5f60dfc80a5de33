// SPDX-License-Identifier: MIT
// glClear, and glClearBuffer of single buffers (OpenGL 3.0, 4.2.3).
#include <array>
#include <bit>
#include <cstdint>

#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/scissor_box.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client {
namespace {

/// Nothing of the back buffer is left from before.
bool clears_all(const Context& c, GLbitfield mask) {
    return (mask & GL_COLOR_BUFFER_BIT) != 0 && !c.state.window.scissor_enabled &&
           c.state.window.draw_buffer == GL_BACK && glstate::writes_all_channels(c.state);
}

/// Nor of the depths that it was drawn by.
bool leaves_nothing(const Context& c, GLbitfield mask) {
    const bool depth = c.draw_target().format().depth_bits == 0 ||
                       ((mask & GL_DEPTH_BUFFER_BIT) != 0 && c.state.depth_stencil.depth_mask);
    return depth && clears_all(c, mask);
}

/// Clears on every node that it goes to: `pack(buffer)` is the command, `mask` what glClear would call the buffers.
template <class Pack>
void clear(Context& c, GLbitfield mask, Pack&& pack) {
    if (c.state.local.render_mode != GL_RENDER || c.draws_nothing) return;
    c.flush_block();
    c.session().before_clear(c.draw_source(), mask, c.draw_target() && leaves_nothing(c, mask));
    c.draw(scissor_box(c.state), needs_of_clear(), pack);
    if (c.framebuffers->draw && (mask & (GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT)) != 0) {
        std::lock_guard lock(c.share().mutex);
        c.framebuffers->draw->note_redrawn();
    }
    if (c.draw_target() && clears_all(c, mask)) c.draw_target().note_cleared();
}

/// One glClearBuffer.
struct BufferClear {
    GLenum buffer;
    GLint drawbuffer;
    GLenum type;
    std::array<std::uint32_t, 4> value;  ///< bits of that type
};

GLbitfield mask_of(GLenum buffer) {
    switch (buffer) {
        case GL_COLOR: return GL_COLOR_BUFFER_BIT;
        case GL_DEPTH: return GL_DEPTH_BUFFER_BIT;
        case GL_STENCIL: return GL_STENCIL_BUFFER_BIT;
        default: return GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    }
}

unsigned values_of(GLenum buffer) {
    if (buffer == GL_COLOR) return 4;
    return buffer == GL_DEPTH || buffer == GL_STENCIL ? 1 : 0;
}

void clear_buffer(Context& c, const BufferClear& what) {
    const bool color = what.buffer == GL_COLOR;
    const GLint buffers = color ? static_cast<GLint>(glstate::kDrawBuffers) : 1;
    if (what.drawbuffer < 0 || what.drawbuffer >= buffers) return c.error(GL_INVALID_VALUE);
    if (!may_draw_to_target(c)) return;
    if (what.drawbuffer > 0 && !c.framebuffers->draw) return;  // a window has one
    clear(c, mask_of(what.buffer), [&](wire::PackBuffer& buffer) {
        const auto& v = what.value;
        glapi::pack::ClearBuffer(buffer, what.buffer, what.drawbuffer, what.type, v[0], v[1], v[2], v[3]);
    });
}

/// `other`: the buffer besides the colours that has such values.
template <class T>
void clear_values(Context& c, GLenum buffer, GLint drawbuffer, GLenum type, GLenum other, const T* values) {
    if (buffer != GL_COLOR && (buffer != other || other == GL_NONE)) return c.error(GL_INVALID_ENUM);
    BufferClear what{buffer, drawbuffer, type, {}};
    for (unsigned i = 0; i < values_of(buffer); ++i) what.value[i] = std::bit_cast<std::uint32_t>(values[i]);
    clear_buffer(c, what);
}

}  // namespace

namespace api {

void Clear(Context& c, GLbitfield mask) {
    constexpr GLbitfield kKnown = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if (mask & ~(c.profile.is_es() ? kKnown : kKnown | GL_ACCUM_BUFFER_BIT)) return c.error(GL_INVALID_VALUE);
    if (!may_draw_to_target(c) || mask == 0) return;
    clear(c, mask, [&](wire::PackBuffer& buffer) { glapi::pack::Clear(buffer, mask); });
}

void ClearBufferfv(Context& c, GLenum buffer, GLint drawbuffer, const GLfloat* value) {
    clear_values(c, buffer, drawbuffer, GL_FLOAT, GL_DEPTH, value);
}
void ClearBufferiv(Context& c, GLenum buffer, GLint drawbuffer, const GLint* value) {
    clear_values(c, buffer, drawbuffer, GL_INT, GL_STENCIL, value);
}
void ClearBufferuiv(Context& c, GLenum buffer, GLint drawbuffer, const GLuint* value) {
    clear_values(c, buffer, drawbuffer, GL_UNSIGNED_INT, GL_NONE, value);
}
void ClearBufferfi(Context& c, GLenum buffer, GLint drawbuffer, GLfloat depth, GLint stencil) {
    if (buffer != GL_DEPTH_STENCIL) return c.error(GL_INVALID_ENUM);
    clear_buffer(c, {buffer,
                     drawbuffer,
                     GL_FLOAT_32_UNSIGNED_INT_24_8_REV,
                     {std::bit_cast<std::uint32_t>(depth), static_cast<std::uint32_t>(stencil), 0, 0}});
}

}  // namespace api

// ---- in display lists ----

namespace {

template <class T>
void record(Context& c, CommandId command, GLenum buffer, GLint drawbuffer, const T* value) {
    c.list().record(static_cast<std::uint16_t>(command), buffer, drawbuffer,
                    glapi::recorded_array(value, static_cast<std::ptrdiff_t>(values_of(buffer))));
}

template <class T>
void replay_clear(Context& c, std::span<const std::byte> payload,
                  void (*GlTable::*command)(Context&, GLenum, GLint, const T*)) {
    glapi::RecordReader in(payload);
    const auto buffer = in.get<GLenum>();
    const auto drawbuffer = in.get<GLint>();
    (execution_table(c).*command)(c, buffer, drawbuffer, in.array<T>());
}

}  // namespace

namespace compile {

void ClearBufferfv(Context& c, GLenum buffer, GLint drawbuffer, const GLfloat* value) {
    record(c, CommandId::ClearBufferfv, buffer, drawbuffer, value);
    if (c.list().execute) execution_table(c).ClearBufferfv(c, buffer, drawbuffer, value);
}
void ClearBufferiv(Context& c, GLenum buffer, GLint drawbuffer, const GLint* value) {
    record(c, CommandId::ClearBufferiv, buffer, drawbuffer, value);
    if (c.list().execute) execution_table(c).ClearBufferiv(c, buffer, drawbuffer, value);
}
void ClearBufferuiv(Context& c, GLenum buffer, GLint drawbuffer, const GLuint* value) {
    record(c, CommandId::ClearBufferuiv, buffer, drawbuffer, value);
    if (c.list().execute) execution_table(c).ClearBufferuiv(c, buffer, drawbuffer, value);
}

}  // namespace compile

namespace replay {

void ClearBufferfv(Context& c, std::span<const std::byte> payload) {
    replay_clear(c, payload, &GlTable::ClearBufferfv);
}
void ClearBufferiv(Context& c, std::span<const std::byte> payload) {
    replay_clear(c, payload, &GlTable::ClearBufferiv);
}
void ClearBufferuiv(Context& c, std::span<const std::byte> payload) {
    replay_clear(c, payload, &GlTable::ClearBufferuiv);
}

}  // namespace replay
}  // namespace wall::client
