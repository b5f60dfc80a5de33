// SPDX-License-Identifier: MIT
#include "tileserver/objects/framebuffer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "tileserver/driver/window_values.h"
#include "tileserver/objects/driver_framebuffer.h"
#include "tileserver/objects/renderbuffer.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver {

Framebuffer::Framebuffer(ObjectAccount& account, Driver& driver)
    : ObjectOf(account), driver_(driver), gl_(driver.gl()) {
    gl_.CreateFramebuffers(1, &framebuffer_);
}

Framebuffer::~Framebuffer() {
    driver_.forget_target();
    gl_.DeleteFramebuffers(1, &framebuffer_);
}

void Framebuffer::define(const glstate::FramebufferDefinition& definition) {
    definition_ = definition;
    defined_ = true;
}

void Framebuffer::draw_part(const std::optional<geom::Rect>& part) {
    part_ = part;
    geometry_.part = part;
    driver_.forget_target();
}

Result<void> Framebuffer::update(const ObjectTable& objects, SharedContents& shared) {
    if (!defined_ && textures_ == objects.version(ObjectKind::texture) &&
        renderbuffers_ == objects.version(ObjectKind::renderbuffer))
        return {};
    detach_all();
    if (auto attached = attach_all(framebuffer_, objects, shared); !attached) return attached;
    set_buffers();
    set_defaults();
    complete_ = gl_.CheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    GLint depth = GL_NONE;
    gl_.GetNamedFramebufferAttachmentParameteriv(framebuffer_, GL_DEPTH_ATTACHMENT,
                                                 GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &depth);
    has_depth_ = depth != GL_NONE;
    find_size();
    driver_.forget_target();
    defined_ = false;
    textures_ = objects.version(ObjectKind::texture);
    renderbuffers_ = objects.version(ObjectKind::renderbuffer);
    return {};
}

void Framebuffer::set_buffers() {
    gl_.NamedFramebufferDrawBuffers(framebuffer_, static_cast<GLsizei>(definition_.draw_buffers.size()),
                                    definition_.draw_buffers.data());
    gl_.NamedFramebufferReadBuffer(framebuffer_, definition_.read_buffer);
}

void Framebuffer::set_defaults() {
    const glstate::FramebufferDefaults& defaults = definition_.defaults;
    const std::array<std::pair<GLenum, std::uint32_t>, 5> values{{
        {GL_FRAMEBUFFER_DEFAULT_WIDTH, defaults.width},
        {GL_FRAMEBUFFER_DEFAULT_HEIGHT, defaults.height},
        {GL_FRAMEBUFFER_DEFAULT_LAYERS, defaults.layers},
        {GL_FRAMEBUFFER_DEFAULT_SAMPLES, defaults.samples},
        {GL_FRAMEBUFFER_DEFAULT_FIXED_SAMPLE_LOCATIONS, defaults.fixed_places},
    }};
    for (const auto& [word, value] : values)
        gl_.NamedFramebufferParameteri(framebuffer_, word, static_cast<GLint>(value));
}

void Framebuffer::detach_all() {
    for (unsigned place = 0; place < glstate::kAttachmentPoints; ++place)
        gl_.NamedFramebufferRenderbuffer(framebuffer_, glstate::attachment_point(place), GL_RENDERBUFFER, 0);
}

