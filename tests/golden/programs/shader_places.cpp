// SPDX-License-Identifier: MIT
// Meshes that shaders place, large enough to be cut into pieces: by matrices, which a wall knows before it draws, and
// by bones or by functions of the vertex, which it does not. All of them reach over tiles' borders.
#include <array>
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Vertex {
    GLfloat weight, place[3];
};
constexpr int kColumns = 60, kRows = 40;

/// A wavy grid over [-1, 1]^2, and its triangles.
struct Grid {
    std::vector<Vertex> vertices;
    std::vector<GLushort> indices;
    Grid() {
        for (int row = 0; row <= kRows; ++row)
            for (int column = 0; column <= kColumns; ++column) add(column, row);
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column)
                for (const auto& [c, r] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}})
                    indices.push_back(static_cast<GLushort>((row + r) * (kColumns + 1) + column + c));
    }
    GLsizei count() const { return static_cast<GLsizei>(indices.size()); }

private:
    void add(int column, int row) {
        const float x = 2.0f * static_cast<float>(column) / kColumns - 1,
                    y = 2.0f * static_cast<float>(row) / kRows - 1;
        vertices.push_back({static_cast<float>((column * 7 + row * 5) % 16) / 15, {x, y, 0.2f * std::sin(7 * x + y)}});
    }
};

/// In buffers; the array of number 0 has no places, those are number 1.
const Grid& bind_grid() {
    static const Grid grid;
    static GLuint buffers[2];
    if (buffers[0] == 0) {
        glGenBuffers(2, buffers);
        glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(grid.vertices.size() * sizeof(Vertex)),
                     grid.vertices.data(), GL_STATIC_DRAW);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(grid.indices.size() * sizeof(GLushort)),
                     grid.indices.data(), GL_STATIC_DRAW);
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glVertexAttribPointer(0, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(sizeof(GLfloat)));
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    return grid;
}

void unbind_grid() {
    glDisableVertexAttribArray(0);
    glDisableVertexAttribArray(1);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    glUseProgram(0);
}

using Matrix = std::array<GLfloat, 16>;

/// Turned about y, shrunk, and moved.
Matrix turned(float angle, float scale, float x, float y, float z) {
    const float c = std::cos(angle) * scale, s = std::sin(angle) * scale;
    return {c, 0, -s, 0, 0, scale, 0, 0, s, 0, c, 0, x, y, z, 1};
}
/// 90 degrees wide, from 0.5 to 10.
constexpr Matrix kPerspective = {1, 0, 0, 0, 0, 1.3f, 0, 0, 0, 0, -10.5f / 9.5f, -1, 0, 0, -10 / 9.5f, 0};

void set_matrix(GLuint program, const char* name, const Matrix& matrix) {
    glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, matrix.data());
}

constexpr const char* kFragment = "#version 120\nvarying vec4 shade; void main() { gl_FragColor = shade; }";

}  // namespace

SCENE(shader_placed_mesh, 4) {
    clear(0.1f, 0, 0.1f);
    static GLuint program;
    if (frame == 0)
        program = linked_program(
            "#version 120\nattribute vec3 place; attribute float weight; varying vec4 shade;\n"
            "uniform mat4 projection, view[3]; uniform vec2 shift;\n"
            "vec4 seen(in vec3 p) { vec4 eye = view[1] * vec4(p, 1.0); return eye; }\n"
            "void main() { shade = vec4(weight, abs(sin(9.0 * place.xy)), 1.0); vec4 at = projection * "
            "seen(place * 1.5);\n  at.xy += shift * at.w; gl_Position = at; }",
            kFragment, {"weight", "place"});
    glEnable(GL_DEPTH_TEST);
    glUseProgram(program);
    const Grid& grid = bind_grid();
    const float angle = 0.5f * static_cast<float>(frame);
    set_matrix(program, "projection", kPerspective);
    // The second reaches behind the eye.
    const GLint shift = glGetUniformLocation(program, "shift");
    for (int i = 0; i < 3; ++i) {
        set_matrix(program, "view[1]", turned(angle + static_cast<float>(i), 0.6f, 0, 0, i == 1 ? -0.5f : -2.0f));
        glUniform2f(shift, 0.6f * static_cast<float>(i - 1), 0.2f * static_cast<float>(frame) - 0.3f);
        glDrawElements(GL_TRIANGLES, grid.count(), GL_UNSIGNED_SHORT, nullptr);
    }
    set_matrix(program, "view[1]", turned(angle, 0.2f, 0.6f, 0.7f, -1));
    glPointSize(7);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(grid.vertices.size()));
    glPointSize(1);
    unbind_grid();
    say_error("shader_placed_mesh");
}

