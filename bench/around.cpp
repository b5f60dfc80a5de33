// SPDX-License-Identifier: MIT
// A band of triangles all around the eye, in which the camera turns slowly: what tiles that look elsewhere share among
// each other (docs/walls.md, "Views"). Any GLX. `around --help` tells the options; bench/views.py measures it on a
// wall.
#define GL_GLEXT_PROTOTYPES 1  // NOLINT: before the first GL header
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "bench/gl_window.h"

namespace {

constexpr int kRows = 60;        // of quads, from the lower edge to the upper one
constexpr float kHeight = 1.2f;  // of the band, at a distance of 5: well within a field of view of 30 degrees

struct Options {
    int triangles = 200'000, frames = 40, width = 400, height = 300;
    std::string how = "immediate";
};

struct Vertex {
    float normal[3], place[3];
};

/// Columns of quads; the first column follows the last.
struct Band {
    explicit Band(int triangles) : columns(std::max(8, triangles / 2 / kRows)) {
        for (int column = 0; column <= columns; ++column)
            for (int row = 0; row <= kRows; ++row) {
                const float angle =
                    2 * std::numbers::pi_v<float> * static_cast<float>(column) / static_cast<float>(columns);
                const float up = kHeight * (2 * static_cast<float>(row) / kRows - 1);
                const float reach = 5 + 0.2f * std::sin(40 * angle) * std::cos(9 * up);
                vertices.push_back(
                    {{-std::sin(angle), 0, std::cos(angle)}, {reach * std::sin(angle), up, -reach * std::cos(angle)}});
            }
    }
    const Vertex& at(int column, int row) const {
        return vertices[static_cast<std::size_t>(column * (kRows + 1) + row)];
    }
    int columns;
    std::vector<Vertex> vertices;
};

void draw_column(const Band& band, int column) {
    glBegin(GL_TRIANGLE_STRIP);
    for (int row = 0; row <= kRows; ++row)
        for (const int beside : {column, column + 1}) {
            glNormal3fv(band.at(beside, row).normal);
            glVertex3fv(band.at(beside, row).place);
        }
    glEnd();
}

/// Ready to be drawn over and over.
class Drawing {
public:
    Drawing(const Band& band, const std::string& how) : band_(band), how_(how) {
        if (how == "lists") compile_lists();
        if (how == "buffers") fill_buffers();
    }
    void draw() const {
        if (how_ == "lists")
            for (GLuint i = 0; i < lists_; ++i) glCallList(first_ + i);
        else if (how_ == "buffers") glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
        else
            for (int column = 0; column < band_.columns; ++column) draw_column(band_, column);
    }

private:
    void compile_lists() {
        constexpr int kColumnsEach = 8;
        lists_ = static_cast<GLuint>((band_.columns + kColumnsEach - 1) / kColumnsEach);
        first_ = glGenLists(static_cast<GLsizei>(lists_));
        for (int column = 0; column < band_.columns; ++column) {
            if (column % kColumnsEach == 0) glNewList(first_ + static_cast<GLuint>(column / kColumnsEach), GL_COMPILE);
            draw_column(band_, column);
            if (column % kColumnsEach == kColumnsEach - 1 || column + 1 == band_.columns) glEndList();
        }
    }
    void fill_buffers() {
        std::vector<GLuint> indices;
        for (int column = 0; column < band_.columns; ++column)
            for (int row = 0; row < kRows; ++row) {
                const auto at = static_cast<GLuint>(column * (kRows + 1) + row), beside = at + kRows + 1;
                for (const GLuint corner : {at, beside, at + 1, beside, beside + 1, at + 1}) indices.push_back(corner);
            }
        GLuint names[2];
        glGenBuffers(2, names);
        glBindBuffer(GL_ARRAY_BUFFER, names[0]);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(band_.vertices.size() * sizeof(Vertex)),
                     band_.vertices.data(), GL_STATIC_DRAW);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, names[1]);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)), indices.data(),
                     GL_STATIC_DRAW);
        glNormalPointer(GL_FLOAT, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, normal)));
        glVertexPointer(3, GL_FLOAT, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, place)));
        glEnableClientState(GL_NORMAL_ARRAY);
        glEnableClientState(GL_VERTEX_ARRAY);
        count_ = static_cast<GLsizei>(indices.size());
    }

    const Band& band_;
    const std::string how_;
    GLuint first_ = 0, lists_ = 0;
    GLsizei count_ = 0;
};

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        const char* value = argv[i + 1];
        if (name == "--size" && std::sscanf(value, "%dx%d", &o.width, &o.height) == 2) continue;
        else if (name == "--triangles") o.triangles = std::atoi(value);
        else if (name == "--frames") o.frames = std::atoi(value);
        else if (name == "--how") o.how = value;
        else return false;
    }
    return argc % 2 == 1 && o.triangles > 0 && o.frames > 0 && o.width > 0 && o.height > 0 &&
           (o.how == "immediate" || o.how == "lists" || o.how == "buffers");
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (!parse(argc, argv, o)) {
        std::fputs(
            "usage: around [--triangles N] [--how immediate|lists|buffers] [--frames N] [--size WxH]\n"
            "Draws N frames of a lit band of triangles around the eye and prints frames/s and the band's elements.\n",
            stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, 0};
    wall::bench::GlWindow window("around", static_cast<unsigned>(o.width), static_cast<unsigned>(o.height),
                                 kAttributes);
    if (!window.current()) return 1;

    glViewport(0, 0, o.width, o.height);
    glMatrixMode(GL_PROJECTION);
    const double x = 0.1, y = x * o.height / o.width;
    glFrustum(-x, x, -y, y, 0.1, 20);
    glMatrixMode(GL_MODELVIEW);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    const Band band(o.triangles);
    const Drawing drawing(band, o.how);
    auto start = std::chrono::steady_clock::now();
    constexpr int kFirst = 2;  // frames until tiles show it, and nodes have what they keep
    for (int frame = 0; frame < o.frames + kFirst; ++frame) {
        if (frame == kFirst) {
            glFinish();
            start = std::chrono::steady_clock::now();
        }
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glLoadIdentity();
        glRotatef(0.7f * static_cast<float>(frame), 0, 1, 0);
        drawing.draw();
        window.swap();
    }
    glFinish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%d frames in %.2f s: %.2f frames/s, %d elements\n", o.frames, seconds.count(),
                o.frames / seconds.count(), band.columns * kRows * 6);
}
