// SPDX-License-Identifier: MIT
// Programs that copy out of their window again and again, in every frame.
#include <array>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kSide = 40;  // pixels of what is copied

struct Copies {
    GLuint cube = 0, framebuffer = 0;
    std::array<GLuint, 4> flat{};  // RGBA, RGB, copied in part, and blitted to
};

Copies make_copies() {
    Copies made;
    glGenTextures(1, &made.cube);
    glBindTexture(GL_TEXTURE_CUBE_MAP, made.cube);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenTextures(4, made.flat.data());
    const auto image = random_image(std::size_t{kSide} * kSide * 4);
    for (const GLuint texture : made.flat) {
        glBindTexture(GL_TEXTURE_2D, texture);
        const GLint format = texture == made.flat[1] ? GL_RGB8 : GL_RGBA8;
        glTexImage2D(GL_TEXTURE_2D, 0, format, kSide, kSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    glGenFramebuffers(1, &made.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, made.framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, made.flat[3], 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return made;
}

void rectangle(int x, int y, int width, int height) {
    glBegin(GL_QUADS);
    for (const auto& [s, t] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        glTexCoord2i(s, t), glVertex2i(x + s * width, y + t * height);
    glEnd();
}

/// Something else for each number, over the middle of the window, where tiles meet.
void draw_surroundings(int number) {
    for (int i = 0; i < 5; ++i) {
        glColor3f(0.2f * static_cast<float>(i), 0.1f * static_cast<float>(number % 10), 0.7f);
        rectangle(150 + 17 * i, 110 + (7 * i + 3 * number) % 40, 30, 45);
    }
}

void show(GLuint texture, int x, int y) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    rectangle(x, y, kSide, kSide);
    glDisable(GL_TEXTURE_2D);
}

void say_texels(const char* what, GLenum target) {
    std::array<GLubyte, kSide * kSide * 4> texels{};
    glGetTexImage(target, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    unsigned sum = 0;
    for (const GLubyte value : texels) sum = sum * 31 + value;
    say("%s: %08x", what, sum);
}

}  // namespace

/// So often that the window turns whole in frame 3, in the middle of it: what it has so far stays, with its depth.
SCENE(window_copies, 6, {.whole = true}) {
    static Copies copies;
    clear(0.2f, 0.3f, 0.1f);
    if (frame == 0) copies = make_copies();
    pixel_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glColor3f(1, 1, 0);
    glTranslatef(0, 0, 0.5f);
    rectangle(180, 20, 50, 110);  // before the others
    glTranslatef(0, 0, -0.5f);
    glBindTexture(GL_TEXTURE_CUBE_MAP, copies.cube);
    for (int face = 0; face < 6; ++face) {
        draw_surroundings(10 * frame + face);
        glCopyTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), 0, GL_RGB, 175, 115 + 3 * face,
                         kSide, kSide, 0);
    }
    glEnable(GL_SCISSOR_TEST);  // of what is drawn, not of what is copied
    glScissor(190, 140, 10, 10);
    glBindTexture(GL_TEXTURE_2D, copies.flat[0]);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 180, 130, kSide, kSide, 0);
    glBindTexture(GL_TEXTURE_2D, copies.flat[1]);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 180, 130, kSide, kSide);
    glDisable(GL_SCISSOR_TEST);
    glBindTexture(GL_TEXTURE_2D, copies.flat[2]);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 5 + frame, 7, 195, 145, 12, 9);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, -4, -4, 10, 10);  // partly outside
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, copies.framebuffer);
    glBlitFramebuffer(170, 120, 230, 180, 0, 0, kSide, kSide, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDisable(GL_DEPTH_TEST);
    for (std::size_t i = 0; i < copies.flat.size(); ++i) show(copies.flat[i], 20 + 90 * static_cast<int>(i), 200);
    if (frame % 2) glBlitFramebuffer(150, 110, 250, 180, 20, 20, 120, 90, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindTexture(GL_TEXTURE_CUBE_MAP, copies.cube);
    if (frame == 4)
        for (GLenum face = 0; face < 6; ++face) say_texels("face", GL_TEXTURE_CUBE_MAP_POSITIVE_X + face);
    say_error("copies");
}

/// Once in each frame: where tiles each have a part, it stays so.
SCENE(window_copy, 6) {
    static Copies copies;
    clear(0.2f, 0.3f, 0.1f);
    if (frame == 0) copies = make_copies();
    pixel_view(canvas);
    draw_surroundings(frame);
    glBindTexture(GL_TEXTURE_2D, copies.flat[0]);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 180, 130, kSide, kSide, 0);
    show(copies.flat[0], 30, 210);
    glBindTexture(GL_TEXTURE_2D, copies.flat[1]);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 3 * frame, 6, 40, 205, 25, 30);
    show(copies.flat[1], 230, 30);
    say_texels("copied", GL_TEXTURE_2D);
    say_error("copy");
}

}  // namespace golden
