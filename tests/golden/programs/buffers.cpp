// SPDX-License-Identifier: MIT
// What happens to fragments, and the buffers they go to: front and back, depth, stencil, accumulation.
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

void shards(int count, float z = 0) {
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < count * 3; ++i) {
        glColor4f(random_unit(), random_unit(), random_unit(), random_unit());
        glVertex3f(random_unit() * 2 - 1, random_unit() * 2 - 1, z + random_unit() * 1.6f - 0.8f);
    }
    glEnd();
}

}  // namespace

SCENE(clears, 4) {
    clear(0.1f, 0.2f, 0.3f);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 40; ++i) {
        glScissor(static_cast<int>(random_bits() % 420) - 20, static_cast<int>(random_bits() % 320) - 20, 30 + i * 3,
                  90 - i * 2);
        glColorMask(i % 2 > 0, i % 3 > 0, frame != 1, 1);
        glClearColor(random_unit(), random_unit(), random_unit(), random_unit());
        glClear(i % 4 ? GL_COLOR_BUFFER_BIT : GL_DEPTH_BUFFER_BIT);
    }
    glColorMask(1, 1, 1, 1);
    glScissor(180, 100, 0, 50);  // empty
    glClear(GL_COLOR_BUFFER_BIT);
    glScissor(0, 0, canvas.width, canvas.height);
    glDisable(GL_SCISSOR_TEST);
}

SCENE(depth, 8) {
    const GLenum functions[] = {GL_NEVER, GL_LESS, GL_EQUAL, GL_LEQUAL, GL_GREATER, GL_NOTEQUAL, GL_GEQUAL, GL_ALWAYS};
    clear();
    glClearDepth(0.5);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(functions[frame]);
    glDepthRange(frame % 3 ? 0 : 0.9, frame % 3 ? 1 : 0.1);
    shards(30);
    glDepthMask(GL_FALSE);
    shards(10);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDepthRange(0, 1);
    glDisable(GL_DEPTH_TEST);
}

SCENE(blending, 6) {
    const GLenum sources[] = {GL_ONE, GL_SRC_ALPHA, GL_DST_COLOR, GL_ONE_MINUS_DST_ALPHA, GL_SRC_ALPHA_SATURATE,
                              GL_ZERO};
    const GLenum destinations[] = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_COLOR, GL_DST_ALPHA,
                                   GL_ONE, GL_ONE_MINUS_SRC_COLOR};
    glClearColor(0.3f, 0.4f, 0.5f, 0.6f);
    glClear(GL_COLOR_BUFFER_BIT);
    cell_view(0, 1, 1);
    glEnable(GL_BLEND);
    glBlendFunc(sources[frame], destinations[frame]);
    shards(25);
    glDisable(GL_BLEND);
}

SCENE(logic_and_alpha, 8) {
    const GLenum operations[] = {GL_CLEAR, GL_XOR,  GL_INVERT,        GL_OR_REVERSE,
                                 GL_EQUIV, GL_NAND, GL_COPY_INVERTED, GL_AND};
    const GLenum functions[] = {GL_NEVER, GL_LESS, GL_EQUAL, GL_LEQUAL, GL_GREATER, GL_NOTEQUAL, GL_GEQUAL, GL_ALWAYS};
    clear(0.2f, 0.4f, 0.6f);
    glShadeModel(GL_FLAT);
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(operations[frame]);
    cell_view(0, 2, 1);
    shards(20);
    glDisable(GL_COLOR_LOGIC_OP);
    glEnable(GL_ALPHA_TEST);
    glAlphaFunc(functions[frame], 0.5f);
    cell_view(1, 2, 1);
    shards(20);
    glDisable(GL_ALPHA_TEST);
    glEnable(GL_DITHER);
}

