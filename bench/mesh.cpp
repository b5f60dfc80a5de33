// SPDX-License-Identifier: MIT
// A mesh of many small triangles in immediate mode, one glBegin for all of it or one for each strip: what a
// simulation's surface looks like to the packer. Or compiled into a display list once. Any GLX. `mesh --help` tells the
// options; bench/mesh.py measures it on a wall.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bench/gl_window.h"

namespace {

struct Options {
    int columns = 187, rows = 94;  // 2 * 187 * 94 = 35,156 triangles
    int frames = 60;
    int width = 800, height = 600;
    bool strips = false, list = false;
};

void vertex(const Options& o, int column, int row, float time) {
    const float x = 2.0f * static_cast<float>(column) / static_cast<float>(o.columns) - 1;
    const float y = 2.0f * static_cast<float>(row) / static_cast<float>(o.rows) - 1;
    const float slope = 0.4f * std::cos(6 * x + time);
    glNormal3f(-slope, 0.2f * y, 1);
    glVertex3f(x, y, 0.1f * std::sin(6 * x + time) * std::cos(4 * y));
}

void draw_triangles(const Options& o, float time) {
    glBegin(GL_TRIANGLES);
    for (int row = 0; row < o.rows; ++row) {
        for (int column = 0; column < o.columns; ++column) {
            vertex(o, column, row, time), vertex(o, column + 1, row, time), vertex(o, column, row + 1, time);
            vertex(o, column + 1, row, time), vertex(o, column + 1, row + 1, time), vertex(o, column, row + 1, time);
        }
    }
    glEnd();
}

void draw_strips(const Options& o, float time) {
    for (int row = 0; row < o.rows; ++row) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int column = 0; column <= o.columns; ++column)
            vertex(o, column, row + 1, time), vertex(o, column, row, time);
        glEnd();
    }
}

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0; };
        if (is("--strips")) o.strips = true;
        else if (is("--list")) o.list = true;
        else if (is("--frames") && i + 1 < argc) o.frames = std::atoi(argv[++i]);
        else if (is("--size") && i + 1 < argc && std::sscanf(argv[++i], "%dx%d", &o.width, &o.height) == 2) continue;
        else return false;
    }
    return o.frames > 0 && o.width > 0 && o.height > 0;
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (!parse(argc, argv, o)) {
        std::fputs(
            "usage: mesh [--strips] [--list] [--frames N] [--size WxH]\n"
            "Draws N frames of a lit mesh of 35,156 triangles (one glBegin, or one strip a row) and prints frames/s.\n"
            "--list: from a display list, always the same.\n",
            stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, 0};
    wall::bench::GlWindow window("mesh", static_cast<unsigned>(o.width), static_cast<unsigned>(o.height), kAttributes);
    if (!window.current()) return 1;

    glViewport(0, 0, o.width, o.height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_NORMALIZE);
    const auto draw = [&](float time) { o.strips ? draw_strips(o, time) : draw_triangles(o, time); };
    if (o.list) {
        glNewList(1, GL_COMPILE);
        draw(0);
        glEndList();
    }
    const auto start = std::chrono::steady_clock::now();
    for (int frame = 0; frame < o.frames; ++frame) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        if (o.list) glCallList(1);
        else draw(0.05f * static_cast<float>(frame));
        window.swap();
    }
    glFinish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%d frames in %.2f s: %.1f frames/s\n", o.frames, seconds.count(), o.frames / seconds.count());
}
