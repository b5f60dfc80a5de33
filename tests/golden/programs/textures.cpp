// SPDX-License-Identifier: MIT
// Textures of OpenGL 3: floats, signed numbers, sRGB, blocks of RGTC, swizzles, arrays; what is read back of them.
#include <array>
#include <utility>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kSize = 64;  // texels a side

GLuint make_texture(GLenum target, GLint filter = GL_LINEAR) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(target, name);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

/// Four components a texel: waves between `low` and `high`.
std::vector<GLfloat> waves(float low, float high) {
    std::vector<GLfloat> texels;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            for (int i = 0; i < 4; ++i) {
                const int step = (x * (i + 1) + y * (4 - i)) % kSize;
                texels.push_back(low + (high - low) * static_cast<float>(step) / (kSize - 1));
            }
    return texels;
}

/// The bound texture in a cell, its colours scaled.
void show(int cell, float scale = 1) {
    cell_view(cell, 4, 3);
    glEnable(GL_TEXTURE_2D);
    glColor3f(scale, scale, scale);
    unit_square();
    glDisable(GL_TEXTURE_2D);
}

/// What glGetTexImage says of level 0, in a form that every difference changes.
void say_texels(const char* what, GLenum target, std::size_t texels, GLenum format, GLenum type, std::size_t bytes) {
    std::vector<GLubyte> image(texels * bytes);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(target, 0, format, type, image.data());
    unsigned sum = 2166136261u;
    for (const GLubyte byte : image) sum = (sum ^ byte) * 16777619u;
    say("%s %#x %#x: %08x", what, format, type, sum);
    say_error(what);
}

struct Kind {
    const char* name;
    GLint internal_format;
    float low, high;
};

GLuint compile(GLenum type, const char* source) {
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    return shader;
}

GLuint make_program(const char* vertex, const char* fragment) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
    glLinkProgram(program);
    return program;
}

}  // namespace

SCENE(texture_kinds, 2) {  // texels of many kinds, given as floats, drawn and read back
    static constexpr Kind kKinds[] = {{"half", GL_RGBA16F, -1, 3},
                                      {"float", GL_RGBA32F, -1, 3},
                                      {"two", GL_RG32F, 0, 2},
                                      {"one", GL_R16F, 0, 2},
                                      {"short floats", GL_R11F_G11F_B10F, 0, 4},
                                      {"one exponent", GL_RGB9_E5, 0, 4},
                                      {"signed", GL_RGBA8_SNORM, -1, 1},
                                      {"curve", GL_SRGB8_ALPHA8, 0, 1},
                                      {"blocks", GL_COMPRESSED_RED_RGTC1, 0, 1},
                                      {"two of blocks", GL_COMPRESSED_SIGNED_RG_RGTC2, -1, 1},
                                      {"half luminance", GL_LUMINANCE16F_ARB, 0, 2},
                                      {"ten bits", GL_RGB10_A2, 0, 1}};
    clear(0.1f, 0.1f, 0.1f);
    int cell = 0;
    for (const Kind& kind : kKinds) {
        make_texture(GL_TEXTURE_2D);
        glTexImage2D(GL_TEXTURE_2D, 0, kind.internal_format, kSize, kSize, 0, GL_RGBA, GL_FLOAT,
                     waves(kind.low, kind.high).data());
        if (frame == 1) {
            const GLint turned[] = {GL_BLUE, GL_RED, GL_ONE, GL_ALPHA};
            glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, turned);
        }
        show(cell++, 1 / kind.high);
        say_error(kind.name);
        if (kind.internal_format == GL_COMPRESSED_SIGNED_RG_RGTC2) continue;  // decoded by halves of a step
        say_texels(kind.name, GL_TEXTURE_2D, kSize * kSize, GL_RGBA, GL_FLOAT, 16);
    }
}

