// SPDX-License-Identifier: MIT
// Draws with a base vertex, of several instances, and with primitive restart: from buffers, from the program's memory,
// beyond the ends of buffers, and into display lists.
#include <cmath>
#include <cstddef>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kCorners = 9, kShapes = 4, kInstances = 12;

struct Corner {
    GLfloat place[2];
    GLubyte colour[4];
};

/// Some shapes behind one another: a hub and its rim.
std::vector<Corner> shapes() {
    std::vector<Corner> out;
    for (int shape = 0; shape < kShapes; ++shape) {
        out.push_back({{0, 0}, {255, 255, 255, 255}});
        for (int i = 0; i < kCorners - 1; ++i) {
            const float angle = 6.2832f * static_cast<float>(i) / (kCorners - 2);
            const float radius = 0.55f + 0.1f * static_cast<float>((i * (shape + 2)) % 5);
            out.push_back({{radius * std::cos(angle), radius * std::sin(angle)},
                           {static_cast<GLubyte>(60 * shape), static_cast<GLubyte>(30 * i), 120, 255}});
        }
    }
    return out;
}

constexpr GLushort kEnd = 0xffff;
const std::vector<GLushort>& fan() {  // one shape
    static const auto* out = new std::vector<GLushort>{0, 1, 2, 3, 4, 5, 6, 7, 8};
    return *out;
}
const std::vector<GLushort>& broken() {  // two fans, a lone index, a fan
    static const auto* out =
        new std::vector<GLushort>{0, 1, 2, 3, kEnd, 0, 4, 5, 6, kEnd, kEnd, 3, kEnd, 0, 7, 8, kEnd};
    return *out;
}

template <class T>
GLuint buffer_of(GLenum target, const std::vector<T>& content) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(content.size() * sizeof(T)), content.data(), GL_STATIC_DRAW);
    return name;
}

struct Buffers {
    std::vector<Corner> corners = shapes();
    GLuint vertices = buffer_of(GL_ARRAY_BUFFER, corners);
    GLuint fan_indices = buffer_of(GL_ELEMENT_ARRAY_BUFFER, fan()),
           broken_indices = buffer_of(GL_ELEMENT_ARRAY_BUFFER, broken());
};

/// Where vertices and indices come from.
struct Source {
    const Buffers& buffers;
    bool vertices_in_buffer, indices_in_buffer;

    void point() const {
        glBindBuffer(GL_ARRAY_BUFFER, vertices_in_buffer ? buffers.vertices : 0);
        const auto* base = vertices_in_buffer ? nullptr : reinterpret_cast<const std::byte*>(buffers.corners.data());
        glVertexPointer(2, GL_FLOAT, sizeof(Corner), base);
        glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Corner), base + offsetof(Corner, colour));
    }
    const void* indices(GLuint buffer, const std::vector<GLushort>& content) const {
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_in_buffer ? buffer : 0);
        return indices_in_buffer ? nullptr : content.data();
    }
    const void* fan_indices() const { return indices(buffers.fan_indices, fan()); }
    const void* broken_indices() const { return indices(buffers.broken_indices, broken()); }
};

using Way = void (*)(const Source&);
constexpr Way kWays[] = {
    [](const Source& s) {
        glDrawElementsBaseVertex(GL_TRIANGLE_FAN, kCorners, GL_UNSIGNED_SHORT, s.fan_indices(), kCorners);
    },
    [](const Source& s) {
        glDrawRangeElementsBaseVertex(GL_LINE_STRIP, 0, kCorners, kCorners, GL_UNSIGNED_SHORT, s.fan_indices(),
                                      2 * kCorners);
    },
    [](const Source& s) {
        const GLsizei counts[] = {5, 6, 3};
        const void* at = s.fan_indices();
        const void* const indices[] = {at, at, at};
        const GLint bases[] = {0, 3 * kCorners, kCorners + 4};
        glMultiDrawElementsBaseVertex(GL_TRIANGLE_FAN, counts, GL_UNSIGNED_SHORT, indices, 3, bases);
    },
    [](const Source& s) {
        glEnableClientState(GL_PRIMITIVE_RESTART_NV);
        glPrimitiveRestartIndexNV(kEnd);
        glDrawElements(GL_TRIANGLE_FAN, static_cast<GLsizei>(broken().size()), GL_UNSIGNED_SHORT, s.broken_indices());
        glDisableClientState(GL_PRIMITIVE_RESTART_NV);
    },
    [](const Source& s) {  // the index is compared before the base is added
        glEnableClientState(GL_PRIMITIVE_RESTART_NV);
        glPrimitiveRestartIndexNV(kEnd);
        glDrawElementsBaseVertex(GL_LINE_LOOP, static_cast<GLsizei>(broken().size()), GL_UNSIGNED_SHORT,
                                 s.broken_indices(), 3 * kCorners);
        glDisableClientState(GL_PRIMITIVE_RESTART_NV);
    },
    [](const Source& s) {
        glEnableClientState(GL_PRIMITIVE_RESTART_NV);
        glPrimitiveRestartIndexNV(5);
        glDrawElements(GL_TRIANGLE_STRIP, kCorners, GL_UNSIGNED_SHORT, s.fan_indices());
        glDisableClientState(GL_PRIMITIVE_RESTART_NV);
    },
};