/// One that is gone leaves its point empty.
Result<void> Framebuffer::attach(GLuint to, const glstate::FramebufferAttachment& attachment,
                                 const ObjectTable& objects, SharedContents& shared) {
    if (attachment.target == GL_RENDERBUFFER) {
        const auto renderbuffer = objects.look_up<Renderbuffer>(attachment.object);
        if (!renderbuffer) return tl::unexpected(renderbuffer.error());
        if (*renderbuffer != nullptr)
            gl_.NamedFramebufferRenderbuffer(to, attachment.point, GL_RENDERBUFFER, (*renderbuffer)->name());
        return {};
    }
    const auto found = objects.look_up<Texture>(attachment.object);
    if (!found) return tl::unexpected(found.error());
    Texture* const texture = *found;
    const auto target = texture_target(attachment.target);
    if (texture == nullptr || !target || texture->target() != *target) return {};
    if (!texture->own(shared)) return fail(too_much("texture memory"));
    const auto& info = glapi::info_of(*target);
    const GLuint name = texture->content().name();
    if (attachment.layer == glstate::kAllLayers) {
        gl_.NamedFramebufferTexture(to, attachment.point, name, attachment.level);
    } else if (info.first_face != 0) {  // by its name: as a layer only where all faces are there
        gl_.BindFramebuffer(GL_FRAMEBUFFER, to);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, attachment.point, attachment.target, name, attachment.level);
    } else if (is_3d(*target) || info.layers != 0) {
        gl_.NamedFramebufferTextureLayer(to, attachment.point, name, attachment.level, attachment.layer);
    } else {
        gl_.NamedFramebufferTexture(to, attachment.point, name, attachment.level);
    }
    return {};
}

Result<void> Framebuffer::attach_all(GLuint to, const ObjectTable& objects, SharedContents& shared) {
    for (const auto& attachment : definition_.attachments)
        if (auto attached = attach(to, attachment, objects, shared); !attached) return attached;
    return {};
}

/// That of the smallest image (OpenGL 4.6, section 9.2.8), as the driver has them.
void Framebuffer::find_size() {
    std::array<GLint, 2> size{std::numeric_limits<GLint>::max(), std::numeric_limits<GLint>::max()};
    for (const auto& attachment : definition_.attachments) {
        GLint name = 0, kind = GL_NONE;
        gl_.GetNamedFramebufferAttachmentParameteriv(framebuffer_, attachment.point,
                                                     GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &kind);
        if (kind == GL_NONE) continue;
        gl_.GetNamedFramebufferAttachmentParameteriv(framebuffer_, attachment.point,
                                                     GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &name);
        std::array<GLint, 2> image{};
        if (kind == GL_RENDERBUFFER) {
            gl_.GetNamedRenderbufferParameteriv(static_cast<GLuint>(name), GL_RENDERBUFFER_WIDTH, &image[0]);
            gl_.GetNamedRenderbufferParameteriv(static_cast<GLuint>(name), GL_RENDERBUFFER_HEIGHT, &image[1]);
        } else {
            const TextureTarget target = *texture_target(attachment.target);
            const auto& info = glapi::info_of(target);
            const bool all_faces = info.first_face != 0 && attachment.target == info.target;
            const GLenum images = all_faces ? info.first_face : attachment.target;
            driver_.bind_texture_to_edit(target, static_cast<GLuint>(name));
            gl_.GetTexLevelParameteriv(images, attachment.level, GL_TEXTURE_WIDTH, &image[0]);
            gl_.GetTexLevelParameteriv(images, attachment.level, GL_TEXTURE_HEIGHT, &image[1]);
            if (glapi::spatial_dimensions_of(info) == 1) image[1] = std::min(image[1], 1);
        }
        size = {std::min(size[0], image[0]), std::min(size[1], image[1])};
    }
    if (definition_.attachments.empty())
        size = {static_cast<GLint>(definition_.defaults.width), static_cast<GLint>(definition_.defaults.height)};
    const bool any = size[0] != std::numeric_limits<GLint>::max();
    geometry_ = any ? plain_geometry(size[0], size[1]) : LayerGeometry{};
    if (own_) geometry_.window_width = own_->window_width, geometry_.window_height = own_->window_height;
    geometry_.part = part_;
    complete_ = complete_ && any && size[0] > 0 && size[1] > 0;
    driver_.drain_errors();
}

// ---- larger images ----

