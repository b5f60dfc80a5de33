// SPDX-License-Identifier: MIT
// Pixel paths: drawing, reading and copying rectangles of pixels, bitmaps, zoom, transfer, storage. Zooms are odd
// numbers: a fragment's centre on the very border of two zoomed pixels may take either, and other tiles decide
// otherwise.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

void background(Size canvas) {
    clear();
    pixel_view(canvas);
    glShadeModel(GL_SMOOTH);
    glBegin(GL_QUADS);
    glColor4f(1, 0, 0, 0.2f);
    glVertex2i(0, 0);
    glColor4f(0, 1, 0, 0.5f);
    glVertex2i(canvas.width, 0);
    glColor4f(0, 0, 1, 0.8f);
    glVertex2i(canvas.width, canvas.height);
    glColor4f(1, 1, 0, 1);
    glVertex2i(0, canvas.height);
    glEnd();
}

void plain_storage() {
    for (const GLenum name :
         {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS,
          GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS})
        glPixelStorei(name, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

std::uint64_t checksum(const std::vector<GLubyte>& bytes) {
    std::uint64_t sum = 1469598103934665603u;
    for (const GLubyte value : bytes) sum = (sum ^ value) * 1099511628211u;
    return sum;
}

}  // namespace

SCENE(draw_pixels, 5) {
    background(canvas);
    struct Kind {
        GLenum format, type;
        int components;
    };
    const Kind kinds[] = {{GL_RGBA, GL_UNSIGNED_BYTE, 4},
                          {GL_RGB, GL_UNSIGNED_BYTE, 3},
                          {GL_BGRA, GL_UNSIGNED_BYTE, 4},
                          {GL_LUMINANCE, GL_UNSIGNED_BYTE, 1},
                          {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, 2},
                          {GL_RED, GL_BYTE, 1},
                          {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, 1},
                          {GL_RGB, GL_UNSIGNED_SHORT_5_6_5, 1},
                          {GL_RGBA, GL_UNSIGNED_INT_8_8_8_8, 1},
                          {GL_GREEN, GL_SHORT, 1},
                          {GL_RGB, GL_UNSIGNED_INT, 3},
                          {GL_BGR, GL_UNSIGNED_BYTE, 3}};
    const auto image = random_image(40 * 40 * 16);
    if (frame == 1) glPixelZoom(1.713f, 2.317f);
    if (frame == 2) glPixelZoom(-1.513f, 0.537f);
    if (frame == 3) {
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 37);
        glPixelStorei(GL_UNPACK_SKIP_PIXELS, 3);
        glPixelStorei(GL_UNPACK_SKIP_ROWS, 2);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
    }
    if (frame == 4) glPixelStorei(GL_UNPACK_SWAP_BYTES, 1);  // not with the above: Mesa reads undefined memory then
    for (int i = 0; i < 12; ++i) {
        glRasterPos2f(static_cast<float>(i % 4) * 97 + 20.3f, static_cast<float>(i / 4) * 95 + 10.6f);
        glDrawPixels(30, 32, kinds[i].format, kinds[i].type, image.data());
        say_error("draw pixels");
    }
    glPixelZoom(1, 1);
    plain_storage();
}

SCENE(draw_pixels_float_and_fragments, 2) {
    background(canvas);
    std::vector<GLfloat> image;
    for (int i = 0; i < 60 * 50 * 4; ++i) image.push_back(random_unit() * 1.4f - 0.2f);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_FOG);
    glRasterPos2i(165, 120);
    glDrawPixels(60, 50, GL_RGBA, GL_FLOAT, image.data());
    glDisable(GL_FOG);
    glEnable(GL_SCISSOR_TEST);
    glScissor(20, 20, 90, 100);
    glRasterPos2i(10, 10);
    glPixelZoom(2, 3);
    glDrawPixels(60, 50, GL_RGBA, GL_FLOAT, image.data());
    glDisable(GL_SCISSOR_TEST);
    glPixelZoom(1, 1);
    glEnable(GL_ALPHA_TEST);
    glAlphaFunc(GL_GREATER, 0.5f);
    glColorMask(1, 0, 1, 1);
    glRasterPos2i(260, 150);
    glDrawPixels(60, 50, GL_RGBA, GL_FLOAT, image.data());
    glColorMask(1, 1, 1, 1);
    glDisable(GL_ALPHA_TEST);
    glDisable(GL_BLEND);
    if (frame) {  // textured pixels: every fragment of an image takes the raster position's texture coordinate
        checker_texture(1, 16);
        glEnable(GL_TEXTURE_2D);
        glTexCoord2f(0.4f, 0.3f);
        glRasterPos2i(30, 200);
        glDrawPixels(60, 50, GL_RGBA, GL_FLOAT, image.data());
        glDisable(GL_TEXTURE_2D);
    }
}

