// SPDX-License-Identifier: MIT
// Meshes that stay and are drawn often in a frame, their triangles in no order, whole and in pieces: what nodes may
// draw in another one, with flat colours, samples that are counted, and colours that depend on the order.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Vertex {
    GLfloat place[3];
    GLubyte colour[4];
};

constexpr int kSide = 40, kTimes = 24;  // 9,600 indices

struct Mesh {
    GLuint vertices = 0, indices = 0;
    GLsizei count = 0;

    Mesh() {
        std::vector<Vertex> points;
        for (int row = 0; row <= kSide; ++row)
            for (int column = 0; column <= kSide; ++column) {
                const float x = 2 * static_cast<float>(column) / kSide - 1, y = 2 * static_cast<float>(row) / kSide - 1;
                points.push_back({{x, y, 0.5F * std::sin(5 * x) * std::cos(4 * y)},
                                  {static_cast<GLubyte>(column * 31), static_cast<GLubyte>(row * 47),
                                   static_cast<GLubyte>((column ^ row) * 9), 160}});
            }
        std::vector<std::array<GLushort, 3>> triangles;
        const auto at = [](int column, int row) { return static_cast<GLushort>(row * (kSide + 1) + column); };
        for (int row = 0; row < kSide; ++row)
            for (int column = 0; column < kSide; ++column) {
                triangles.push_back({at(column, row), at(column + 1, row), at(column, row + 1)});
                triangles.push_back({at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)});
            }
        restart_random();
        for (std::size_t i = triangles.size() - 1; i > 0; --i)
            std::swap(triangles[i], triangles[random_bits() % (i + 1)]);
        count = static_cast<GLsizei>(3 * triangles.size());
        glGenBuffers(1, &vertices);
        glGenBuffers(1, &indices);
        glBindBuffer(GL_ARRAY_BUFFER, vertices);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(Vertex)), points.data(),
                     GL_STATIC_DRAW);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof triangles[0]),
                     triangles.data(), GL_STATIC_DRAW);
    }
    void bind() const {
        glBindBuffer(GL_ARRAY_BUFFER, vertices);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glVertexPointer(3, GL_FLOAT, sizeof(Vertex), nullptr);
        glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, colour)));
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_COLOR_ARRAY);
    }
    void draw() const { glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_SHORT, nullptr); }
};

/// Many over the window, then a large one that every tile shows a part of.
void draw_all(const Mesh& mesh, int frame) {
    for (int i = 0; i <= kTimes; ++i) {
        glPushMatrix();
        if (i < kTimes) {
            glTranslatef(0.4F * static_cast<float>(i % 6) - 1, 0.4F * static_cast<float>(i / 6) - 0.6F, 0.6F);
            glScalef(0.15F, 0.15F, 0.15F);
        }
        glRotatef(static_cast<float>(20 + 13 * i + 7 * frame), 0.3F, 1, 0.2F);
        mesh.draw();
        glPopMatrix();
    }
}

}  // namespace

SCENE(drawn_often, 5) {
    static const Mesh mesh;
    clear(0.1F, 0.1F, 0.15F);
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    mesh.bind();
    if (frame == 1) glShadeModel(GL_FLAT);
    if (frame == 2) glDisable(GL_DEPTH_TEST);
    if (frame == 3) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    static GLuint query = 0;
    if (query == 0) glGenQueries(1, &query);
    if (frame == 4) glBeginQuery(GL_SAMPLES_PASSED, query);
    draw_all(mesh, frame);
    if (frame == 4) {
        glEndQuery(GL_SAMPLES_PASSED);
        GLuint samples = 0;
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples);
        say("%u samples", samples);
    }
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    glDisable(GL_BLEND);
    glShadeModel(GL_SMOOTH);
    say_error("drawn often");
}

}  // namespace golden
