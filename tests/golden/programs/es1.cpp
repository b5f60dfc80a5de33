// SPDX-License-Identifier: MIT
// OpenGL ES 1.1: lights, fog and matrices of fixed point over arrays of fixed point and bytes, points with sizes of an
// array, rectangles cut out of textures, palettes, cube maps with generated coordinates, and framebuffers by their old
// names. All of it reaches over tiles' borders.
#include <EGL/egl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr Needs kEs1{.es = 1};

// Words that the desktop's headers do not have.
constexpr GLenum kPointSizeArray = 0x8B9C, kCropRectangle = 0x8B9D, kGeneratedCoordinates = 0x8D60;
constexpr GLfixed kOne = 65536;

/// A command that libGL has no stub of, by its name.
template <class... Given>
void es(const char* name, Given... given) {
    reinterpret_cast<void (*)(Given...)>(eglGetProcAddress(name))(given...);
}

GLfixed fixed(float value) { return static_cast<GLfixed>(std::lround(value * 65536.0f)); }

void clear_es(float r, float g, float b) {
    es("glClearColorx", fixed(r), fixed(g), fixed(b), kOne);
    es("glClearDepthx", kOne);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

void perspective(Size canvas) {
    const float top = 0.57735f, right = top * static_cast<float>(canvas.width) / static_cast<float>(canvas.height);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    es("glFrustumx", fixed(-right), fixed(right), fixed(-top), fixed(top), kOne, 20 * kOne);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    es("glTranslatex", GLfixed{0}, GLfixed{0}, -3 * kOne);
}

void pixels(Size canvas) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    es("glOrthof", 0.0f, static_cast<float>(canvas.width), 0.0f, static_cast<float>(canvas.height), -1.0f, 1.0f);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

void checks(GLuint name, GLenum target, GLenum image) {
    std::vector<GLushort> texels;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            texels.push_back((x / 4 + y / 4) % 2 ? 0xF81F : static_cast<GLushort>(0x07E0 + x * 2));
    glBindTexture(target, name);
    glTexImage2D(image, 0, GL_RGB, 16, 16, 0, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, texels.data());
    es("glTexParameterx", target, GLenum{GL_TEXTURE_MIN_FILTER}, GLfixed{GL_NEAREST});
    es("glTexParameterx", target, GLenum{GL_TEXTURE_MAG_FILTER}, GLfixed{GL_NEAREST});
}

/// A ball of strips, in fixed point, with normals that are its vertices and coordinates of bytes.
struct Ball {
    static constexpr int kSlices = 20, kStacks = 12;
    std::vector<GLfixed> vertices;
    std::vector<GLbyte> coordinates;
    std::vector<GLushort> indices;

    Ball() {
        for (int stack = 0; stack <= kStacks; ++stack)
            for (int slice = 0; slice <= kSlices; ++slice) {
                const float up = 3.1416f * static_cast<float>(stack) / kStacks,
                            around = 6.2832f * static_cast<float>(slice) / kSlices;
                for (const float v : {std::sin(up) * std::cos(around), std::cos(up), std::sin(up) * std::sin(around)})
                    vertices.push_back(fixed(v));
                coordinates.push_back(static_cast<GLbyte>(slice));
                coordinates.push_back(static_cast<GLbyte>(stack));
            }
        for (int stack = 0; stack < kStacks; ++stack)
            for (int slice = 0; slice < kSlices; ++slice) {
                const int at = stack * (kSlices + 1) + slice, below = at + kSlices + 1;
                for (const int corner : {at, below, at + 1, at + 1, below, below + 1})
                    indices.push_back(static_cast<GLushort>(corner));
            }
    }
    void enable() const {
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_NORMAL_ARRAY);
        glVertexPointer(3, GL_FIXED, 0, vertices.data());
        glNormalPointer(GL_FIXED, 0, vertices.data());
    }
    void draw() const {
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_SHORT, indices.data());
    }
};

void light(int number, float x, float y, float red, float blue) {
    const auto name = static_cast<GLenum>(GL_LIGHT0 + number);
    const GLfixed place[4] = {fixed(x), fixed(y), 2 * kOne, 0}, color[4] = {fixed(red), kOne / 4, fixed(blue), kOne};
    es("glLightxv", name, GLenum{GL_POSITION}, static_cast<const GLfixed*>(place));
    es("glLightxv", name, GLenum{GL_DIFFUSE}, static_cast<const GLfixed*>(color));
    glEnable(name);
}

