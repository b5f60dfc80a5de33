// SPDX-License-Identifier: MIT
// Windows with left and right buffers (OpenGL 4.6, 17.4.1; GLX 1.4, GLX_STEREO). Where there are none, such as on
// Mesa's software renderers, the scene draws what the eye GOLDEN_EYE ("left" or "right") sees: all of the same, with
// colours where that eye's are. It is also the eye whose picture is read.
#include <cstdlib>
#include <string_view>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

enum class Eye { left, right };

Eye golden_eye() {
    const char* name = std::getenv("GOLDEN_EYE");
    return name && std::string_view(name) == "right" ? Eye::right : Eye::left;
}

bool has_both() {
    GLboolean stereo = GL_FALSE;
    glGetBooleanv(GL_STEREO, &stereo);
    return stereo == GL_TRUE;
}

GLenum buffer_of(Eye eye) {
    if (has_both()) return eye == Eye::left ? GL_BACK_LEFT : GL_BACK_RIGHT;
    return eye == golden_eye() ? GL_BACK : GL_NONE;
}

/// As a program with two cameras does it: each eye beside the other, off-axis, so that their pictures meet at 3.
void look(Eye eye, Size canvas) {
    constexpr double kNear = 1, kMeet = 3, kApart = 0.3;
    const double half = 0.577, wide = half * canvas.width / canvas.height;
    const double side = (eye == Eye::left ? -1 : 1) * kApart / 2;
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-wide - side * kNear / kMeet, wide - side * kNear / kMeet, -half, half, kNear, 10);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslated(-side, 0, -kMeet);
}

void things(int frame) {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    for (const double z : {-1.5, 0.0, 1.0}) {
        glPushMatrix();
        glTranslated(z * 0.6, 0.2 * frame - 0.4, z);
        glScaled(0.6, 0.6, 0.6);
        lit_sphere();
        glPopMatrix();
    }
    glDisable(GL_LIGHTING);
}

/// Both eyes' pictures in one go; then a corner of each by itself.
void together(int frame, Size canvas) {
    glDrawBuffer(has_both() ? GL_BACK : buffer_of(golden_eye()));
    clear(0.1f, 0.2f, 0.3f);
    look(Eye::left, canvas);
    things(frame);
    glEnable(GL_SCISSOR_TEST);
    for (const Eye eye : {Eye::left, Eye::right}) {
        glDrawBuffer(buffer_of(eye));
        glScissor(eye == Eye::left ? 20 : canvas.width - 80, 30, 60, 40);
        clear(1, eye == Eye::left ? 0.0f : 0.5f, 0);
    }
    glDisable(GL_SCISSOR_TEST);
}

void one_by_one(int frame, Size canvas) {
    for (const Eye eye : {Eye::left, Eye::right}) {
        glDrawBuffer(buffer_of(eye));
        clear(0, eye == Eye::left ? 0.2f : 0.0f, 0.2f);
        look(eye, canvas);
        things(frame);
    }
}

/// What the left eye's picture has left in the depth and the stencil buffer counts for the right eye's.
void with_one_depth(int frame, Size canvas) {
    one_by_one(frame, canvas);
    glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    for (const Eye eye : {Eye::left, Eye::right}) {
        glDrawBuffer(buffer_of(eye));
        glStencilFunc(GL_GREATER, 1, 0xff);
        glColor3f(1, 1, eye == Eye::left ? 0.0f : 1.0f);
        pixel_view(canvas);
        glTranslated(0, 0, eye == Eye::left ? -0.2 : 0.3);
        glRectf(100, 50, eye == Eye::left ? 220.0f : 320.0f, 250);
    }
    glDisable(GL_STENCIL_TEST);
}

}  // namespace

SCENE(two_eyes, 6, {.stereo = true}) {
    glReadBuffer(has_both() ? buffer_of(golden_eye()) : GL_BACK);
    switch (frame % 3) {
        case 0: together(frame, canvas); break;
        case 1: one_by_one(frame, canvas); break;
        case 2: with_one_depth(frame, canvas); break;
    }
}

}  // namespace golden
