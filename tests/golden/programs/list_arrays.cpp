// SPDX-License-Identifier: MIT
// Display lists made from vertex arrays: what they draw, and the current values that programs find behind them.
#include <array>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Vertex {
    GLfloat place[2], colour[3], normal[3], texture[2];
};
constexpr std::array<Vertex, 3> kTriangle{{{{-0.9f, -0.9f}, {1, 0, 0}, {1, 0, 0.2f}, {0, 0}},
                                           {{0.9f, -0.8f}, {0, 0, 1}, {-1, 0, 0.2f}, {0.7f, 0.7f}},
                                           {{0, 0.9f}, {0, 1, 0}, {0, 1, 0.2f}, {0.9f, 0.8f}}}};
constexpr GLenum kArrays[] = {GL_VERTEX_ARRAY, GL_COLOR_ARRAY, GL_NORMAL_ARRAY, GL_TEXTURE_COORD_ARRAY};

void point_to_arrays() {
    glVertexPointer(2, GL_FLOAT, sizeof(Vertex), kTriangle[0].place);
    glColorPointer(3, GL_FLOAT, sizeof(Vertex), kTriangle[0].colour);
    glNormalPointer(GL_FLOAT, sizeof(Vertex), kTriangle[0].normal);
    glTexCoordPointer(2, GL_FLOAT, sizeof(Vertex), kTriangle[0].texture);
    for (const GLenum array : kArrays) glEnableClientState(array);
}

void arrays() { glDrawArrays(GL_TRIANGLES, 0, 3); }
void line() {
    glBegin(GL_LINES);
    glVertex2f(-0.9f, 0.7f);
    glVertex2f(0.9f, 0.6f);
    glEnd();
}
void yellow_line() {
    glBegin(GL_LINES);
    glColor3f(1, 1, 0);
    glVertex2f(-0.9f, -0.5f);
    glVertex2f(0.9f, -0.4f);
    glEnd();
}

struct MixedList {
    const char* name;
    void (*compile)();
};
constexpr MixedList kMixed[] = {
    {"arrays", arrays},
    {"arrays, vertices", [] { arrays(), line(); }},
    {"arrays, normal, vertices", [] { arrays(), glNormal3f(0, 0, 1), line(); }},
    {"arrays, colour, arrays", [] { arrays(), glColor3f(1, 1, 0), arrays(); }},
    {"vertices, arrays", [] { yellow_line(), arrays(); }},
    {"arrays without colour",
     [] {
         glDisableClientState(GL_COLOR_ARRAY);
         glColor3f(1, 0, 1), arrays();
         glEnableClientState(GL_COLOR_ARRAY);
     }},
    {"arrays, state, vertices", [] { arrays(), glLineWidth(3), line(), glLineWidth(1); }},
    {"arrays, vertices, arrays", [] { arrays(), yellow_line(), arrays(); }},
    {"arrays, colour", [] { arrays(), glColor3f(0, 1, 1); }},
    {"elements",
     [] {
         const GLubyte indices[] = {2, 0, 1};
         glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_BYTE, indices);
     }},
    {"called list, vertices", [] { glCallList(200), line(); }},
    {"array elements",
     [] {
         glBegin(GL_TRIANGLES);
         for (int i = 0; i < 3; ++i) glArrayElement(i);
         glEnd();
     }},
};

}  // namespace

SCENE(list_arrays, 3) {  // frame 1 is lit, frame 2 lit with colours as materials
    clear(0.1f, 0.1f, 0.2f);
    if (frame == 0) {
        point_to_arrays();
        GLuint name = 200;
        for (const MixedList& mixed : kMixed) {
            glNewList(name++, GL_COMPILE);
            mixed.compile();
            glEndList();
        }
        for (const GLenum array : kArrays) glDisableClientState(array);
    }
    if (frame > 0) glEnable(GL_LIGHTING), glEnable(GL_LIGHT0), glEnable(GL_NORMALIZE);
    if (frame > 1) glEnable(GL_COLOR_MATERIAL);
    int cell = 0;
    for (const MixedList& mixed : kMixed) {
        cell_view(cell, 4, 3);
        glColor3f(0.9f, 0.6f, 0.5f);
        glNormal3f(0, 0, 1);
        glTexCoord2f(0.5f, 0.25f);
        glCallList(200 + static_cast<GLuint>(cell++));
        GLfloat colour[4], normal[3], texture[4], diffuse[4];
        glGetFloatv(GL_CURRENT_COLOR, colour);
        glGetFloatv(GL_CURRENT_NORMAL, normal);
        glGetFloatv(GL_CURRENT_TEXTURE_COORDS, texture);
        glGetMaterialfv(GL_FRONT, GL_DIFFUSE, diffuse);
        say("%s: colour %.5g %.5g %.5g normal %.5g %.5g %.5g texture %.5g %.5g diffuse %.5g %.5g", mixed.name,
            colour[0], colour[1], colour[2], normal[0], normal[1], normal[2], texture[0], texture[1], diffuse[0],
            diffuse[1]);
        glBegin(GL_TRIANGLES);  // with what is current now
        glVertex2f(-0.5f, 0.9f);
        glVertex2f(-0.9f, 0.9f);
        glVertex2f(-0.7f, 0.2f);
        glEnd();
    }
    for (const GLenum name : {GL_LIGHTING, GL_LIGHT0, GL_NORMALIZE, GL_COLOR_MATERIAL}) glDisable(name);
    say_error("list_arrays");
}

}  // namespace golden
