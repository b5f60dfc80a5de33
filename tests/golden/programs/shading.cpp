// SPDX-License-Identifier: MIT
// Lighting, materials, fog, clip planes, texture coordinate generation, texture environments and images.
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

void light(GLenum name, float x, float y, float z, float w, float r, float g, float b) {
    const GLfloat position[] = {x, y, z, w}, colour[] = {r, g, b, 1};
    glLightfv(name, GL_POSITION, position);
    glLightfv(name, GL_DIFFUSE, colour);
    glLightfv(name, GL_SPECULAR, colour);
    glEnable(name);
}

void material(GLenum face, float r, float g, float b, float shininess) {
    const GLfloat diffuse[] = {r, g, b, 1}, specular[] = {0.7f, 0.7f, 0.7f, 1};
    glMaterialfv(face, GL_AMBIENT_AND_DIFFUSE, diffuse);
    glMaterialfv(face, GL_SPECULAR, specular);
    glMaterialf(face, GL_SHININESS, shininess);
}

void lights_off() {
    glDisable(GL_LIGHTING);
    for (GLenum i = 0; i < 8; ++i) glDisable(GL_LIGHT0 + i);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace

SCENE(lighting, 5) {
    clear(0.05f, 0.05f, 0.05f);
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    light(GL_LIGHT0, 2, 2, 3, 1, 1, 0.9f, 0.8f);
    light(GL_LIGHT1, -1, 0.5f, 0.3f, 0, 0.2f, 0.4f, 1);
    const GLfloat toward[] = {0, -0.3f, -1};
    light(GL_LIGHT2, 0, 1, 3, 1, 1, 0, 0);
    glLightfv(GL_LIGHT2, GL_SPOT_DIRECTION, toward);
    glLightf(GL_LIGHT2, GL_SPOT_CUTOFF, 14);
    glLightf(GL_LIGHT2, GL_SPOT_EXPONENT, 9);
    light(GL_LIGHT7, 0, -2, 0, 1, 0, 1, 0.3f);
    glLightf(GL_LIGHT7, GL_CONSTANT_ATTENUATION, 0.6f);
    glLightf(GL_LIGHT7, GL_LINEAR_ATTENUATION, 0.3f);
    glLightf(GL_LIGHT7, GL_QUADRATIC_ATTENUATION, 0.2f);
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, frame == 1);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, frame >= 2);
    const GLfloat ambient[] = {0.1f, 0.1f, 0.2f, 1};
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, ambient);
    glShadeModel(frame == 4 ? GL_FLAT : GL_SMOOTH);
    material(GL_FRONT, 0.8f, 0.8f, 0.8f, 20);
    material(GL_BACK, 0.9f, 0.5f, 0.1f, 3);
    glEnable(GL_NORMALIZE);
    if (frame == 3) {  // half a sphere, seen from inside
        const GLdouble plane[] = {0, 0, -1, 0.3};
        glClipPlane(GL_CLIP_PLANE0, plane);
        glEnable(GL_CLIP_PLANE0);
    }
    for (int i = 0; i < 6; ++i) {
        glPushMatrix();
        glTranslatef(static_cast<float>(i % 3) * 1.3f - 1.3f, static_cast<float>(i / 3) * 1.3f - 0.6f, 0);
        glRotatef(static_cast<float>(i) * 33, 0.3f, 1, 0.2f);
        glScalef(0.5f, 0.6f, 0.5f);
        lit_sphere();
        glPopMatrix();
    }
    glDisable(GL_CLIP_PLANE0);
    glDisable(GL_NORMALIZE);
    lights_off();
}

