// SPDX-License-Identifier: MIT
#include "client_lib/context/framebuffer_binding.h"

#include <mutex>
#include <utility>

namespace wall::client {
namespace {

bool complete(Context& c, const Framebuffer* framebuffer) {
    if (!framebuffer) return !c.has_no_surface();
    std::lock_guard lock(c.share().mutex);
    return framebuffer->status() == GL_FRAMEBUFFER_COMPLETE;
}

std::uint32_t samples_of(Context& c, const std::shared_ptr<Framebuffer>& framebuffer, const DrawTarget& window) {
    if (!framebuffer) return window ? window.format().samples : 0;
    std::lock_guard lock(c.share().mutex);
    return framebuffer->samples();
}

/// Of the framebuffer that is drawn to or read from; nothing: it has none.
template <class Shape>
std::optional<ImageShape> shape(Context& c, const Framebuffer& framebuffer, Shape&& shape) {
    std::lock_guard lock(c.share().mutex);
    return (framebuffer.*shape)();
}

}  // namespace

std::shared_ptr<Framebuffer>* framebuffer_binding(Context& c, GLenum target) {
    switch (target) {
        case GL_FRAMEBUFFER:
        case GL_DRAW_FRAMEBUFFER: return &c.framebuffers->draw;
        case GL_READ_FRAMEBUFFER: return &c.framebuffers->read;
        default: return nullptr;
    }
}

void bind_framebuffer(Context& c, GLenum target, std::shared_ptr<Framebuffer> framebuffer) {
    FramebufferUse& use = *c.framebuffers;
    const bool draw = target != GL_READ_FRAMEBUFFER, read = target != GL_DRAW_FRAMEBUFFER;
    if ((!draw || use.draw == framebuffer) && (!read || use.read == framebuffer)) return;
    c.flush_block();
    if (draw) use.draw = framebuffer;
    if (read) use.read = std::move(framebuffer);
    use.stamp = next_stamp();
}

bool may_draw_to_target(Context& c) {
    if (complete(c, c.framebuffers->draw.get())) return true;
    c.error(GL_INVALID_FRAMEBUFFER_OPERATION);
    return false;
}

bool may_read_from_target(Context& c) {
    if (complete(c, c.framebuffers->read.get())) return true;
    c.error(GL_INVALID_FRAMEBUFFER_OPERATION);
    return false;
}

bool may_read_pixels(Context& c) {
    if (!may_read_from_target(c)) return false;
    const auto& framebuffer = c.framebuffers->read;
    if (!framebuffer) return !c.has_no_surface();
    std::lock_guard lock(c.share().mutex);
    if (framebuffer->samples() != 0) c.error(GL_INVALID_OPERATION);
    return framebuffer->samples() == 0;
}

std::uint32_t samples_drawn(Context& c) { return samples_of(c, c.framebuffers->draw, c.draw_target()); }
std::uint32_t samples_read(Context& c) { return samples_of(c, c.framebuffers->read, c.read_target()); }

void detach_from_bound(Context& c, const Object& image) {
    const FramebufferUse& use = *c.framebuffers;
    for (const auto& framebuffer : {use.draw, use.read}) {
        if (!framebuffer) continue;
        for (unsigned place = 0; place < glstate::kAttachmentPoints; ++place)
            if (framebuffer->at(place).object() == &image)
                change_framebuffer(c, *framebuffer, [&](Framebuffer& f) { f.attach(place, {}); });
    }
}

bool is_attached(const Context& c, const Object& image) {
    bool attached = false;
    c.framebuffers->names.for_each([&](const Framebuffer& framebuffer) {
        for (unsigned place = 0; place < glstate::kAttachmentPoints; ++place)
            attached = attached || framebuffer.at(place).object() == &image;
    });
    return attached;
}

GLint window_color_format(Context& c, const DrawTarget& window) {
    const bool srgb = window && window.encodes_srgb() && c.get<glstate::el::framebuffer_srgb>();
    return srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
}

namespace {

/// Of the window's buffer, or the framebuffer object's.
template <class Shape>
const TextureFormat* color_format(Context& c, const std::shared_ptr<Framebuffer>& framebuffer, const DrawTarget& window,
                                  GLenum window_buffer, Shape&& which) {
    if (!framebuffer) return window_buffer == GL_NONE ? nullptr : find_texture_format(window_color_format(c, window));
    const auto found = shape(c, *framebuffer, which);
    return found ? found->format : nullptr;
}

}  // namespace

const TextureFormat* read_color_format(Context& c) {
    return color_format(c, c.framebuffers->read, c.read_target(), c.state.window.read_buffer, &Framebuffer::read_shape);
}
const TextureFormat* draw_color_format(Context& c) {
    return color_format(c, c.framebuffers->draw, c.draw_target(), c.state.window.draw_buffer, &Framebuffer::draw_shape);
}
const TextureFormat* first_draw_format(Context& c) {
    return color_format(c, c.framebuffers->draw, c.draw_target(), c.state.window.draw_buffer,
                        &Framebuffer::first_draw_shape);
}

ComponentBits draw_target_bits(Context& c) {
    const auto& framebuffer = c.framebuffers->draw;
    if (!framebuffer) {
        const DrawTarget target = c.draw_target();
        if (!target) return {};
        const SurfaceFormat& format = target.format();
        return {8, 8, 8, format.alpha_bits, 0, 0, format.depth_bits, format.stencil_bits};
    }
    ComponentBits bits{};
    if (const auto color = shape(c, *framebuffer, &Framebuffer::draw_shape)) bits = color->bits;
    bits.depth = bits.stencil = 0;
    if (const auto depth = shape(c, *framebuffer, &Framebuffer::depth_shape)) bits.depth = depth->bits.depth;
    if (const auto stencil = shape(c, *framebuffer, &Framebuffer::stencil_shape)) bits.stencil = stencil->bits.stencil;
    return bits;
}

bool has_depth(Context& c, bool reading) {
    const auto& framebuffer = reading ? c.framebuffers->read : c.framebuffers->draw;
    if (framebuffer) return shape(c, *framebuffer, &Framebuffer::depth_shape).has_value();
    const DrawTarget target = reading ? c.read_target() : c.draw_target();
    return target && target.format().depth_bits != 0;
}

bool has_stencil(Context& c, bool reading) {
    const auto& framebuffer = reading ? c.framebuffers->read : c.framebuffers->draw;
    if (framebuffer) return shape(c, *framebuffer, &Framebuffer::stencil_shape).has_value();
    const DrawTarget target = reading ? c.read_target() : c.draw_target();
    return target && target.format().stencil_bits != 0;
}

}  // namespace wall::client
