// SPDX-License-Identifier: MIT
// Framebuffer objects that are copied to the window as they are, frame after frame, by blits or as textures, which
// nodes then draw in parts; and all that needs more of them than that, once it has become a habit.
#include <array>
#include <cstddef>

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

// ---- as textures ----

/// As toolkits bring the pictures of their widgets to a window.
constexpr const char* kPlacedByMatrices =
    "attribute vec3 place; attribute vec2 corner; varying vec2 uv; uniform mat4 to; uniform mat3 from;\n"
    "void main() { uv = (from * vec3(corner, 1.0)).xy; gl_Position = to * vec4(place, 1.0); }";
constexpr const char* kAsItIs =
    "uniform sampler2D picture; uniform float opacity; varying vec2 uv;\n"
    "void main() { vec4 c = texture2D(picture, uv); c.a *= opacity; gl_FragColor = c; }";
constexpr const char* kBoth =
    "uniform sampler2D picture, other; uniform float opacity; varying vec2 uv;\n"
    "void main() { gl_FragColor = opacity * texture2D(picture, uv) + 0.5 * texture2D(other, uv); }";
constexpr const char* kBesideIt =
    "uniform sampler2D picture; uniform vec2 step; varying vec2 uv;\n"
    "void main() { gl_FragColor = texture2D(picture, uv) - 0.5 * texture2D(picture, uv + 9.0 * step); }";

struct Corner {
    GLfloat place[3], texel[2];
};
constexpr Corner kCorners[] = {{{-1, -1, 0}, {0, 0}}, {{1, -1, 0}, {1, 0}}, {{-1, 1, 0}, {0, 1}}, {{1, 1, 0}, {1, 1}}};
constexpr int kTriangles[] = {0, 1, 2, 2, 1, 3};

GLuint corner_buffer() {
    static GLuint buffer = 0;
    if (buffer != 0) return buffer;
    std::vector<Corner> corners;
    for (const int corner : kTriangles) corners.push_back(kCorners[corner]);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                 GL_STATIC_DRAW);
    return buffer;
}

/// From a buffer, or from memory as a strip; at these pixels of the canvas.
void draw_picture(GLuint program, Size picture, float x, float y, Size canvas, bool from_buffer, float scale = 1) {
    const auto width = static_cast<float>(canvas.width), height = static_cast<float>(canvas.height);
    const float sx = scale * static_cast<float>(picture.width) / width,
                sy = scale * static_cast<float>(picture.height) / height;
    const GLfloat to[16] = {sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 1, 0, sx - 1 + 2 * x / width, sy - 1 + 2 * y / height,
                            0,  1},
                  from[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "to"), 1, GL_FALSE, to);
    glUniformMatrix3fv(glGetUniformLocation(program, "from"), 1, GL_FALSE, from);
    glUniform1f(glGetUniformLocation(program, "opacity"), 0.75f);
    glUniform1i(glGetUniformLocation(program, "other"), 1);
    glUniform2f(glGetUniformLocation(program, "step"), 1 / width, 1 / height);
    glBindBuffer(GL_ARRAY_BUFFER, from_buffer ? corner_buffer() : 0);
    const auto at = [&](std::size_t offset) -> const void* {
        return from_buffer ? reinterpret_cast<const void*>(offset) : reinterpret_cast<const char*>(kCorners) + offset;
    };
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Corner), at(0));
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(Corner), at(offsetof(Corner, texel)));
    glEnableVertexAttribArray(0), glEnableVertexAttribArray(1);
    if (from_buffer) glDrawArrays(GL_TRIANGLES, 0, 6);
    else glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisableVertexAttribArray(0), glDisableVertexAttribArray(1);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glUseProgram(0);
}

/// Of fixed function, but for what becomes of the texel.
void draw_indexed(GLuint program, Size canvas) {
    static const GLubyte indices[] = {0, 1, 3, 2};
    const auto width = static_cast<float>(canvas.width), height = static_cast<float>(canvas.height);
    const GLfloat vertices[] = {0, 0, width, 0, 0, height, width, height};
    static const GLfloat texels[] = {0, 0, 1, 0, 0, 1, 1, 1};
    pixel_view(canvas);
    glUseProgram(program);
    glVertexPointer(2, GL_FLOAT, 0, vertices);
    glTexCoordPointer(2, GL_FLOAT, 0, texels);
    glEnableClientState(GL_VERTEX_ARRAY), glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glDrawElements(GL_QUADS, 4, GL_UNSIGNED_BYTE, indices);
    glDisableClientState(GL_VERTEX_ARRAY), glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glUseProgram(0);
}

void bind_pictures(const Picture& first, const Picture& second) {
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, second.color);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, first.color);
}

}  // namespace

SCENE(sampled_out, 4 * kEach) {  // by a buffer, a strip, two at once, fixed function; scaled, moved, read beside, read
    static Picture picture, other;
    static Size size;
    static const GLuint plain = linked_program(kPlacedByMatrices, kAsItIs, {"place", "corner"}),
                        both = linked_program(kPlacedByMatrices, kBoth, {"place", "corner"}),
                        beside = linked_program(kPlacedByMatrices, kBesideIt, {"place", "corner"}),
                        fixed = linked_program(
                            "void main() { gl_TexCoord[0] = gl_MultiTexCoord0; gl_Position = ftransform(); }",
                            "uniform sampler2D s; void main() { gl_FragColor = texture2D(s, gl_TexCoord[0].st).grba; }",
                            {});
    const int way = frame / kEach;
    const bool last = frame % kEach == kEach - 1;
    if (frame % kEach == 0) {
        size = way == 1 ? Size{canvas.width - 60, canvas.height - 40} : canvas;
        picture = make_picture(size), other = make_picture(size, way == 1 ? 4 : 0);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, other.framebuffer);
    draw_balls(frame + 7, size);
    if (way == 1) {
        copy(other.framebuffer, picture.framebuffer, size);
    } else {
        glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer);
        draw_balls(frame, size);
    }
    if (way == 3 && last) {
        std::vector<GLubyte> pixels(std::size_t{4} * static_cast<std::size_t>(size.width * size.height));
        glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        say("pixels %08x", sum_of(pixels));
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    clear(0.3f, 0.1f, 0.1f);
    bind_pictures(picture, other);
    if (way == 0) {
        draw_picture(plain, size, 0, 0, canvas, true, last ? 0.4f : 1);
    } else if (way == 1) {
        const GLint filter = last ? GL_LINEAR : GL_NEAREST;
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
        draw_picture(plain, size, last ? 17.5f : 17, 9, canvas, false);
    } else if (way == 2) {
        draw_picture(last ? beside : both, size, 0, 0, canvas, true);
    } else {
        draw_indexed(fixed, canvas);
    }
    say_error("sampled_out");
}

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
