// SPDX-License-Identifier: MIT
#include "tileserver/driver/pixelless_target.h"

namespace wall::tileserver {

PixellessTarget::PixellessTarget(Driver& driver, std::uint32_t width, std::uint32_t height) : driver_(driver) {
    const Gl& gl = driver.gl();
    geometry_ = plain_geometry(static_cast<std::int32_t>(width), static_cast<std::int32_t>(height));
    gl.CreateFramebuffers(1, &framebuffer_);
    gl.NamedFramebufferParameteri(framebuffer_, GL_FRAMEBUFFER_DEFAULT_WIDTH, static_cast<GLint>(width));
    gl.NamedFramebufferParameteri(framebuffer_, GL_FRAMEBUFFER_DEFAULT_HEIGHT, static_cast<GLint>(height));
    driver.forget_target();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (driver.flip_y()) gl.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, 1);  // as layers
    complete_ = gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

PixellessTarget::~PixellessTarget() {
    driver_.forget_target();
    driver_.gl().DeleteFramebuffers(1, &framebuffer_);
}

void PixellessTarget::bind(GLenum, GLenum) { driver_.gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }

}  // namespace wall::tileserver
