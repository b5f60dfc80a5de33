// SPDX-License-Identifier: MIT
#include "client_lib/context/copied_texels.h"

#include <cstring>
#include <memory>
#include <mutex>
#include <optional>

#include "client_lib/context/copied_parts.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/gathered_window.h"
#include "client_lib/context/query_state.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/pixel_convert.h"

namespace wall::client {
namespace {

/// An image of one layer, which a framebuffer object has as it is.
bool is_flat(const ImageCall& call) {
    const glapi::TextureTargetInfo& info = *target_word(call.target)->info;
    return call.dimensions == 2 && glapi::spatial_dimensions_of(info) == 2 && info.layers == 0;
}

/// Alpha may be left away, and is one where it was.
bool same_colors(const ImageShape& from, const TextureFormat& to, ComponentBits bits) {
    constexpr auto kAlphaAside = [](GLenum base) { return base == GL_RGBA ? GLenum{GL_RGB} : base; };
    if (kAlphaAside(from.format->base) != kAlphaAside(to.base)) return false;
    if (bits.alpha == 0 || from.bits.alpha == 0) bits.alpha = from.bits.alpha;
    return std::memcmp(&from.bits, &bits, sizeof bits) == 0;
}

/// Texels go over as they are: neither curves nor missing components come between.
bool same_texels(const ImageShape& from, const TextureFormat& to, const ComponentBits& bits) {
    return to.use == ImageUse::drawn && !to.srgb && !from.format->srgb && same_colors(from, to, bits) &&
           from.format->component_type == to.component_type && bits.depth == 0 && bits.stencil == 0 &&
           bits.luminance == 0 && bits.intensity == 0;
}

bool inside(const ImageCall& call, GLint x, GLint y, const ImageShape& from) {
    return x >= 0 && y >= 0 && std::int64_t{x} + call.width <= from.width &&
           std::int64_t{y} + call.height <= from.height;
}

/// What is read from, if every node has all of it. Of a window's samples pixels are made.
std::optional<ImageShape> source_shape(Context& c) {
    if (const auto& read = c.framebuffers->read) {
        std::lock_guard lock(c.share().mutex);
        return read->read_shape();
    }
    if (!can_copy_out_of_window(c)) return std::nullopt;
    const DrawTarget window = c.read_target();
    if (window_color_format(c, window) != GL_RGBA8) return std::nullopt;  // a blit would change colours
    const TextureFormat* format = find_texture_format(window.format().alpha_bits != 0 ? GL_RGBA8 : GL_RGB8);
    return ImageShape{window.size().width, window.size().height, 0, format, format->bits};
}

bool has_attached(const Framebuffer& framebuffer, const Object* image) {
    for (unsigned place = 0; image && place < glstate::kAttachmentPoints; ++place)
        if (framebuffer.at(place).object() == image) return true;
    return false;
}

/// The image as a framebuffer object of its own; while it lives, the one that is drawn to, without a scissor.
class CopyTarget {
public:
    CopyTarget(Context& c, const ImageCall& call)
        : c_(c),
          drawn_(c.framebuffers->draw),
          made_(std::make_shared<Framebuffer>(0)),
          scissor_(c.get<glstate::el::scissor_enabled>()) {
        const auto texture = bound_texture(c, call.target);
        {
            std::lock_guard lock(c_.share().mutex);
            made_->attach(0, {.texture = texture, .target = call.target, .level = call.level});
            c_.share().by_id[made_->id] = made_;
        }
        bind_framebuffer(c_, GL_DRAW_FRAMEBUFFER, made_);
        c_.set<glstate::el::scissor_enabled>(0, 0);
    }
    ~CopyTarget() {
        c_.set<glstate::el::scissor_enabled>(0, scissor_);
        bind_framebuffer(c_, GL_DRAW_FRAMEBUFFER, drawn_);
        c_.forget_object(made_->id);
        std::lock_guard lock(c_.share().mutex);
        c_.share().by_id.erase(made_->id);
    }
    CopyTarget(const CopyTarget&) = delete;

private:
    Context& c_;
    const std::shared_ptr<Framebuffer> drawn_, made_;
    const glstate::el::scissor_enabled::type scissor_;
};

}  // namespace

bool can_copy_on_nodes(Context& c, const ImageCall& call, const TextureFormat& to, const ComponentBits& bits, GLint x,
                       GLint y) {
    if (!is_flat(call) || call.width == 0 || call.height == 0) return false;
    if (transfer_matters(c.state, call.format) || c.queries->conditional) return false;
    if (c.get<glstate::el::rasterizer_discard>() || c.state.local.render_mode != GL_RENDER) return false;
    const auto texture = bound_texture(c, call.target);
    if (texture && texture->parameters.generate_mipmap) return false;
    const auto& read = c.framebuffers->read;
    if (read && has_attached(*read, texture.get())) return false;
    const auto from = source_shape(c);
    return from && from->samples == 0 && inside(call, x, y, *from) && same_texels(*from, to, bits);
}

void copy_on_nodes(Context& c, const ImageCall& call, GLint x, GLint y) {
    c.flush_block();
    want_whole_images(c);
    const CopyTarget target(c, call);
    const PixelRect touched{static_cast<float>(call.x), static_cast<float>(call.y),
                            static_cast<float>(call.x + call.width), static_cast<float>(call.y + call.height)};
    c.draw(touched, needs_of_clear(), [&](wire::PackBuffer& buffer) {
        glapi::pack::Blit(buffer, x, y, x + call.width, y + call.height, call.x, call.y, call.x + call.width,
                          call.y + call.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    });
}

}  // namespace wall::client
