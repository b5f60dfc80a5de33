// SPDX-License-Identifier: MIT
// Texels that are copied from image to image, views of textures, stencil values that are sampled. What was uploaded and
// what was drawn, seen in the window over tiles' borders and read back.
#include <array>
#include <initializer_list>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kSize = 64;

GLuint storage(GLenum target, GLenum format, int levels = 1, int layers = 1) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(target, name);
    if (layers > 1) glTexStorage3D(target, levels, format, kSize, kSize, layers);
    else glTexStorage2D(target, levels, format, kSize, kSize);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

GLuint view_of(GLuint origin, GLenum target, GLenum format, GLuint level, GLuint layer, GLuint layers = 1,
               GLuint levels = 1) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glTextureView(name, target, origin, format, level, levels, layer, layers);
    glBindTexture(target, name);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

/// Draws a triangle over a green ground to the texture's layer.
void draw_to(GLuint texture, GLint layer, float turn) {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (layer < 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    else glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0, layer);
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    glViewport(0, 0, kSize, kSize);
    glClearColor(0.1f, 0.5f, 0.2f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glColor3f(1, 0.8f, 0.1f);
    glBegin(GL_TRIANGLES);
    glVertex2f(-0.8f, -0.7f), glVertex2f(0.9f, -0.5f + turn), glVertex2f(0.1f - turn, 0.8f);
    glEnd();
    glColor3f(1, 1, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
}

/// A texture in a cell of the window.
void show(GLuint texture, int cell, int columns, int rows) {
    glMatrixMode(GL_PROJECTION);
    glPushMatrix();
    cell_view(cell, columns, rows);
    glBindTexture(GL_TEXTURE_2D, texture);
    glEnable(GL_TEXTURE_2D);
    unit_square();
    glDisable(GL_TEXTURE_2D);
    glMatrixMode(GL_PROJECTION);
    glPopMatrix();
    glMatrixMode(GL_MODELVIEW);
}

void say_texels(const char* what, GLuint texture, GLint level, GLenum format, GLenum type) {
    std::vector<GLubyte> bytes(16 * kSize * kSize * 8);
    glGetTextureImage(texture, level, format, type, static_cast<GLsizei>(bytes.size()), bytes.data());
    unsigned sum = 0;
    for (const GLubyte byte : bytes) sum = sum * 31 + byte;
    say("%s: %08x", what, sum);
}

GLuint program_of(const char* fragment) {
    const GLuint program = glCreateProgram();
    const char* const texts[] = {
        "#version 130\nin vec4 place; out vec2 at; void main() { gl_Position = place; at = place.xy * 0.5 + 0.5; }",
        fragment};
    for (int i = 0; i < 2; ++i) {
        const GLuint shader = glCreateShader(i == 0 ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
        glShaderSource(shader, 1, &texts[i], nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glBindAttribLocation(program, 0, "place");
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

}  // namespace

/// What was uploaded, what was drawn, faces, layers and blocks go from image to image; in later frames again, over what
/// is there.
SCENE(copied_images, 3) {
    clear(0.1f, 0.1f, 0.2f);
    static GLuint array, drawn, kept, mixed, words, cube, blocks, color;
    if (frame == 0) {
        array = storage(GL_TEXTURE_2D_ARRAY, GL_RGBA8, 1, 4);
        const auto texels = random_image(4 * kSize * kSize * 4);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, kSize, kSize, 4, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        drawn = storage(GL_TEXTURE_2D, GL_RGBA8);
        kept = storage(GL_TEXTURE_2D, GL_RGBA8);
        mixed = storage(GL_TEXTURE_2D, GL_SRGB8_ALPHA8);
        words = storage(GL_TEXTURE_2D, GL_R32UI);
        cube = storage(GL_TEXTURE_CUBE_MAP, GL_RGBA8);
        blocks = storage(GL_TEXTURE_2D, GL_COMPRESSED_RGBA_S3TC_DXT1_EXT);
        glGenRenderbuffers(1, &color);
        glBindRenderbuffer(GL_RENDERBUFFER, color);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
        const GLuint pairs = storage(GL_TEXTURE_2D, GL_RG32UI);
        const auto bits = random_image(8 * kSize * kSize);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSize, kSize, GL_RG_INTEGER, GL_UNSIGNED_INT, bits.data());
        glCopyImageSubData(pairs, GL_TEXTURE_2D, 0, 3, 5, 0, blocks, GL_TEXTURE_2D, 0, 8, 4, 0, 10, 9, 1);
        glDeleteTextures(1, &pairs);
        say_error("blocks");
    }
    draw_to(drawn, -1, 0.2f * static_cast<float>(frame));
    glCopyImageSubData(array, GL_TEXTURE_2D_ARRAY, 0, 0, 0, frame, kept, GL_TEXTURE_2D, 0, 5, 7, 0, 40, 41, 1);
    glCopyImageSubData(array, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 1, mixed, GL_TEXTURE_2D, 0, 0, 0, 0, kSize, kSize, 1);
    glCopyImageSubData(drawn, GL_TEXTURE_2D, 0, 8, 8, 0, mixed, GL_TEXTURE_2D, 0, 20, 10, 0, 40, 50, 1);
    glCopyImageSubData(mixed, GL_TEXTURE_2D, 0, 0, 0, 0, words, GL_TEXTURE_2D, 0, 0, 0, 0, kSize, kSize, 1);
    glCopyImageSubData(words, GL_TEXTURE_2D, 0, 0, 0, 0, cube, GL_TEXTURE_CUBE_MAP, 0, 0, 0, frame, kSize, 32, 1);
    glCopyImageSubData(cube, GL_TEXTURE_CUBE_MAP, 0, 0, 0, 0, array, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 1, kSize, kSize, 3);
    glCopyImageSubData(array, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 1, color, GL_RENDERBUFFER, 0, 0, 0, 0, kSize, kSize, 1);
    glCopyImageSubData(color, GL_RENDERBUFFER, 0, 0, 0, 0, kept, GL_TEXTURE_2D, 0, 32, 0, 0, 32, 20, 1);
    say_error("copies");
    show(kept, 0, 2, 2);
    show(mixed, 1, 2, 2);
    show(blocks, 2, 2, 2);
    show(drawn, 3, 2, 2);
    say_texels("words", words, 0, GL_RED_INTEGER, GL_UNSIGNED_INT);
    say_texels("array", array, 0, GL_RGBA, GL_UNSIGNED_BYTE);
    say_texels("cube", cube, 0, GL_RGBA, GL_UNSIGNED_BYTE);
    glCopyImageSubData(kept, GL_TEXTURE_2D, 0, 0, 0, 0, blocks, GL_TEXTURE_2D, 0, 0, 0, 0, 4, 4, 1);
    say_error("of other sizes");
}

/// Layers of one storage, uploaded and drawn through views and through their origin.
SCENE(texture_views, 4) {
    clear(0.2f, 0.1f, 0.1f);
    static GLuint origin, layer, curved, words, faces, tail;
    if (frame == 0) {
        origin = storage(GL_TEXTURE_2D_ARRAY, GL_RGBA8, 3, 8);
        const auto texels = random_image(4 * kSize * kSize * 8);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, kSize, kSize, 8, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        layer = view_of(origin, GL_TEXTURE_2D, GL_RGBA8, 0, 2, 1, 3);
        curved = view_of(origin, GL_TEXTURE_2D, GL_SRGB8_ALPHA8, 0, 2);
        words = view_of(origin, GL_TEXTURE_2D, GL_R32UI, 0, 3);
        faces = view_of(origin, GL_TEXTURE_CUBE_MAP, GL_RGBA8, 0, 1, 6);
        tail = view_of(layer, GL_TEXTURE_2D, GL_RGBA8, 1, 0, 1, 2);
        say_error("views");
        for (const GLuint name : {origin, layer, faces, tail}) {
            std::array<GLint, 5> part{};
            glGetTextureParameteriv(name, GL_TEXTURE_VIEW_MIN_LEVEL, &part[0]);
            glGetTextureParameteriv(name, GL_TEXTURE_VIEW_NUM_LEVELS, &part[1]);
            glGetTextureParameteriv(name, GL_TEXTURE_VIEW_MIN_LAYER, &part[2]);
            glGetTextureParameteriv(name, GL_TEXTURE_VIEW_NUM_LAYERS, &part[3]);
            glGetTextureParameteriv(name, GL_TEXTURE_IMMUTABLE_LEVELS, &part[4]);
            say("levels %d + %d, layers %d + %d, of %d", part[0], part[1], part[2], part[3], part[4]);
        }
    }
    if (frame == 1) {
        const std::vector<GLuint> red(20 * 20, 0xff0000ffu);
        glTextureSubImage2D(words, 0, 10, 30, 20, 20, GL_RED_INTEGER, GL_UNSIGNED_INT, red.data());
        glBindTexture(GL_TEXTURE_CUBE_MAP, faces);
        glTexSubImage2D(GL_TEXTURE_CUBE_MAP_NEGATIVE_X, 0, 40, 5, 20, 20, GL_RGBA, GL_UNSIGNED_BYTE, red.data());
    }
    if (frame == 2) draw_to(layer, -1, 0.3f);
    if (frame == 3) {
        glGenerateTextureMipmap(layer);
        draw_to(origin, 3, 0.1f);
        const std::vector<GLubyte> blue(4 * 8 * 8, 200);
        glTextureSubImage2D(tail, 0, 4, 4, 8, 8, GL_RGBA, GL_UNSIGNED_BYTE, blue.data());
    }
    say_error("changes");
    show(layer, 0, 2, 2);
    show(curved, 1, 2, 2);
    show(view_of(origin, GL_TEXTURE_2D, GL_RGBA8, 0, 3), 2, 2, 2);
    if (frame == 3) show(tail, 3, 2, 2);
    say_texels("origin", origin, 0, GL_RGBA, GL_UNSIGNED_BYTE);
    say_texels("words", words, 0, GL_RED_INTEGER, GL_UNSIGNED_INT);
    say_texels("faces", faces, 0, GL_RGBA, GL_UNSIGNED_BYTE);
    if (frame == 3) say_texels("tail", tail, 0, GL_RGBA, GL_UNSIGNED_BYTE);
    GLuint none = 0;
    glGenTextures(1, &none);
    glTextureView(none, GL_TEXTURE_2D, origin, GL_RGBA16, 0, 1, 0, 1);
    say_error("of another size");
}

/// Stencil values that were drawn are looked up by a shader, of a texture of both and of one of its own; beside where
/// no pixel's centre lies between two texels.
SCENE(stencil_textures, 2) {
    clear(0.1f, 0.2f, 0.2f);
    static GLuint both, alone, program;
    if (frame == 0) {
        both = storage(GL_TEXTURE_2D, GL_DEPTH24_STENCIL8);
        glTexParameteri(GL_TEXTURE_2D, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_STENCIL_INDEX);
        alone = storage(GL_TEXTURE_2D, GL_STENCIL_INDEX8);
        std::vector<GLubyte> values(kSize * kSize);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<GLubyte>(i % kSize * 4);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSize, kSize, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, values.data());
        program = program_of(
            "#version 130\nuniform usampler2D values; in vec2 at; out vec4 color;\n"
            "void main() { float v = float(texture(values, at + 0.0003).r) / 255.0; color = vec4(v, 1.0 - v, 0.3, "
            "1.0); }");
    }
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, both, 0);
    glDrawBuffer(GL_NONE);
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    glViewport(0, 0, kSize, kSize);
    glClearStencil(40);
    glClear(GL_STENCIL_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 160 + 50 * frame, 0xff);
    glStencilOp(GL_REPLACE, GL_REPLACE, GL_REPLACE);
    glBegin(GL_TRIANGLES);
    glVertex2f(-0.8f, -0.7f), glVertex2f(0.9f, -0.5f), glVertex2f(0.1f, 0.8f);
    glEnd();
    glDisable(GL_STENCIL_TEST);
    glClearStencil(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    say_error("stencil");
    glUseProgram(program);
    for (int i = 0; i < 2; ++i) {
        glViewport(viewport[0] + i * viewport[2] / 2, viewport[1], viewport[2] / 2, viewport[3]);
        glBindTexture(GL_TEXTURE_2D, i == 0 ? both : alone);
        glBegin(GL_QUADS);
        for (const auto& [x, y] : {std::array{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
            glVertexAttrib4f(0, x, y, 0, 1);
        glEnd();
    }
    glUseProgram(0);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    say_texels("drawn", both, 0, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE);
    say_texels("alone", alone, 0, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE);
    say_error("sampled");
}

}  // namespace golden
