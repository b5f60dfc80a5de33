// SPDX-License-Identifier: MIT
// Which framebuffer objects a context draws to and reads from, changing them, and what follows for its commands. The
// application's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_use.h"

namespace wall::client {

/// What the application has bound to a target; null: the surface's own, or no such target.
std::shared_ptr<Framebuffer>* framebuffer_binding(Context& c, GLenum target);

/// Binds to both, or one; commands before it are sent off.
void bind_framebuffer(Context& c, GLenum target, std::shared_ptr<Framebuffer> framebuffer);
/// To be called around every change of a framebuffer: `change(framebuffer)`.
template <class Change>
void change_framebuffer(Context& c, Framebuffer& framebuffer, Change&& change) {
    c.flush_block();
    {
        std::lock_guard lock(c.share().mutex);
        change(framebuffer);
    }
    c.framebuffers->stamp = next_stamp();
}

/// False, and GL_INVALID_FRAMEBUFFER_OPERATION, if what is drawn to (read from) is not complete.
bool may_draw_to_target(Context& c);
bool may_read_from_target(Context& c);
/// The same for single pixels, which one with several samples a pixel does not have: GL_INVALID_OPERATION.
bool may_read_pixels(Context& c);

/// Samples of each pixel of what is drawn to (read from), a window as well; 0: one, and it is not multisampled.
std::uint32_t samples_drawn(Context& c);
std::uint32_t samples_read(Context& c);

/// An object that is deleted leaves the framebuffers that are bound (OpenGL 4.6, 9.2.8).
void detach_from_bound(Context& c, const Object& image);
/// Whether any framebuffer of the context has it attached.
bool is_attached(const Context& c, const Object& image);

/// What the colours of a window count as now: GL_RGBA8, or GL_SRGB8_ALPHA8 where GL_FRAMEBUFFER_SRGB makes them so.
GLint window_color_format(Context& c, const DrawTarget& window);
/// Of the colours that are read from, that are drawn, and that the first draw buffer takes. Null: there are none.
const TextureFormat* read_color_format(Context& c);
const TextureFormat* draw_color_format(Context& c);
const TextureFormat* first_draw_format(Context& c);
/// Bits of what is drawn to. Of a window: as its format says.
ComponentBits draw_target_bits(Context& c);
bool has_depth(Context& c, bool reading);
bool has_stencil(Context& c, bool reading);

}  // namespace wall::client
