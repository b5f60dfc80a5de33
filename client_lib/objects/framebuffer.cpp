// SPDX-License-Identifier: MIT
#include "client_lib/objects/framebuffer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "client_lib/objects/es_formats.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

using glstate::kAttachmentPoints;
using glstate::kColorAttachments;

constexpr unsigned kDepth = kColorAttachments, kStencil = kColorAttachments + 1;

/// What may be drawn to as a colour (Mesa: also the bases of old textures).
bool color_renderable(GLenum base) {
    switch (base) {
        case GL_RGBA:
        case GL_RGB:
        case GL_RG:
        case GL_RED:
        case GL_ALPHA:
        case GL_LUMINANCE:
        case GL_LUMINANCE_ALPHA:
        case GL_INTENSITY: return true;
        default: return false;
    }
}

}  // namespace

bool Framebuffer::renderable(unsigned place, const TextureFormat& format) const {
    if (format.compressed() || (es_ != 0 && !es_is_drawn(es_, format.internal_format))) return false;
    if (place < kColorAttachments) return color_renderable(format.base);
    if (format.base == GL_DEPTH_STENCIL) return true;
    return format.base == (place == kDepth ? GL_DEPTH_COMPONENT : GL_STENCIL_INDEX);
}

const Object* Attachment::object() const {
    if (texture) return texture.get();
    return renderbuffer.get();
}

TextureLevel* Attachment::image() const { return texture ? texture->find_level(face_of(target), level) : nullptr; }

std::optional<ImageShape> shape_of(const Attachment& attachment) {
    if (attachment.renderbuffer) {
        const Renderbuffer& r = *attachment.renderbuffer;
        const TextureFormat* format = find_renderbuffer_format(r.internal_format());
        if (!r.has_storage() || !format) return std::nullopt;
        return ImageShape{r.width(), r.height(), r.samples(), format, stored_bits(*format, GL_RGBA, GL_UNSIGNED_BYTE)};
    }
    const TextureLevel* image = attachment.image();
    const TextureFormat* format = image ? find_texture_format(image->internal_format) : nullptr;
    if (!format || image->width <= 0 || image->height <= 0) return std::nullopt;
    const bool rows_are_layers = glapi::spatial_dimensions_of(attachment.texture->info) == 1;
    const auto& layers = rows_are_layers ? image->height : image->depth;
    if (!attachment.layered && attachment.layer >= layers) return std::nullopt;
    return ImageShape{static_cast<std::uint32_t>(image->width),
                      rows_are_layers ? 1u : static_cast<std::uint32_t>(image->height), image->samples, format,
                      stored_bits(*format, image->format, image->type)};
}

void Framebuffer::attach(unsigned place, Attachment attachment) {
    if (attachments_[place] == attachment) return;
    attachments_[place] = std::move(attachment);
    stamp_ = next_stamp();
}

void Framebuffer::set_draw_buffers(const std::array<GLenum, kColorAttachments>& buffers) {
    if (std::exchange(draw_buffers_, buffers) != buffers) stamp_ = next_stamp();
}

void Framebuffer::set_read_buffer(GLenum buffer) {
    if (std::exchange(read_buffer_, buffer) != buffer) stamp_ = next_stamp();
}

void Framebuffer::set_defaults(const glstate::FramebufferDefaults& defaults) {
    if (std::exchange(defaults_, defaults) != defaults) stamp_ = next_stamp();
}

GLenum Framebuffer::attachment_error(unsigned place) const {
    const Attachment& attachment = attachments_[place];
    if (!attachment.present()) return GL_NO_ERROR;
    const auto shape = shape_of(attachment);
    if (!shape || !renderable(place, *shape->format)) return GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
    return shape->format->use == ImageUse::drawn ? GL_NO_ERROR : GL_FRAMEBUFFER_UNSUPPORTED;
}

/// Either all attachments are layered, by textures of one target, or none is (OpenGL 4.6, 9.4.2).
bool Framebuffer::mixes_layers() const {
    const Attachment* first = nullptr;
    return std::ranges::any_of(attachments_, [&](const Attachment& attachment) {
        if (!attachment.present()) return false;
        if (!first) first = &attachment;
        return attachment.layered != first->layered || (attachment.layered && attachment.target != first->target);
    });
}