SCENE(pixel_transfer, 4) {
    background(canvas);
    const auto image = random_image(64 * 64 * 4);
    if (frame == 0) {
        glPixelTransferf(GL_RED_SCALE, 0.5f);
        glPixelTransferf(GL_GREEN_BIAS, 0.3f);
        glPixelTransferf(GL_ALPHA_SCALE, -1);
    }
    if (frame == 1) {
        const GLfloat map[] = {0.9f, 0.1f, 0.6f, 0.3f};
        for (const GLenum to : {GL_PIXEL_MAP_R_TO_R, GL_PIXEL_MAP_G_TO_G, GL_PIXEL_MAP_B_TO_B, GL_PIXEL_MAP_A_TO_A})
            glPixelMapfv(to, 4, map);
        glPixelTransferi(GL_MAP_COLOR, 1);
        glColorMask(1, 1, 0, 0);  // Mesa's mapped blue and alpha are undefined
    }
    if (frame == 2) {  // their use is not compared: Mesa 22 draws images of colour indices in wrong colours
        const GLfloat map[] = {0, 0.25f, 0.5f, 1, 0.2f, 0.7f, 0.1f, 0.9f, 0.4f};
        for (const GLenum to : {GL_PIXEL_MAP_I_TO_R, GL_PIXEL_MAP_I_TO_G, GL_PIXEL_MAP_I_TO_B, GL_PIXEL_MAP_I_TO_A})
            glPixelMapfv(to, 8, map + (to % 2));
        glPixelTransferi(GL_INDEX_SHIFT, -1);
        glPixelTransferi(GL_INDEX_OFFSET, 3);
        GLint size = 0;
        GLfloat answer[8] = {};
        glGetIntegerv(GL_PIXEL_MAP_I_TO_G_SIZE, &size);
        glGetPixelMapfv(GL_PIXEL_MAP_I_TO_G, answer);
        say("map of %d: %.5g %.5g", size, answer[1], answer[7]);
    }
    glRasterPos2i(100, 40);
    glDrawPixels(64, 64, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
    glColorMask(1, 1, 1, 1);
    if (frame == 3) {  // a texture is transferred as well
        glPixelTransferf(GL_BLUE_SCALE, 2);
        glPixelTransferf(GL_RED_BIAS, -0.4f);
        checker_texture(5, 16);
        glPixelTransferf(GL_BLUE_SCALE, 1);
        glPixelTransferf(GL_RED_BIAS, 0);
        glEnable(GL_TEXTURE_2D);
        glColor3f(1, 1, 1);
        cell_view(3, 3, 3);
        unit_square();
        glDisable(GL_TEXTURE_2D);
    }
    std::vector<GLubyte> read(40 * 40 * 4);
    glReadPixels(90, 30, 40, 40, GL_RGBA, GL_UNSIGNED_BYTE, read.data());  // transferred a second time
    if (frame < 2) say("frame %d: corner %d %d", frame, read[0], read[1]);
    for (const GLenum name : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE}) glPixelTransferf(name, 1);
    for (const GLenum name : {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS}) glPixelTransferf(name, 0);
    for (const GLenum name : {GL_MAP_COLOR, GL_INDEX_SHIFT, GL_INDEX_OFFSET}) glPixelTransferi(name, 0);
}

