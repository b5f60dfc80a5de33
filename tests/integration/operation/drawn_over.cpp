// SPDX-License-Identifier: MIT
// A program that draws its picture in its first frame, and then never clears its window: each frame lays a ground
// behind what is there, by depth. The picture is the same from the second frame on, as long as the window keeps its
// colours and depths; what has been lost of either is seen.
//
// drawn_over [--size WxH] [--samples N] [--stencil 0|1]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "tests/golden/programs/window.h"

namespace {

constexpr auto kFrame = std::chrono::milliseconds(50);

void quad(float x, float y, float size, float z) {
    glBegin(GL_QUADS);
    glVertex3f(x, y, z), glVertex3f(x + size, y, z), glVertex3f(x + size, y + size, z), glVertex3f(x, y + size, z);
    glEnd();
}

/// Squares of many colours at many depths, nearer than the ground.
void draw_squares() {
    for (int i = 0; i < 60; ++i) {
        glColor3f(static_cast<float>(i * 7 % 60) / 59, static_cast<float>(i * 13 % 60) / 59,
                  static_cast<float>(i) / 59);
        quad(static_cast<float>(i * 37 % 100) / 50 - 1, static_cast<float>(i * 61 % 100) / 50 - 1, 0.3f,
             static_cast<float>(i * 29 % 60) / 60 - 0.6f);
    }
}

/// Where nothing is; and with stencil values, but once a pixel.
void draw_ground(bool stencil) {
    if (stencil) {
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_EQUAL, 0, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    }
    glColor3f(0.1f, 0.3f, 0.6f);
    quad(-1, -1, 2, 0.5f);
    glDisable(GL_STENCIL_TEST);
    glColor3f(0.8f, 0.2f, 0.1f);
    quad(-1, -1, 2, 0.7f);
}

}  // namespace

int main(int argc, char** argv) {
    golden::Size size{400, 300};
    golden::Needs needs;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        if (name == "--size") std::sscanf(argv[i + 1], "%dx%d", &size.width, &size.height);
        if (name == "--samples") needs.samples = std::atoi(argv[i + 1]);
        if (name == "--stencil") needs.stencil = std::atoi(argv[i + 1]) != 0;
    }
    const auto window = golden::Window::by_glx(size, needs);
    glEnable(GL_DEPTH_TEST);
    for (bool first = true;; first = false) {
        if (first) {
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            draw_squares();
        }
        draw_ground(needs.stencil);
        window->swap();
        std::this_thread::sleep_for(kFrame);
    }
}
