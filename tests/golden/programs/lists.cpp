// SPDX-License-Identifier: MIT
// Display lists, vertex arrays, evaluators.
#include <cmath>
#include <cstddef>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Vertex {
    GLfloat x, y, z;
    GLubyte r, g, b, a;
    GLshort s, t;
    GLbyte nx, ny, nz, pad;
    GLboolean edge;
};

std::vector<Vertex> vertices(int count) {
    std::vector<Vertex> made;
    for (int i = 0; i < count; ++i)
        made.push_back({random_unit() * 2 - 1, random_unit() * 2 - 1, random_unit() - 0.5f,
                        static_cast<GLubyte>(random_bits()), static_cast<GLubyte>(random_bits()),
                        static_cast<GLubyte>(random_bits()), 255, static_cast<GLshort>(i % 3),
                        static_cast<GLshort>(i % 2), 0, 0, 127, 0, static_cast<GLboolean>(i % 4 != 0)});
    return made;
}

void point_to(const std::vector<Vertex>& v) {
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), &v[0].x);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), &v[0].r);
    glTexCoordPointer(2, GL_SHORT, sizeof(Vertex), &v[0].s);
    glNormalPointer(GL_BYTE, sizeof(Vertex), &v[0].nx);
    glEdgeFlagPointer(sizeof(Vertex), &v[0].edge);
}

void disable_arrays() {
    for (const GLenum array :
         {GL_VERTEX_ARRAY, GL_COLOR_ARRAY, GL_TEXTURE_COORD_ARRAY, GL_NORMAL_ARRAY, GL_EDGE_FLAG_ARRAY})
        glDisableClientState(array);
}

}  // namespace

SCENE(list_state, 4) {  // lists that change state, matrices, textures and attributes
    if (frame == 0) {
        checker_texture(2, 16);
        glNewList(1, GL_COMPILE);
        glColor3f(1, 0.5f, 0);
        glTranslatef(0.4f, 0.1f, 0);
        glEnable(GL_TEXTURE_2D);
        glBindTexture(GL_TEXTURE_2D, 2);
        glEndList();
        glNewList(2, GL_COMPILE);
        glPushMatrix();
        glScalef(0.3f, 0.3f, 1);
        glRotatef(30, 0, 0, 1);
        unit_square();
        glPopMatrix();
        glEndList();
        glNewList(3, GL_COMPILE);
        glPushAttrib(GL_CURRENT_BIT | GL_ENABLE_BIT);
        glDisable(GL_TEXTURE_2D);
        glColor3f(0, 1, 1);
        glCallList(2);
        glPopAttrib();
        glEndList();
        glNewList(4, GL_COMPILE);
        glLoadIdentity();
        glDisable(GL_TEXTURE_2D);
        glCallList(9);   // defined later
        glCallList(77);  // never
        glEndList();
        glNewList(9, GL_COMPILE_AND_EXECUTE);
        glColor3f(0.3f, 1, 0.3f);
        glCallList(2);
        glEndList();
    }
    clear(0.1f, 0.1f, 0.3f);
    glTranslatef(-0.8f, -0.6f + 0.3f * static_cast<float>(frame), 0);
    glColor3f(1, 1, 1);
    glCallList(1);
    glCallList(2);
    glCallList(1);
    glCallList(3);
    glCallList(2);
    GLfloat colour[4], matrix[16];
    glGetFloatv(GL_CURRENT_COLOR, colour);
    glGetFloatv(GL_MODELVIEW_MATRIX, matrix);
    say("after lists: %.5g %.5g %.5g, at %.5g %.5g, texture %d", colour[0], colour[1], colour[2], matrix[12],
        matrix[13], glIsEnabled(GL_TEXTURE_2D));
    glCallList(4);
    if (frame == 2) {  // redefined
        glNewList(9, GL_COMPILE);
        glColor3f(1, 0, 1);
        glTranslatef(0.5f, 0.5f, 0);
        glCallList(2);
        glEndList();
    }
    say("is list %d %d", glIsList(9), glIsList(77));
}

