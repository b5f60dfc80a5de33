// SPDX-License-Identifier: MIT
// glBlitFramebuffer (OpenGL 4.6, 18.3.1). Every node copies by itself out of a framebuffer object, which all of them
// hold, and out of a window that all of them hold as a whole. Out of one of which each holds a part, the pixels are
// gathered first and given to the nodes as one.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <optional>

#include "client_lib/context/copied_parts.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/gathered_window.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

struct Corners {
    GLint x0, y0, x1, y1;

    bool operator==(const Corners&) const = default;
    bool empty() const { return x0 == x1 || y0 == y1; }
    PixelBox box() const { return {std::min(x0, x1), std::min(y0, y1), std::abs(x1 - x0), std::abs(y1 - y0)}; }
};

constexpr GLint kFarthest = 1 << 24;  // pixels: nothing can lie there

bool is_absurd(const Corners& c) {
    return std::ranges::any_of(std::array{c.x0, c.y0, c.x1, c.y1},
                               [](GLint v) { return v < -kFarthest || v > kFarthest; });
}

/// Buffers of `mask` that both have.
GLbitfield common_buffers(Context& c, GLbitfield mask) {
    if (!read_color_format(c) || !draw_color_format(c)) mask &= ~GLbitfield{GL_COLOR_BUFFER_BIT};
    if (!has_depth(c, true) || !has_depth(c, false)) mask &= ~GLbitfield{GL_DEPTH_BUFFER_BIT};
    if (!has_stencil(c, true) || !has_stencil(c, false)) mask &= ~GLbitfield{GL_STENCIL_BUFFER_BIT};
    return mask;
}

GLenum multisample_error(Context& c, const Corners& from, const Corners& to) {
    const std::uint32_t read = samples_read(c), draw = samples_drawn(c);
    if (read != 0 && draw != 0 && read != draw) return GL_INVALID_OPERATION;
    const bool same_size = from.box().width == to.box().width && from.box().height == to.box().height;
    return (read != 0 || draw != 0) && !same_size ? GL_INVALID_OPERATION : GL_NO_ERROR;
}

/// Whole numbers go to the same kind of them, and nothing lies between two of them.
GLenum whole_error(Context& c, GLbitfield mask, GLenum filter) {
    if ((mask & GL_COLOR_BUFFER_BIT) == 0) return GL_NO_ERROR;
    const TextureFormat &from = *read_color_format(c), &to = *draw_color_format(c);
    if (!from.whole() && !to.whole()) return GL_NO_ERROR;
    return from.component_type != to.component_type || filter == GL_LINEAR ? GL_INVALID_OPERATION : GL_NO_ERROR;
}

/// What the two read and drawn images at a buffer are; null: there is none, or it is the window's.
const Attachment* attached(const std::shared_ptr<Framebuffer>& framebuffer, GLenum point) {
    const auto place = framebuffer ? glstate::attachment_place(point) : std::nullopt;
    return place && framebuffer->at(*place).present() ? &framebuffer->at(*place) : nullptr;
}

/// Whether colours of the image that is read go to that image.
bool draws_to_itself(const FramebufferUse& use) {
    if (!use.read || !use.draw) return !use.read && !use.draw;
    const Attachment* from = attached(use.read, use.read->read_buffer());
    return from && std::ranges::any_of(use.draw->draw_buffers(), [&](GLenum buffer) {
               const Attachment* to = attached(use.draw, buffer);
               return to && *to == *from;
           });
}

/// What depth and stencil values are kept in.
struct DepthFormat {
    GLenum type = GL_UNSIGNED_NORMALIZED;
    unsigned depth = 0, stencil = 0;  ///< bits
};

/// Of the image that has depth, or stencil values; or of the window.
DepthFormat depth_format(Context& c, const std::shared_ptr<Framebuffer>& framebuffer, const DrawTarget& window,
                         std::optional<ImageShape> (Framebuffer::*shape)() const) {
    if (!framebuffer) return {.depth = window.format().depth_bits, .stencil = window.format().stencil_bits};
    std::lock_guard lock(c.share().mutex);
    const auto image = (*framebuffer.*shape)();
    return image ? DepthFormat{image->format->component_type, image->bits.depth, image->bits.stencil} : DepthFormat{};
}