GLuint shader(GLenum type, const char* source) {
    const GLuint name = glCreateShader(type);
    glShaderSource(name, 1, &source, nullptr);
    glCompileShader(name);
    return name;
}

constexpr GLuint kShift = 5, kTint = 6;

/// Each instance has a place of its own, by its number, and by arrays that go on with instances.
GLuint instanced_program() {
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader(GL_VERTEX_SHADER,
                                   "#version 120\n"
                                   "#extension GL_ARB_draw_instanced : require\n"
                                   "attribute vec2 shift;\n"
                                   "attribute vec4 tint;\n"
                                   "varying vec4 colour;\n"
                                   "void main() {\n"
                                   "    float number = float(gl_InstanceIDARB);\n"
                                   "    vec2 place = gl_Vertex.xy * (0.1 + 0.01 * number) + shift\n"
                                   "        + vec2(0.15 * number - 0.85, 0.0);\n"
                                   "    colour = gl_Color * 0.5 + tint * 0.5;\n"
                                   "    gl_Position = gl_ModelViewProjectionMatrix * vec4(place, 0.0, 1.0);\n"
                                   "}\n"));
    glAttachShader(program, shader(GL_FRAGMENT_SHADER,
                                   "#version 120\n"
                                   "varying vec4 colour;\n"
                                   "void main() { gl_FragColor = colour; }\n"));
    glBindAttribLocation(program, kShift, "shift");
    glBindAttribLocation(program, kTint, "tint");
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    say("linked %d", linked);
    return program;
}

/// Arrays of instances: one value for each, and one for every three.
void point_by_instance() {
    static const GLfloat shifts[kInstances][2] = {{0, 0},     {0, 0.2f}, {0, 0.4f},  {0, 0.6f}, {0, -0.2f}, {0, -0.4f},
                                                  {0, -0.6f}, {0, 0},    {0, 0.25f}, {0, 0.5f}, {0, -0.3f}, {0, 0}};
    static const GLubyte tints[4][4] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 0, 255}};
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glVertexAttribPointer(kShift, 2, GL_FLOAT, GL_FALSE, 0, shifts);
    glVertexAttribPointer(kTint, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, tints);
    glVertexAttribDivisor(kShift, 1);
    glVertexAttribDivisor(kTint, 3);
    for (const GLuint index : {kShift, kTint}) glEnableVertexAttribArray(index);
    GLint divisor = 0;
    glGetVertexAttribiv(kTint, GL_VERTEX_ATTRIB_ARRAY_DIVISOR, &divisor);
    say("divisor %d", divisor);
}

void end_instances() {
    for (const GLuint index : {kShift, kTint}) glDisableVertexAttribArray(index), glVertexAttribDivisor(index, 0);
}

