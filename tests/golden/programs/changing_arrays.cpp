// SPDX-License-Identifier: MIT
// Arrays in the program's memory: some never change, some in part, some wholly, some are locked; interleaved and each
// for itself; with indices that leave memory out that is not the program's.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kColumns = 40, kRows = 30;

struct Vertex {
    GLfloat place[3];
    GLubyte colour[4];
};

std::vector<Vertex> grid(float bend) {
    std::vector<Vertex> out;
    for (int row = 0; row <= kRows; ++row)
        for (int column = 0; column <= kColumns; ++column) {
            const float x = 2 * static_cast<float>(column) / kColumns - 1, y = 2 * static_cast<float>(row) / kRows - 1;
            out.push_back({{0.9f * x + bend * std::sin(5 * y), 0.9f * y + bend * std::cos(7 * x), 0},
                           {static_cast<GLubyte>(column * 6), static_cast<GLubyte>(row * 8), 90, 255}});
        }
    return out;
}

const std::vector<GLushort>& triangles() {
    static const auto* out = [] {
        auto* indices = new std::vector<GLushort>;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const int at = row * (kColumns + 1) + column;
                for (const int i : {at, at + 1, at + kColumns + 1, at + 1, at + kColumns + 2, at + kColumns + 1})
                    indices->push_back(static_cast<GLushort>(i));
            }
        return indices;
    }();
    return *out;
}

void point_to(const Vertex* vertices) {
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), vertices->place);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), vertices->colour);
}

void draw_grid() {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(triangles().size()), GL_UNSIGNED_SHORT, triangles().data());
}

/// Vertices at the ends of a piece of memory whose middle may not be read.
struct Split {
    static constexpr std::size_t kBytes = std::size_t{1} << 16;
    std::byte* memory =
        static_cast<std::byte*>(mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    std::vector<GLushort> indices;

    Split() {
        auto* places = reinterpret_cast<GLfloat*>(memory);
        constexpr int kCount = kBytes / (2 * sizeof(GLfloat));
        for (int i = 0; i < 100; ++i) {
            for (const int at : {i, kCount - 1 - i}) {
                places[2 * at] = 0.018f * static_cast<float>(i) - 0.9f;
                places[2 * at + 1] = at == i ? 0.8f : -0.8f * std::cos(0.05f * static_cast<float>(i));
            }
            indices.insert(indices.end(), {static_cast<GLushort>(i), static_cast<GLushort>(kCount - 1 - i)});
        }
        const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
        mprotect(memory + page, kBytes - 2 * page, PROT_NONE);
    }
};

}  // namespace

SCENE(changing_arrays, 8) {
    static std::vector<Vertex>*still, *partly, *wholly, *locked;
    static const Split* split;
    static std::vector<GLfloat>* apart;
    if (frame == 0) {
        still = new auto(grid(0.05f)), partly = new auto(grid(0)), wholly = new auto(grid(0)),
        locked = new auto(grid(0.1f));
        split = new Split;
        apart = new std::vector<GLfloat>;
        for (const Vertex& v : *still) apart->insert(apart->end(), {v.place[0], v.place[1]});
    }
    for (int i = 0; i < 30; ++i) {  // some rows, another place in every frame
        Vertex& v = (*partly)[static_cast<std::size_t>((frame * 137 + i * 11) % ((kColumns + 1) * (kRows + 1)))];
        v.colour[2] = static_cast<GLubyte>(30 * frame), v.place[0] += 0.02f;
    }
    *wholly = grid(0.02f * static_cast<float>(frame));
    clear(0.05f, 0.1f, 0.15f);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    int cell = 0;
    for (const std::vector<Vertex>* vertices : {still, partly, wholly}) {
        cell_view(cell++, 3, 3);
        point_to(vertices->data());
        draw_grid();
    }
    cell_view(cell++, 3, 3);
    point_to(locked->data());
    glLockArraysEXT(0, static_cast<GLsizei>(locked->size()));
    draw_grid();
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(locked->size()));
    if (frame == 5) {
        GLint first = -1, count = -1;
        glGetIntegerv(GL_ARRAY_ELEMENT_LOCK_FIRST_EXT, &first);
        glGetIntegerv(GL_ARRAY_ELEMENT_LOCK_COUNT_EXT, &count);
        say("locked %d %d", first, count);
        glLockArraysEXT(0, 3), say_error("locked twice");
    }
    glUnlockArraysEXT();
    (*locked)[static_cast<std::size_t>(frame * 50)].place[1] += 0.1f;  // in between it may change
    if (frame == 5) {
        glUnlockArraysEXT(), say_error("unlocked twice");
        glLockArraysEXT(-1, 3), say_error("first");
        glLockArraysEXT(0, 0), say_error("none");
    }
    cell_view(cell++, 3, 3);
    glDisableClientState(GL_COLOR_ARRAY);
    glColor3f(0.3f, 0.9f, 0.5f);
    glVertexPointer(2, GL_FLOAT, 0, split->memory);
    glDrawElements(GL_LINES, static_cast<GLsizei>(split->indices.size()), GL_UNSIGNED_SHORT, split->indices.data());
    cell_view(cell++, 3, 3);
    glVertexPointer(2, GL_FLOAT, 0, apart->data());
    glDrawArrays(GL_LINE_STRIP, 100, static_cast<GLsizei>(apart->size() / 2) - 200 - 20 * frame);
    cell_view(cell++, 3, 3);  // the same memory in another way
    glVertexPointer(2, GL_FLOAT, 16, apart->data());
    glDrawArrays(GL_LINES, 0, static_cast<GLsizei>(apart->size() / 4) - frame);
    glDisableClientState(GL_VERTEX_ARRAY);
    say_error("changing_arrays");
}

}  // namespace golden