SCENE(es1_lights, 3, kEs1) {
    static const Ball ball;
    if (frame == 0) {
        checks(1, GL_TEXTURE_2D, GL_TEXTURE_2D);
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_LIGHTING);
        glEnable(GL_FOG);
        glEnable(GL_NORMALIZE);
        es("glFogx", GLenum{GL_FOG_MODE}, GLfixed{GL_LINEAR});
        es("glFogx", GLenum{GL_FOG_START}, 2 * kOne);
        es("glFogx", GLenum{GL_FOG_END}, 5 * kOne);
        const GLfixed gray[4] = {kOne / 2, kOne / 2, kOne / 2, kOne};
        es("glFogxv", GLenum{GL_FOG_COLOR}, static_cast<const GLfixed*>(gray));
        es("glMaterialx", GLenum{GL_FRONT_AND_BACK}, GLenum{GL_SHININESS}, 20 * kOne);
    }
    clear_es(0.1f, 0.2f, 0.3f);
    perspective(canvas);
    light(0, -1, 1, 1, 0);
    light(1, 2, -1, 0, 1);
    ball.enable();
    glEnable(GL_TEXTURE_2D);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(2, GL_BYTE, 0, ball.coordinates.data());
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    es("glScalex", kOne / 5, kOne / 6, kOne);
    glMatrixMode(GL_MODELVIEW);
    for (int i = 0; i < 4; ++i) {
        glPushMatrix();
        es("glTranslatex", fixed(static_cast<float>(i) * 0.9f - 1.4f), fixed(0.3f * static_cast<float>(i % 2)),
           -kOne * i / 2);
        es("glRotatex", (30 * i + 20 * frame) * kOne, kOne, kOne, GLfixed{0});
        es("glScalex", fixed(0.6f), fixed(0.6f), fixed(0.6f));
        if (i == 2) glDisable(GL_TEXTURE_2D);
        ball.draw();
        glPopMatrix();
    }
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    GLfixed answers[16] = {};
    es("glGetFixedv", GLenum{GL_FOG_END}, answers);
    es("glGetLightxv", GLenum{GL_LIGHT1}, GLenum{GL_DIFFUSE}, answers + 1);
    say("fixed %d %d %d", answers[0], answers[1], answers[3]);
    GLfixed mantissa[16];
    GLint exponent[16];
    es("glQueryMatrixxOES", mantissa, exponent);
    say("matrix %d %d", mantissa[14], exponent[14]);
}

// ---- points and rectangles ----

void palette_texture(GLuint name) {
    std::vector<GLubyte> image(16 * 3 + 8 * 8 / 2);
    for (std::size_t i = 0; i < 48; ++i) image[i] = static_cast<GLubyte>(i * 53);
    for (std::size_t i = 48; i < image.size(); ++i) image[i] = static_cast<GLubyte>(i * 29);
    glBindTexture(GL_TEXTURE_2D, name);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, GL_PALETTE4_RGB8_OES, 8, 8, 0, static_cast<GLsizei>(image.size()),
                           image.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

/// The texture's part, at a place of the window.
void rectangle(GLuint name, std::array<GLint, 4> part, float x, float y, float width, float height) {
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteriv(GL_TEXTURE_2D, kCropRectangle, part.data());
    es("glDrawTexfOES", x, y, 0.25f, width, height);
}

SCENE(es1_points, 2, kEs1) {
    if (frame == 0) {
        checks(1, GL_TEXTURE_2D, GL_TEXTURE_2D);
        palette_texture(2);
    }
    clear_es(0, 0.1f, 0);
    glEnable(GL_TEXTURE_2D);
    glEnable(GL_DEPTH_TEST);
    glColor4ub(255, 255, 255, 255);
    rectangle(1, {0, 0, 16, 16}, 20, 30, 112, 96);
    rectangle(2, {2, 1, 5, 6}, 150, 60, 160, 200);
    rectangle(1, {16, 4, -16, 8}, 300, 20, 64, 64);
    pixels(canvas);
    std::vector<GLfloat> places;
    std::vector<GLfixed> sizes;
    std::vector<GLubyte> colors;
    for (int i = 0; i < 60; ++i) {
        places.push_back(random_unit() * static_cast<float>(canvas.width));
        places.push_back(random_unit() * static_cast<float>(canvas.height));
        sizes.push_back(kOne * (4 + (i / 4) % 24));
        for (int k = 0; k < 4; ++k) colors.push_back(static_cast<GLubyte>(random_bits()));
    }
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glEnableClientState(kPointSizeArray);
    glVertexPointer(2, GL_FLOAT, 0, places.data());
    glColorPointer(4, GL_UNSIGNED_BYTE, 0, colors.data());
    es("glPointSizePointerOES", GLenum{GL_FIXED}, GLsizei{0}, static_cast<const void*>(sizes.data()));
    glBindTexture(GL_TEXTURE_2D, 1);
    glEnable(GL_POINT_SPRITE);
    es("glTexEnvx", GLenum{GL_POINT_SPRITE}, GLenum{GL_COORD_REPLACE}, GLfixed{1});
    glDrawArrays(GL_POINTS, 0, 30);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_POINT_SPRITE);
    std::vector<GLubyte> indices;
    for (GLubyte i = 59; i >= 30; i = static_cast<GLubyte>(i - 1 - frame)) indices.push_back(i);
    glDrawElements(GL_POINTS, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_BYTE, indices.data());
    glDisableClientState(kPointSizeArray);
    glDisableClientState(GL_COLOR_ARRAY);
}

