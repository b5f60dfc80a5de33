// SPDX-License-Identifier: MIT
// A program whose picture tells which frame it shows: the whole window has one colour, made from the frame's number. So
// a tile that shows another frame than its neighbours, or half a frame, is seen in a screenshot.
//
// frame_clock [--size WxH] [--vertices N] [--fps N] [--incremental] [--egl]     runs until it is ended
//   --vertices: so many vertices a frame, in triangles of the same colour
//   --fps: frames a second on the average; without it as many as possible
//   --incremental: clears only once, so each frame builds on the one before
#include <GL/gl.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/golden/programs/window.h"

namespace {

struct Options {
    golden::Size size{400, 300};
    int vertices = 6, fps = 0;
    bool incremental = false, egl = false;
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--incremental") == 0) options.incremental = true;
        if (std::strcmp(argv[i], "--egl") == 0) options.egl = true;
        if (i + 1 == argc) continue;
        if (std::strcmp(argv[i], "--size") == 0)
            std::sscanf(argv[i + 1], "%dx%d", &options.size.width, &options.size.height);
        if (std::strcmp(argv[i], "--fps") == 0) options.fps = std::atoi(argv[i + 1]);
        if (std::strcmp(argv[i], "--vertices") == 0) options.vertices = std::atoi(argv[i + 1]);
    }
    return options;
}

/// Red and green: the number's low 16 bits. Blue: full, so that it is no background.
void draw(unsigned frame, int vertices) {
    glBegin(GL_TRIANGLES);
    glColor3ub(static_cast<GLubyte>(frame), static_cast<GLubyte>(frame >> 8), 255);
    for (const float side : {-1.0f, 1.0f}) {
        glVertex2f(-1, -1);
        glVertex2f(1, 1);
        glVertex2f(side, -side);
    }
    for (int i = 6; i < vertices; ++i) {
        const auto at = static_cast<float>(i / 3);
        const float corner = static_cast<float>(i % 3) * 2.1f;
        glVertex2f(0.9f * std::sin(at) + 0.01f * std::sin(corner),
                   0.9f * std::cos(at * 1.7f) + 0.01f * std::cos(corner));
    }
    glEnd();
}

}  // namespace

int main(int argc, char** argv) {
    const Options options = parse(argc, argv);
    const auto window =
        options.egl ? golden::Window::by_egl(options.size, {}) : golden::Window::by_glx(options.size, {});
    const auto start = std::chrono::steady_clock::now();
    for (unsigned frame = 1;; ++frame) {
        if (options.fps != 0)
            std::this_thread::sleep_until(start + std::chrono::milliseconds(1000) * frame / options.fps);
        if (frame == 1 || !options.incremental) glClear(GL_COLOR_BUFFER_BIT);
        draw(frame, options.vertices);
        window->swap();
    }
}
