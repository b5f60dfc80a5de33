// SPDX-License-Identifier: MIT
// A program that shows a film: a picture over the whole window whose texture is written anew for every frame. Or, with
// --still, one picture, which is written once. It says how many frames a second it came to, and when the first one was
// done. Any GLX. `cinema --help` tells the options.
#include <GL/gl.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/gl_window.h"

namespace {

using Clock = std::chrono::steady_clock;

struct Size {
    unsigned width = 0, height = 0;
};

bool read_size(const std::string& text, Size& size) {
    return std::sscanf(text.c_str(), "%ux%u", &size.width, &size.height) == 2 && size.width > 0 && size.height > 0;
}

/// Every frame has another picture: a pattern that moves to the left, so that tiles differ and a missed frame shows.
void paint(std::vector<std::uint32_t>& pixels, const Size& size, unsigned frame) {
    for (unsigned y = 0; y < size.height; ++y)
        for (unsigned x = 0; x < size.width; ++x) {
            const std::uint32_t at = x + 3 * frame;
            pixels[std::size_t{y} * size.width + x] =
                0xff000000u | (at & 0xff) | ((at ^ y) & 0xff) << 8 | (y & 0xff) << 16;
        }
}

void draw() {
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 1), glVertex2f(-1, -1);
    glTexCoord2f(1, 1), glVertex2f(1, -1);
    glTexCoord2f(1, 0), glVertex2f(1, 1);
    glTexCoord2f(0, 0), glVertex2f(-1, 1);
    glEnd();
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Shows a film: writes a texture anew for every frame and draws it over the window.", "cinema");
    std::string window_text = "800x200", picture_text = "1920x1080";
    unsigned frames = 60;
    bool still = false;
    app.add_option("--window", window_text, "WIDTHxHEIGHT in pixels")->capture_default_str();
    app.add_option("--picture", picture_text, "WIDTHxHEIGHT in pixels, of four bytes each")->capture_default_str();
    app.add_option("--frames", frames, "ends behind so many; 0: never")->capture_default_str();
    app.add_flag("--still", still, "the picture is written once");
    CLI11_PARSE(app, argc, argv);
    Size size, picture;
    if (!read_size(window_text, size) || !read_size(picture_text, picture)) {
        std::fputs("cinema: --window and --picture are WIDTHxHEIGHT, as in 1920x1080\n", stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, 0};
    wall::bench::GlWindow window("cinema", size.width, size.height, kAttributes);
    if (!window.current()) return 1;
    glViewport(0, 0, static_cast<GLsizei>(size.width), static_cast<GLsizei>(size.height));
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const auto width = static_cast<GLsizei>(picture.width), height = static_cast<GLsizei>(picture.height);
    std::vector<std::uint32_t> pixels(std::size_t{picture.width} * picture.height);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);

    const auto begin = Clock::now();
    auto second = begin;
    for (unsigned frame = 0; frames == 0 || frame < frames; ++frame) {
        if (!still || frame == 0) {
            paint(pixels, picture, frame);
            glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        }
        draw();
        window.swap();
        if (frame > 0) continue;
        std::vector<std::uint32_t> row(size.width);  // which all of a wall's nodes have a part of
        glReadPixels(0, 0, static_cast<GLsizei>(size.width), 1, GL_RGBA, GL_UNSIGNED_BYTE, row.data());
        std::printf("first frame after %.3f s\n", seconds_since(begin));
        std::fflush(stdout);
        second = Clock::now();
    }
    glFinish();
    if (frames > 1) std::printf("%.2f frames/s\n", (frames - 1) / seconds_since(second));
    return 0;
}