// ---- framebuffers and cube maps ----

SCENE(es1_targets, 2, kEs1) {
    static const Ball ball;
    static GLuint framebuffer = 0;
    static constexpr GLsizei kSide = 64;
    if (frame == 0) {
        for (GLenum face = 0; face < 6; ++face) checks(3, GL_TEXTURE_CUBE_MAP, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face);
        glBindTexture(GL_TEXTURE_2D, 4);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, kSide, kSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        es("glGenFramebuffersOES", GLsizei{1}, &framebuffer);
    }
    es("glBindFramebufferOES", GLenum{GL_FRAMEBUFFER}, framebuffer);
    es("glFramebufferTexture2DOES", GLenum{GL_FRAMEBUFFER}, GLenum{GL_COLOR_ATTACHMENT0}, GLenum{GL_TEXTURE_2D},
       GLuint{4}, GLint{0});
    glViewport(0, 0, kSide, kSide);
    clear_es(0.5f, 0.2f, 0.1f * static_cast<float>(frame));
    perspective({kSide, kSide});
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glEnable(GL_TEXTURE_CUBE_MAP);
    glBindTexture(GL_TEXTURE_CUBE_MAP, 3);
    es("glTexGeniOES", kGeneratedCoordinates, GLenum{GL_TEXTURE_GEN_MODE}, GLint{GL_REFLECTION_MAP});
    glEnable(kGeneratedCoordinates);
    glColor4f(1, 1, 1, 1);
    ball.enable();
    es("glRotatex", (20 + 10 * frame) * kOne, GLfixed{0}, kOne, GLfixed{0});
    ball.draw();
    glDisable(kGeneratedCoordinates);
    glDisable(GL_TEXTURE_CUBE_MAP);
    glDisable(GL_CULL_FACE);
    es("glBindFramebufferOES", GLenum{GL_FRAMEBUFFER}, GLuint{0});
    glViewport(0, 0, canvas.width, canvas.height);
    clear_es(0, 0, 0.2f);
    perspective(canvas);
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 4);
    glDisableClientState(GL_NORMAL_ARRAY);
    static constexpr GLfloat kPlaces[] = {-2, -1.5f, 2, -1.5f, -2, 1.5f, 2, 1.5f},
                             kCoordinates[] = {0, 0, 2, 0, 0, 2, 2, 2};
    static GLuint buffer = 0;
    if (frame == 0) {
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glBufferData(GL_ARRAY_BUFFER, sizeof kPlaces, kPlaces, GL_STATIC_DRAW);
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexPointer(2, GL_FLOAT, 0, nullptr);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(2, GL_FLOAT, 0, kCoordinates);
    es("glRotatex", 30 * kOne, kOne, GLfixed{0}, GLfixed{0});
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
}

}  // namespace
}  // namespace golden
