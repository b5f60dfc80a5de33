// SPDX-License-Identifier: MIT
// Framebuffer objects: pictures that are drawn, sampled, copied and read back; several at once; of many formats.
#include <array>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kSize = 128;  // texels a side

GLuint make_texture(GLint internal_format, GLenum format, GLenum type, int size = kSize, bool mipmaps = false) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, internal_format, size, size, 0, format, type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

GLuint make_renderbuffer(GLenum internal_format, int samples = 0, int size = kSize) {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, internal_format, size, size);
    return name;
}

GLuint make_framebuffer() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    return name;
}

/// A picture with depth: two spheres that cut each other, in a view of its own.
void draw_picture(int frame, float shade = 0.2f, int size = kSize) {
    glPushAttrib(GL_VIEWPORT_BIT | GL_ENABLE_BIT);
    glViewport(0, 0, size, size);
    clear(shade, 0.3f, 0.4f);
    perspective_view({size, size});
    glEnable(GL_DEPTH_TEST), glEnable(GL_LIGHTING), glEnable(GL_LIGHT0), glEnable(GL_COLOR_MATERIAL);
    glDisable(GL_TEXTURE_2D);
    glRotatef(25 * static_cast<float>(frame), 1, 1, 0);
    glColor3f(1, 0.7f, 0.2f);
    lit_sphere();
    glTranslatef(0.7f, 0.3f, 0);
    glColor3f(0.3f, 0.8f, 0.9f);
    lit_sphere();
    glPopAttrib();
}

void show(GLuint texture, int cell, int columns, int rows) {
    cell_view(cell, columns, rows);
    glBindTexture(GL_TEXTURE_2D, texture);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    unit_square();
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glDisable(GL_TEXTURE_2D);
}

void say_status(const char* what) { say("%s: status %#x", what, glCheckFramebufferStatus(GL_FRAMEBUFFER)); }

void say_pixel(const char* what, int x, int y) {
    std::array<GLubyte, 4> pixel{};
    glReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    GLfloat depth = -1;
    glReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    say("%s at %d,%d: %d %d %d %d, depth %.4g", what, x, y, pixel[0], pixel[1], pixel[2], pixel[3],
        static_cast<double>(depth));
}

}  // namespace

SCENE(framebuffer, 4) {  // a picture in a texture, drawn anew in every frame, with mipmaps, and drawn upon
    static GLuint texture, small, framebuffer;
    if (frame == 0) {
        texture = make_texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, kSize, true);
        framebuffer = make_framebuffer();
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
        say_status("without depth");
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  make_renderbuffer(GL_DEPTH_COMPONENT24));
        say_status("with depth");
        small = make_texture(GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE, 32);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (frame != 2) draw_picture(frame);  // in frame 2 it is that of frame 1
    if (frame == 3) {                     // a part from memory, over what was drawn
        const auto image = random_image(std::size_t{32} * 16 * 4);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 20, 40, 32, 16, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        glViewport(60, 60, 30, 30);
        glMatrixMode(GL_PROJECTION), glLoadIdentity(), glMatrixMode(GL_MODELVIEW), glLoadIdentity();
        glColor3f(1, 0, 1);
        unit_square();
    }
    say_pixel("picture", 64, 70);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    clear(0.1f, 0.1f, 0.1f);
    glBindTexture(GL_TEXTURE_2D, texture);
    glGenerateMipmap(GL_TEXTURE_2D);
    show(texture, 0, 2, 2);
    show(texture, 5, 4, 4);  // small: from the mipmaps
    show(texture, 54, 8, 8);
    // A copy of a part, through the framebuffer that is read from.
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBindTexture(GL_TEXTURE_2D, small);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 48, 48, 32, 32);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    show(small, 3, 2, 2);
    std::vector<GLubyte> texels(std::size_t{kSize} * kSize * 4);
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    unsigned sum = 0;
    for (const GLubyte value : texels) sum = sum * 31 + value;
    say("texels %08x", sum);
    say_error("framebuffer");
}

