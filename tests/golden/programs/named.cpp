// SPDX-License-Identifier: MIT
// What OpenGL 4.1 to 4.5 add around objects: attributes that are bound to buffers apart from their format, attributes
// of doubles, objects that are changed by name, several bound at once, and clip space turned around. All of it reaches
// over tiles' borders.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

GLuint linked(const char* vertex, const char* fragment) {
    const GLuint program = glCreateProgram();
    for (const auto& [type, text] : {std::pair{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = glCreateShader(static_cast<GLenum>(type));
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

/// A corner of a mesh, as programs lay them out.
struct Corner {
    GLfloat x, y;
    GLubyte color[4];
};

/// A grid of squares over most of the window, six corners each.
std::vector<Corner> grid(int columns, GLubyte blue) {
    std::vector<Corner> out;
    const float step = 1.8f / static_cast<float>(columns);
    for (int i = 0; i < columns * columns; ++i) {
        const float x = -0.9f + step * static_cast<float>(i % columns),
                    y = -0.9f + step * static_cast<float>(i / columns);
        const auto red = static_cast<GLubyte>(255 * (i % columns) / columns),
                   green = static_cast<GLubyte>(255 * (i / columns) / columns);
        for (const auto& [dx, dy] :
             {std::array{0.f, 0.f}, {0.85f, 0.f}, {0.85f, 0.85f}, {0.f, 0.f}, {0.85f, 0.85f}, {0.f, 0.85f}})
            out.push_back({x + dx * step, y + dy * step, {red, green, blue, 255}});
    }
    return out;
}

constexpr const char* kColored = R"(#version 330
    layout(location = 0) in vec2 place;
    layout(location = 1) in vec4 tint;
    layout(location = 2) in vec2 offset;
    out vec4 shade;
    void main() { shade = tint; gl_Position = vec4(place + offset, 0, 1); })";
constexpr const char* kShaded = R"(#version 330
    in vec4 shade; out vec4 color;
    void main() { color = shade; })";

}  // namespace

/// One format, meshes that change by their buffer only; one of them is the same for all corners, one goes on by
/// instances. In the last frame attributes are set by pointers again.
SCENE(attribute_bindings, 4) {
    clear(0.1f, 0.1f, 0.2f);
    static GLuint program, array, meshes[2], offsets;
    if (frame == 0) {
        program = linked(kColored, kShaded);
        glGenVertexArrays(1, &array);
        glGenBuffers(2, meshes);
        for (int i = 0; i < 2; ++i) {
            const auto corners = grid(4 + 3 * i, static_cast<GLubyte>(200 * i));
            glBindBuffer(GL_ARRAY_BUFFER, meshes[i]);
            glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                         GL_STATIC_DRAW);
        }
        const GLfloat moves[] = {0, 0, 0.05f, 0.02f, -0.04f, 0.07f};
        glGenBuffers(1, &offsets);
        glBindBuffer(GL_ARRAY_BUFFER, offsets);
        glBufferData(GL_ARRAY_BUFFER, sizeof moves, moves, GL_STATIC_DRAW);
        glBindBuffer(GL_ARRAY_BUFFER, 0);
        glBindVertexArray(array);
        glVertexAttribFormat(0, 2, GL_FLOAT, GL_FALSE, 0);
        glVertexAttribFormat(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Corner, color));
        glVertexAttribFormat(2, 2, GL_FLOAT, GL_FALSE, 0);
        glVertexAttribBinding(0, 5);
        glVertexAttribBinding(1, 5);
        glVertexAttribBinding(2, 7);
        for (GLuint i = 0; i < 3; ++i) glEnableVertexAttribArray(i);
    }
    glBindVertexArray(array);
    glUseProgram(program);
    glBindVertexBuffer(5, meshes[frame & 1], 6 * sizeof(Corner), sizeof(Corner));
    glBindVertexBuffer(7, offsets, frame == 1 ? 8 : 0, frame == 2 ? 0 : 8);
    glVertexBindingDivisor(7, frame == 2 ? 0 : 1);
    if (frame == 3) {
        glBindBuffer(GL_ARRAY_BUFFER, meshes[0]);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
        glBindBuffer(GL_ARRAY_BUFFER, 0);
    }
    glDrawArraysInstanced(GL_TRIANGLES, 0, 60, 2);
    GLint values[3] = {};
    glGetVertexAttribiv(0, GL_VERTEX_ATTRIB_BINDING, &values[0]);
    glGetVertexAttribiv(1, GL_VERTEX_ATTRIB_RELATIVE_OFFSET, &values[1]);
    glGetIntegeri_v(GL_VERTEX_BINDING_STRIDE, 7, &values[2]);
    say("attribute 0 at %d, 1 %d behind, %d a step", values[0], values[1], values[2]);
    say_error("bindings");
    glBindVertexArray(0);
    glUseProgram(0);
}

