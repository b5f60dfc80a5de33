// SPDX-License-Identifier: MIT
// A framebuffer object as the application defined it (OpenGL 4.6, chapter 9): which images are drawn to. Belongs to one
// context; used by its thread, its images under the share group's mutex.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "client_lib/objects/drawn_target.h"
#include "client_lib/objects/renderbuffer.h"
#include "client_lib/objects/texture.h"
#include "common/glstate/framebuffer.h"

namespace wall::client {

/// What is attached at one point: an image of a texture, or a renderbuffer.
struct Attachment {
    std::shared_ptr<Texture> texture;
    std::shared_ptr<Renderbuffer> renderbuffer;
    GLenum target = GL_NONE;  ///< of a texture: the image target, such as a cube map's face
    GLint level = 0, layer = 0;
    bool layered = false;  ///< all layers, or faces; `target` is the texture's own then

    bool present() const { return texture || renderbuffer; }
    const Object* object() const;
    /// The texture's image, the first of several; null: it has none there.
    TextureLevel* image() const;
    bool operator==(const Attachment&) const = default;
};

/// An attached image as it is drawn to.
struct ImageShape {
    std::uint32_t width = 0, height = 0, samples = 0;
    const TextureFormat* format = nullptr;
    ComponentBits bits{};
};
/// Nothing: there is no image.
std::optional<ImageShape> shape_of(const Attachment& attachment);

class Framebuffer final : public Object, public DrawnTarget, public std::enable_shared_from_this<Framebuffer> {
public:
    /// `es`: the version of OpenGL ES, times ten, which says what may be drawn to; 0: of OpenGL.
    explicit Framebuffer(GLuint own_name, unsigned es = 0) : Object(next_object_id(), own_name), es_(es) {}

    const Attachment& at(unsigned place) const { return attachments_[place]; }
    /// Places as of glstate::attachment_place().
    void attach(unsigned place, Attachment attachment);
    const std::array<GLenum, glstate::kColorAttachments>& draw_buffers() const { return draw_buffers_; }
    void set_draw_buffers(const std::array<GLenum, glstate::kColorAttachments>& buffers);
    GLenum read_buffer() const { return read_buffer_; }
    void set_read_buffer(GLenum buffer);

    const glstate::FramebufferDefaults& defaults() const { return defaults_; }
    void set_defaults(const glstate::FramebufferDefaults& defaults);

    /// GL_FRAMEBUFFER_COMPLETE, or why not, as Mesa decides it (OpenGL 4.6, 9.4.2; what GL_ARB_framebuffer_object and
    /// GL_ARB_ES2_compatibility say). The share group's mutex is held.
    GLenum status() const;
    /// Of the image that the read buffer, any draw buffer, the first one names. Nothing: none. The share group's mutex
    /// is held.
    std::optional<ImageShape> read_shape() const;
    std::optional<ImageShape> draw_shape() const;
    std::optional<ImageShape> first_draw_shape() const { return named_shape(draw_buffers_[0]); }
    std::optional<ImageShape> depth_shape() const { return shape_of(attachments_[glstate::kColorAttachments]); }
    std::optional<ImageShape> stencil_shape() const { return shape_of(attachments_[glstate::kColorAttachments + 1]); }
    /// Samples of each pixel; 0: one, and it is not multisampled.
    std::uint32_t samples() const;

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    ClientName target_id() const override { return id; }
    std::uint32_t width() const override { return size(&ImageShape::width).value_or(defaults_.width); }
    std::uint32_t height() const override { return size(&ImageShape::height).value_or(defaults_.height); }
    void for_each_image(const std::function<void(const Object&)>& use) const override;
    void note_drawn() override;
    std::uint64_t defined() const override { return stamp_; }
    bool has_plain_images() const override;
    bool may_be_larger() const override;
    /// Its colours or depths were cleared, or something was copied over all of it. Its textures know who draws them
    /// from then on. The share group's mutex is held.
    void note_redrawn();
    /// Samples were made pixels of there, for which both must have the same size.
    void note_resolved() { resolved_ = true; }

private:
    std::optional<std::uint32_t> size(std::uint32_t ImageShape::*side) const;
    std::optional<ImageShape> named_shape(GLenum buffer) const;
    GLenum attachment_error(unsigned place) const;
    bool mixes_layers() const;
    bool renderable(unsigned place, const TextureFormat& format) const;

    const unsigned es_;
    std::array<Attachment, glstate::kAttachmentPoints> attachments_;
    std::array<GLenum, glstate::kColorAttachments> draw_buffers_{GL_COLOR_ATTACHMENT0};
    GLenum read_buffer_ = GL_COLOR_ATTACHMENT0;
    bool resolved_ = false;
    glstate::FramebufferDefaults defaults_;
    std::uint64_t stamp_ = next_stamp();
};

}  // namespace wall::client
