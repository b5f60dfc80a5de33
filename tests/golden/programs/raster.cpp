// SPDX-License-Identifier: MIT
// Raster positions: transformed, lit and clipped, and told in window pixels.
#include "tests/golden/programs/scene.h"

namespace golden {

SCENE(raster_positions, 2) {
    clear();
    perspective_view(canvas);
    const auto bits = random_image(8 * 16);
    const GLfloat position[] = {1, 1, 3, 1};
    glEnable(GL_LIGHT0);
    glLightfv(GL_LIGHT0, GL_POSITION, position);
    for (int i = 0; i < 40; ++i) {
        if (frame) (i % 2 ? glEnable : glDisable)(GL_LIGHTING);
        glNormal3f(0.3f, 0.2f, 0.9f);
        glColor3f(random_unit(), random_unit(), random_unit());
        glRasterPos3f(random_unit() * 4 - 2, random_unit() * 3 - 1.5f, random_unit() * 3 - 1.5f);
        glBitmap(16, 16, 8, 8, 0, 0, bits.data());
        GLboolean valid = 0;
        GLfloat window[4] = {}, colour[4] = {}, distance = 0;
        glGetBooleanv(GL_CURRENT_RASTER_POSITION_VALID, &valid);
        if (valid) {
            glGetFloatv(GL_CURRENT_RASTER_POSITION, window);
            glGetFloatv(GL_CURRENT_RASTER_COLOR, colour);
            glGetFloatv(GL_CURRENT_RASTER_DISTANCE, &distance);
        }
        say("raster %d %.4g %.4g %.4g %.4g colour %.4g %.4g distance %.4g", valid, window[0], window[1], window[2],
            window[3], colour[0], colour[2], distance);
    }
    glDisable(GL_LIGHTING);
    glDisable(GL_LIGHT0);
    glColor3f(1, 1, 1);
    glRasterPos4d(0.5, 0.5, 0, 2);
    const GLshort at[] = {0, -1};
    glBitmap(16, 16, 0, 0, 5, 5, bits.data());
    glRasterPos2sv(at);
    glBitmap(16, 16, 0, 0, 5, 5, bits.data());
}

SCENE(window_positions, 3) {  // told in window pixels, over all tiles
    clear(0.1f, 0.1f, 0.3f);
    perspective_view(canvas);  // does not matter
    const auto image = random_image(24 * 20 * 4);
    glEnable(GL_DEPTH_TEST);
    if (frame == 2) glDepthRange(0.75, 0.25);
    for (int i = 0; i < 30; ++i) {
        const float x = random_unit() * 380 - 10, y = random_unit() * 290 - 10, z = random_unit() * 1.4f - 0.2f;
        glColor3f(random_unit(), random_unit(), random_unit());
        const GLint whole[] = {static_cast<GLint>(x), static_cast<GLint>(y), 1};
        const GLdouble exact[] = {x, y, z};
        if (i % 4 == 0) glWindowPos2f(x, y);
        if (i % 4 == 1) glWindowPos3iv(whole);
        if (i % 4 == 2) glWindowPos3dv(exact);
        if (i % 4 == 3) glWindowPos2s(static_cast<GLshort>(whole[0]), static_cast<GLshort>(whole[1]));
        if (frame == 1 && i % 2) glDrawPixels(24, 20, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        else glBitmap(24, 20, 3.25f, 2.5f, 4, 4, image.data());
        GLfloat window[4] = {};
        glGetFloatv(GL_CURRENT_RASTER_POSITION, window);
        say("window %.5g %.5g %.5g %.5g", window[0], window[1], window[2], window[3]);
    }
    glDepthRange(0, 1);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace golden
