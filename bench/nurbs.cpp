// SPDX-License-Identifier: MIT
// Surfaces as animators have them: 102 bicubic patches that move, each cut anew into 1,800 triangles in strips in every
// frame, in immediate mode (W4.2, "Nurbs"). Any GLX. `nurbs --help` tells the options; bench/scaling.py measures it.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bench/gl_window.h"

namespace {

constexpr int kColumns = 17, kRows = 6;  // of patches: 102
constexpr int kSteps = 30;               // along each side: 2 * 30 * 30 = 1,800 triangles
constexpr int kControl = 4;              // points a side

struct Options {
    int frames = 60;
    int width = 800, height = 600;
};

using Weights = std::array<float, kControl>;

Weights bernstein(float t) {
    const float s = 1 - t;
    return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}
Weights slopes(float t) {
    const float s = 1 - t;
    return {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t};
}

/// A patch of a sheet that covers the window: what its control points are high.
struct Patch {
    float left, bottom, width, height;
    std::array<Weights, kControl> heights;

    Patch(int column, int row, float time) {
        width = 2.0f / kColumns, height = 2.0f / kRows;
        left = -1 + width * static_cast<float>(column), bottom = -1 + height * static_cast<float>(row);
        for (int v = 0; v < kControl; ++v)
            for (int u = 0; u < kControl; ++u) {
                const float x = left + width * static_cast<float>(u) / 3,
                            y = bottom + height * static_cast<float>(v) / 3;
                heights[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)] =
                    0.1f * std::sin(7 * x + time) * std::cos(5 * y - time);
            }
    }
    float sum(const Weights& u, const Weights& v) const {
        float out = 0;
        for (std::size_t i = 0; i < kControl; ++i)
            for (std::size_t k = 0; k < kControl; ++k) out += v[i] * u[k] * heights[i][k];
        return out;
    }
    void vertex(int column, int row) const {
        const float u = static_cast<float>(column) / kSteps, v = static_cast<float>(row) / kSteps;
        const Weights wu = bernstein(u), wv = bernstein(v);
        glNormal3f(-sum(slopes(u), wv) / width, -sum(wu, slopes(v)) / height, 1);
        glVertex3f(left + width * u, bottom + height * v, sum(wu, wv));
    }
    void draw() const {
        for (int row = 0; row < kSteps; ++row) {
            glBegin(GL_TRIANGLE_STRIP);
            for (int column = 0; column <= kSteps; ++column) vertex(column, row + 1), vertex(column, row);
            glEnd();
        }
    }
};

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0; };
        if (is("--frames") && i + 1 < argc) o.frames = std::atoi(argv[++i]);
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
            "usage: nurbs [--frames N] [--size WxH]\n"
            "Draws N frames of 102 lit patches, 183,600 triangles in strips, and prints frames/s.\n",
            stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, 0};
    wall::bench::GlWindow window("nurbs", static_cast<unsigned>(o.width), static_cast<unsigned>(o.height), kAttributes);
    if (!window.current()) return 1;

    glViewport(0, 0, o.width, o.height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_NORMALIZE);
    glEnable(GL_COLOR_MATERIAL);
    const auto start = std::chrono::steady_clock::now();
    for (int frame = 0; frame < o.frames; ++frame) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                glColor3f(0.3f + 0.04f * static_cast<float>(column), 0.5f, 1 - 0.1f * static_cast<float>(row));
                Patch(column, row, 0.05f * static_cast<float>(frame)).draw();
            }
        window.swap();
    }
    glFinish();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::printf("%.2f frames/s\n", o.frames / took.count());
    return 0;
}