SCENE(color_material, 6) {
    const GLenum modes[] = {GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION, GL_AMBIENT_AND_DIFFUSE, GL_DIFFUSE};
    const GLenum faces[] = {GL_FRONT, GL_FRONT_AND_BACK, GL_FRONT, GL_BACK, GL_FRONT_AND_BACK, GL_FRONT};
    clear();
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glShadeModel(GL_SMOOTH);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, 1);
    light(GL_LIGHT0, 1, 2, 4, 1, 1, 1, 1);
    material(GL_FRONT_AND_BACK, 0.4f, 0.4f, 0.4f, 10);
    glColorMaterial(faces[frame], modes[frame]);
    glColor3f(0.9f, 0.1f, 0.2f);
    glEnable(GL_COLOR_MATERIAL);
    glBegin(GL_QUAD_STRIP);
    for (int i = 0; i < 14; ++i) {
        glColor3f(random_unit(), random_unit(), random_unit());
        glNormal3f(std::sin(static_cast<float>(i)), 0.3f, 1);
        glVertex3f(-1.6f + 0.5f * static_cast<float>(i / 2), i % 2 ? 0.2f : 1.2f,
                   std::sin(static_cast<float>(i)) * 0.4f);
    }
    glEnd();
    glColor3f(0.1f, 0.8f, 0.9f);
    glDisable(GL_COLOR_MATERIAL);
    glColor3f(1, 1, 1);     // must not reach the material any more
    glBegin(GL_TRIANGLES);  // materials between vertices
    for (int i = 0; i < 9; ++i) {
        const GLfloat diffuse[] = {random_unit(), random_unit(), random_unit(), 1};
        if (i % 2) glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, diffuse);
        if (i == 4) glMaterialf(GL_FRONT, GL_SHININESS, 40);
        glNormal3f(0, 0, i % 3 ? 1.0f : -1.0f);
        glVertex3f(-1.5f + 0.4f * static_cast<float>(i), i % 3 == 2 ? -1.2f : -0.3f, 0);
    }
    glEnd();
    GLfloat answer[4];
    for (const GLenum face : {GL_FRONT, GL_BACK})
        for (const GLenum name : {GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION}) {
            glGetMaterialfv(face, name, answer);
            say("material %x %x: %.5g %.5g %.5g %.5g", face, name, answer[0], answer[1], answer[2], answer[3]);
        }
    lights_off();
}

SCENE(fog, 5) {
    clear(0.5f, 0.5f, 0.6f);
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_FOG);
    const GLint modes[] = {GL_LINEAR, GL_EXP, GL_EXP2, GL_LINEAR, GL_EXP};
    const GLfloat colour[] = {0.5f, 0.5f, 0.6f, 1};
    glFogi(GL_FOG_MODE, modes[frame]);
    glFogfv(GL_FOG_COLOR, colour);
    glFogf(GL_FOG_START, 1.5f);
    glFogf(GL_FOG_END, 6);
    glFogf(GL_FOG_DENSITY, 0.35f);
    glHint(GL_FOG_HINT, frame > 2 ? GL_NICEST : GL_FASTEST);
    for (int i = 0; i < 12; ++i) {
        glPushMatrix();
        glTranslatef(random_unit() * 4 - 2, random_unit() * 2 - 1, 1.5f - static_cast<float>(i) * 0.5f);
        glScalef(0.4f, 0.4f, 0.4f);
        glColor3f(1, random_unit(), 0);
        lit_sphere(12, 6);
        glPopMatrix();
    }
    glDisable(GL_FOG);
    glDisable(GL_DEPTH_TEST);
}

SCENE(clip_planes, 3) {
    clear();
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    for (int i = 0; i < 6; ++i) {
        const GLdouble angle = i * 1.047 + frame * 0.2;
        const GLdouble plane[] = {std::cos(angle), std::sin(angle), 0.2 * i - 0.5, 0.55};
        glPushMatrix();
        if (i % 2) glRotatef(20, 0, 1, 0);  // fixed by the modelview matrix of now
        glClipPlane(GL_CLIP_PLANE0 + static_cast<GLenum>(i), plane);
        glPopMatrix();
        glEnable(GL_CLIP_PLANE0 + static_cast<GLenum>(i));
    }
    glColor3f(0.9f, 0.7f, 0.2f);
    glPolygonMode(GL_FRONT_AND_BACK, frame == 2 ? GL_LINE : GL_FILL);
    lit_sphere(40, 20);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CLIP_PLANE3);
    glColor3f(0.2f, 0.7f, 0.9f);
    glScalef(2, 0.2f, 0.2f);
    lit_sphere(40, 20);
    GLdouble answer[4];
    glGetClipPlane(GL_CLIP_PLANE1, answer);
    say("plane %.5g %.5g %.5g %.5g", answer[0], answer[1], answer[2], answer[3]);
    for (GLenum i = 0; i < 6; ++i) glDisable(GL_CLIP_PLANE0 + i);
    glDisable(GL_DEPTH_TEST);
}

