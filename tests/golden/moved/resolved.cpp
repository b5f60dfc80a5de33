// SPDX-License-Identifier: MIT
#include "tests/golden/moved/resolved.h"

namespace golden::moved {
namespace {

bool of_colors(GLenum format) {
    return format != GL_DEPTH_COMPONENT && format != GL_STENCIL_INDEX && format != GL_DEPTH_STENCIL;
}

}  // namespace

Resolved::Resolved(int width, int height, GLenum format) {
    if (!of_colors(format) || width <= 0 || height <= 0) return;
    const auto drawn = static_cast<GLuint>(integer(GL_DRAW_FRAMEBUFFER_BINDING));
    mesa().BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    if (integer(GL_SAMPLES) != 0) blit(width, height);
    mesa().BindFramebuffer(GL_DRAW_FRAMEBUFFER, drawn);
    if (framebuffer_ != 0) mesa().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
}

Resolved::~Resolved() {
    if (framebuffer_ == 0) return;
    mesa().BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    mesa().DeleteFramebuffers(1, &framebuffer_);
    mesa().DeleteRenderbuffers(1, &renderbuffer_);
}

void Resolved::blit(int width, int height) {
    const auto bound = static_cast<GLuint>(integer(GL_RENDERBUFFER_BINDING));
    const bool scissor = mesa().IsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
    mesa().GenRenderbuffers(1, &renderbuffer_);
    mesa().BindRenderbuffer(GL_RENDERBUFFER, renderbuffer_);
    mesa().RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    mesa().BindRenderbuffer(GL_RENDERBUFFER, bound);
    mesa().GenFramebuffers(1, &framebuffer_);
    mesa().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    mesa().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer_);
    if (scissor) mesa().Disable(GL_SCISSOR_TEST);
    mesa().BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    if (scissor) mesa().Enable(GL_SCISSOR_TEST);
}

}  // namespace golden::moved