/// Calls `use(image)` with each texture and renderbuffer that is there, once; whether that was all of them, and all
/// said so.
template <class Use>
bool Framebuffer::all_images(const ObjectTable& objects, Use&& use) {
    std::vector<ClientName> seen;
    bool all = true;
    const auto use_one = [&](const auto& found) { all = found && *found != nullptr && use(**found) && all; };
    for (const glstate::FramebufferAttachment& attachment : definition_.attachments) {
        if (std::ranges::find(seen, attachment.object) != seen.end()) continue;
        seen.push_back(attachment.object);
        if (attachment.target == GL_RENDERBUFFER) use_one(objects.look_up<Renderbuffer>(attachment.object));
        else use_one(objects.look_up<Texture>(attachment.object));
    }
    return all;
}

/// From those of another framebuffer with as many, which lie as `as` says; of a part only that, so that the rest of
/// large images takes no memory where drivers take it as it is written.
void Framebuffer::copy_images(GLuint from, const LayerGeometry& as) {
    const WindowValues::IntBox part =
        part_ ? WindowValues::IntBox{part_->x, part_->y, part_->width, part_->height}
              : WindowValues::IntBox{0, 0, static_cast<std::int32_t>(geometry_.window_width),
                                     static_cast<std::int32_t>(geometry_.window_height)};
    const WindowValues::IntBox source = layer_box(as, part), target = layer_box(geometry_, part);
    if (source.width == 0 || source.height == 0 || target.width == 0 || target.height == 0) return;
    driver_.disable_scissor();
    const bool smooth = source.width > target.width || source.height > target.height;
    for (const auto& attachment : definition_.attachments) {
        const GLbitfield buffers = buffers_at(attachment.point);
        GLint kind = GL_NONE;
        if (buffers == GL_COLOR_BUFFER_BIT) {
            gl_.NamedFramebufferReadBuffer(from, attachment.point);
            gl_.NamedFramebufferDrawBuffers(framebuffer_, 1, &attachment.point);
            gl_.GetNamedFramebufferAttachmentParameteriv(from, attachment.point,
                                                         GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE, &kind);
        }
        const bool whole_numbers = kind == GL_INT || kind == GL_UNSIGNED_INT;
        const bool linear = smooth && buffers == GL_COLOR_BUFFER_BIT && !whole_numbers;
        gl_.BlitNamedFramebuffer(from, framebuffer_, source.x, source.y, source.x + source.width,
                                 source.y + source.height, target.x, target.y, target.x + target.width,
                                 target.y + target.height, buffers, linear ? GL_LINEAR : GL_NEAREST);
    }
    set_buffers();
    driver_.drain_errors();
    driver_.forget_target();
}

void Framebuffer::enlarge(const ObjectTable& objects, SharedContents& shared, std::int32_t width, std::int32_t height) {
    if (own_ || !update(objects, shared) || !complete_) return;
    const DriverFramebuffer before(gl_);
    if (!attach_all(before.name(), objects, shared)) return;
    own_ = geometry_;
    if (all_images(objects, [&](auto& image) { return image.enlarge(width, height); }) && update(objects, shared) &&
        complete_)
        return copy_images(before.name(), *own_);
    restore_images(objects);
}

void Framebuffer::restore_images(const ObjectTable& objects) {
    all_images(objects, [](auto& image) { return image.restore(), true; });
    own_.reset();
}

// What it was attached to keeps an image that is deleted (OpenGL 4.6, 5.1.3).
void Framebuffer::restore(const ObjectTable& objects, SharedContents& shared) {
    if (!own_) return;
    const DriverFramebuffer larger(gl_);
    const LayerGeometry as = geometry_;
    const bool whole = attach_all(larger.name(), objects, shared).has_value();
    restore_images(objects);
    if (whole && update(objects, shared) && complete_) copy_images(larger.name(), as);
}

// Its draw buffers are its own, not the window's.
void Framebuffer::bind(GLenum, GLenum) { gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }

bool Framebuffer::draws_colors() const {
    return std::ranges::any_of(definition_.attachments, [&](const auto& attachment) {
        return std::ranges::count(definition_.draw_buffers, attachment.point) != 0;
    });
}

}  // namespace wall::tileserver