SCENE(bitmaps, 4) {
    background(canvas);
    const auto bits = random_image(64 * 8);
    if (frame == 1) {
        glPixelStorei(GL_UNPACK_LSB_FIRST, 1);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 43);
        glPixelStorei(GL_UNPACK_SKIP_PIXELS, 5);
        glPixelStorei(GL_UNPACK_SKIP_ROWS, 1);
    }
    glColor3f(1, 1, 1);
    glRasterPos2f(12.5f, 250.5f);
    glColor3f(0, 0, 0);  // not the raster position's colour
    for (int i = 0; i < 14; ++i) glBitmap(19, 30, 3.5f, 2.25f, 26.4f, -15.3f, bits.data());
    glColor3f(0.9f, 0.2f, 1);
    glRasterPos2i(20, 20);
    glBitmap(0, 0, 0, 0, -50, 40, nullptr);  // moves out of the window, stays valid
    for (int i = 0; i < 5; ++i) glBitmap(37, 20, 0, 0, 41, 9, bits.data());
    glRasterPos2i(-5, 20);  // outside: invalid, nothing is drawn
    glBitmap(37, 20, 0, 0, 200, 100, bits.data());
    GLfloat position[4];
    GLboolean valid = 7;
    glGetFloatv(GL_CURRENT_RASTER_POSITION, position);
    glGetBooleanv(GL_CURRENT_RASTER_POSITION_VALID, &valid);
    say("invalid: %d", valid);
    if (frame >= 2) {
        glFlush();  // Mesa 22 gathers bitmaps and would draw those from above by the logic operation from below
        glEnable(GL_LOGIC_OP);
        glEnable(GL_COLOR_LOGIC_OP);
        glLogicOp(frame == 2 ? GL_XOR : GL_AND_INVERTED);
        glRasterPos2i(120, 60);
        glBitmap(60, 60, 0, 0, 70, 0, bits.data());
        glBitmap(60, 60, 0, 0, 70, 0, bits.data());
        glDisable(GL_COLOR_LOGIC_OP);
        glDisable(GL_LOGIC_OP);
    }
    glGetFloatv(GL_CURRENT_RASTER_POSITION, position);
    if (frame >= 2) say("position %.5g %.5g %.5g %.5g", position[0], position[1], position[2], position[3]);
    plain_storage();
}

SCENE(copy_pixels, 4) {
    background(canvas);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 12; ++i) {
        glColor3f(random_unit(), random_unit(), random_unit());
        glVertex2f(random_unit() * 200, random_unit() * 150);
    }
    glEnd();
    if (frame == 1) glPixelZoom(1.513f, 1.237f);
    if (frame == 2) glPixelZoom(-1, -1);
    if (frame == 3) glPixelTransferf(GL_RED_SCALE, 0.2f);
    glRasterPos2i(210, 145);
    glCopyPixels(20, 15, 130, 90, GL_COLOR);
    glRasterPos2i(30, 60);
    glCopyPixels(25, 45, 100, 80, GL_COLOR);  // source and destination overlap
    glRasterPos2i(380, 280);
    glCopyPixels(180, 130, 60, 50, GL_COLOR);
    glPixelTransferf(GL_RED_SCALE, 1);
    glPixelZoom(1, 1);
}

