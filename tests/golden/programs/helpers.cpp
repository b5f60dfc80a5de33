// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <utility>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {
std::uint32_t g_random = 1;
constexpr float kPi = 3.14159265f;
}  // namespace

void restart_random() { g_random = 12345; }

unsigned random_bits() {
    g_random = g_random * 1664525u + 1013904223u;
    return g_random >> 8;
}

std::vector<GLubyte> random_image(std::size_t bytes) {
    std::vector<GLubyte> image(bytes);
    for (auto& value : image) value = static_cast<GLubyte>(random_bits());
    return image;
}

float random_unit() { return static_cast<float>(random_bits() & 0xffff) / 65535.0f; }

void clear(float r, float g, float b) {
    glClearColor(r, g, b, 1);
    glClearDepth(1);
    glClearStencil(0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

void pixel_view(Size canvas) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0, canvas.width, 0, canvas.height, -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

void perspective_view(Size canvas) {
    const double top = 0.57735, right = top * canvas.width / canvas.height;
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-right, right, -top, top, 1, 20);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(0, 0, -3);
}

void cell_view(int index, int columns, int rows) {
    const float w = 2.0f / static_cast<float>(columns), h = 2.0f / static_cast<float>(rows);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glTranslatef(-1 + w * (static_cast<float>(index % columns) + 0.5f),
                 1 - h * (static_cast<float>(index / columns) + 0.5f), 0);
    glScalef(w * 0.4573f, h * 0.4591f, 1);  // odd: no pixel's centre lies on the border of two texels
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

void lit_sphere(int slices, int stacks, bool poles) {
    for (int i = poles ? 0 : 1; i < stacks - (poles ? 0 : 1); ++i) {
        glBegin(GL_QUAD_STRIP);
        for (int j = 0; j <= slices; ++j)
            for (int k = 1; k >= 0; --k) {
                const float v = static_cast<float>(i + k) / static_cast<float>(stacks);
                const float u = static_cast<float>(j) / static_cast<float>(slices);
                const float x = std::sin(kPi * v) * std::cos(2 * kPi * u), y = std::cos(kPi * v);
                const float z = -std::sin(kPi * v) * std::sin(2 * kPi * u);
                glTexCoord2f(u * 4, v * 2);
                glNormal3f(x, y, z);
                glVertex3f(x, y, z);
            }
        glEnd();
    }
}

void unit_square() {
    glBegin(GL_QUADS);
    glNormal3f(0, 0, 1);
    glTexCoord2f(0, 0);
    glVertex2f(-1, -1);
    glTexCoord2f(1, 0);
    glVertex2f(1, -1);
    glTexCoord2f(1, 1);
    glVertex2f(1, 1);
    glTexCoord2f(0, 1);
    glVertex2f(-1, 1);
    glEnd();
}

void checker_texture(GLuint name, int size) {
    std::vector<unsigned char> texels;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const bool odd = ((x / 4) ^ (y / 4)) & 1;
            const auto ramp = [&](int at) { return static_cast<unsigned char>(255 * at / (size - 1)); };
            texels.insert(texels.end(), {odd ? ramp(x) : static_cast<unsigned char>(230),
                                         odd ? ramp(y) : static_cast<unsigned char>(200),
                                         odd ? static_cast<unsigned char>(40) : ramp(x), ramp(size - 1 - y)});
        }
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
}

GLuint linked_program(const char* vertex, const char* fragment, std::initializer_list<const char*> attributes) {
    const GLuint program = glCreateProgram();
    for (const auto& [type, source] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = glCreateShader(static_cast<GLenum>(type));
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    GLuint location = 0;
    for (const char* attribute : attributes) glBindAttribLocation(program, location++, attribute);
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

}  // namespace golden
