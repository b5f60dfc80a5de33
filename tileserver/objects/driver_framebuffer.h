// SPDX-License-Identifier: MIT
// A framebuffer of the driver for a moment, to copy between images. Render thread.
#pragma once

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

class DriverFramebuffer {
public:
    explicit DriverFramebuffer(const Gl& gl) : gl_(gl) { gl_.CreateFramebuffers(1, &name_); }
    ~DriverFramebuffer() { gl_.DeleteFramebuffers(1, &name_); }
    DriverFramebuffer(const DriverFramebuffer&) = delete;
    GLuint name() const { return name_; }

private:
    const Gl& gl_;
    GLuint name_ = 0;
};

/// What glBlitFramebuffer calls the buffers of an attachment point.
inline GLbitfield buffers_at(GLenum point) {
    switch (point) {
        case GL_DEPTH_ATTACHMENT: return GL_DEPTH_BUFFER_BIT;
        case GL_STENCIL_ATTACHMENT: return GL_STENCIL_BUFFER_BIT;
        case GL_DEPTH_STENCIL_ATTACHMENT: return GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
        default: return GL_COLOR_BUFFER_BIT;
    }
}

}  // namespace wall::tileserver
