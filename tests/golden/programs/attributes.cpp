// SPDX-License-Identifier: MIT
// Vertex attributes beyond the usual ones, in large primitives that lie on several tiles: each tile's part has to see
// the values that were set last, however long ago.
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kColumns = 60;

/// A vertex of a wavy band, with some of its attributes: those of the second texture unit change seldom.
void band_vertex(int i, float y) {
    const float x = static_cast<float>(i) * 1.9f / kColumns - 0.95f;
    glColor3f(0.5f + 0.5f * std::sin(x * 9), 0.7f, 0.5f + 0.5f * y);
    if (i % 7 == 0) glMultiTexCoord2f(GL_TEXTURE1, x * 3, y * 3);
    if (i % 5 == 0) glSecondaryColor3f(0.2f * static_cast<float>(i % 3), 0, 0.1f);
    glMultiTexCoord2f(GL_TEXTURE0, x, y);
    glVertex2f(x, y + 0.1f * std::sin(x * 20));
}

void bands() {
    for (const float y : {-0.9f, -0.1f}) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int i = 0; i <= kColumns; ++i) band_vertex(i, y), band_vertex(i, y + 0.7f);
        glEnd();
        glMultiTexCoord4f(GL_TEXTURE1, 0.2f, 0.3f, 0, 1);  // between two primitives
    }
}

void fan_and_quads() {
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 80; ++i) {
        const float angle = static_cast<float>(i) * 0.08f;
        if (i % 9 == 0) glMultiTexCoord2f(GL_TEXTURE1, std::cos(angle), std::sin(angle));
        glVertex2f(i ? 0.9f * std::cos(angle) : 0.1f, i ? 0.9f * std::sin(angle) : -0.1f);
    }
    glEnd();
    glBegin(GL_QUADS);
    for (int i = 0; i < 48; ++i) {
        const float x = static_cast<float>(i % 8) * 0.24f - 0.95f, y = static_cast<float>(i / 8) * 0.3f - 0.9f;
        glMultiTexCoord2f(GL_TEXTURE1, x, y);
        glVertexAttrib4f(6, x, y, 0, 1);  // nobody reads it
        glVertex2f(x, y), glVertex2f(x + 0.1f, y), glVertex2f(x + 0.1f, y + 0.1f), glVertex2f(x, y + 0.1f);
    }
    glEnd();
}

/// Linear, since which texel is nearest is decided by rounding where one ends.
void smooth_texture(GLuint name, int size) {
    checker_texture(name, size);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glEnable(GL_TEXTURE_2D);
}

}  // namespace

SCENE(attributes_apart, 3) {
    clear(0.1f, 0.1f, 0.1f);
    glActiveTexture(GL_TEXTURE1);
    smooth_texture(91, 8);
    glActiveTexture(GL_TEXTURE0);
    smooth_texture(90, 32);
    if (frame == 1) glEnable(GL_COLOR_SUM);
    glColor3f(1, 1, 1);
    glMultiTexCoord2f(GL_TEXTURE1, 0.6f, 0.1f);
    if (frame < 2) bands();
    else fan_and_quads();
    GLfloat second[4];
    glActiveTexture(GL_TEXTURE1);
    glGetFloatv(GL_CURRENT_TEXTURE_COORDS, second);
    say("second unit %.5g %.5g", second[0], second[1]);
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE0);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_COLOR_SUM);
    say_error("attributes_apart");
}

}  // namespace golden
