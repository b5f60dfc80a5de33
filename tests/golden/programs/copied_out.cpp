// SPDX-License-Identifier: MIT
// Framebuffer objects that are copied to the window as they are, frame after frame, which nodes then draw in parts; and
// all that needs more of them than that, once it has become a habit.
#include <array>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kEach = 11;  // frames with one framebuffer object, and the last of them needs all of it

struct Picture {
    GLuint framebuffer = 0, color = 0, depth = 0;
};

/// With a texture as its colours; or with samples, in renderbuffers.
Picture make_picture(Size size, int samples = 0) {
    Picture made;
    glGenFramebuffers(1, &made.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, made.framebuffer);
    if (samples == 0) {
        glGenTextures(1, &made.color);
        glBindTexture(GL_TEXTURE_2D, made.color);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, made.color, 0);
    } else {
        glGenRenderbuffers(1, &made.color);
        glBindRenderbuffer(GL_RENDERBUFFER, made.color);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, size.width, size.height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, made.color);
    }
    glGenRenderbuffers(1, &made.depth);
    glBindRenderbuffer(GL_RENDERBUFFER, made.depth);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH24_STENCIL8, size.width, size.height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, made.depth);
    return made;
}

/// Balls all over the picture, and some lines and points, each of which few nodes need.
void draw_balls(int frame, Size canvas) {
    glViewport(0, 0, canvas.width, canvas.height);
    clear(0.1f, 0.2f, 0.3f);
    glEnable(GL_DEPTH_TEST), glEnable(GL_LIGHTING), glEnable(GL_LIGHT0), glEnable(GL_COLOR_MATERIAL);
    perspective_view(canvas);
    for (int i = 0; i < 12; ++i) {
        glPushMatrix();
        glTranslatef(-1.8f + 1.2f * static_cast<float>(i % 4), -1.1f + 1.1f * static_cast<float>(i / 4), -0.4f);
        glRotatef(static_cast<float>(9 * frame + 30 * i), 1, 1, 0);
        glScalef(0.4f, 0.4f, 0.4f);
        glColor3f(1, 0.08f * static_cast<float>(i), 0.3f);
        lit_sphere(12, 6);
        glPopMatrix();
    }
    glDisable(GL_LIGHTING), glDisable(GL_COLOR_MATERIAL);
    glBegin(GL_LINES);
    for (int i = 0; i < 20; ++i) {
        glColor3f(random_unit(), 1, random_unit());
        for (int end = 0; end < 2; ++end)
            glVertex3f(3 * random_unit() - 1.5f, 3 * random_unit() - 1.5f, random_unit() - 0.5f);
    }
    glEnd();
    glDisable(GL_DEPTH_TEST);
}

void copy(GLuint from, GLuint to, Size canvas, GLbitfield mask = GL_COLOR_BUFFER_BIT) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    glBlitFramebuffer(0, 0, canvas.width, canvas.height, 0, 0, canvas.width, canvas.height, mask, GL_NEAREST);
}

unsigned sum_of(const std::vector<GLubyte>& bytes) {
    unsigned sum = 0;
    for (const GLubyte value : bytes) sum = sum * 31 + value;
    return sum;
}

void show_small(GLuint texture) {
    cell_view(4, 3, 3);
    glBindTexture(GL_TEXTURE_2D, texture);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    unit_square();
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glDisable(GL_TEXTURE_2D);
}

}  // namespace

SCENE(copied_out, 4 * kEach) {  // read, sampled, read as a texture, drawn over by another framebuffer object
    static Picture picture;
    if (frame % kEach == 0) picture = make_picture(canvas);
    const int needed_for = frame % kEach == kEach - 1 ? frame / kEach : -1;
    glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer);
    draw_balls(frame, canvas);
    if (needed_for == 0) {
        std::vector<GLubyte> pixels(std::size_t{4} * static_cast<std::size_t>(canvas.width * canvas.height));
        glReadPixels(0, 0, canvas.width, canvas.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        say("pixels %08x", sum_of(pixels));
        glReadPixels(0, 0, canvas.width, canvas.height, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, pixels.data());
        say("depths %08x", sum_of(pixels));
    }
    if (needed_for == 3) {
        GLuint other = 0;
        glGenFramebuffers(1, &other);
        glBindFramebuffer(GL_FRAMEBUFFER, other);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture.color, 0);
        cell_view(1, 2, 2);
        glColor3f(1, 1, 0);
        unit_square();
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDeleteFramebuffers(1, &other);
    }
    copy(picture.framebuffer, 0, canvas);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (needed_for == 1) show_small(picture.color);
    if (needed_for == 2) {
        std::vector<GLubyte> texels(std::size_t{4} * static_cast<std::size_t>(canvas.width * canvas.height));
        glBindTexture(GL_TEXTURE_2D, picture.color);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        say("texels %08x", sum_of(texels));
        show_small(picture.color);
    }
    say_error("copied_out");
}

SCENE(copied_through, 3 * kEach) {  // samples, from which pixels are made on the way; copied elsewhere; scaled
    static Picture samples, pixels;
    if (frame % kEach == 0) samples = make_picture(canvas, 4), pixels = make_picture(canvas);
    const int needed_for = frame % kEach == kEach - 1 ? frame / kEach : -1;
    glBindFramebuffer(GL_FRAMEBUFFER, samples.framebuffer);
    draw_balls(frame, canvas);
    if (needed_for == 1) {
        const Picture other = make_picture(canvas);
        copy(samples.framebuffer, other.framebuffer, canvas);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        clear();
        show_small(other.color);
    }
    copy(samples.framebuffer, pixels.framebuffer, canvas);
    if (needed_for == 2) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, pixels.framebuffer);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glBlitFramebuffer(0, 0, canvas.width, canvas.height, canvas.width, 0, 0, canvas.height, GL_COLOR_BUFFER_BIT,
                          GL_NEAREST);
    } else if (needed_for != 1) {
        copy(pixels.framebuffer, 0, canvas);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (needed_for == 0) show_small(pixels.color);
    say_error("copied_through");
}

}  // namespace golden
