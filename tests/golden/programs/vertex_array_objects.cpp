// SPDX-License-Identifier: MIT
// Vertex array objects: many, each with its buffers; changed while another one is bound; deleted buffers that they
// keep; what glPushClientAttrib saves of them.
#include <array>
#include <cmath>
#include <cstddef>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kObjects = 12, kCorners = 7;

const void* at(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

struct Corner {
    GLfloat place[2];
    GLubyte colour[4];
};

std::array<Corner, kCorners> star(int number) {
    std::array<Corner, kCorners> out{};
    for (int i = 0; i < kCorners; ++i) {
        const float angle = 6.2832f * static_cast<float>(i) / kCorners + 0.2f * static_cast<float>(number);
        const float radius = 0.5f + 0.04f * static_cast<float>((i * number) % 11);
        out[static_cast<std::size_t>(i)] = {
            {radius * std::cos(angle), radius * std::sin(angle)},
            {static_cast<GLubyte>(40 * i), static_cast<GLubyte>(20 * number), static_cast<GLubyte>(255 - 30 * i), 255}};
    }
    return out;
}

GLuint buffer(GLenum target, const void* content, std::size_t bytes) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(bytes), content, GL_STATIC_DRAW);
    return name;
}

struct Stars {
    std::array<GLuint, kObjects> objects{}, vertices{}, indices{};

    Stars() {
        glGenVertexArrays(kObjects, objects.data());
        for (int i = 0; i < kObjects; ++i) make(i);
        glBindVertexArray(0);
    }
    void make(int i) {
        const auto n = static_cast<std::size_t>(i);
        say("%d before its first use", glIsVertexArray(objects[n]));
        glBindVertexArray(objects[n]);
        const auto corners = star(i);
        vertices[n] = buffer(GL_ARRAY_BUFFER, corners.data(), sizeof corners);
        const GLubyte order[] = {0, 2, 4, 6, 1, 3, 5};
        indices[n] = buffer(GL_ELEMENT_ARRAY_BUFFER, order, sizeof order);
        glVertexPointer(2, GL_FLOAT, sizeof(Corner), at(0));
        glEnableClientState(GL_VERTEX_ARRAY);
        if (i % 3 == 0) return;  // the current colour
        glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Corner), at(offsetof(Corner, colour)));
        glEnableClientState(GL_COLOR_ARRAY);
    }
};

void say_bound(const char* when) {
    GLint object = 0, array = 0, elements = 0, of_vertices = 0;
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &object);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &array);
    glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &elements);
    glGetIntegerv(GL_VERTEX_ARRAY_BUFFER_BINDING, &of_vertices);
    say("%s: object %d, buffers %d %d %d, vertices %d colours %d", when, object, array, elements, of_vertices,
        glIsEnabled(GL_VERTEX_ARRAY), glIsEnabled(GL_COLOR_ARRAY));
}

/// What is done to them before a frame.
void change(Stars& stars, int frame) {
    if (frame == 1) {
        glBindVertexArray(stars.objects[4]);
        glDisableClientState(GL_COLOR_ARRAY);
        glBindVertexArray(stars.objects[5]);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, stars.indices[5]);
        const GLubyte other[] = {0, 1, 2, 3, 4, 5, 6};
        glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, sizeof other, other);
    } else if (frame == 2) {  // they keep what is deleted while they are not bound
        glBindVertexArray(0);
        glDeleteBuffers(kObjects, stars.vertices.data());
        glDeleteBuffers(kObjects, stars.indices.data());
        say("buffer %d", glIsBuffer(stars.vertices[3]));
    } else if (frame == 3) {
        glBindVertexArray(stars.objects[7]);
        glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT);
        glDisableClientState(GL_VERTEX_ARRAY);
        glBindVertexArray(stars.objects[8]);
        say_bound("pushed");
        glPopClientAttrib();
        say_bound("popped");
        glDeleteVertexArrays(1, &stars.objects[7]);
        say_bound("deleted");
        glBindVertexArray(stars.objects[7]);
        say_error("deleted");
    }
}

}  // namespace

SCENE(vertex_array_objects, 4) {
    static Stars* stars;
    if (frame == 0) stars = new Stars;
    change(*stars, frame);
    clear(0.1f, 0.1f, 0.1f);
    glColor3f(0.9f, 0.8f, 0.2f);
    for (int i = 0; i < kObjects; ++i) {
        const int number = i * 5 % kObjects;
        if (frame == 3 && number == 7) continue;  // deleted
        cell_view(i, 4, 3);
        glBindVertexArray(stars->objects[static_cast<std::size_t>(number)]);
        glDrawArrays(GL_TRIANGLE_FAN, 0, kCorners);
        glDrawElements(GL_LINE_LOOP, kCorners, GL_UNSIGNED_BYTE, nullptr);
        if (i == 0) say_bound("drawn");
    }
    glBindVertexArray(0);
    say_bound("none");
    say_error("vertex_array_objects");
}

}  // namespace golden
