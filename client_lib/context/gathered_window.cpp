// SPDX-License-Identifier: MIT
#include "client_lib/context/gathered_window.h"

#include <mutex>
#include <optional>
#include <utility>

#include "client_lib/context/forget_objects.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

namespace el = glstate::el;

GatheredWindow::GatheredWindow(Context& c, const PixelBox& box, GLbitfield mask, const char* function)
    : c_(c), function_(function), made_(std::in_place, c, GLenum{GL_READ_FRAMEBUFFER}) {
    if (mask & GL_COLOR_BUFFER_BIT)
        attach(**made_, 0, box, window_color_format(c, c.read_target()), GL_RGBA, GL_UNSIGNED_BYTE);
    if (mask & (GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT)) attach_depth(**made_, box);
    made_->bind();
}

GatheredWindow::~GatheredWindow() {
    made_.reset();
    for (const auto& texture : textures_) forget_texture(c_, texture);
}

void GatheredWindow::attach_depth(Framebuffer& to, const PixelBox& box) {
    const bool stencil = has_stencil(c_, true);
    if (stencil)
        attach(to, glstate::kColorAttachments, box, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8);
    else attach(to, glstate::kColorAttachments, box, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    if (stencil) to.attach(glstate::kColorAttachments + 1, to.at(glstate::kColorAttachments));
}

void GatheredWindow::attach(Framebuffer& to, unsigned place, const PixelBox& box, GLint internal_format, GLenum format,
                            GLenum type) {
    auto pixels = gather_plain(c_, box, format, type, function_);
    std::lock_guard lock(c_.share().mutex);
    const auto texture = make_texture(c_, 0, glapi::TextureTarget::t2d);
    TextureLevel& level = texture->level_at(0, 0);
    level.internal_format = internal_format;
    level.width = box.width;
    level.height = box.height;
    level.depth = 1;
    level.format = level.data_format = format;
    level.type = level.data_type = type;
    level.content = LevelContent::stored;
    level.pixels = std::move(pixels);
    level.stamp = next_stamp();
    touch(c_.share(), *texture);
    to.attach(place, {.texture = texture, .target = GL_TEXTURE_2D});
    textures_.push_back(texture);
}

PixelRect touched_by_blit(const PixelBox& box) {
    constexpr float kMargin = 1;
    return {static_cast<float>(box.x) - kMargin, static_cast<float>(box.y) - kMargin,
            static_cast<float>(box.x + box.width) + kMargin, static_cast<float>(box.y + box.height) + kMargin};
}

bool turn_whole(Context& c, ClientSurface& window) {
    switch (c.session().wholeness(window)) {
        case Wholeness::is: return true;
        case Wholeness::cannot_be: return false;
        case Wholeness::may_be: break;
    }
    if (window.options.format.stereo && window.drawn) return false;  // only one buffer is gathered
    c.flush_block();
    const PixelBox all{0, 0, static_cast<std::int32_t>(window.layout.width),
                       static_cast<std::int32_t>(window.layout.height)};
    std::optional<GatheredWindow> gathered;
    const GLenum buffer = window.options.format.double_buffered ? GL_BACK : GL_FRONT;
    const Instead<el::read_buffer> from(c, buffer);
    const Instead<el::draw_buffer> to(c, buffer);
    const Instead<el::scissor_enabled> everywhere(c, 0);
    GLbitfield mask = GL_COLOR_BUFFER_BIT;
    if (has_depth(c, false)) mask |= GL_DEPTH_BUFFER_BIT;
    if (has_stencil(c, false)) mask |= GL_STENCIL_BUFFER_BIT;
    const bool readable = c.reads_drawn_surface() && !c.framebuffers->read;
    if (window.drawn && readable) gathered.emplace(c, all, mask, "window drawn whole");
    c.session().draw_whole(window);
    if (gathered)
        c.draw(touched_by_blit(all), needs_of_clear(), [&](wire::PackBuffer& packed) {
            glapi::pack::Blit(packed, 0, 0, all.width, all.height, 0, 0, all.width, all.height, mask, GL_NEAREST);
        });
    return true;
}

bool can_copy_out_of_window(Context& c) {
    ClientSurface* const window = c.read_surface();
    if (window == nullptr || c.state.local.render_mode != GL_RENDER) return false;
    CopyHabit& habit = window->copies;
    habit.note(window->frame);
    if (habit.copies_much() && c.reads_drawn_surface() && !c.framebuffers->draw) turn_whole(c, *window);
    return habit.copies() && c.session().everywhere(*window);
}

}  // namespace wall::client