/// Doubles that floats could not tell apart: from an array, and as the current value of an attribute.
SCENE(double_attributes, 3) {
    clear();
    static GLuint program, places, doubles;
    if (frame == 0) {
        program = linked(R"(#version 410
            layout(location = 0) in vec2 place;
            layout(location = 1) in dvec2 near;
            layout(location = 3) in dvec4 one;
            out vec4 shade;
            void main() {
                double more = (near.x - near.y) * 1e12, less = (one.x - one.y) * 1e12;
                shade = vec4(float(more), float(less) * float(one.w), 0.3, 1);
                gl_Position = vec4(place, 0, 1);
            })",
                         kShaded);
        const auto corners = grid(5, 0);
        glGenBuffers(1, &places);
        glBindBuffer(GL_ARRAY_BUFFER, places);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                     GL_STATIC_DRAW);
        std::vector<GLdouble> pairs;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            pairs.push_back(1 + 1e-12 * static_cast<double>(i % 6) / 6);
            pairs.push_back(1);
        }
        glGenBuffers(1, &doubles);
        glBindBuffer(GL_ARRAY_BUFFER, doubles);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(pairs.size() * sizeof(GLdouble)), pairs.data(),
                     GL_STATIC_DRAW);
    }
    glUseProgram(program);
    glBindBuffer(GL_ARRAY_BUFFER, places);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
    glEnableVertexAttribArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, doubles);
    glVertexAttribLPointer(1, 2, GL_DOUBLE, 0, nullptr);
    glVertexAttribL4d(3, 1 + 0.5e-12, 1, 0, frame == 0 ? 1 : 0.5);
    if (frame < 2) glEnableVertexAttribArray(1);
    else glVertexAttribL2d(1, 1 + 0.75e-12, 1);
    glDrawArrays(GL_TRIANGLES, 0, 150);
    GLdouble got[4] = {};
    glGetVertexAttribLdv(3, GL_CURRENT_VERTEX_ATTRIB, got);
    say("%.17g %.17g %g %g", got[0], got[1], got[2], got[3]);
    say_error("doubles");
    glDisableVertexAttribArray(0);
    glDisableVertexAttribArray(1);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glUseProgram(0);
}

/// A texture that is drawn to and sampled, its framebuffer, its mesh and where the mesh lies: nothing but the vertex
/// array is ever bound.
SCENE(named_objects, 3) {
    static GLuint program, painter, array, mesh, texture, framebuffer;
    if (frame == 0) {
        painter = linked(kColored, kShaded);
        program = linked(kColored, R"(#version 330
            uniform sampler2D image; in vec4 shade; out vec4 color;
            void main() { color = texture(image, shade.xy) + vec4(0, 0, shade.z * 0.5, 0); })");
        glCreateVertexArrays(1, &array);
        glCreateBuffers(1, &mesh);
        const auto corners = grid(6, 100);
        glNamedBufferStorage(mesh, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                             GL_DYNAMIC_STORAGE_BIT);
        glVertexArrayVertexBuffer(array, 0, mesh, 0, sizeof(Corner));
        glVertexArrayAttribFormat(array, 0, 2, GL_FLOAT, GL_FALSE, 0);
        glVertexArrayAttribFormat(array, 1, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Corner, color));
        glVertexArrayAttribBinding(array, 1, 0);
        glEnableVertexArrayAttrib(array, 0);
        glEnableVertexArrayAttrib(array, 1);
        glCreateTextures(GL_TEXTURE_2D, 1, &texture);
        glTextureStorage2D(texture, 1, GL_RGBA8, 64, 64);
        glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glCreateFramebuffers(1, &framebuffer);
        glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, texture, 0);
        say("status %x", glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER));
    }
    clear(0.2f, 0.2f, 0.2f);
    const GLfloat ground[] = {0, 0.3f * static_cast<float>(frame), 0.6f, 1};
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, ground);
    glBindVertexArray(array);
    glUseProgram(painter);
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, 64, 64);
    glDrawArrays(GL_TRIANGLES, 0, 108);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    const std::array<GLubyte, 16> spots{255, 255, 255, 255, 0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255};
    glTextureSubImage2D(texture, 0, 20 + 5 * frame, 30, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, spots.data());
    const GLubyte yellow[] = {255, 255, 0, 255};
    glClearTexSubImage(texture, 0, 0, 50, 0, 64, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE, yellow);
    glBindTextureUnit(2, texture);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "image"), 2);
    const Corner moved{0, static_cast<float>(frame) * 0.3f, {255, 255, 255, 255}};
    glNamedBufferSubData(mesh, 60 * sizeof(Corner), sizeof moved, &moved);
    glDrawArrays(GL_TRIANGLES, 0, 216);
    std::array<GLubyte, 16> got{};
    glGetTextureSubImage(texture, 0, 20, 49, 0, 2, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE, sizeof got, got.data());
    say("%d %d %d, %d %d %d", got[0], got[1], got[2], got[8], got[9], got[10]);
    GLint bound = 0;
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
    say("bound %d", bound);
    say_error("named");
    glBindTextureUnit(2, 0);
    glBindVertexArray(0);
    glUseProgram(0);
}

/// The window's upper edge is where clip space ends, and depths begin at 0; with lighting faces, boxes and what lies
/// behind what show it.
SCENE(clip_control, 4) {
    clear(0.1f, 0.15f, 0.1f);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glClipControl(frame & 1 ? GL_UPPER_LEFT : GL_LOWER_LEFT, frame & 2 ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
    perspective_view(canvas);
    for (int i = 0; i < 5; ++i) {
        glPushMatrix();
        glTranslatef(-1.2f + 0.6f * static_cast<float>(i), 0.35f * static_cast<float>(i) - 0.8f,
                     -0.5f * static_cast<float>(i));
        glScalef(0.3f, 0.3f, 0.3f);
        glColor3f(0.2f * static_cast<float>(i), 0.8f, 1 - 0.2f * static_cast<float>(i));
        glFrontFace(i % 2 == 0 ? GL_CCW : GL_CW);
        lit_sphere(12, 6);
        glPopMatrix();
    }
    glColor3f(1, 1, 1);
    glRasterPos3f(0.4f, 0.5f, 0);
    GLfloat position[4];
    glGetFloatv(GL_CURRENT_RASTER_POSITION, position);
    say("raster %.4g %.4g %.4g", static_cast<double>(position[0]), static_cast<double>(position[1]),
        static_cast<double>(position[2]));
    say_error("clip");
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glFrontFace(GL_CCW);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace golden