SCENE(stencil, 6) {
    const GLenum operations[] = {GL_KEEP, GL_ZERO, GL_REPLACE, GL_INCR, GL_DECR, GL_INVERT};
    clear(0.1f, 0.1f, 0.1f);
    glClearStencil(2);
    glClear(GL_STENCIL_BUFFER_BIT);
    glEnable(GL_STENCIL_TEST);
    glEnable(GL_DEPTH_TEST);
    glStencilMask(frame == 5 ? 0x3 : 0xff);
    glStencilFunc(GL_LEQUAL, 1, 0x7);
    glStencilOp(operations[(frame + 2) % 6], operations[(frame + 1) % 6], operations[frame]);
    shards(40);
    glDisable(GL_DEPTH_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    for (int value = 0; value < 6; ++value) {
        glStencilFunc(GL_EQUAL, value, 0xf);
        glColor3f(static_cast<float>(value) / 5, 1 - static_cast<float>(value) / 5, 0.5f);
        glRectf(-0.8f, -0.8f, 0.8f, 0.8f);
    }
    glStencilMask(0xff);
    glDisable(GL_STENCIL_TEST);
}

SCENE(accumulation, 4) {
    glClearAccum(0.1f, 0, 0.2f, 0);
    glClear(GL_ACCUM_BUFFER_BIT);
    for (int pass = 0; pass < 4; ++pass) {
        clear(0, 0, 0.1f);
        perspective_view(canvas);
        glEnable(GL_DEPTH_TEST);
        glRotatef(static_cast<float>(pass * 4), 0, 1, 1);
        glColor3f(0.8f, 0.6f, 0.2f);
        lit_sphere(10, 5);
        glDisable(GL_DEPTH_TEST);
        shards(3);
        glAccum(pass == 0 && frame != 1 ? GL_LOAD : GL_ACCUM, 0.25f);
    }
    if (frame == 2) glAccum(GL_ADD, 0.1f), glAccum(GL_MULT, 0.8f);
    if (frame == 3) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(50, 40, 251, 187);
    }
    clear(0.4f, 0, 0);
    glAccum(GL_RETURN, frame == 2 ? 1.2f : 1.0f);
    glDisable(GL_SCISSOR_TEST);
}

SCENE(draw_buffers, 4) {
    glDrawBuffer(frame == 3 ? GL_FRONT_AND_BACK : GL_BACK);
    clear(0, 0.2f, 0.2f);
    shards(12);
    glDrawBuffer(GL_NONE);
    shards(5);
    glDrawBuffer(GL_BACK_LEFT);
    glPointSize(9);
    glBegin(GL_POINTS);
    glVertex2f(0, 0);
    glEnd();
    glPointSize(1);
    glDrawBuffer(GL_BACK);
    glDrawBuffer(GL_AUX0);
    say_error("no auxiliary buffer");
    GLint draw = 0, read = 0;
    glGetIntegerv(GL_DRAW_BUFFER, &draw);
    glGetIntegerv(GL_READ_BUFFER, &read);
    say("buffers %x %x", draw, read);
}

SCENE(front_buffer, 4, {.read = GL_FRONT}) {  // never swaps
    glDrawBuffer(GL_FRONT);
    if (frame == 0) clear(0, 0, 0.3f);
    shards(4 + frame);
    glFlush();
}

SCENE(single_buffered, 4, {.double_buffered = false}) {
    if (frame % 2 == 0) clear(0.2f, 0, 0);
    shards(5 + frame * 3);
    glFlush();
}

SCENE(kept_back_buffer, 5) {  // programs rely on it (pipes, noof)
    if (frame == 0) clear();
    perspective_view(canvas);
    glRotatef(static_cast<float>(frame) * 70, 0, 0, 1);
    glTranslatef(1, 0, 0);
    glScalef(0.3f, 0.3f, 0.3f);
    glColor3f(static_cast<float>(frame) * 0.2f, 1, 1 - static_cast<float>(frame) * 0.2f);
    lit_sphere();
}

SCENE(through_egl, 3, {.egl = true}) {
    clear(0.1f, 0, 0.1f);
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_TEXTURE_2D);
    if (frame == 0) checker_texture(1, 32);
    glRotatef(static_cast<float>(frame) * 25, 0.2f, 1, 0.3f);
    glColor3f(1, 1, 1);
    lit_sphere();
    glDisable(GL_TEXTURE_2D);
    shards(6);
    glDisable(GL_DEPTH_TEST);
}

SCENE(polygon_smooth, 2) {
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    perspective_view(canvas);
    glEnable(GL_POLYGON_SMOOTH);
    glEnable(GL_BLEND);
    glBlendFunc(frame ? GL_SRC_ALPHA_SATURATE : GL_SRC_ALPHA, frame ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    glHint(GL_POLYGON_SMOOTH_HINT, GL_NICEST);
    shards(10);
    glDisable(GL_BLEND);
    glDisable(GL_POLYGON_SMOOTH);
}

}  // namespace golden