// The order is Mesa's: depth, stencil, colours; then what they have in common.
GLenum Framebuffer::status() const {
    std::optional<std::uint32_t> samples;
    bool same_samples = true;
    for (const unsigned place : {kDepth, kStencil, 0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
        if (const GLenum error = attachment_error(place)) return error;
        const auto shape = shape_of(attachments_[place]);
        if (!shape) continue;
        same_samples = same_samples && samples.value_or(shape->samples) == shape->samples;
        samples = shape->samples;
    }
    if (mixes_layers()) return GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS;
    if (!same_samples) return GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE;
    if (!samples && (defaults_.width == 0 || defaults_.height == 0))
        return GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT;
    const Attachment &depth = attachments_[kDepth], &stencil = attachments_[kStencil];
    if (depth.present() && stencil.present() && depth.object() != stencil.object()) return GL_FRAMEBUFFER_UNSUPPORTED;
    return GL_FRAMEBUFFER_COMPLETE;
}

std::optional<ImageShape> Framebuffer::named_shape(GLenum buffer) const {
    if (buffer == GL_NONE) return std::nullopt;
    return shape_of(attachments_[*glstate::attachment_place(buffer)]);
}
std::optional<ImageShape> Framebuffer::read_shape() const { return named_shape(read_buffer_); }
std::optional<ImageShape> Framebuffer::draw_shape() const {
    for (const GLenum buffer : draw_buffers_)
        if (const auto shape = named_shape(buffer)) return shape;
    return std::nullopt;
}

std::uint32_t Framebuffer::samples() const {
    for (const Attachment& attachment : attachments_)
        if (const auto shape = shape_of(attachment)) return shape->samples;
    return defaults_.samples;
}

std::optional<std::uint32_t> Framebuffer::size(std::uint32_t ImageShape::*side) const {
    std::uint32_t smallest = std::numeric_limits<std::uint32_t>::max();
    for (const Attachment& attachment : attachments_)
        if (const auto shape = shape_of(attachment)) smallest = std::min(smallest, (*shape).*side);
    return smallest == std::numeric_limits<std::uint32_t>::max() ? std::nullopt : std::optional(smallest);
}

void Framebuffer::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    glstate::FramebufferDefinition definition{draw_buffers_, read_buffer_, defaults_, {}};
    for (unsigned place = 0; place < kAttachmentPoints; ++place) {
        const Attachment& attachment = attachments_[place];
        if (!attachment.present()) continue;
        const GLenum target = attachment.renderbuffer ? GLenum{GL_RENDERBUFFER} : attachment.target;
        const GLint layer = attachment.layered ? glstate::kAllLayers : attachment.layer;
        definition.attachments.push_back(
            {glstate::attachment_point(place), attachment.object()->id, target, attachment.level, layer});
    }
    glapi::pack::Framebuffer(buffer, id, encode(definition));
    packed();
}

void Framebuffer::for_each_image(const std::function<void(const Object&)>& use) const {
    for (const Attachment& attachment : attachments_)
        if (attachment.present()) use_with_base(*attachment.object(), use);
}

bool Framebuffer::has_plain_images() const {
    return std::ranges::all_of(attachments_, [](const Attachment& attachment) {
        if (!attachment.texture) return true;
        const Texture& texture = *attachment.texture;
        const glapi::TextureTargetInfo& info = texture.info;
        const bool flat = glapi::spatial_dimensions_of(info) == 2 && info.layers == 0 && info.first_face == 0;
        const auto defined = std::ranges::count_if(texture.faces[0], &TextureLevel::defined);
        return flat && !texture.view.origin && attachment.level == 0 && defined == 1;
    });
}

bool Framebuffer::may_be_larger() const {
    return !resolved_ && std::ranges::all_of(attachments_, [](const Attachment& attachment) {
        const auto shape = attachment.present() ? shape_of(attachment) : std::optional<ImageShape>();
        return !shape || shape->samples == 0;
    });
}

void Framebuffer::note_redrawn() {
    note_redrawn_here();
    for (const Attachment& attachment : attachments_)
        if (attachment.texture) attachment.texture->drawn_by = weak_from_this();
}

void Framebuffer::note_drawn() {
    for (const Attachment& attachment : attachments_) {
        if (attachment.renderbuffer) attachment.renderbuffer->note_drawn();
        if (attachment.texture) attachment.texture->note_drawn(face_of(attachment.target), attachment.level);
        if (!attachment.layered) continue;
        for (unsigned face = 1; face < glapi::face_count(attachment.texture->info); ++face)
            attachment.texture->note_drawn(face, attachment.level);
    }
}

}  // namespace wall::client
