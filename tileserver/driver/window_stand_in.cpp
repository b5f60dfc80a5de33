// SPDX-License-Identifier: MIT
#include "tileserver/driver/window_stand_in.h"

namespace wall::tileserver {

WindowStandIn::WindowStandIn(Driver& driver, std::uint32_t width, std::uint32_t height) : driver_(driver) {
    const Gl& gl = driver.gl();
    geometry_ = plain_geometry(static_cast<std::int32_t>(width), static_cast<std::int32_t>(height));
    gl.CreateRenderbuffers(1, &pixels_);
    gl.NamedRenderbufferStorage(pixels_, GL_R8, geometry_.area.width, geometry_.area.height);
    gl.CreateFramebuffers(1, &framebuffer_);
    gl.NamedFramebufferRenderbuffer(framebuffer_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixels_);
    driver.forget_target();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (driver.flip_y()) gl.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, 1);  // as layers
    complete_ = gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

WindowStandIn::~WindowStandIn() {
    driver_.forget_target();
    driver_.gl().DeleteFramebuffers(1, &framebuffer_);
    driver_.gl().DeleteRenderbuffers(1, &pixels_);
}

void WindowStandIn::bind(GLenum, GLenum) { driver_.gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }

}  // namespace wall::tileserver