// By the matrices of fixed function: arrays, a list, and vertices one by one, some of them with a w.
SCENE(shader_placed_vertices, 3) {
    clear(0, 0.1f, 0.1f);
    static GLuint program, list;
    if (frame == 0) {
        program = linked_program(
            "uniform vec4 bend; varying vec4 shade; void main() { shade = gl_Color;\n"
            "  gl_Position = gl_ProjectionMatrix * (gl_ModelViewMatrix * gl_Vertex) + bend; }",
            "varying vec4 shade; void main() { gl_FragColor = shade; }", {});
        list = glGenLists(1);
        glNewList(list, GL_COMPILE);
        glColor3f(0.9f, 0.9f, 0.2f);
        lit_sphere(60, 30);
        glEndList();
    }
    static const Grid grid;
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(program);
    const GLint bend = glGetUniformLocation(program, "bend");
    for (int i = 0; i < 2; ++i) {
        glUniform4f(bend, i == 0 ? 0 : 0.7f, i == 0 ? 0 : -0.4f, 0, 0);
        glColor3f(0.3f, 0.6f, 0.9f);
        glEnableClientState(GL_VERTEX_ARRAY);
        glVertexPointer(3, GL_FLOAT, sizeof(Vertex), grid.vertices.data()->place);
        glPushMatrix();
        glScalef(0.4f, 0.4f, 1);
        glRotatef(static_cast<GLfloat>(20 * frame), 0, 0, 1);
        glDrawElements(GL_TRIANGLES, grid.count(), GL_UNSIGNED_SHORT, grid.indices.data());
        glPopMatrix();
        glDisableClientState(GL_VERTEX_ARRAY);
        glPushMatrix();
        glTranslatef(0.4f * static_cast<GLfloat>(frame), 0.8f, 0);
        glScalef(0.3f, 0.3f, 0.3f);
        glCallList(list);
        glPopMatrix();
        glBegin(GL_TRIANGLE_STRIP);
        for (int k = 0; k < 40; ++k) {
            const float x = static_cast<float>(k) / 20 - 1, w = k % 3 == 0 ? 2.0f : 1.0f;
            glColor3f(0.5f + x / 2, 0.2f, 0.5f - x / 2);
            glVertex4f(x * w, (k % 2 == 0 ? -0.9f : -0.6f) * w, 0.3f * w, w);
        }
        glEnd();
    }
    glUseProgram(0);
    say_error("shader_placed_vertices");
}

// Not to be known before it is drawn: bones chosen by an attribute, and a wave.
SCENE(shader_skinned_mesh, 3) {
    clear(0.1f, 0.1f, 0);
    static GLuint skinned, waving;
    if (frame == 0) {
        const char* attributes = "#version 120\nattribute vec3 place; attribute float weight; varying vec4 shade;\n";
        const std::string bones = std::string(attributes) +
                                  "uniform mat4 bones[4]; void main() { shade = vec4(weight, place.xy, 1.0);\n"
                                  "  int bone = int(weight * 3.0); gl_Position = mix(bones[bone] * vec4(place, 1.0),\n"
                                  "    bones[0] * vec4(place, 1.0), fract(weight * 3.0)); }";
        const std::string wave = std::string(attributes) +
                                 "uniform float time; void main() { shade = vec4(place.yx, weight, 1.0);\n"
                                 "  gl_Position = vec4(place.xy * 0.5 + 0.4 * sin(place.yx * 5.0 + time), 0.5, 1.0); }";
        skinned = linked_program(bones.c_str(), kFragment, {"weight", "place"});
        waving = linked_program(wave.c_str(), kFragment, {"weight", "place"});
    }
    const Grid& grid = bind_grid();
    const float angle = 0.3f * static_cast<float>(frame);
    glUseProgram(waving);
    glUniform1f(glGetUniformLocation(waving, "time"), angle);
    glDrawElements(GL_TRIANGLES, grid.count(), GL_UNSIGNED_SHORT, nullptr);
    glUseProgram(skinned);
    for (int i = 0; i < 4; ++i) {
        const float x = 0.4f * static_cast<float>(i % 2) - 0.2f, y = 0.4f * static_cast<float>(i / 2) - 0.2f;
        const std::string name = "bones[" + std::to_string(i) + "]";
        set_matrix(skinned, name.c_str(), turned(angle + static_cast<float>(i), 0.7f, x, y, 0));
    }
    glDrawElements(GL_TRIANGLES, grid.count(), GL_UNSIGNED_SHORT, nullptr);
    unbind_grid();
    say_error("shader_skinned_mesh");
}

}  // namespace golden