SCENE(list_geometry, 4) {  // halves of Begin/End, calls inside it, bases and types
    clear();
    if (frame == 0) {
        const GLuint first = glGenLists(8);
        say("generated %u", first);
        for (GLuint i = 0; i < 8; ++i) {
            glNewList(first + i, GL_COMPILE);
            const float angle = static_cast<float>(i) * 0.785f;
            glColor3f(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2));
            glVertex2f(std::cos(angle) * 0.9f, std::sin(angle) * 0.9f);
            glEndList();
        }
        glNewList(100, GL_COMPILE);
        glBegin(GL_TRIANGLE_FAN);
        glColor3f(0.5f, 0.5f, 0.5f);
        glVertex2f(0, 0);
        glEndList();
        glNewList(101, GL_COMPILE);
        glEnd();
        glEndList();
        glNewList(102, GL_COMPILE);
        for (int i = 0; i < 4; ++i) glCallList(100 + static_cast<GLuint>(i % 2));
        glEndList();
        glNewList(103, GL_COMPILE);
        lit_sphere(60, 40);
        glEndList();
    }
    const GLubyte bytes[] = {0, 1, 2, 3, 4, 5, 6, 7};
    const GLushort shorts[] = {7, 5, 3, 1};
    const GLfloat floats[] = {0.2f, 2.9f, 4.0f, 6.7f};
    const GLubyte pairs[] = {0, 1, 0, 4, 0, 6};
    glListBase(1);
    glScalef(0.5f, 0.5f, 1);
    for (int i = 0; i < 4; ++i) {
        glPushMatrix();
        glTranslatef(i % 2 ? 1.0f : -1.0f, i / 2 ? 1.0f : -1.0f, 0);
        glCallList(100);
        if (i == 0) glCallLists(8, GL_UNSIGNED_BYTE, bytes);
        if (i == 1) glCallLists(4, GL_UNSIGNED_SHORT, shorts);
        if (i == 2) glCallLists(4, GL_FLOAT, floats);
        if (i == 3) glCallLists(3, GL_2_BYTES, pairs);
        glCallList(101);
        glPopMatrix();
    }
    glCallList(102);
    glTranslatef(0, 0.2f * static_cast<float>(frame), 0);
    glScalef(0.5f, 0.5f, 0.5f);
    glColor3f(1, 1, 0);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glCallList(103);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    if (frame == 3) {
        glDeleteLists(1, 8);
        glCallList(1);
        say("deleted: %d, next %u", glIsList(3), glGenLists(2));
    }
    glNewList(0, GL_COMPILE);
    say_error("list 0");
    glEndList();
    say_error("no list open");
    glListBase(0);
}

SCENE(list_images, 3) {  // pixels, arrays, evaluators and textures as they were when compiled
    clear();
    glShadeModel(GL_SMOOTH);
    if (frame == 0) {
        std::vector<GLubyte> image(32 * 32 * 4);
        for (auto& value : image) value = static_cast<GLubyte>(random_bits());
        auto made = vertices(30);
        point_to(made);
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_COLOR_ARRAY);
        const GLushort indices[] = {0, 5, 9, 2, 8, 20, 11, 29, 1};
        glNewList(30, GL_COMPILE);
        glRasterPos2f(-0.5f, -0.5f);
        glDrawPixels(32, 32, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        glBitmap(32, 32, 0, 0, 40, 10, image.data());
        glBitmap(32, 32, 0, 0, 40, 10, image.data());
        glDrawArrays(GL_TRIANGLES, 0, 12);
        glDrawElements(GL_TRIANGLES, 9, GL_UNSIGNED_SHORT, indices);
        glBindTexture(GL_TEXTURE_2D, 31);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glPolygonStipple(image.data());
        glEndList();
        disable_arrays();
        for (auto& value : image) value = 0;  // too late to matter
    }
    glTranslatef(0.1f * static_cast<float>(frame), 0, 0);
    glCallList(30);
    glEnable(GL_TEXTURE_2D);
    glEnable(GL_POLYGON_STIPPLE);
    glColor3f(1, 1, 1);
    glScalef(0.3f, 0.3f, 1);
    glTranslatef(2, 2, 0);
    unit_square();
    glDisable(GL_POLYGON_STIPPLE);
    glDisable(GL_TEXTURE_2D);
}

