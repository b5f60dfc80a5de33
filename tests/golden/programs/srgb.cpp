// SPDX-License-Identifier: MIT
// Windows that are drawn to by the curve of sRGB while GL_FRAMEBUFFER_SRGB is on; of OpenGL ES, where they were asked
// for, always.
#include <array>
#include <utility>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr Needs kUnasked{.srgb = true}, kAsked{.srgb = true, .asks_srgb = true};

void say_of_the_window() {
    GLint encoding = -1, capable = -1;
    glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_BACK_LEFT, GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING,
                                          &encoding);
    glGetIntegerv(GL_FRAMEBUFFER_SRGB_CAPABLE_EXT, &capable);
    say("encoding %x, capable %d", encoding, capable);
    say_error("of the window");
}

/// Colours from dark to bright, over tiles' borders.
void ramp(float y, float height) {
    glBegin(GL_QUAD_STRIP);
    for (int i = 0; i <= 12; ++i) {
        const float s = static_cast<float>(i) / 12;
        glColor4f(s, 0.5f * s, 1 - s, 0.3f + 0.5f * s);
        glVertex2f(2 * s - 1, y);
        glVertex2f(2 * s - 1, y + height);
    }
    glEnd();
}

void blended(float y) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    ramp(y, 0.3f);
    glDisable(GL_BLEND);
}

void on_and_off(int frame) {
    glEnable(GL_FRAMEBUFFER_SRGB);
    clear(0.2f, 0.05f, 0.4f);
    ramp(-0.9f, 0.4f);
    blended(-0.7f);
    glDisable(GL_FRAMEBUFFER_SRGB);
    ramp(0.1f, 0.4f);
    blended(0.3f + 0.05f * static_cast<float>(frame));
}

}  // namespace

SCENE(srgb_window, 3, kAsked) {
    if (frame == 0) say_of_the_window();
    on_and_off(frame);
}

SCENE(srgb_window_unasked, 2, kUnasked) {
    if (frame == 0) say_of_the_window();
    on_and_off(frame);
}

SCENE(srgb_images, 3, kAsked) {  // frame 2: without the curve
    std::vector<std::array<unsigned char, 4>> pixels;
    for (unsigned i = 0; i < 100 * 60; ++i)
        pixels.push_back({static_cast<unsigned char>(i % 100 * 2), static_cast<unsigned char>(i / 100 * 4), 90, 255});
    if (frame < 2) glEnable(GL_FRAMEBUFFER_SRGB);
    clear(0.1f, 0.1f, 0.1f);
    glWindowPos2i(canvas.width / 2 - 50, 20);
    glDrawPixels(100, 60, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glWindowPos2i(20, 100);
    glCopyPixels(canvas.width / 2 - 50, 20, 100, 60, GL_COLOR);
    say_error("images");
    glDisable(GL_FRAMEBUFFER_SRGB);
}

SCENE(srgb_blits, 4, kAsked) {
    static std::array<GLuint, 2> framebuffers, renderbuffers;
    if (framebuffers[0] == 0) {
        glGenFramebuffers(2, framebuffers.data());
        glGenRenderbuffers(2, renderbuffers.data());
        for (std::size_t i = 0; i < 2; ++i) {
            glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[i]);
            glRenderbufferStorage(GL_RENDERBUFFER, i == 0 ? GL_RGBA8 : GL_SRGB8_ALPHA8, 120, 90);
            glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[i]);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffers[i]);
        }
    }
    if (frame % 2 == 1) glEnable(GL_FRAMEBUFFER_SRGB);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    clear(0.1f, 0.1f, 0.4f);
    ramp(-0.95f, 0.3f);
    for (int i = 0; i < 2; ++i) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[static_cast<std::size_t>(i)]);
        glViewport(0, 0, 120, 90);
        clear(0.3f, 0, 0.3f);
        ramp(-0.5f, 1);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        const int x = 140 * i + 13, y = 107;
        glBlitFramebuffer(0, 0, 120, 90, x, y, x + 120, y + 90, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glDisable(GL_FRAMEBUFFER_SRGB);
        glBlitFramebuffer(0, 0, 120, 90, x, 50, x + 40, 80, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        if (frame % 2 == 1) glEnable(GL_FRAMEBUFFER_SRGB);
    }
    say_error("blits");
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    glDisable(GL_FRAMEBUFFER_SRGB);
}

SCENE(srgb_copies, 3, kAsked) {  // the same texels, whether they are copied with or without the curve
    glEnable(GL_FRAMEBUFFER_SRGB);
    clear(0.2f, 0.05f, 0.4f);
    ramp(-0.9f, 0.5f);
    if (frame == 1) glDisable(GL_FRAMEBUFFER_SRGB);
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, frame == 2 ? GL_SRGB8_ALPHA8 : GL_RGBA8, 60, 0, 128, 64, 0);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glBegin(GL_QUADS);
    for (const auto& [s, t] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
        glTexCoord2f(s, t);
        glVertex2f(s - 0.5f, 0.9f * t);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glDeleteTextures(1, &texture);
    glDisable(GL_FRAMEBUFFER_SRGB);
}

SCENE(srgb_single_buffered, 2, {.double_buffered = false, .srgb = true, .asks_srgb = true, .read = GL_FRONT}) {
    on_and_off(frame);
}

SCENE(srgb_samples, 3, {.samples = 4, .srgb = true, .asks_srgb = true}) { on_and_off(frame); }

SCENE(srgb_egl, 2, {.egl = true, .srgb = true, .asks_srgb = true}) {
    if (frame == 0) say_of_the_window();
    on_and_off(frame);
}

namespace {

/// Without a program: parts of the window, cleared.
void cleared_parts(int frame) {
    glClearColor(0.2f, 0.05f, 0.4f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 16; ++i) {
        const float s = static_cast<float>(i) / 15;
        glScissor(20 * i, 10 * i + frame, 30, 60);
        glClearColor(s, 0.5f * s, 1 - s, s);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace

SCENE(srgb_es3, 2, {.es = 3, .srgb = true, .asks_srgb = true}) { cleared_parts(frame); }

SCENE(srgb_es3_unasked, 2, {.es = 3, .srgb = true}) { cleared_parts(frame); }

}  // namespace golden