SCENE(float_targets, 2) {  // light adds up above one in a framebuffer of halves
    static GLuint framebuffer, texture;
    if (frame == 0) {
        texture = make_texture(GL_TEXTURE_2D);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, kSize, kSize, 0, GL_RGBA, GL_FLOAT, nullptr);
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
        say("status %#x", glCheckFramebufferStatus(GL_FRAMEBUFFER));
        glViewport(0, 0, kSize, kSize);
        glColor3f(0.5f, 2, 0.25f);
        unit_square();  // the first that is drawn to it, read at once
        say_texels("one square", GL_TEXTURE_2D, kSize * kSize, GL_RGBA, GL_FLOAT, 16);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSize, kSize);
    clear();
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < 12; ++i) {
        glLoadIdentity();
        glRotatef(static_cast<float>(30 * i + 7 * frame), 0, 0, 1);
        glTranslatef(0.4f, 0, 0);
        glScalef(0.5f, 0.5f, 1);
        glColor3f(0.4f, 0.3f, 0.2f);
        unit_square();
    }
    glDisable(GL_BLEND);
    glLoadIdentity();
    std::array<GLfloat, 4> middle{};
    glReadPixels(kSize / 2, kSize / 2, 1, 1, GL_RGBA, GL_FLOAT, middle.data());
    say("the middle is %.4g %.4g %.4g", static_cast<double>(middle[0]), static_cast<double>(middle[1]),
        static_cast<double>(middle[2]));
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    clear(0.1f, 0.1f, 0.2f);
    glBindTexture(GL_TEXTURE_2D, texture);
    for (int cell = 0; cell < 12; ++cell) show(cell, static_cast<float>(cell + 1) / 12);
    say_texels("sum", GL_TEXTURE_2D, kSize * kSize, GL_RGBA, GL_FLOAT, 16);
}

SCENE(texture_arrays, 3) {  // layers that come from memory, are changed in part, and drawn to
    constexpr int kLayers = 4;
    static GLuint array, lines, framebuffer, program;
    if (frame == 0) {
        program =
            make_program("varying vec3 at; void main() { at = gl_MultiTexCoord0.stp; gl_Position = ftransform(); }",
                         "#extension GL_EXT_texture_array : enable\n"
                         "uniform sampler2DArray layers; uniform sampler1DArray lines; varying vec3 at;\n"
                         "void main() { gl_FragColor = at.p < 4.0 ? texture2DArray(layers, at) : texture1DArray(lines, "
                         "at.st * 4.0); }");
        array = make_texture(GL_TEXTURE_2D_ARRAY);
        const auto texels = random_image(std::size_t{kSize} * kSize * kLayers * 4);
        glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, kSize, kSize, kLayers, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     texels.data());
        lines = make_texture(GL_TEXTURE_1D_ARRAY, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_1D_ARRAY, 0, GL_RGBA8, kSize, kLayers, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, array, 0, 2);
        say("status %#x", glCheckFramebufferStatus(GL_FRAMEBUFFER));
    }
    const auto part = random_image(std::size_t{20} * 20 * 2 * 4);
    glBindTexture(GL_TEXTURE_2D_ARRAY, array);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 10 * frame, 5, 0, 20, 20, 2, GL_RGBA, GL_UNSIGNED_BYTE, part.data());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSize, kSize);
    clear(0.2f, 0.5f, static_cast<float>(frame) / 3);
    perspective_view({kSize, kSize});
    glColor3f(1, 1, 0);
    unit_square();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    clear();
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "layers"), 0);
    glUniform1i(glGetUniformLocation(program, "lines"), 1);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_1D_ARRAY, lines);
    glActiveTexture(GL_TEXTURE0);
    for (int layer = 0; layer <= kLayers; ++layer) {
        cell_view(layer, 3, 2);
        glBegin(GL_QUADS);
        for (const auto& [s, t] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
            glTexCoord3f(s, t, static_cast<float>(layer));
            glVertex2f(2 * s - 1, 2 * t - 1);
        }
        glEnd();
    }
    glUseProgram(0);
    say_texels("layers", GL_TEXTURE_2D_ARRAY, std::size_t{kSize} * kSize * kLayers, GL_RGBA, GL_UNSIGNED_BYTE, 4);
}

}  // namespace golden