SCENE(depth_and_stencil_pixels, 3) {
    clear();
    pixel_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glBegin(GL_TRIANGLE_STRIP);  // a ramp of depths
    glColor3f(0.2f, 0.2f, 0.2f);
    glVertex3f(0, 0, -0.9f);
    glVertex3f(400, 0, 0.9f);
    glVertex3f(0, 300, 0);
    glVertex3f(400, 300, -0.5f);
    glEnd();
    std::vector<GLfloat> depth;
    std::vector<GLubyte> stencil;
    for (int i = 0; i < 50 * 50; ++i) {
        depth.push_back(random_unit());
        stencil.push_back(static_cast<GLubyte>(i / 50 % 7));
    }
    glColorMask(0, 0, 0, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glRasterPos2i(160, 110);
    glPixelZoom(1.513f, 1.537f);
    glDrawPixels(50, 50, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    glRasterPos2i(175, 120);
    glDrawPixels(50, 50, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil.data());
    glPixelZoom(1, 1);
    if (frame) {
        glRasterPos2i(60, 60);
        glCopyPixels(165, 115, 70, 60, GL_DEPTH);
        glRasterPos2i(250, 200);
        glCopyPixels(175, 120, 70, 60, GL_STENCIL);
    }
    glColorMask(1, 1, 1, 1);
    glDepthFunc(GL_LESS);
    glColor3f(1, 0.5f, 0);
    glRectf(0, 0, 400, 300);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, 3, 7);
    glColor3f(0, 1, 1);
    glRectf(0, 0, 400, 300);
    glDisable(GL_STENCIL_TEST);
    glDepthFunc(GL_LESS);
    plain_storage();
    if (frame == 2) {
        std::vector<GLubyte> read(90 * 90);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(160, 110, 90, 90, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, read.data());
        say("stencil sum %016llx", static_cast<unsigned long long>(checksum(read)));
        plain_storage();
    }
}

SCENE(read_pixels, 1) {
    background(canvas);
    struct Kind {
        GLenum format, type;
        int bytes;
    };
    const Kind kinds[] = {{GL_RGBA, GL_UNSIGNED_BYTE, 4},
                          {GL_BGRA, GL_UNSIGNED_BYTE, 4},
                          {GL_RGB, GL_UNSIGNED_BYTE, 3},
                          {GL_BGR, GL_UNSIGNED_BYTE, 3},
                          {GL_RED, GL_UNSIGNED_BYTE, 1},
                          {GL_ALPHA, GL_UNSIGNED_BYTE, 1},
                          {GL_LUMINANCE, GL_UNSIGNED_BYTE, 1},
                          {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, 2},
                          {GL_RGBA, GL_UNSIGNED_SHORT, 8},
                          {GL_RGB, GL_FLOAT, 12},
                          {GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, 4},
                          {GL_RGB, GL_UNSIGNED_SHORT_5_6_5, 2},
                          {GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV, 2},
                          {GL_RGBA, GL_BYTE, 4},
                          {GL_BLUE, GL_INT, 4},
                          {GL_RGBA, GL_UNSIGNED_INT_10_10_10_2, 4}};
    // Clears of exact colours, so that one wall of several tiles answers the very same bytes.
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 300; ++i) {
        glScissor(static_cast<int>(random_bits() % 380), static_cast<int>(random_bits() % 280), 30, 30);
        glClearColor(static_cast<float>(random_bits() % 256) / 255.0f, static_cast<float>(random_bits() % 256) / 255.0f,
                     static_cast<float>(random_bits() % 256) / 255.0f,
                     static_cast<float>(random_bits() % 256) / 255.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glScissor(0, 0, canvas.width, canvas.height);
    glDisable(GL_SCISSOR_TEST);
    for (int storage = 0; storage < 3; ++storage)
        for (const Kind& kind : kinds) {
            plain_storage();
            if (storage == 1)
                glPixelStorei(GL_PACK_ALIGNMENT, 1), glPixelStorei(GL_PACK_ROW_LENGTH, 61),
                    glPixelStorei(GL_PACK_SKIP_PIXELS, 5);
            if (storage == 2)
                glPixelStorei(GL_PACK_ALIGNMENT, 8), glPixelStorei(GL_PACK_SKIP_ROWS, 3),
                    glPixelStorei(GL_PACK_SWAP_BYTES, 1);
            std::vector<GLubyte> read(64 * 64 * 16, 0xa5);
            glReadPixels(181, 131, 43, 37, kind.format, kind.type, read.data());
            say("read %d %04x %04x: %016llx", storage, kind.format, kind.type,
                static_cast<unsigned long long>(checksum(read)));
            say_error("read");
        }
    plain_storage();
    std::vector<GLubyte> outside(40 * 40 * 4, 0x5a);
    glReadPixels(-10, -10, 40, 40, GL_RGBA, GL_UNSIGNED_BYTE,
                 outside.data());  // what lies outside stays as it was, here
    glReadPixels(380, 280, 40, 40, GL_RGBA, GL_UNSIGNED_BYTE, outside.data());
    say("inside part %d %d %d", outside[0], outside[1], outside[2]);
    GLfloat depth = -1;
    glReadPixels(200, 150, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    say("depth %.5g", depth);
    glReadPixels(0, 0, 1, 1, GL_COLOR_INDEX, GL_UNSIGNED_BYTE, outside.data());
    say_error("colour index");
}

}  // namespace golden