SCENE(framebuffer_copy, 3) {  // what is drawn is copied to textures: as a whole, in part, to faces, and upon each other
    struct Copied {
        GLint format;
        GLuint framebuffer, whole, part;
    };
    static std::array<Copied, 3> all{};
    static GLuint cube, other;
    if (frame == 0) {
        const std::array<GLint, 3> formats{GL_RGBA8, GL_RGBA16F, GL_RGB10_A2};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const GLuint drawn = make_texture(formats[i], GL_RGBA, GL_UNSIGNED_BYTE);
            all[i].format = formats[i];
            all[i].framebuffer = make_framebuffer();
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, drawn, 0);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                      make_renderbuffer(GL_DEPTH_COMPONENT24));
            all[i].whole = make_texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4);
            all[i].part = make_texture(formats[i], GL_RGBA, GL_UNSIGNED_BYTE);
            const auto image = random_image(std::size_t{kSize} * kSize * 4);
            glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        }
        other = make_framebuffer();
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, all[1].part, 0);
        glGenTextures(1, &cube);
    }
    glEnable(GL_SCISSOR_TEST);  // of what is drawn, not of what is copied
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Copied& each = all[i];
        glBindFramebuffer(GL_FRAMEBUFFER, each.framebuffer);
        glScissor(0, 0, kSize, kSize);
        draw_picture(frame + static_cast<int>(i));
        glScissor(10, 10, 20, 20);
        glBindTexture(GL_TEXTURE_2D, each.whole);
        glCopyTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLenum>(each.format), 0, 0, kSize, kSize, 0);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, other);
        glBindTexture(GL_TEXTURE_2D, each.part);
        glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 8 * (frame + 1), 4, 40, 30, 64, 80);
        if (frame == 1) {  // upon what was copied
            const auto image = random_image(std::size_t{16} * 16 * 4);
            glTexSubImage2D(GL_TEXTURE_2D, 0, 30, 30, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
        }
    }
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, all[0].framebuffer);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
    for (GLenum face = 0; face < 6; ++face)
        glCopyTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, face == 5 ? GL_RGB : GL_RGBA,
                         static_cast<GLint>(8 * face), 0, 64, 64, 0);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    clear(0.1f, 0.1f, 0.1f);
    for (std::size_t i = 0; i < all.size(); ++i) {
        show(all[i].whole, static_cast<int>(2 * i), 4, 2);
        show(all[i].part, static_cast<int>(2 * i + 1), 4, 2);
    }
    std::vector<GLubyte> texels(std::size_t{64} * 64 * 4);
    for (GLenum face = 0; face < 6; ++face) {
        glGetTexImage(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        unsigned sum = 0;
        for (const GLubyte value : texels) sum = sum * 31 + value;
        say("face %u: %08x", face, sum);
    }
    say_error("copies");
}

SCENE(framebuffer_blit, 2) {  // frame 1: scaled and upside down; samples are resolved
    static GLuint framebuffer, multisampled;
    if (frame == 0) {
        framebuffer = make_framebuffer();
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, make_renderbuffer(GL_RGBA8));
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                                  make_renderbuffer(GL_DEPTH24_STENCIL8));
        say_status("renderbuffers");
        multisampled = make_framebuffer();
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  make_renderbuffer(GL_RGBA8, 4));
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  make_renderbuffer(GL_DEPTH_COMPONENT24, 4));
        say_status("multisampled");
        GLint samples = 0, buffers = 0;
        glGetIntegerv(GL_SAMPLES, &samples);
        glGetIntegerv(GL_SAMPLE_BUFFERS, &buffers);
        say("samples %d, sample buffers %d", samples, buffers);
    }
    clear(0.2f, 0.1f, 0.1f);
    glBindFramebuffer(GL_FRAMEBUFFER, multisampled);
    draw_picture(frame, 0.6f);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    draw_picture(frame + 1);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    const auto blit = [](int size, std::array<int, 4> to) {
        glBlitFramebuffer(0, 0, size, size, to[0], to[1], to[2], to[3], GL_COLOR_BUFFER_BIT, GL_NEAREST);
    };
    if (frame == 0) {
        blit(kSize, {20, 130, 20 + kSize, 130 + kSize});
        glEnable(GL_SCISSOR_TEST);
        glScissor(180, 120, 100, 90);
        blit(kSize, {170, 100, 170 + kSize, 100 + kSize});
        glDisable(GL_SCISSOR_TEST);
    } else {  // of an odd number of texels: no pixel's centre lies on the border of two
        blit(kSize - 1, {20, 130, 20 + 2 * kSize, 130 + kSize});
        blit(kSize - 1, {330, 100, 290, 10});
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, multisampled);
    glBlitFramebuffer(0, 0, kSize, kSize, 10, 0, 10 + kSize, kSize, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, std::array<GLubyte, 4>{}.data());
    say_error("of samples");
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    say_error("framebuffer_blit");
}

