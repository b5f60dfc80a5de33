// SPDX-License-Identifier: MIT
// Draws from buffer objects: large ones, of which a tile shows a part; all ways to give the elements; buffers that
// change in part, as a whole and by mapping; what is current behind a draw.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Vertex {
    GLfloat place[3], normal[3], texture[2];
    GLubyte colour[4];
};

constexpr int kColumns = 100, kRows = 70;  // 42,000 indices of triangles

Vertex vertex(int column, int row, float height) {
    const float x = 2 * static_cast<float>(column) / kColumns - 1, y = 2 * static_cast<float>(row) / kRows - 1;
    const auto shade = [](int value) { return static_cast<GLubyte>(value & 255); };
    return {{x, y, height * std::sin(4 * x) * std::cos(3 * y)},
            {-height * std::cos(4 * x), height * std::sin(3 * y), 1},
            {x * 2, y * 2},
            {shade(column * 5), shade(row * 9), shade((column ^ row) * 3), 255}};
}

std::vector<Vertex> grid(float height) {
    std::vector<Vertex> out;
    for (int row = 0; row <= kRows; ++row)
        for (int column = 0; column <= kColumns; ++column) out.push_back(vertex(column, row, height));
    return out;
}

GLushort index_at(int column, int row) { return static_cast<GLushort>(row * (kColumns + 1) + column); }

std::vector<GLushort> triangles() {
    std::vector<GLushort> out;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            for (const auto& [c, r] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}})
                out.push_back(index_at(column + c, row + r));
    return out;
}

/// All rows in one strip, joined by triangles without an area.
std::vector<GLushort> strip() {
    std::vector<GLushort> out;
    for (int row = 0; row < kRows; ++row) {
        out.push_back(index_at(0, row));
        for (int column = 0; column <= kColumns; ++column)
            out.push_back(index_at(column, row)), out.push_back(index_at(column, row + 1));
        out.push_back(index_at(kColumns, row + 1));
    }
    return out;
}

template <class T>
GLuint buffer_of(GLenum target, const std::vector<T>& content, GLenum usage = GL_STATIC_DRAW) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(content.size() * sizeof(T)), content.data(), usage);
    return name;
}

const void* at(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

void point_to_arrays(GLuint buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), at(offsetof(Vertex, place)));
    glNormalPointer(GL_FLOAT, sizeof(Vertex), at(offsetof(Vertex, normal)));
    glTexCoordPointer(2, GL_FLOAT, sizeof(Vertex), at(offsetof(Vertex, texture)));
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), at(offsetof(Vertex, colour)));
}

constexpr GLenum kArrays[] = {GL_VERTEX_ARRAY, GL_NORMAL_ARRAY, GL_TEXTURE_COORD_ARRAY, GL_COLOR_ARRAY};

/// Kept over the frames of a scene.
struct Buffers {
    std::vector<Vertex> vertices = grid(0.3f);
    std::vector<GLushort> indices = triangles(), strip_indices = strip();
    GLuint array = buffer_of(GL_ARRAY_BUFFER, vertices), elements = buffer_of(GL_ELEMENT_ARRAY_BUFFER, indices),
           strips = buffer_of(GL_ELEMENT_ARRAY_BUFFER, strip_indices);
    GLsizei count = static_cast<GLsizei>(indices.size()), strip_count = static_cast<GLsizei>(strip_indices.size());
};

/// One way to draw the grid or a part of it.
using Way = void (*)(Buffers&);
constexpr Way kWays[] = {
    [](Buffers& b) { glDrawElements(GL_TRIANGLES, b.count, GL_UNSIGNED_SHORT, nullptr); },
    [](Buffers& b) { glDrawRangeElements(GL_TRIANGLES, 0, 7170, b.count / 6 * 3, GL_UNSIGNED_SHORT, at(6000)); },
    [](Buffers& b) {
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, b.strips);
        glDrawElements(GL_TRIANGLE_STRIP, b.strip_count, GL_UNSIGNED_SHORT, nullptr);
    },
    [](Buffers& b) {
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
        glDrawElements(GL_TRIANGLES, b.count, GL_UNSIGNED_SHORT, b.indices.data());
    },
    [](Buffers&) { glDrawArrays(GL_POINTS, 0, (kColumns + 1) * (kRows + 1)); },
    [](Buffers&) { glDrawArrays(GL_LINE_STRIP, 100, 5000); },
    [](Buffers&) {
        const GLint first[] = {0, 3000, 10};
        const GLsizei count[] = {101, 2500, 7};
        glMultiDrawArrays(GL_LINES, first, count, 3);
    },
    [](Buffers&) { glDrawArrays(GL_TRIANGLE_FAN, 2000, 900); },
    [](Buffers& b) {
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        glDrawElements(GL_TRIANGLES, b.count / 3, GL_UNSIGNED_SHORT, nullptr);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    },
    [](Buffers&) {
        glEnable(GL_LINE_STIPPLE);
        glLineStipple(3, 0x3f17);
        glDrawArrays(GL_LINES, 0, 4000);  // each line anew: of a long strip Mesa makes what it did before matter
        glDisable(GL_LINE_STIPPLE);
    },
    [](Buffers&) { glDrawArrays(GL_QUADS, 0, 5000); },
    [](Buffers&) { glDrawArrays(GL_QUAD_STRIP, 0, 5000); },
};