SCENE(texgen, 4) {
    clear();
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_TEXTURE_2D);
    checker_texture(1, 32);
    const GLenum modes[] = {GL_OBJECT_LINEAR, GL_EYE_LINEAR, GL_SPHERE_MAP, GL_EYE_LINEAR};
    const GLfloat s[] = {1, 0.3f, 0, 0.2f}, t[] = {0, 1, 0.5f, 0};
    glTexGeni(GL_S, GL_TEXTURE_GEN_MODE, static_cast<GLint>(modes[frame]));
    glTexGeni(GL_T, GL_TEXTURE_GEN_MODE, static_cast<GLint>(modes[frame]));
    glTexGenfv(GL_S, GL_OBJECT_PLANE, s);
    glTexGenfv(GL_T, GL_OBJECT_PLANE, t);
    glPushMatrix();
    glRotatef(40, 0, 0, 1);
    glTexGenfv(GL_S, GL_EYE_PLANE, s);
    glPopMatrix();
    glTexGenfv(GL_T, GL_EYE_PLANE, t);
    glEnable(GL_TEXTURE_GEN_S);
    glEnable(GL_TEXTURE_GEN_T);
    if (frame == 3) {
        glMatrixMode(GL_TEXTURE);
        glRotatef(30, 0, 0, 1);
        glScalef(2, 3, 1);
        glMatrixMode(GL_MODELVIEW);
    }
    for (int i = 0; i < 4; ++i) {
        glPushMatrix();
        glTranslatef(static_cast<float>(i % 2) * 1.6f - 0.8f, static_cast<float>(i / 2) * 1.4f - 0.7f, 0);
        glRotatef(static_cast<float>(i) * 50, 1, 1, 0);
        glScalef(0.6f, 0.6f, 0.6f);
        lit_sphere();
        glPopMatrix();
    }
    GLfloat answer[4];
    glGetTexGenfv(GL_S, GL_EYE_PLANE, answer);
    say("eye plane %.5g %.5g %.5g %.5g", answer[0], answer[1], answer[2], answer[3]);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glDisable(GL_TEXTURE_GEN_S);
    glDisable(GL_TEXTURE_GEN_T);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_DEPTH_TEST);
}

SCENE(texture_environments, 4) {
    clear(0.2f, 0.4f, 0.3f);
    const GLint formats[] = {GL_ALPHA, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_INTENSITY, GL_RGB, GL_RGBA};
    const GLint functions[] = {GL_MODULATE, GL_DECAL, GL_BLEND, GL_REPLACE};
    const GLfloat environment[] = {0.1f, 0.9f, 0.4f, 0.5f};
    std::vector<GLubyte> texels(16 * 16 * 4);
    for (auto& value : texels) value = static_cast<GLubyte>(random_bits());
    glEnable(GL_TEXTURE_2D);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, environment);
    glBindTexture(GL_TEXTURE_2D, 7);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, frame % 2 ? GL_LINEAR : GL_NEAREST);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, functions[frame]);
    for (int i = 0; i < 6; ++i) {
        cell_view(i, 3, 2);
        glTexImage2D(GL_TEXTURE_2D, 0, formats[i], 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        if (functions[frame] == GL_DECAL && formats[i] < GL_RGB) continue;  // undefined
        glBegin(GL_QUADS);
        for (int k = 0; k < 4; ++k) {
            const float x = k == 1 || k == 2 ? 1.0f : 0.0f, y = k > 1 ? 1.0f : 0.0f;
            glColor4f(x, 0.8f, y, 0.9f);
            glTexCoord2f(x * 1.5f - 0.2f, y * 1.5f);
            glVertex2f(x * 2 - 1, y * 2 - 1);
        }
        glEnd();
    }
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_BLEND);
}