SCENE(vertex_arrays, 5) {
    clear();
    checker_texture(4, 8);
    auto made = vertices(64);
    point_to(made);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    if (frame == 1) {
        glEnableClientState(GL_TEXTURE_COORD_ARRAY);
        glEnable(GL_TEXTURE_2D);
    }
    if (frame == 2) {
        glEnableClientState(GL_EDGE_FLAG_ARRAY);
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    }
    if (frame == 3) {
        glEnableClientState(GL_NORMAL_ARRAY);
        glEnable(GL_LIGHTING);
        glEnable(GL_LIGHT0);
        glEnable(GL_COLOR_MATERIAL);
    }
    const GLubyte bytes[] = {0, 3, 9, 11, 40, 63};
    const GLushort shorts[] = {5, 6, 7, 30, 31, 32};
    const GLuint words[] = {60, 50, 40, 1, 2, 3};
    for (int i = 0; i < 8; ++i) {
        cell_view(i, 4, 2);
        if (i == 0) glDrawArrays(GL_TRIANGLES, 0, 15);
        if (i == 1) glDrawArrays(GL_TRIANGLE_STRIP, 20, 9);
        if (i == 2) glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_BYTE, bytes);
        if (i == 3) glDrawElements(GL_LINE_LOOP, 6, GL_UNSIGNED_SHORT, shorts);
        if (i == 4) glDrawElements(GL_TRIANGLE_FAN, 6, GL_UNSIGNED_INT, words);
        if (i == 5) {
            glBegin(GL_POLYGON);
            for (const GLint k : {3, 4, 8, 12, 1}) glArrayElement(k);
            glEnd();
        }
        if (i == 6) {  // the program changes its data between two draws
            for (auto& vertex : made) vertex.x *= 0.5f;
            glDrawArrays(GL_QUADS, 8, 8);
        }
        if (i == 7) {
            glDisableClientState(GL_COLOR_ARRAY);
            glColor3f(0.2f, 0.9f, 0.2f);
            glDrawRangeElements(GL_TRIANGLES, 30, 32, 3, GL_UNSIGNED_SHORT, shorts + 3);
            glEnableClientState(GL_COLOR_ARRAY);
        }
    }
    disable_arrays();
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_COLOR_MATERIAL);
    glDisable(GL_LIGHTING);
    glDisable(GL_LIGHT0);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    void* pointer = nullptr;
    glGetPointerv(GL_COLOR_ARRAY_POINTER, &pointer);
    GLint stride = 0, type = 0;
    glGetIntegerv(GL_COLOR_ARRAY_STRIDE, &stride);
    glGetIntegerv(GL_COLOR_ARRAY_TYPE, &type);
    say("pointer kept %d stride %d type %x", pointer == &made[0].r, stride, type);
}