SCENE(framebuffer_many, 1) {  // faces, levels, slices; a depth texture; two colours at once
    clear();
    const GLuint framebuffer = make_framebuffer();
    const GLuint depth = make_texture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    glDrawBuffer(GL_NONE), glReadBuffer(GL_NONE);
    say_status("depth alone");
    draw_picture(0);
    glDrawBuffer(GL_COLOR_ATTACHMENT0), glReadBuffer(GL_COLOR_ATTACHMENT0);
    const GLuint color = make_texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, kSize, true);
    for (int level = 1; level < 8; ++level)
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, kSize >> level, kSize >> level, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     nullptr);
    for (int level = 0; level < 8; ++level) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, level);
        glClearColor(0.1f * static_cast<float>(level), 1 - 0.1f * static_cast<float>(level), 0.5f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, 0, 0);
    const GLuint first = make_texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE),
                 second = make_texture(GL_RGB, GL_RGB, GL_UNSIGNED_BYTE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, first, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, second, 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    say_status("two colours");
    draw_picture(1, 0.8f);
    GLint names[2] = {}, type = 0;
    glGetIntegerv(GL_DRAW_BUFFER1, &names[0]);
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &names[1]);
    glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE,
                                          &type);
    say("draw buffer 1 %#x, bound %d, attached %#x", names[0], names[1] != 0, type);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    show(depth, 0, 3, 2);
    show(color, 1, 3, 2);
    show(color, 13, 7, 5);
    show(first, 2, 3, 2);
    show(second, 3, 3, 2);
    glDeleteFramebuffers(1, &framebuffer);
    say_error("framebuffer_many");
}

SCENE(framebuffer_wrong, 1) {  // what OpenGL refuses
    clear(0, 0.2f, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    say_error("no framebuffer");
    const GLuint framebuffer = make_framebuffer();
    say_status("nothing attached");
    glClear(GL_COLOR_BUFFER_BIT);
    say_error("clear of an incomplete one");
    glBegin(GL_POINTS), glVertex2f(0, 0), glEnd();
    say_error("draw to an incomplete one");
    const GLuint texture = make_texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 3);
    say_status("a level that has no image");
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 99);
    say_error("no such level");
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_3D, texture, 0);
    say_error("another target");
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_BACK, GL_TEXTURE_2D, texture, 0);
    say_error("no attachment point");
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    say_status("colour as depth");
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, 0, 0);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 4, 4);
    say_error("no renderbuffer");
    make_renderbuffer(GL_RGBA8);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, -1, 4);
    say_error("negative size");
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA, 1 << 20, 4);
    say_error("too large");
    glRenderbufferStorage(GL_RENDERBUFFER, GL_BACK, 4, 4);
    say_error("no such format");
    glBlitFramebuffer(0, 0, 4, 4, 0, 0, 4, 4, GL_ACCUM_BUFFER_BIT, GL_NEAREST);
    say_error("blit of an incomplete one");
    glDrawBuffer(GL_BACK);
    say_error("buffer of a window");
    glDeleteTextures(1, &texture);
    say_status("its image deleted");
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDrawBuffer(GL_COLOR_ATTACHMENT0);
    say_error("attachment as a buffer of a window");
    GLint value = 0;
    for (const GLenum name : {GL_MAX_COLOR_ATTACHMENTS, GL_MAX_DRAW_BUFFERS, GL_RED_BITS, GL_DEPTH_BITS}) {
        glGetIntegerv(name, &value);
        say("%#x: %d", name, value);
    }
    glDeleteFramebuffers(1, &framebuffer);
    unit_square();
}

}  // namespace golden