SCENE(texture_filters, 6) {  // a floor to the horizon
    clear();
    perspective_view(canvas);
    const GLint filters[] = {GL_NEAREST,
                             GL_LINEAR,
                             GL_NEAREST_MIPMAP_NEAREST,
                             GL_LINEAR_MIPMAP_NEAREST,
                             GL_NEAREST_MIPMAP_LINEAR,
                             GL_LINEAR_MIPMAP_LINEAR};
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 3);
    for (int level = 0, size = 64; size; ++level, size /= 2) {
        std::vector<GLubyte> texels;
        for (int i = 0; i < size * size; ++i)
            for (int c = 0; c < 3; ++c)
                texels.push_back(static_cast<GLubyte>(((i / size / 4 + i % size / 4) & 1) ? 255 - 30 * level
                                                                                          : 40 * (c == level % 3)));
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGB, size, size, 0, GL_RGB, GL_UNSIGNED_BYTE, texels.data());
    }
    const GLfloat border[] = {1, 0, 1, 1};
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, border);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filters[frame]);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, frame % 2 ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, frame % 3 == 1 ? GL_CLAMP : GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, frame % 3 == 2 ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    glHint(GL_PERSPECTIVE_CORRECTION_HINT, GL_NICEST);
    glColor3f(1, 1, 1);
    glBegin(GL_QUADS);
    glTexCoord2f(-3.9f, 0.03f);
    glVertex3f(-4, -0.8f, 2);
    glTexCoord2f(4.13f, 0.03f);
    glVertex3f(4, -0.8f, 2);
    glTexCoord2f(4.13f, 24.06f);
    glVertex3f(4, -0.8f, -15);
    glTexCoord2f(-3.9f, 24.06f);
    glVertex3f(-4, -0.8f, -15);
    glEnd();
    glTranslatef(0, 0.5f, 0);
    glScalef(1, 0.5f, 1);
    unit_square();
    glDisable(GL_TEXTURE_2D);
}

SCENE(texture_updates, 4) {  // sub-images, 1D, proxies, reading back, objects kept over frames
    clear();
    if (frame == 0) checker_texture(11, 64);
    glEnable(GL_TEXTURE_2D);
    glColor3f(1, 1, 1);
    glBindTexture(GL_TEXTURE_2D, 11);
    std::vector<GLubyte> patch(20 * 20 * 3);
    for (auto& value : patch) value = static_cast<GLubyte>(random_bits() + static_cast<unsigned>(frame) * 30);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 20);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 3);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 2);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 5 + frame * 12, 30 - frame * 5, 14, 12, GL_RGB, GL_UNSIGNED_BYTE, patch.data());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 0);
    cell_view(0, 2, 1);
    unit_square();
    glDisable(GL_TEXTURE_2D);
    glEnable(GL_TEXTURE_1D);
    glBindTexture(GL_TEXTURE_1D, 12);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    if (frame == 0) glTexImage1D(GL_TEXTURE_1D, 0, GL_RGB, 16, 0, GL_RGB, GL_UNSIGNED_BYTE, patch.data());
    glTexSubImage1D(GL_TEXTURE_1D, 0, frame * 3, 4, GL_BGRA, GL_UNSIGNED_BYTE, patch.data());
    cell_view(1, 2, 1);
    unit_square();
    glDisable(GL_TEXTURE_1D);
    std::vector<GLubyte> whole(64 * 64 * 4);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, whole.data());
    unsigned long sum = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) sum = sum * 31 + whole[i];
    GLint width = 0, red = 0, components = 0, proxy = -1;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_RED_SIZE, &red);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &components);
    glTexImage2D(GL_PROXY_TEXTURE_2D, 0, GL_RGBA, 1 << 20, 1 << 20, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &proxy);
    say("texture sum %lu width %d red %d format %x proxy %d is %d %d", sum, width, red, components, proxy,
        glIsTexture(11), glIsTexture(99));
}

SCENE(copy_texture, 3) {  // out of the picture, over tile borders
    clear(0.3f, 0, 0.3f);
    perspective_view(canvas);
    glRotatef(static_cast<float>(frame) * 20, 0, 0, 1);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        glColor4f(random_unit(), random_unit(), random_unit(), random_unit());
        glVertex3f(random_unit() * 4 - 2, random_unit() * 3 - 1.5f, 0);
    }
    glEnd();
    glBindTexture(GL_TEXTURE_2D, 21);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, frame == 1 ? GL_RGBA : GL_RGB, 100, 50, 128, 128, 0);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 30, 40, 190, 140, 60, 50);
    glBindTexture(GL_TEXTURE_1D, 22);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glCopyTexImage1D(GL_TEXTURE_1D, 0, GL_RGB, 150, 140, 128, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glColor3f(1, 1, 1);
    glEnable(GL_TEXTURE_2D);
    cell_view(0, 2, 1);
    unit_square();
    glDisable(GL_TEXTURE_2D);
    glEnable(GL_TEXTURE_1D);
    cell_view(1, 2, 1);
    unit_square();
    glDisable(GL_TEXTURE_1D);
}

}  // namespace golden
