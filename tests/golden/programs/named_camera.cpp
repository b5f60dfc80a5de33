// SPDX-License-Identifier: MIT
// Pillars around the eye whose shaders no parser follows, for tiles that look elsewhere (octagon.py): bones that a
// variable chooses, instances by a second attribute, a geometry shader. Their cameras have names, which whoever starts
// the scene may say: "camera", and "matrices[1]", projection and view in one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

using Matrix = std::array<float, 16>;

constexpr int kPillars = 20, kBones = 4;

GLuint link(const std::vector<std::pair<GLenum, const char*>>& sources) {
    const GLuint linked = glCreateProgram();
    for (const auto& [kind, source] : sources) {
        const GLuint shader = glCreateShader(kind);
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(linked, shader);
        glDeleteShader(shader);
    }
    glBindAttribLocation(linked, 0, "corner");
    glBindAttribLocation(linked, 1, "place");
    glLinkProgram(linked);
    return linked;
}

constexpr const char* kSkinned =
    "#version 130\n"
    "uniform mat4 camera; uniform vec3 bones[4]; in vec3 corner; in vec4 place; out vec3 color;\n"
    "void main() { color = fract(place.xyz * 0.7 + corner * 0.3);\n"
    "gl_Position = camera * vec4(corner + place.xyz + bones[int(place.w)], 1.0); }";
constexpr const char* kPlain =
    "#version 130\n"
    "in vec3 color; out vec4 shown; void main() { shown = vec4(color, 1.0); }";
constexpr const char* kPoints =
    "#version 150\n"
    "in vec3 corner; in vec4 place; void main() { gl_Position = vec4(corner * 0.001 + place.xyz, 1.0); }";
constexpr const char* kCross =
    "#version 150\n"
    "layout(points) in; layout(triangle_strip, max_vertices = 4) out; uniform mat4 matrices[2]; out vec3 color;\n"
    "void main() { vec4 at = gl_in[0].gl_Position; color = fract(at.xyz * 0.6);\n"
    "for (int i = 0; i < 4; ++i) {\n"
    "gl_Position = matrices[1] * matrices[0] * (at + vec4(0.3 * float(i % 2), 0.3 * float(i / 2), 0.0, 0.0));\n"
    "EmitVertex(); } EndPrimitive(); }";
constexpr const char* kFlat =
    "#version 150\n"
    "in vec3 color; out vec4 shown; void main() { shown = vec4(color, 1.0); }";

Matrix projection(Size canvas) {
    constexpr float kNear = 0.1F, kFar = 60;
    const float x = 1, y = static_cast<float>(canvas.height) / static_cast<float>(canvas.width);
    Matrix out{};
    out[0] = 1 / x;
    out[5] = 1 / y;
    out[10] = -(kFar + kNear) / (kFar - kNear);
    out[11] = -1;
    out[14] = -2 * kFar * kNear / (kFar - kNear);
    return out;
}

/// Its column of the view is turned by `degrees` around the upright axis.
Matrix turned(const Matrix& by, float degrees) {
    const float angle = degrees * std::numbers::pi_v<float> / 180, sin = std::sin(angle), cos = std::cos(angle);
    Matrix out = by;
    for (std::size_t row = 0; row < 4; ++row) {
        out[row] = cos * by[row] - sin * by[8 + row];
        out[8 + row] = sin * by[row] + cos * by[8 + row];
    }
    return out;
}

struct Pillars {
    std::vector<float> corners, places;  ///< 3 and 4 of each vertex
    std::vector<float> points;           ///< 4 of each pillar

    Pillars() {
        constexpr std::array<std::array<float, 3>, 6> kSquare = {{{-0.3F, -0.8F, 0},
                                                                  {0.3F, -0.8F, 0},
                                                                  {0.3F, 0.8F, 0.1F},
                                                                  {-0.3F, -0.8F, 0},
                                                                  {0.3F, 0.8F, 0.1F},
                                                                  {-0.3F, 0.8F, 0.1F}}};
        for (int i = 0; i < kPillars; ++i) {
            const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kPillars;
            const float far = 3 + static_cast<float>(i % 3);
            const std::array<float, 4> place = {far * std::sin(angle), 0.2F * static_cast<float>(i % 5) - 0.4F,
                                                -far * std::cos(angle), static_cast<float>(i % kBones)};
            for (const auto& corner : kSquare) {
                corners.insert(corners.end(), corner.begin(), corner.end());
                places.insert(places.end(), place.begin(), place.end());
            }
            points.insert(points.end(), place.begin(), place.end());
        }
    }
};

void draw_skinned(const Pillars& pillars, const Matrix& camera, int frame) {
    static const GLuint program = link({{GL_VERTEX_SHADER, kSkinned}, {GL_FRAGMENT_SHADER, kPlain}});
    std::array<float, std::size_t{3} * kBones> bones{};
    for (std::size_t i = 0; i < bones.size(); ++i)
        bones[i] = 0.1F * std::sin(static_cast<float>(i) + static_cast<float>(frame));
    glUseProgram(program);
    glUniform3fv(glGetUniformLocation(program, "bones"), kBones, bones.data());
    glUniformMatrix4fv(glGetUniformLocation(program, "camera"), 1, GL_FALSE, camera.data());
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, pillars.corners.data());
    glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, 0, pillars.places.data());
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glDrawArrays(GL_TRIANGLES, 0, 6 * kPillars);
}

void draw_points(const Pillars& pillars, const Matrix& camera) {
    static const GLuint program =
        link({{GL_VERTEX_SHADER, kPoints}, {GL_GEOMETRY_SHADER, kCross}, {GL_FRAGMENT_SHADER, kFlat}});
    const Matrix own{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.2F, 0.5F, 0.1F, 1};
    std::array<float, 32> both{};
    std::copy_n(own.begin(), 16, both.begin());
    std::copy_n(camera.begin(), 16, both.begin() + 16);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "matrices"), 2, GL_FALSE, both.data());
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, pillars.corners.data());
    glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, 0, pillars.points.data());
    glDrawArrays(GL_POINTS, 0, kPillars);
}

}  // namespace

SCENE(named_camera, 4) {
    static const Pillars pillars;
    clear(0.1F, 0.15F, 0.2F);
    glEnable(GL_DEPTH_TEST);
    const Matrix camera = projection(canvas);
    draw_skinned(pillars, frame == 2 ? turned(camera, 25) : camera, frame);
    if (frame >= 1) draw_points(pillars, turned(camera, -12));
    glDisableVertexAttribArray(0);
    glDisableVertexAttribArray(1);
    glUseProgram(0);
    say_error("named cameras");
}

}  // namespace golden
