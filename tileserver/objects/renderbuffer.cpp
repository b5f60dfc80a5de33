// SPDX-License-Identifier: MIT
#include "tileserver/objects/renderbuffer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "tileserver/objects/driver_framebuffer.h"

namespace wall::tileserver {

Renderbuffer::Renderbuffer(ObjectAccount& account, Driver& driver)
    : ObjectOf(account), driver_(driver), gl_(driver.gl()) {
    gl_.CreateRenderbuffers(1, &name_);
}

Renderbuffer::~Renderbuffer() {
    restore();
    gl_.DeleteRenderbuffers(1, &name_);
}

bool Renderbuffer::enlarge(std::int32_t width, std::int32_t height) {
    const std::uint64_t bytes = kSampleBytes * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (kept_ != 0 || samples_ != 0 || width_ == 0 || !affords(bytes, 0)) return false;
    GLuint larger = 0;
    driver_.drain_errors();
    gl_.CreateRenderbuffers(1, &larger);
    gl_.NamedRenderbufferStorage(larger, internal_format_, width, height);
    kept_ = std::exchange(name_, larger);
    larger_bytes_ = bytes;
    renamed();
    if (driver_.drain_errors() == 0 && has_content(own_bytes() + larger_bytes_)) return true;
    restore();
    return false;
}

void Renderbuffer::restore() {
    if (kept_ == 0) return;
    gl_.DeleteRenderbuffers(1, &name_);
    name_ = std::exchange(kept_, 0);
    renamed();
    static_cast<void>(has_content(own_bytes()));  // less than before
}

std::uint64_t Renderbuffer::own_bytes() const {
    return kSampleBytes * std::max(samples_, 1u) * static_cast<std::uint64_t>(width_) *
           static_cast<std::uint64_t>(height_);
}

bool Renderbuffer::define(std::uint32_t samples, GLenum internal_format, std::int32_t width, std::int32_t height) {
    restore();
    driver_.drain_errors();
    gl_.NamedRenderbufferStorageMultisample(name_, static_cast<GLsizei>(samples), internal_format, width, height);
    const bool stored = driver_.drain_errors() == 0;
    width_ = stored ? width : 0;
    height_ = stored ? height : 0;
    samples_ = samples;
    internal_format_ = internal_format;
    renamed();  // framebuffers that it belongs to have another size
    if (width_ != 0 && height_ != 0) clear();
    return has_content(own_bytes());
}

GLenum Renderbuffer::point() const {
    GLint depth = 0, stencil = 0;
    gl_.GetNamedRenderbufferParameteriv(name_, GL_RENDERBUFFER_DEPTH_SIZE, &depth);
    gl_.GetNamedRenderbufferParameteriv(name_, GL_RENDERBUFFER_STENCIL_SIZE, &stencil);
    if (depth != 0) return stencil != 0 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
    return stencil != 0 ? GL_STENCIL_ATTACHMENT : GL_COLOR_ATTACHMENT0;
}

void Renderbuffer::read(std::int32_t first, std::int32_t rows, GLenum format, GLenum type, std::span<std::byte> to) {
    const DriverFramebuffer framebuffer(gl_);
    gl_.NamedFramebufferRenderbuffer(framebuffer.name(), point(), GL_RENDERBUFFER, name_);
    driver_.forget_target();
    driver_.neutral_pixel_transfer();
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl_.ReadnPixels(0, first, width_, rows, format, type, static_cast<GLsizei>(to.size()), to.data());
    driver_.drain_errors();
}

// By way of a texture of the same format, which takes pixels.
void Renderbuffer::write(std::int32_t first, std::int32_t rows, GLenum format, GLenum type,
                         std::span<const std::byte> from) {
    const DriverFramebuffer source(gl_), target(gl_);
    GLuint texture = 0;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &texture);
    driver_.neutral_pixel_transfer();
    driver_.bind_texture_to_edit(TextureTarget::t2d, texture);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format_), width_, rows, 0, format, type, from.data());
    gl_.NamedFramebufferTexture(source.name(), point(), texture, 0);
    gl_.NamedFramebufferRenderbuffer(target.name(), point(), GL_RENDERBUFFER, name_);
    driver_.disable_scissor();
    gl_.BlitNamedFramebuffer(source.name(), target.name(), 0, 0, width_, rows, 0, first, width_, first + rows,
                             buffers_at(point()), GL_NEAREST);
    driver_.forget_texture(texture);
    gl_.DeleteTextures(1, &texture);
    driver_.drain_errors();
}

/// The driver's memory may have been another session's.
void Renderbuffer::clear() {
    const DriverFramebuffer framebuffer(gl_);
    const GLuint to = framebuffer.name();
    const GLbitfield buffers = buffers_at(point());
    GLint kind = GL_NONE;
    gl_.NamedFramebufferRenderbuffer(to, point(), GL_RENDERBUFFER, name_);
    driver_.disable_scissor();
    constexpr std::array<GLint, 4> kZero{};
    constexpr std::array<GLfloat, 4> kZeroReal{};
    if (buffers & GL_COLOR_BUFFER_BIT) {
        gl_.GetNamedFramebufferAttachmentParameteriv(to, point(), GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE, &kind);
        if (kind == GL_INT || kind == GL_UNSIGNED_INT) gl_.ClearNamedFramebufferiv(to, GL_COLOR, 0, kZero.data());
        else gl_.ClearNamedFramebufferfv(to, GL_COLOR, 0, kZeroReal.data());
    }
    if (buffers & GL_DEPTH_BUFFER_BIT) gl_.ClearNamedFramebufferfv(to, GL_DEPTH, 0, kZeroReal.data());
    if (buffers & GL_STENCIL_BUFFER_BIT) gl_.ClearNamedFramebufferiv(to, GL_STENCIL, 0, kZero.data());
    driver_.drain_errors();
}

}  // namespace wall::tileserver