void change(Buffers& b, int frame) {
    glBindBuffer(GL_ARRAY_BUFFER, b.array);
    constexpr GLsizeiptr kRow = (kColumns + 1) * sizeof(Vertex);
    if (frame == 1) {  // some rows
        const auto other = grid(-0.6f);
        for (const int row : {5, 6, 40})
            glBufferSubData(GL_ARRAY_BUFFER, row * kRow, kRow, other.data() + row * (kColumns + 1));
    } else if (frame == 2) {
        auto* mapped = static_cast<Vertex*>(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_WRITE));
        for (int i = 0; i < 2000; ++i) mapped[i * 3].place[2] += 0.2f;
        glUnmapBuffer(GL_ARRAY_BUFFER);
    } else if (frame == 3) {  // as a stream does it
        glBufferData(GL_ARRAY_BUFFER, kRow * (kRows + 1), nullptr, GL_STREAM_DRAW);
        const auto other = grid(0.1f);
        glBufferSubData(GL_ARRAY_BUFFER, 0, kRow * (kRows + 1), other.data());
    }
}

void turn(int frame) {
    glRotatef(-50 + 15 * static_cast<float>(frame), 1, 0, 0);
    glRotatef(20 * static_cast<float>(frame), 0, 0, 1);
}

}  // namespace

SCENE(vertex_buffers, 4) {  // every frame in another way to change the content
    static Buffers* buffers;
    if (frame == 0) buffers = new Buffers;
    change(*buffers, frame);
    clear(0.1f, 0.1f, 0.15f);
    perspective_view(canvas);
    turn(frame);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING), glEnable(GL_LIGHT0), glEnable(GL_NORMALIZE), glEnable(GL_COLOR_MATERIAL);
    point_to_arrays(buffers->array);
    for (const GLenum array : kArrays) glEnableClientState(array);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers->elements);
    glColor3f(0.25f, 0.5f, 0.75f);
    kWays[0](*buffers);
    GLfloat colour[4];
    glGetFloatv(GL_CURRENT_COLOR, colour);
    say("colour behind it %.5g %.5g %.5g", colour[0], colour[1], colour[2]);
    for (const GLenum array : kArrays) glDisableClientState(array);
    for (const GLenum name : {GL_LIGHTING, GL_LIGHT0, GL_NORMALIZE, GL_COLOR_MATERIAL, GL_DEPTH_TEST}) glDisable(name);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    say_error("vertex_buffers");
}

SCENE(ways_to_draw, 2) {  // frame 1 with a texture
    static Buffers* buffers;
    if (frame == 0) buffers = new Buffers;
    clear(0.15f, 0.1f, 0.1f);
    if (frame == 1) checker_texture(3, 32), glEnable(GL_TEXTURE_2D);
    int cell = 0;
    for (const Way way : kWays) {
        cell_view(cell++, 4, 3);
        glPushMatrix();
        turn(1);
        point_to_arrays(buffers->array);
        for (const GLenum array : kArrays) glEnableClientState(array);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers->elements);
        way(*buffers);
        for (const GLenum array : kArrays) glDisableClientState(array);
        glPopMatrix();
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    glDisable(GL_TEXTURE_2D);
    say_error("ways_to_draw");
}

SCENE(wrong_draws, 1) {  // what lies outside of buffers, mapped ones, deleted ones
    static Buffers* buffers = new Buffers;
    clear();
    pixel_view(canvas);
    point_to_arrays(buffers->array);
    for (const GLenum array : kArrays) glEnableClientState(array);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers->elements);
    glMapBuffer(GL_ARRAY_BUFFER, GL_WRITE_ONLY);
    kWays[0](*buffers);
    say_error("from a mapped buffer");
    glUnmapBuffer(GL_ARRAY_BUFFER);
    glDrawElements(GL_TRIANGLES, -1, GL_UNSIGNED_SHORT, nullptr);
    say_error("fewer than none");
    glDrawElements(GL_TRIANGLES, 3, GL_FLOAT, nullptr);
    say_error("indices of floats");
    glDrawElements(GL_POLYGON + 1, 3, GL_UNSIGNED_SHORT, nullptr);
    say_error("no such primitive");
    glDeleteBuffers(1, &buffers->elements);
    glDeleteBuffers(1, &buffers->array);
    GLint bound = -1;
    glGetIntegerv(GL_VERTEX_ARRAY_BUFFER_BINDING, &bound);
    say("array of a deleted buffer: %d", bound);
    for (const GLenum array : kArrays) glDisableClientState(array);
    say_error("wrong_draws");
}

}  // namespace golden