/// Depth and stencil values are copied between images of one format only; what one of them lacks is not copied.
bool depths_differ(Context& c, GLbitfield mask) {
    if ((mask & (GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT)) == 0) return false;
    const auto shape = (mask & GL_DEPTH_BUFFER_BIT) ? &Framebuffer::depth_shape : &Framebuffer::stencil_shape;
    const DepthFormat from = depth_format(c, c.framebuffers->read, c.read_target(), shape),
                      to = depth_format(c, c.framebuffers->draw, c.draw_target(), shape);
    const bool depths = from.depth != 0 && to.depth != 0, stencils = from.stencil != 0 && to.stencil != 0;
    return (depths && (from.depth != to.depth || from.type != to.type)) || (stencils && from.stencil != to.stencil);
}

/// What OpenGL ES forbids beyond that (OpenGL ES 3.0.6, 4.3.3).
GLenum es_error(Context& c, const Corners& from, const Corners& to, GLbitfield mask) {
    const FramebufferUse& use = *c.framebuffers;
    if (samples_drawn(c) != 0 || (samples_read(c) != 0 && from != to)) return GL_INVALID_OPERATION;
    std::lock_guard lock(c.share().mutex);
    return (mask & GL_COLOR_BUFFER_BIT) && draws_to_itself(use) ? GL_INVALID_OPERATION : GL_NO_ERROR;
}

void blit(Context& c, const Corners& from, const Corners& to, GLbitfield mask, GLenum filter) {
    c.draw(touched_by_blit(to.box()), needs_of_clear(), [&](wire::PackBuffer& buffer) {
        glapi::pack::Blit(buffer, from.x0, from.y0, from.x1, from.y1, to.x0, to.y0, to.x1, to.y1, mask, filter);
    });
}

}  // namespace

void BlitFramebuffer(Context& c, GLint from_x0, GLint from_y0, GLint from_x1, GLint from_y1, GLint to_x0, GLint to_y0,
                     GLint to_x1, GLint to_y1, GLbitfield mask, GLenum filter) {
    constexpr GLbitfield kBuffers = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if (!may_draw_to_target(c) || !may_read_from_target(c)) return;
    if (filter != GL_NEAREST && filter != GL_LINEAR) return c.error(GL_INVALID_ENUM);
    if (mask & ~kBuffers) return c.error(GL_INVALID_VALUE);
    if ((mask & ~GLbitfield{GL_COLOR_BUFFER_BIT}) != 0 && filter != GL_NEAREST) return c.error(GL_INVALID_OPERATION);
    const Corners from{from_x0, from_y0, from_x1, from_y1}, to{to_x0, to_y0, to_x1, to_y1};
    if (is_absurd(from) || is_absurd(to)) return;
    if (const GLenum error = multisample_error(c, from, to)) return c.error(error);
    mask = common_buffers(c, mask);
    if (const GLenum error = whole_error(c, mask, filter)) return c.error(error);
    if (depths_differ(c, mask)) return c.error(GL_INVALID_OPERATION);
    if (const GLenum error = c.profile.is_es() ? es_error(c, from, to, mask) : GLenum{GL_NO_ERROR})
        return c.error(error);
    if (mask == 0 || from.empty() || to.empty()) return;
    c.flush_block();
    if (c.framebuffers->read) {
        CopyOfParts copy(c, {from.x0, from.y0, from.x1, from.y1}, {to.x0, to.y0, to.x1, to.y1}, mask);
        blit(c, from, to, mask, filter);
        return copy.finish();
    }
    if (can_copy_out_of_window(c)) return blit(c, from, to, mask, filter);
    // What lies outside of the window is not written; outside of what was gathered of it neither.
    const PixelBox inside = clip_to_window(c, from.box());
    if (inside.empty()) return;
    const GatheredWindow gathered(c, inside, mask, "glBlitFramebuffer");
    blit(c, {from.x0 - inside.x, from.y0 - inside.y, from.x1 - inside.x, from.y1 - inside.y}, to, mask, filter);
}

}  // namespace wall::client::api
