// SPDX-License-Identifier: MIT
#include "tileserver/objects/renderbuffer.h"

#include <algorithm>
#include <array>

namespace wall::tileserver {

Renderbuffer::Renderbuffer(ObjectAccount& account, Driver& driver)
    : ObjectOf(account), driver_(driver), gl_(driver.gl()) {
    gl_.CreateRenderbuffers(1, &name_);
}

Renderbuffer::~Renderbuffer() { gl_.DeleteRenderbuffers(1, &name_); }

bool Renderbuffer::define(std::uint32_t samples, GLenum internal_format, std::int32_t width, std::int32_t height) {
    driver_.drain_errors();
    gl_.NamedRenderbufferStorageMultisample(name_, static_cast<GLsizei>(samples), internal_format, width, height);
    const bool stored = driver_.drain_errors() == 0;
    width_ = stored ? width : 0;
    height_ = stored ? height : 0;
    renamed();  // framebuffers that it belongs to have another size
    if (width_ != 0 && height_ != 0) clear();
    return has_content(kSampleBytes * std::max(samples, 1u) * static_cast<std::uint64_t>(width_) *
                       static_cast<std::uint64_t>(height_));
}

/// The driver's memory may have been another session's.
void Renderbuffer::clear() {
    GLint depth = 0, stencil = 0, kind = GL_NONE;
    gl_.GetNamedRenderbufferParameteriv(name_, GL_RENDERBUFFER_DEPTH_SIZE, &depth);
    gl_.GetNamedRenderbufferParameteriv(name_, GL_RENDERBUFFER_STENCIL_SIZE, &stencil);
    const bool color = depth == 0 && stencil == 0;
    const GLenum point = color          ? GL_COLOR_ATTACHMENT0
                         : stencil == 0 ? GL_DEPTH_ATTACHMENT
                         : depth == 0   ? GL_STENCIL_ATTACHMENT
                                        : GL_DEPTH_STENCIL_ATTACHMENT;
    GLuint framebuffer = 0;
    gl_.CreateFramebuffers(1, &framebuffer);
    gl_.NamedFramebufferRenderbuffer(framebuffer, point, GL_RENDERBUFFER, name_);
    driver_.disable_scissor();
    constexpr std::array<GLint, 4> kZero{};
    constexpr std::array<GLfloat, 4> kZeroReal{};
    if (color) {
        gl_.GetNamedFramebufferAttachmentParameteriv(framebuffer, point, GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE,
                                                     &kind);
        if (kind == GL_INT || kind == GL_UNSIGNED_INT)
            gl_.ClearNamedFramebufferiv(framebuffer, GL_COLOR, 0, kZero.data());
        else gl_.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, kZeroReal.data());
    } else {
        if (depth != 0) gl_.ClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, kZeroReal.data());
        if (stencil != 0) gl_.ClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, kZero.data());
    }
    gl_.DeleteFramebuffers(1, &framebuffer);
    driver_.drain_errors();
}

}  // namespace wall::tileserver
