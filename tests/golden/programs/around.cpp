// SPDX-License-Identifier: MIT
// A room around the eye, for tiles that look elsewhere (octagon.py): whichever way one looks there is something, and
// each frame is about what must stay right there: lights, fog and planes in eye space, a sky without depth, vertices in
// lists, arrays and buffers, shaders, and a title that no camera draws.
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kPillars = 24;
constexpr GLuint kTexture = 31;

void camera(Size canvas) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    const double x = 0.1, y = x * canvas.height / canvas.width;
    glFrustum(-x, x, -y, y, 0.1, 60);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glRotatef(-12, 0, 1, 0);
    glTranslatef(0.4f, -0.2f, 0.7f);
}

/// Six squares, so near that only its missing depth keeps it behind all else.
void sky() {
    glDisable(GL_DEPTH_TEST);
    checker_texture(kTexture, 16);
    glEnable(GL_TEXTURE_2D);
    glColor3f(0.4f, 0.5f, 0.6f);
    constexpr std::array<std::array<float, 4>, 6> kSides = {
        {{0, 0, 1, 0}, {90, 0, 1, 0}, {180, 0, 1, 0}, {270, 0, 1, 0}, {90, 1, 0, 0}, {270, 1, 0, 0}}};
    for (const auto& [angle, ax, ay, az] : kSides) {
        glPushMatrix();
        glRotatef(angle, ax, ay, az);
        glTranslatef(0, 0, -1);
        unit_square();
        glPopMatrix();
    }
    glDisable(GL_TEXTURE_2D);
    glEnable(GL_DEPTH_TEST);
}

template <class Draw>
void for_each_pillar(Draw&& draw) {
    for (int i = 0; i < kPillars; ++i) {
        glPushMatrix();
        glRotatef(360.0f * static_cast<float>(i) / kPillars, 0, 1, 0);
        glTranslatef(0, 0.5f * std::sin(static_cast<float>(i)), -3.5f - static_cast<float>(i % 3));
        glScalef(0.35f, 0.8f, 0.35f);
        glColor3f(0.3f + 0.1f * static_cast<float>(i % 7), 0.4f, 1 - 0.1f * static_cast<float>(i % 5));
        draw();
        glPopMatrix();
    }
}

void light() {
    const GLfloat place[] = {2, 2, 1, 1}, white[] = {1, 1, 1, 1};
    glLightfv(GL_LIGHT0, GL_POSITION, place);
    glLightfv(GL_LIGHT0, GL_SPECULAR, white);
    glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, white);
    glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, 12);
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, 1);
    glEnable(GL_LIGHT0);
    glEnable(GL_LIGHTING);
    glEnable(GL_COLOR_MATERIAL);
    glEnable(GL_NORMALIZE);
}

/// A floor of many triangles, from a buffer: nodes keep it, and draw the pieces that they see.
struct Floor {
    static constexpr int kSide = 60;
    struct Vertex {
        float x, y, z;
        GLubyte color[4];
    };
    GLuint vertices = 0, indices = 0;

    Floor() {
        std::vector<Vertex> points;
        std::vector<GLushort> corners;
        for (int row = 0; row <= kSide; ++row)
            for (int column = 0; column <= kSide; ++column) {
                const float x = 0.4f * static_cast<float>(column - kSide / 2),
                            z = 0.4f * static_cast<float>(row - kSide / 2);
                points.push_back({x,
                                  -1.2f + 0.2f * std::sin(x) * std::cos(z),
                                  z,
                                  {static_cast<GLubyte>(row * 37), static_cast<GLubyte>(column * 53), 120, 255}});
            }
        for (int row = 0; row < kSide; ++row)
            for (int column = 0; column < kSide; ++column)
                for (const int step : {0, 1, kSide + 1, 1, kSide + 2, kSide + 1})
                    corners.push_back(static_cast<GLushort>(row * (kSide + 1) + column + step));
        glGenBuffers(1, &vertices);
        glGenBuffers(1, &indices);
        glBindBuffer(GL_ARRAY_BUFFER, vertices);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(Vertex)), points.data(),
                     GL_STATIC_DRAW);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(GLushort)),
                     corners.data(), GL_STATIC_DRAW);
        unbind();
    }
    static void unbind() {
        glBindBuffer(GL_ARRAY_BUFFER, 0);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    }
    void draw() const {
        glBindBuffer(GL_ARRAY_BUFFER, vertices);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glVertexPointer(3, GL_FLOAT, sizeof(Vertex), nullptr);
        glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, color)));
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_COLOR_ARRAY);
        glDrawElements(GL_TRIANGLES, kSide * kSide * 6, GL_UNSIGNED_SHORT, nullptr);
        glDisableClientState(GL_VERTEX_ARRAY);
        glDisableClientState(GL_COLOR_ARRAY);
        unbind();
    }
};

