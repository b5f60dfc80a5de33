// SPDX-License-Identifier: MIT
// A program that draws a picture into a texture once, and shows it in every frame until it is ended: what it shows,
// only the nodes have. Also a second texture that it changes in part from memory after it was drawn, mipmaps, and a
// renderbuffer.
//
// drawn_once [--size WxH] [--anew-at N]   --anew-at: draws the picture again in frame N
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "tests/golden/programs/window.h"

namespace {

constexpr int kTexels = 256;
constexpr auto kFrame = std::chrono::milliseconds(50);

GLuint make_texture() {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kTexels, kTexels, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

void quad(float x0, float y0, float x1, float y1) {
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(x0, y0);
    glTexCoord2f(1, 0), glVertex2f(x1, y0);
    glTexCoord2f(1, 1), glVertex2f(x1, y1);
    glTexCoord2f(0, 1), glVertex2f(x0, y1);
    glEnd();
}

/// Squares of many colours, one over the other, in the framebuffer that is bound.
void draw_squares() {
    glViewport(0, 0, kTexels, kTexels);
    glClearColor(0.1f, 0.2f, 0.3f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_TEXTURE_2D);
    for (int i = 0; i < 60; ++i) {
        const float x = static_cast<float>(i * 37 % 100) / 50 - 1, y = static_cast<float>(i * 61 % 100) / 50 - 1;
        glColor3f(static_cast<float>(i * 7 % 10) / 9, static_cast<float>(i * 3 % 10) / 9,
                  static_cast<float>(i % 10) / 9);
        quad(x, y, x + 0.3f, y + 0.3f);
    }
}

void draw_picture(GLuint framebuffer, GLuint texture) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    draw_squares();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glGenerateMipmap(GL_TEXTURE_2D);
}

void change_part(GLuint texture) {
    std::array<GLubyte, 40 * 40 * 4> part{};
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<GLubyte>(i * 13);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 100, 100, 40, 40, GL_RGBA, GL_UNSIGNED_BYTE, part.data());
}

void show(GLuint texture, float x0, float y0, float x1, float y1) {
    glBindTexture(GL_TEXTURE_2D, texture);
    quad(x0, y0, x1, y1);
}

/// A framebuffer whose picture is in a renderbuffer.
GLuint make_renderbuffer() {
    GLuint framebuffer = 0, renderbuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &renderbuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kTexels, kTexels);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
    return framebuffer;
}

/// Copies a part of it to the same part of the window.
void show_renderbuffer(GLuint framebuffer) {
    constexpr int kFrom = 20, kTo = 150;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(kFrom, kFrom, kTo, kTo, kFrom, kFrom, kTo, kTo, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

}  // namespace

int main(int argc, char** argv) {
    golden::Size size{400, 300};
    int anew_at = -1;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (std::string(argv[i]) == "--size") std::sscanf(argv[i + 1], "%dx%d", &size.width, &size.height);
        if (std::string(argv[i]) == "--anew-at") anew_at = std::atoi(argv[i + 1]);
    }
    const auto window = golden::Window::by_glx(size, {});
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    const GLuint whole = make_texture(), changed = make_texture(), renderbuffer = make_renderbuffer();
    for (int frame = 0;; ++frame) {
        if (frame == 0 || frame == anew_at) {
            draw_picture(framebuffer, whole);
            draw_picture(framebuffer, changed);
            change_part(changed);
            glBindFramebuffer(GL_FRAMEBUFFER, renderbuffer);
            draw_squares();
            glBindFramebuffer(GL_FRAMEBUFFER, 0);
        }
        glViewport(0, 0, size.width, size.height);
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glColor3f(1, 1, 1);
        glEnable(GL_TEXTURE_2D);
        show(whole, -1, -1, 0.2f, 1);
        show(changed, 0.2f, -1, 1, 0.5f);
        show(whole, 0.4f, 0.6f, 0.7f, 0.9f);  // from the mipmaps
        show_renderbuffer(renderbuffer);
        window->swap();
        std::this_thread::sleep_for(kFrame);
    }
}
