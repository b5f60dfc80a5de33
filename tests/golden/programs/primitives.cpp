// SPDX-License-Identifier: MIT
// Points, lines, polygons and how long runs of vertices hold together.
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

void fan_of_vertices(int count) {
    for (int i = 0; i < count; ++i) {
        const float angle = static_cast<float>(i) * 6.2831853f / static_cast<float>(count);
        glColor3f(0.5f + 0.5f * std::cos(angle), 0.5f + 0.5f * std::sin(angle), static_cast<float>(i % 3) * 0.4f);
        glVertex2f(std::cos(angle) * 0.9f, std::sin(angle) * 0.9f);
    }
}

void zigzag(int count) {
    for (int i = 0; i < count; ++i) {
        const float x = -0.95f + 1.9f * static_cast<float>(i / 2) / static_cast<float>(count / 2);
        glColor3f(random_unit(), random_unit(), random_unit());
        glVertex2f(x, i % 2 ? 0.8f : -0.8f);
    }
}

void soup(int count) {
    for (int i = 0; i < count; ++i) {
        glColor3f(random_unit(), random_unit(), random_unit());
        glVertex2f(random_unit() * 2 - 1, random_unit() * 2 - 1);
    }
}

void big_mesh(Size canvas) {
    pixel_view(canvas);
    const int columns = 200, rows = 75;
    for (int y = 0; y < rows; ++y) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int x = 0; x <= columns; ++x)
            for (int k = 0; k < 2; ++k) {
                const float u = static_cast<float>(x) / columns, v = static_cast<float>(y + k) / rows;
                glColor3f(u, v, 0.5f + 0.5f * std::sin(u * 30) * std::sin(v * 20));
                glVertex2f(u * static_cast<float>(canvas.width), v * static_cast<float>(canvas.height));
            }
        glEnd();
    }
}

void one_long_strip(Size canvas) {
    perspective_view(canvas);
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i < 20000; ++i) {
        const float t = static_cast<float>(i) * 0.0045f, r = 0.2f + static_cast<float>(i) * 0.00006f;
        glColor3f(0.5f + 0.5f * std::sin(t), 0.5f + 0.5f * std::cos(t * 0.7f), static_cast<float>(i % 2));
        glVertex3f(r * std::cos(t) * (i % 2 ? 0.9f : 1.0f), r * std::sin(t) * (i % 2 ? 0.9f : 1.0f),
                   static_cast<float>(i) * 0.00002f);
    }
    glEnd();
}

// Without stipple: Mesa starts its pattern anew wherever its own vertex buffer happens to be full.
void long_line_strip(Size canvas, GLenum mode) {
    perspective_view(canvas);
    glBegin(mode);
    for (int i = 0; i < 9000; ++i) {
        const float t = static_cast<float>(i) * 0.02f;
        glColor3f(1, 0.5f + 0.5f * std::sin(t * 0.1f), 0.5f + 0.5f * std::cos(t * 0.13f));
        glVertex3f(std::sin(t * 1.01f) * 1.6f, std::cos(t * 0.731f) * 1.2f, std::sin(t * 0.31f));
    }
    glEnd();
}

}  // namespace

SCENE(primitive_modes, 3) {
    const GLenum modes[] = {GL_POINTS,         GL_LINES,        GL_LINE_STRIP, GL_LINE_LOOP,  GL_TRIANGLES,
                            GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN, GL_QUADS,      GL_QUAD_STRIP, GL_POLYGON};
    clear(0.1f, 0.1f, 0.2f);
    glShadeModel(frame == 1 ? GL_FLAT : GL_SMOOTH);  // flat: the provoking vertex
    for (int i = 0; i < 20; ++i) {
        cell_view(i, 5, 4);
        const int count = i < 10 ? 12 : 13 + i % 3;  // incomplete primitives as well
        glBegin(modes[i % 10]);
        if (frame == 2) zigzag(count);
        else if (modes[i % 10] == GL_POLYGON || modes[i % 10] == GL_TRIANGLE_FAN) fan_of_vertices(count);
        else soup(count);
        glEnd();
    }
    glBegin(GL_TRIANGLES);  // nothing at all
    glEnd();
}