SCENE(array_types, 2) {
    clear();
    const GLdouble doubles[] = {-0.9, -0.9, 0.8, -0.7, 0.1, 0.9};
    const GLshort shorts[] = {-1, -1, 1, -1, 0, 1};
    const GLint ints[] = {-1, 1, 0, 1, 1, 1, 0, 1, 0, -1, 0, 1};
    const GLfloat colours[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const GLushort dim[] = {65535, 0, 30000, 0, 65535, 30000, 20000, 20000, 65535};
    const GLdouble bright[] = {1, 1, 0, 1, 0, 1, 1, 1, 1, 0, 0, 1};
    const GLbyte signs[] = {127, 0, -128, 0, 127, 127, -1, 60, 0};
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    cell_view(0, 2, 2);
    glVertexPointer(2, GL_DOUBLE, 0, doubles);
    glColorPointer(3, GL_FLOAT, 0, colours);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    cell_view(1, 2, 2);
    glVertexPointer(2, GL_SHORT, 0, shorts);
    glColorPointer(3, GL_UNSIGNED_SHORT, 0, dim);
    glDrawArrays(frame ? GL_LINE_LOOP : GL_TRIANGLES, 0, 3);
    cell_view(2, 2, 2);
    glVertexPointer(4, GL_INT, 0, ints);
    glColorPointer(4, GL_DOUBLE, 0, bright);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    cell_view(3, 2, 2);
    glVertexPointer(2, GL_SHORT, 0, shorts);
    glColorPointer(3, GL_BYTE, 0, signs);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    disable_arrays();
}

SCENE(interleaved_arrays, 2) {
    const GLenum formats[] = {GL_V2F,         GL_V3F,         GL_C4UB_V2F,        GL_C4UB_V3F,       GL_C3F_V3F,
                              GL_N3F_V3F,     GL_C4F_N3F_V3F, GL_T2F_V3F,         GL_T4F_V4F,        GL_T2F_C4UB_V3F,
                              GL_T2F_C3F_V3F, GL_T2F_N3F_V3F, GL_T2F_C4F_N3F_V3F, GL_T4F_C4F_N3F_V4F};
    clear();
    checker_texture(4, 8);
    std::vector<GLfloat> data;
    for (int i = 0; i < 15 * 24; ++i) data.push_back(random_unit() * 2 - (i % 3 ? 1.0f : 0.6f));
    if (frame) glEnable(GL_TEXTURE_2D);
    for (int i = 0; i < 14; ++i) {
        cell_view(i, 5, 3);
        glColor3f(1, 1, 1);
        glInterleavedArrays(formats[i], 0, data.data());
        if (formats[i] == GL_T4F_V4F || formats[i] == GL_T4F_C4F_N3F_V4F)  // w of both signs is its own scene
            for (std::size_t k = 0; k < data.size(); ++k) data[k] = std::fabs(data[k]) + 0.1f;
        glDrawArrays(GL_TRIANGLES, 0, 12);
    }
    disable_arrays();
    glDisable(GL_TEXTURE_2D);
}

SCENE(evaluators, 5) {
    clear();
    perspective_view(canvas);
    glRotatef(-40, 1, 0.2f, 0);
    GLfloat surface[4][5][3], colours[2][2][4] = {{{1, 0, 0, 1}, {0, 1, 0, 1}}, {{0, 0, 1, 1}, {1, 1, 0, 1}}};
    const GLfloat coordinates[2][2][2] = {{{0, 0}, {0, 2}}, {{2, 0}, {2, 2}}};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 5; ++j) {
            surface[i][j][0] = static_cast<float>(j) * 0.6f - 1.2f;
            surface[i][j][1] = static_cast<float>(i) * 0.6f - 0.9f;
            surface[i][j][2] = random_unit() * 1.5f - 0.7f;
        }
    glMap2f(GL_MAP2_VERTEX_3, 0, 1, 3, 5, 0, 2, 15, 4, &surface[0][0][0]);
    glMap2f(GL_MAP2_COLOR_4, 0, 1, 4, 2, 0, 2, 8, 2, &colours[0][0][0]);
    glMap2f(GL_MAP2_TEXTURE_COORD_2, 0, 1, 2, 2, 0, 2, 4, 2, &coordinates[0][0][0]);
    glEnable(GL_MAP2_VERTEX_3);
    glEnable(GL_DEPTH_TEST);
    glMapGrid2f(14, 0, 1, 11, 0, 2);
    if (frame == 1 || frame == 3) glEnable(GL_MAP2_COLOR_4);
    if (frame == 2) {
        checker_texture(6, 16);
        glEnable(GL_TEXTURE_2D);
        glEnable(GL_MAP2_TEXTURE_COORD_2);
        glEnable(GL_AUTO_NORMAL);
        glEnable(GL_LIGHTING);
        glEnable(GL_LIGHT0);
    }
    glColor3f(0.7f, 0.7f, 0.7f);
    if (frame < 3) {
        glEvalMesh2(frame == 0 ? GL_LINE : GL_FILL, 0, 14, 0, 11);
    } else if (frame == 3) {
        for (int j = 0; j < 11; ++j) {
            glBegin(GL_QUAD_STRIP);
            for (int i = 0; i <= 14; ++i)
                glEvalPoint2(i, j), glEvalCoord2f(static_cast<float>(i) / 14, static_cast<float>(j + 1) * 2 / 11);
            glEnd();
        }
    } else {
        const GLdouble curve[] = {-1.5, -1, 0, 1, -0.5, 2, 0.3, 1, 0.7, -2, 0, 1, 1.5, 1, 0, 1};
        glMap1d(GL_MAP1_VERTEX_4, -1, 1, 4, 4, curve);
        glMap1f(GL_MAP1_COLOR_4, -1, 1, 4, 2, &colours[0][0][0]);
        glEnable(GL_MAP1_VERTEX_4);
        glEnable(GL_MAP1_COLOR_4);
        glMapGrid1d(30, -1, 1);
        glEvalMesh1(GL_LINE, 0, 30);
        glPointSize(5);
        glEvalMesh1(GL_POINT, 3, 20);
        glBegin(GL_LINE_STRIP);
        for (int i = 0; i < 20; ++i) glEvalCoord1d(-1 + i * 0.09);
        glEnd();
        glPointSize(1);
        GLint order = 0;
        GLdouble domain[2] = {}, back[16] = {};
        glGetMapiv(GL_MAP1_VERTEX_4, GL_ORDER, &order);
        glGetMapdv(GL_MAP1_VERTEX_4, GL_DOMAIN, domain);
        glGetMapdv(GL_MAP1_VERTEX_4, GL_COEFF, back);
        say("map order %d domain %.5g %.5g coefficients %.5g %.5g", order, domain[0], domain[1], back[4], back[13]);
    }
    GLfloat current[4];
    glGetFloatv(GL_CURRENT_COLOR, current);  // evaluation leaves the current colour alone
    say("colour %.5g %.5g %.5g", current[0], current[1], current[2]);
    for (const GLenum name : {GL_MAP2_VERTEX_3, GL_MAP2_COLOR_4, GL_MAP2_TEXTURE_COORD_2, GL_AUTO_NORMAL, GL_LIGHTING,
                              GL_LIGHT0, GL_TEXTURE_2D, GL_MAP1_VERTEX_4, GL_MAP1_COLOR_4, GL_DEPTH_TEST})
        glDisable(name);
}

}  // namespace golden