/// A strip in one glBegin that goes all around: each node gets what it sees of it.
void ribbon() {
    constexpr int kSteps = 400;
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i <= kSteps; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSteps;
        glColor3f(0.5f + 0.5f * std::sin(angle), 0.6f, 0.5f + 0.5f * std::cos(3 * angle));
        for (const float up : {0.9f, 1.3f})
            glVertex3f(2.5f * std::sin(angle), up + 0.2f * std::sin(5 * angle), -2.5f * std::cos(angle));
    }
    glEnd();
}

/// Labels in the scene, all around: letters that move the raster position, and an image. Each view has its own, also
/// those that the camera does not see.
void labels() {
    static constexpr GLubyte kLetters[2][8] = {{0x81, 0x42, 0x24, 0x18, 0x18, 0x24, 0x42, 0x81},
                                               {0xff, 0x80, 0x80, 0xfc, 0x80, 0x80, 0x80, 0xff}};
    std::array<GLubyte, 6 * 5 * 4> image{};
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<GLubyte>(i * 7);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int i = 0; i < 21; ++i) {
        const float angle = 0.3f + 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 21;
        glColor3f(1, 0.2f + 0.03f * static_cast<float>(i), 0.9f);
        glRasterPos3f(2.2f * std::sin(angle), 0.37f * std::cos(5 * angle), -2.2f * std::cos(angle));
        for (const auto& letter : {kLetters[0], kLetters[1], kLetters[0]}) glBitmap(8, 8, 1, 2, 9.5f, 0, letter);
        if (i % 3 != 0) continue;
        glPixelZoom(2.137f, 1.513f);  // odd, as in pixels.cpp
        glDrawPixels(6, 5, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        glPixelZoom(1, 1);
    }
}

void title(Size canvas) {
    pixel_view(canvas);
    glDisable(GL_DEPTH_TEST);
    // Not glRecti: behind a list Mesa 22.3 draws it in the colour of before the list, where lighting was never on.
    glBegin(GL_QUADS);
    glColor3f(1, 1, 0.2f);
    for (const auto& [x, y] : {std::pair{10, 10}, {canvas.width / 3, 10}, {canvas.width / 3, 20}, {10, 20}})
        glVertex2i(x, y);
    glEnd();
}

GLuint program() {
    static const char* const kVertex =
        "varying vec3 eye; void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;\n"
        "eye = vec3(gl_ModelViewMatrix * gl_Vertex); gl_FrontColor = gl_Color; }";
    static const char* const kFragment =
        "varying vec3 eye; void main() { gl_FragColor = vec4(gl_Color.rgb * (1.2 - 0.12 * length(eye)), 1.0); }";
    const GLuint linked = glCreateProgram();
    for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}}) {
        const GLuint shader = glCreateShader(kind);
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(linked, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(linked);
    return linked;
}

}  // namespace

SCENE(around, 6) {
    static const Floor floor;
    static const GLuint shaded = program(), sphere = [] {
        const GLuint list = glGenLists(1);
        glNewList(list, GL_COMPILE);
        lit_sphere();
        glEndList();
        return list;
    }();
    clear(0.1f, 0.1f, 0.2f);
    camera(canvas);
    sky();
    floor.draw();
    ribbon();
    if (frame >= 1) light();
    if (frame == 2) {
        const GLfloat gray[] = {0.5f, 0.5f, 0.5f, 1};
        glFogfv(GL_FOG_COLOR, gray);
        glFogi(GL_FOG_MODE, GL_LINEAR);
        glFogf(GL_FOG_START, 1);
        glFogf(GL_FOG_END, 7);
        glEnable(GL_FOG);
    }
    if (frame == 3) {
        const GLdouble plane[] = {0, 1, 0, 0.1};
        glClipPlane(GL_CLIP_PLANE0, plane);
        glEnable(GL_CLIP_PLANE0);
    }
    if (frame == 4) glUseProgram(shaded);
    if (frame == 5) for_each_pillar([] { lit_sphere(12, 6); });
    else for_each_pillar([] { glCallList(sphere); });
    glUseProgram(0);
    labels();
    for (const GLenum on : {GL_FOG, GL_CLIP_PLANE0, GL_LIGHTING, GL_LIGHT0, GL_COLOR_MATERIAL, GL_NORMALIZE})
        glDisable(on);
    title(canvas);
    GLfloat matrix[16];
    camera(canvas);
    glGetFloatv(GL_PROJECTION_MATRIX, matrix);
    say("projection %.6g %.6g %.6g", static_cast<double>(matrix[0]), static_cast<double>(matrix[5]),
        static_cast<double>(matrix[10]));
}

}  // namespace golden