SCENE(long_runs, 4) {
    clear();
    glShadeModel(GL_SMOOTH);
    if (frame == 0) big_mesh(canvas);
    if (frame == 1) one_long_strip(canvas);
    if (frame == 2) long_line_strip(canvas, GL_LINE_STRIP);
    if (frame == 3) long_line_strip(canvas, GL_LINE_LOOP);
}

SCENE(long_polygons, 2) {  // filled: Mesa's own cuts of so long an outline show
    clear();
    glShadeModel(frame == 1 ? GL_FLAT : GL_SMOOTH);
    cell_view(0, 1, 1);
    glBegin(GL_POLYGON);
    fan_of_vertices(7001);
    glEnd();
    glTranslatef(0.2f, 0.1f, -0.1f);
    glScalef(0.5f, 0.5f, 1);
    glBegin(GL_TRIANGLE_FAN);
    glVertex2f(0.1f, 0.2f);
    fan_of_vertices(6500);
    glEnd();
    glTranslatef(-0.4f, -0.1f, -0.1f);
    glBegin(GL_QUAD_STRIP);
    zigzag(6000);
    glEnd();
}

SCENE(points, 2) {
    clear();
    pixel_view(canvas);
    if (frame) {
        glEnable(GL_POINT_SMOOTH);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    for (int size = 1; size < 28; ++size) {
        glPointSize(static_cast<float>(size) * 0.7f + 0.3f);
        glBegin(GL_POINTS);
        for (int i = 0; i < 12; ++i) {
            glColor4f(random_unit(), random_unit(), 1, 0.7f);
            glVertex2f(random_unit() * static_cast<float>(canvas.width),
                       random_unit() * static_cast<float>(canvas.height));
        }
        glEnd();
    }
    glPointSize(1);
    glBegin(GL_POINTS);
    for (int i = 0; i < 2000; ++i) {
        glColor3f(random_unit(), 1, random_unit());
        glVertex2i(static_cast<int>(random_bits() % 400), static_cast<int>(random_bits() % 300));
    }
    glEnd();
}

SCENE(lines, 4) {
    clear();
    pixel_view(canvas);
    const bool smooth = frame & 1, stipple = frame & 2;
    (smooth ? glEnable : glDisable)(GL_LINE_SMOOTH);
    (smooth ? glEnable : glDisable)(GL_BLEND);
    (stipple ? glEnable : glDisable)(GL_LINE_STIPPLE);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE);
    for (int i = 0; i < 60; ++i) {
        glLineWidth(0.5f + static_cast<float>(i % 9));
        glLineStipple(1 + i % 5, static_cast<GLushort>(0x5a3c + i * 977));
        glColor4f(random_unit(), random_unit(), random_unit(), 0.8f);
        glBegin(i % 3 ? GL_LINES : GL_LINE_STRIP);
        for (int k = 0; k < 4; ++k)
            glVertex2f(random_unit() * static_cast<float>(canvas.width),
                       random_unit() * static_cast<float>(canvas.height));
        glEnd();
    }
    glLineWidth(1);
}

