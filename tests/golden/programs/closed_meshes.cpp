// SPDX-License-Identifier: MIT
// Meshes without a hole, vertex by vertex, in strips and in triangles that share their edges: from outside, in front of
// a ground that is to be seen nowhere within them; and from inside, through the eye's plane and behind it, where the
// ground is to be seen nowhere at all. Whoever moves vertices must move all that are at one place alike. They are
// others in each frame.
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kSlices = 60, kStacks = 31;

float wobble = 0;  // of the frame

/// A point of a sphere with dents, of about radius 1; the same bits for the first slice and the last.
void dented(int slice, int stack) {
    const float turn = static_cast<float>(slice % kSlices) * 6.2831853f / kSlices;
    const float rise = stack == 0 || stack == kStacks ? 0 : std::sin(static_cast<float>(stack) * 3.1415927f / kStacks);
    const float radius = 1 + 0.17f * rise * std::sin(5 * turn + wobble) * std::cos(static_cast<float>(stack) * 0.9f);
    const float x = radius * rise * std::cos(turn), y = radius * rise * std::sin(turn);
    const float z = std::cos(static_cast<float>(stack) * 3.1415927f / kStacks) * (rise == 0 ? 1 : radius);
    glNormal3f(x, y, z);
    glColor3f(0.2f + 0.1f * static_cast<float>(slice % 7), 0.5f + 0.4f * rise, 0.3f);
    glVertex3f(x, y, z);
}

void strips() {
    for (int stack = 0; stack < kStacks; ++stack) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int slice = 0; slice <= kSlices; ++slice) dented(slice, stack), dented(slice, stack + 1);
        glEnd();
    }
}

/// Each in an order of its own, with a change of state every now and then, which ends what is packed so far.
void triangles() {
    for (int stack = 0; stack < kStacks; ++stack) {
        if (stack % 5 == 0) glShadeModel(stack % 2 ? GL_FLAT : GL_SMOOTH);
        glBegin(GL_TRIANGLES);
        for (int slice = 0; slice < kSlices; ++slice) {
            dented(slice, stack), dented(slice + 1, stack), dented(slice, stack + 1);
            dented(slice, stack + 1), dented(slice + 1, stack), dented(slice + 1, stack + 1);
        }
        glEnd();
    }
    glShadeModel(GL_SMOOTH);
}

}  // namespace

// Frames 0, 2, ... show them from outside, the others from inside.
SCENE(closed_meshes, 8) {
    clear(1, 0, 1);
    glEnable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    const double ratio = static_cast<double>(canvas.width) / canvas.height, near = 0.05;
    glFrustum(-near * ratio, near * ratio, -near, near, near, 200);
    glMatrixMode(GL_MODELVIEW);
    const auto turned = static_cast<float>(frame);
    wobble = 0.1f * turned;
    if (frame % 2 != 0) {
        glLoadIdentity();
        glTranslatef(0.3f, 0.2f, -1.5f);
        glRotatef(17 * turned, 0.3f, 1, 0.2f);
        glScalef(4, 3, 9);
        frame % 4 == 1 ? strips() : triangles();
        return;
    }
    for (int i = 0; i < 3; ++i) {
        glLoadIdentity();
        glTranslatef(static_cast<float>(i) * 2 - 2, static_cast<float>(i % 2), -2.0f - 3 * static_cast<float>(i));
        glRotatef(17 * turned + 30 * static_cast<float>(i), 1, static_cast<float>(i), 0.2f);
        (i + frame / 2) % 2 == 0 ? strips() : triangles();
    }
}

}  // namespace golden