/// The same in buffers.
void point_by_instance_in_buffers() {
    static GLuint shifts, tints;
    if (shifts == 0) {
        std::vector<GLfloat> places;
        for (int i = 0; i < kInstances; ++i)
            places.push_back(0), places.push_back(0.05f * static_cast<float>(i) - 0.3f);
        shifts = buffer_of(GL_ARRAY_BUFFER, places);
        tints = buffer_of(GL_ARRAY_BUFFER,
                          std::vector<GLubyte>{0, 0, 255, 255, 255, 0, 255, 255, 0, 255, 255, 255, 9, 9, 9, 255});
    }
    glBindBuffer(GL_ARRAY_BUFFER, shifts);
    glVertexAttribPointer(kShift, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glBindBuffer(GL_ARRAY_BUFFER, tints);
    glVertexAttribPointer(kTint, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
    glVertexAttribDivisor(kShift, 1);
    glVertexAttribDivisor(kTint, 3);
    for (const GLuint index : {kShift, kTint}) glEnableVertexAttribArray(index);
}

void wrong_draws(const Source& source) {
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, -1), say_error("fewer than no instances");
    glDrawArraysInstanced(GL_TRIANGLES, -1, 3, 1), say_error("first");
    glDrawArraysInstanced(99, 0, 3, 1), say_error("mode");
    glDrawElementsInstanced(GL_TRIANGLES, 3, GL_FLOAT, source.fan_indices(), 2), say_error("type");
    glDrawElementsBaseVertex(GL_TRIANGLES, -3, GL_UNSIGNED_SHORT, source.fan_indices(), 2), say_error("count");
    glVertexAttribDivisor(99, 1), say_error("attribute");
    glPrimitiveRestartNV(), say_error("outside");
}

}  // namespace

SCENE(elements_from_a_base, 4) {  // vertices and indices in buffers or in memory
    static const Buffers* buffers = new Buffers;
    const Source source{*buffers, frame % 2 == 0, frame < 2};
    clear(0.1f, 0.1f, 0.15f);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    int cell = 0;
    for (const Way way : kWays) {
        cell_view(cell++, 4, 3);
        source.point();
        way(source);
    }
    glNewList(1, GL_COMPILE);
    kWays[0](source);
    kWays[4](source);
    glEndList();
    cell_view(cell++, 4, 3);
    glCallList(1);
    cell_view(cell++, 4, 3);
    glColor3f(1, 0.5f, 0.5f);
    glBegin(GL_LINE_STRIP);  // as the extension has it by single vertices
    for (int i = 0; i < 8; ++i) {
        if (i == 4) glPrimitiveRestartNV();
        glVertex2f(0.2f * static_cast<float>(i) - 0.8f, i % 2 ? 0.5f : -0.5f);
    }
    glEnd();
    cell_view(cell++, 4, 3);
    glEnableClientState(GL_PRIMITIVE_RESTART_NV);
    glPrimitiveRestartIndexNV(4);
    glBegin(GL_LINE_STRIP);
    for (int i = 0; i < kCorners; ++i) glArrayElement(i);
    glEnd();
    glDisableClientState(GL_PRIMITIVE_RESTART_NV);
    if (frame == 0) wrong_draws(source);
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    say_error("elements_from_a_base");
}

SCENE(instances, 4) {
    static const Buffers* buffers = new Buffers;
    static GLuint program;
    if (frame == 0) program = instanced_program();
    const Source source{*buffers, frame % 2 == 0, frame < 2};
    clear(0.15f, 0.1f, 0.1f);
    glUseProgram(program);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    const auto rows = [&](int row) { cell_view(row, 1, 5); };
    source.point();
    for (const bool in_buffers : {false, true}) {
        in_buffers ? point_by_instance_in_buffers() : point_by_instance();
        rows(in_buffers ? 1 : 0);
        glDrawArraysInstanced(GL_TRIANGLE_FAN, kCorners, kCorners, kInstances);
        rows(in_buffers ? 3 : 2);
        glDrawElementsInstanced(GL_LINE_LOOP, kCorners, GL_UNSIGNED_SHORT, source.fan_indices(), kInstances);
    }
    rows(4);
    glEnableClientState(GL_PRIMITIVE_RESTART_NV);
    glPrimitiveRestartIndexNV(kEnd);
    glDrawElementsInstancedBaseVertex(GL_TRIANGLE_FAN, static_cast<GLsizei>(broken().size()), GL_UNSIGNED_SHORT,
                                      source.broken_indices(), kInstances - 3, 2 * kCorners);
    glDisableClientState(GL_PRIMITIVE_RESTART_NV);
    rows(0);
    glDrawArrays(GL_LINE_STRIP, 0, kCorners);  // one instance: the first values of its arrays
    end_instances();
    glUseProgram(0);
    rows(1);
    glDrawArraysInstanced(GL_POINTS, 0, kCorners, 2);  // fixed function: twice the same
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    say_error("instances");
}

}  // namespace golden