SCENE(polygon_modes, 4) {
    clear(0.2f, 0.2f, 0.2f);
    const GLenum modes[] = {GL_FILL, GL_LINE, GL_POINT};
    glPointSize(4);
    glLineWidth(2);
    glFrontFace(frame & 1 ? GL_CW : GL_CCW);
    if (frame & 2) glEnable(GL_CULL_FACE);
    for (int i = 0; i < 12; ++i) {
        cell_view(i, 4, 3);
        glCullFace(i % 2 ? GL_FRONT : GL_BACK);
        glPolygonMode(GL_FRONT, modes[i % 3]);
        glPolygonMode(GL_BACK, modes[(i / 3) % 3]);
        glBegin(GL_TRIANGLES);
        for (int k = 0; k < 6; ++k) {
            glEdgeFlag((i + k) % 4 != 0);
            glColor3f(random_unit(), random_unit(), random_unit());
            glVertex2f(random_unit() * 2 - 1, random_unit() * 2 - 1);
        }
        glEnd();
        glBegin(GL_POLYGON);
        for (int k = 0; k < 7; ++k) {
            const float angle = static_cast<float>(i % 2 ? k : -k) * 0.8976f;
            glEdgeFlag(k % 3 != 1);
            glVertex2f(0.6f * std::cos(angle), 0.6f * std::sin(angle));
        }
        glEnd();
        glEdgeFlag(GL_TRUE);
    }
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

SCENE(polygon_stipple_offset, 3) {
    clear();
    GLubyte pattern[128];
    for (int i = 0; i < 128; ++i) pattern[i] = static_cast<GLubyte>((i / 4) % 2 ? 0xcc ^ i : 0x33 + frame * 40);
    glEnable(GL_POLYGON_STIPPLE);
    glPolygonStipple(pattern);
    for (int i = 0; i < 6; ++i) {
        cell_view(i, 3, 2);
        glColor3f(random_unit(), random_unit(), random_unit());
        unit_square();
    }
    glDisable(GL_POLYGON_STIPPLE);
    GLubyte answer[128] = {};
    glGetPolygonStipple(answer);
    say("stipple %02x %02x %02x %02x", answer[0], answer[1], answer[70], answer[127]);

    perspective_view(canvas);  // decals on a sphere, by offset
    glEnable(GL_DEPTH_TEST);
    glRotatef(30, 1, 1, 0);
    glColor3f(0.3f, 0.3f, 0.6f);
    lit_sphere(16, 8, false);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(-1.0f, -2.0f * static_cast<float>(frame + 1));
    glColor3f(1, 1, 0);
    lit_sphere(16, 8, false);
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_DEPTH_TEST);
}

SCENE(near_plane, 3) {  // vertices behind the viewer, w <= 0
    clear();
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glBegin(frame == 2 ? GL_LINES : GL_TRIANGLES);
    for (int i = 0; i < 90; ++i) {
        glColor3f(random_unit(), random_unit(), random_unit());
        const float w = frame == 1 ? random_unit() * 2 - 0.5f : 1.0f;
        glVertex4f(random_unit() * 8 - 4, random_unit() * 8 - 4, random_unit() * 10 - 5, w);
    }
    glEnd();
    glDisable(GL_DEPTH_TEST);
}

SCENE(rectangles_viewports, 3) {
    clear(0, 0.1f, 0);
    pixel_view(canvas);
    glColor3f(1, 0.5f, 0);
    glRectf(10.5f, 10.5f, 120.25f, 50);
    glRecti(200, 20, 150, 90);
    glColor3f(0, 0.5f, 1);
    const GLdouble a[] = {220, 100}, b[] = {300.5, 180.5};
    glRectdv(a, b);
    const GLshort c[] = {5, 200}, d[] = {60, 280};
    glRectsv(c, d);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 8; ++i) {
        const int x = -60 + i * 55 + frame * 7, y = -40 + i * 31;
        glViewport(x, y, 160 + i * 9, 120 - i * 5);
        glScissor(x + 11, y + 7, 100, 77);
        glDepthRange(0.1 * i, 1 - 0.1 * i);
        glMatrixMode(GL_PROJECTION);
        glLoadIdentity();
        glMatrixMode(GL_MODELVIEW);
        glColor3f(random_unit(), random_unit(), random_unit());
        glBegin(GL_POLYGON);
        for (int k = 0; k < 9; ++k)
            glVertex2f(1.3f * std::cos(static_cast<float>(k) * 0.698f),
                       1.3f * std::sin(static_cast<float>(k) * 0.698f));
        glEnd();
        if (i == frame) glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    glDepthRange(0, 1);
    glViewport(0, 0, canvas.width, canvas.height);
}

}  // namespace golden
