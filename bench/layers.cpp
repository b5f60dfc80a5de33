// SPDX-License-Identifier: MIT
// A program that draws over the same pixels again and again: sheets that each cover the whole window, wave through each
// other in depth, and are kept in buffers. Any GLX. `layers --help` tells the options; bench/compose.py has several
// nodes draw it.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/gl_window.h"

namespace {

constexpr int kColumns = 96, kRows = 54;  // squares of a sheet

struct Vertex {
    float x, y, z;
    float r, g, b;
};

/// In the order of two triangles a square.
std::vector<Vertex> sheet(int number) {
    const auto corner = [number](int column, int row) {
        const float x = 2.0f * static_cast<float>(column) / kColumns - 1,
                    y = 2.0f * static_cast<float>(row) / kRows - 1;
        const float turn = 1.7f * static_cast<float>(number);
        const float wave = std::sin(7 * x + turn) * std::cos(5 * y - turn);
        return Vertex{
            x, y, 0.8f * wave, 0.5f + 0.5f * std::sin(turn), 0.5f + 0.5f * wave, 0.5f + 0.5f * std::cos(turn + x)};
    };
    std::vector<Vertex> out;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            for (const auto& [right, up] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
                out.push_back(corner(column + right, row + up));
    return out;
}

GLuint keep(const std::vector<Vertex>& vertices) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(GL_ARRAY_BUFFER, name);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                 GL_STATIC_DRAW);
    return name;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Draws sheets over each other that each cover the window.", "layers");
    int sheets = 8, frames = 0;
    std::string size = "480x270";
    app.add_option("--sheets", sheets)->capture_default_str()->check(CLI::Range(1, 1000));
    app.add_option("--size", size, "WIDTHxHEIGHT of the window, in pixels")->capture_default_str();
    app.add_option("--frames", frames, "ends behind so many; 0: never")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    unsigned width = 0, height = 0;
    if (std::sscanf(size.c_str(), "%ux%u", &width, &height) != 2 || width == 0 || height == 0) {
        std::fputs("layers: --size is WIDTHxHEIGHT, as in 480x270\n", stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, 0};
    wall::bench::GlWindow window("layers", width, height, kAttributes);
    if (!window.current()) return 1;
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glEnable(GL_DEPTH_TEST);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    std::vector<GLuint> buffers;
    for (int i = 0; i < sheets; ++i) buffers.push_back(keep(sheet(i)));
    for (int frame = 0; frames == 0 || frame < frames; ++frame) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glRotatef(0.01f, 0, 0, 1);
        for (const GLuint buffer : buffers) {
            glBindBuffer(GL_ARRAY_BUFFER, buffer);
            glVertexPointer(3, GL_FLOAT, sizeof(Vertex), nullptr);
            glColorPointer(3, GL_FLOAT, sizeof(Vertex), reinterpret_cast<const void*>(offsetof(Vertex, r)));
            glDrawArrays(GL_TRIANGLES, 0, 6 * kColumns * kRows);
        }
        window.swap();
    }
    return 0;
}
