// SPDX-License-Identifier: MIT
// OpenGL ES 3.0: instances with uniform blocks and a fixed restart index, several targets of several kinds, textures in
// blocks of ETC2 and EAC, and transform feedback that pauses. All of it reaches over tiles' borders.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr Needs kEs{.es = 3};

GLuint shader_of(GLenum type, const char* text) {
    const std::string source = std::string("#version 300 es\nprecision highp float;\nprecision highp int;\n") + text;
    const char* whole = source.c_str();
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &whole, nullptr);
    glCompileShader(shader);
    GLint status = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &status);
    if (!status) say("does not compile");
    return shader;
}

/// `captured` goes to a buffer, if it is not null.
GLuint linked(const char* vertex, const char* fragment, const char* captured = nullptr) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader_of(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, shader_of(GL_FRAGMENT_SHADER, fragment));
    if (captured) glTransformFeedbackVaryings(program, 1, &captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

template <class T>
GLuint buffer_of(GLenum target, const std::vector<T>& content) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(content.size() * sizeof(T)), content.data(), GL_STATIC_DRAW);
    return name;
}

/// Covers [-1, 1]^2 without an array.
constexpr const char* kWhole = R"(
    out vec2 at;
    void main() {
        at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
        gl_Position = vec4(at * 2.0 - 1.0, 0, 1);
    })";

void draw_whole() { glDrawArrays(GL_TRIANGLE_STRIP, 0, 4); }

/// Draws to one of a row of fields of the window.
void field(Size canvas, int number, int fields) {
    const int width = canvas.width / fields;
    glViewport(number * width, 0, width, canvas.height);
}
void whole_window(Size canvas) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
}

// ---- instances ----

constexpr int kRing = 24, kInstances = 40;

/// Two rings, each a strip, and what separates them.
std::vector<GLushort> strips() {
    std::vector<GLushort> out;
    for (GLushort ring = 0; ring < 2; ++ring) {
        for (GLushort i = 0; i <= kRing; ++i) {
            const auto at = static_cast<GLushort>(ring * kRing + i % kRing);
            out.push_back(at);
            out.push_back(static_cast<GLushort>(at + kRing));
        }
        out.push_back(0xffff);
    }
    return out;
}

struct Corner {
    GLfloat place[2];
    GLubyte kind[4];  ///< whole numbers for the shader
};

std::vector<Corner> rings() {
    std::vector<Corner> out;
    for (int ring = 0; ring < 3; ++ring)
        for (int i = 0; i < kRing; ++i) {
            const float angle = 6.2832f * static_cast<float>(i) / kRing,
                        radius = 0.4f + 0.3f * static_cast<float>(ring);
            out.push_back({{radius * std::cos(angle), radius * std::sin(angle)},
                           {static_cast<GLubyte>(ring), static_cast<GLubyte>(i), 0, 1}});
        }
    return out;
}

constexpr const char* kInstanceVertex = R"(
    layout(location = 0) in vec2 place;
    layout(location = 1) in uvec4 kind;
    layout(location = 2) in vec4 tint;
    layout(std140) uniform Move { mat4 turn; vec4 shift[40]; };
    flat out uint ring;
    out vec4 color;
    void main() {
        ring = kind.x;
        color = tint * (0.5 + 0.5 * float(kind.y % 5u) / 4.0);
        gl_Position = turn * vec4(place * 0.22, 0, 1) + vec4(shift[gl_InstanceID].xy, 0, 0);
    })";
constexpr const char* kInstanceFragment = R"(
    flat in uint ring;
    in vec4 color;
    layout(location = 0) out vec4 result;
    void main() { result = (ring & 1u) == 1u ? color.brga : color; })";

SCENE(es3_instances, 3, kEs) {
    static GLuint program, object, uniforms, query;
    if (frame == 0) {
        program = linked(kInstanceVertex, kInstanceFragment);
        glGenVertexArrays(1, &object);
        glBindVertexArray(object);
        buffer_of(GL_ARRAY_BUFFER, rings());
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
        glEnableVertexAttribArray(1);
        glVertexAttribIPointer(1, 4, GL_UNSIGNED_BYTE, sizeof(Corner), reinterpret_cast<void*>(2 * sizeof(GLfloat)));
        std::vector<GLuint> tints;
        for (GLuint i = 0; i < kInstances; ++i)
            tints.push_back(3u << 30 | (i * 97 % 1024) << 20 | (i * 57 % 1024) << 10 | 900);
        buffer_of(GL_ARRAY_BUFFER, tints);
        glEnableVertexAttribArray(2);
        glVertexAttribPointer(2, 4, GL_UNSIGNED_INT_2_10_10_10_REV, GL_TRUE, 0, nullptr);
        glVertexAttribDivisor(2, 1);
        buffer_of(GL_ELEMENT_ARRAY_BUFFER, strips());
        uniforms = buffer_of(GL_UNIFORM_BUFFER, std::vector<GLfloat>(16 + 4 * kInstances));
        glUniformBlockBinding(program, glGetUniformBlockIndex(program, "Move"), 1);
        glGenQueries(1, &query);
        glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
    }
    const float angle = 0.3f * static_cast<float>(frame), c = std::cos(angle), s = std::sin(angle);
    glBindBuffer(GL_UNIFORM_BUFFER, uniforms);
    auto* move = static_cast<GLfloat*>(glMapBufferRange(GL_UNIFORM_BUFFER, 0, (16 + 4 * kInstances) * sizeof(GLfloat),
                                                        GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
    const GLfloat turn[16] = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::memcpy(move, turn, sizeof turn);
    for (int i = 0; i < kInstances; ++i) {
        const GLfloat shift[4] = {-0.9f + 0.2f * static_cast<float>(i % 10),
                                  -0.75f + 0.5f * static_cast<float>(i / 10)};
        std::memcpy(move + 16 + 4 * i, shift, sizeof shift);
    }
    glUnmapBuffer(GL_UNIFORM_BUFFER);
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms);
    glClearColor(0.1f, 0.1f, 0.2f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUseProgram(program);
    glBindVertexArray(object);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
    glDrawElementsInstanced(GL_TRIANGLE_STRIP, static_cast<GLsizei>(strips().size()), GL_UNSIGNED_SHORT, nullptr,
                            kInstances);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint passed = 7;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &passed);
    say("any samples passed: %u", passed);
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    say("waited: %d", glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1000000000) != GL_TIMEOUT_EXPIRED);
    glDeleteSync(fence);
}

// ---- targets ----

constexpr GLsizei kSide = 64;
constexpr GLenum kKinds[] = {GL_RGBA8, GL_RGBA16F, GL_RGBA8UI, GL_SRGB8_ALPHA8};

constexpr const char* kTargetFragment = R"(
    in vec2 at;
    uniform float time;
    layout(location = 0) out vec4 bytes;
    layout(location = 1) out vec4 floats;
    layout(location = 2) out uvec4 whole;
    layout(location = 3) out vec4 curved;
    void main() {
        bytes = vec4(at, 0.5 + 0.5 * sin(at.x * 20.0 + time), 1);
        floats = vec4(at * 4.0 - 1.5, time, 1);
        whole = uvec4(floatBitsToUint(at.x) >> 16, uint(at.y * 64.0), 5u, 255u);
        curved = vec4(at.yx, 0.25, 1);
        gl_FragDepth = 0.5 * (at.x + at.y);
    })";
constexpr const char* kShowFragment = R"(
    in vec2 at;
    uniform sampler2D bytes, floats, curved;
    uniform highp usampler2D whole;
    uniform highp sampler2DShadow depth;
    uniform int which;
    out vec4 result;
    void main() {
        ivec2 texel = ivec2(at * vec2(textureSize(bytes, 0)));
        if (which == 0) result = texture(bytes, at);
        else if (which == 1) result = fract(texture(floats, at) * 0.5);
        else if (which == 2) result = vec4(texelFetch(whole, texel, 0)) / 255.0;
        else if (which == 3) result = texture(curved, at);
        else result = vec4(texture(depth, vec3(at, 0.6)));
    })";

SCENE(es3_targets, 3, kEs) {
    static GLuint draw, show, framebuffer, samples, resolved, textures[5];
    if (frame == 0) {
        draw = linked(kWhole, kTargetFragment);
        show = linked(kWhole, kShowFragment);
        glGenTextures(5, textures);
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        std::array<GLenum, 4> buffers{};
        for (unsigned i = 0; i < 5; ++i) {
            glBindTexture(GL_TEXTURE_2D, textures[i]);
            glTexStorage2D(GL_TEXTURE_2D, 1, i < 4 ? kKinds[i] : GLenum{GL_DEPTH_COMPONENT24}, kSide, kSide);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
            const GLenum point = i < 4 ? GL_COLOR_ATTACHMENT0 + i : GLenum{GL_DEPTH_ATTACHMENT};
            glFramebufferTexture2D(GL_FRAMEBUFFER, point, GL_TEXTURE_2D, textures[i], 0);
            if (i < 4) buffers[i] = point;
        }
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glDrawBuffers(4, buffers.data());
        say("status %x", glCheckFramebufferStatus(GL_FRAMEBUFFER));
        glUseProgram(show);
        const char* names[] = {"bytes", "floats", "whole", "curved", "depth"};
        for (int i = 0; i < 5; ++i) glUniform1i(glGetUniformLocation(show, names[i]), i);
        GLuint renderbuffers[2];
        glGenRenderbuffers(2, renderbuffers);
        glGenFramebuffers(1, &samples);
        glGenFramebuffers(1, &resolved);
        for (unsigned i = 0; i < 2; ++i) {
            glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[i]);
            glRenderbufferStorageMultisample(GL_RENDERBUFFER, i == 0 ? 4 : 0, GL_RGB10_A2, kSide, kSide);
            glBindFramebuffer(GL_FRAMEBUFFER, i == 0 ? samples : resolved);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffers[i]);
        }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSide, kSide);
    const GLuint whole[4] = {1, 2, 3, 4};
    const GLfloat grey[4] = {0.5f, 0.5f, 0.5f, 1}, far = 1;
    for (const GLint buffer : {0, 1, 3}) glClearBufferfv(GL_COLOR, buffer, grey);
    glClearBufferuiv(GL_COLOR, 2, whole);
    glClearBufferfv(GL_DEPTH, 0, &far);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_SCISSOR_TEST);
    glScissor(4, 6, kSide - 8, kSide - 10);
    glUseProgram(draw);
    glUniform1f(glGetUniformLocation(draw, "time"), static_cast<GLfloat>(frame));
    draw_whole();
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glReadBuffer(GL_COLOR_ATTACHMENT2);
    GLuint texel[4] = {};
    glReadPixels(20, 33, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texel);
    say("whole numbers %u %u %u %u", texel[0], texel[1], texel[2], texel[3]);
    GLint format = 0, type = 0;
    glReadBuffer(GL_COLOR_ATTACHMENT1);
    glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &format);
    glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_TYPE, &type);
    GLfloat real[4] = {};
    glReadPixels(20, 33, 1, 1, GL_RGBA, GL_FLOAT, real);
    say("floats %.5g %.5g %.5g %.5g, as %x %x", real[0], real[1], real[2], real[3], format, type);
    const GLenum forgotten = GL_DEPTH_ATTACHMENT;
    whole_window(canvas);
    glClearColor(0, 0, 0.3f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    for (unsigned i = 0; i < 5; ++i) {
        glActiveTexture(GL_TEXTURE0 + i);
        glBindTexture(GL_TEXTURE_2D, textures[i]);
    }
    glUseProgram(show);
    for (int i = 0; i < 5; ++i) {
        field(canvas, i, 6);
        glUniform1i(glGetUniformLocation(show, "which"), i);
        draw_whole();
    }
    glBindFramebuffer(GL_FRAMEBUFFER, samples);
    glViewport(3, 0, kSide - 9, kSide);
    glClearColor(1, 0.5f, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glUniform1i(glGetUniformLocation(show, "which"), 0);
    draw_whole();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, samples);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
    glBlitFramebuffer(0, 0, kSide, kSide, 0, 0, kSide, kSide, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, kSide, kSide, canvas.width * 5 / 6, 0, canvas.width * 5 / 6 + kSide, kSide,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glInvalidateFramebuffer(GL_FRAMEBUFFER, 1, &forgotten);
    whole_window(canvas);
}

// ---- textures ----

struct Blocks {
    GLenum format;
    GLsizei bytes;
};
constexpr Blocks kBlocks[] = {
    {GL_COMPRESSED_RGB8_ETC2, 8},
    {GL_COMPRESSED_SRGB8_ETC2, 8},
    {GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2, 8},
    {GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2, 8},
    {GL_COMPRESSED_RGBA8_ETC2_EAC, 16},
    {GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC, 16},
    {GL_COMPRESSED_R11_EAC, 8},
    {GL_COMPRESSED_SIGNED_R11_EAC, 8},
    {GL_COMPRESSED_RG11_EAC, 16},
    {GL_COMPRESSED_SIGNED_RG11_EAC, 16},
};

constexpr const char* kImageFragment = R"(
    in vec2 at;
    uniform sampler2D image;
    uniform highp sampler2DArray layers;
    uniform highp sampler3D volume;
    uniform int which;
    out vec4 result;
    void main() {
        if (which == 1) result = texture(layers, vec3(at, floor(at.y * 3.0)));
        else if (which == 2) result = texture(volume, vec3(at, at.x * at.y));
        else result = texture(image, at * 1.5 - 0.25);
        result.rgb = mix(vec3(0.2, 0, 0.2), abs(result.rgb), result.a);
    })";

/// One of 10 formats of blocks, three layers or a volume, each made of random bytes.
void make_images(std::array<GLuint, 12>& textures) {
    glGenTextures(12, textures.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (unsigned i = 0; i < 10; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        const GLsizei blocks = 8 * 6, bytes = blocks * kBlocks[i].bytes;
        const auto content = random_image(static_cast<std::size_t>(bytes));
        if (i % 2 == 0) {
            glCompressedTexImage2D(GL_TEXTURE_2D, 0, kBlocks[i].format, 31, 22, 0, bytes, content.data());
        } else {
            glTexStorage2D(GL_TEXTURE_2D, 1, kBlocks[i].format, 31, 22);
            glCompressedTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 31, 22, kBlocks[i].format, bytes, content.data());
            glCompressedTexSubImage2D(GL_TEXTURE_2D, 0, 8, 4, 4, 4, kBlocks[i].format, kBlocks[i].bytes,
                                      content.data());
        }
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    }
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[10]);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 3, GL_RGB10_A2, 16, 16, 3);
    std::vector<GLuint> texels;
    for (GLuint i = 0; i < 16 * 16 * 3; ++i) texels.push_back(3u << 30 | (i * 7919u & 0x3fffffff));
    const GLuint unpack = buffer_of(GL_PIXEL_UNPACK_BUFFER, texels);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, 16, 16, 3, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glDeleteBuffers(1, &unpack);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    glBindTexture(GL_TEXTURE_3D, textures[11]);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R11F_G11F_B10F, 8, 8, 12, 0, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, nullptr);
    for (GLuint& texel : texels) texel = (texel & 0x1fffffffu) % 0x18f1e3c7u;
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 8);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, 8, 8, 12, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, texels.data());
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_SWIZZLE_R, GL_BLUE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_SWIZZLE_A, GL_ONE);
}

SCENE(es3_textures, 2, kEs) {
    static GLuint program, sampler;
    static std::array<GLuint, 12> textures;
    if (frame == 0) {
        program = linked(kWhole, kImageFragment);
        make_images(textures);
        glGenSamplers(1, &sampler);
        glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
        glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glUseProgram(program);
        glUniform1i(glGetUniformLocation(program, "layers"), 1);
        glUniform1i(glGetUniformLocation(program, "volume"), 2);
        GLint formats = 0;
        glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
        GLint samples = 0, counts = 0;
        glGetInternalformativ(GL_RENDERBUFFER, GL_RGBA8, GL_NUM_SAMPLE_COUNTS, 1, &counts);
        glGetInternalformativ(GL_RENDERBUFFER, GL_RGBA8, GL_SAMPLES, 1, &samples);
        say("samples %d of %d", samples, counts);
    }
    whole_window(canvas);
    glClearColor(0.3f, 0.3f, 0.3f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBindSampler(0, frame == 0 ? 0 : sampler);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[10]);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_3D, textures[11]);
    glActiveTexture(GL_TEXTURE0);
    for (int i = 0; i < 12; ++i) {
        const int width = canvas.width / 4, height = canvas.height / 3;
        glViewport(i % 4 * width, i / 4 * height, width - 3, height - 3);
        glUniform1i(glGetUniformLocation(program, "which"), std::max(0, i - 9));
        if (i < 10) glBindTexture(GL_TEXTURE_2D, textures[static_cast<unsigned>(i)]);
        draw_whole();
    }
    glViewport(0, 0, canvas.width, canvas.height);
}

// ---- transform feedback ----

constexpr int kPoints = 48;

constexpr const char* kCaptureVertex = R"(
    uniform float turn;
    out vec4 place;
    void main() {
        float t = float(gl_VertexID) + turn;
        place = vec4(cos(t * 0.4), sin(t * 0.4), 0, 50.0 + t) * (0.02 * t);
        gl_Position = vec4(0, 0, 0, 1);
    })";
constexpr const char* kNothing = R"(
    out vec4 result;
    void main() { result = vec4(1); })";
constexpr const char* kPointVertex = R"(
    layout(location = 0) in vec4 place;
    void main() {
        gl_Position = vec4(place.xy, 0, 1);
        gl_PointSize = 4.0 + place.w * 0.1;
    })";
constexpr const char* kPointFragment = R"(
    out vec4 result;
    void main() { result = vec4(gl_PointCoord, 0.6, 1); })";

SCENE(es3_feedback, 3, kEs) {
    static GLuint capture, points, object, captured, query;
    if (frame == 0) {
        capture = linked(kCaptureVertex, kNothing, "place");
        points = linked(kPointVertex, kPointFragment);
        captured = buffer_of(GL_ARRAY_BUFFER, std::vector<GLfloat>(4 * kPoints));
        glGenTransformFeedbacks(1, &object);
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, object);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured);
        glGenQueries(1, &query);
    }
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, object);
    glUseProgram(capture);
    glUniform1f(glGetUniformLocation(capture, "turn"), static_cast<GLfloat>(frame));
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, kPoints / 2);
    glPauseTransformFeedback();
    glDrawArrays(GL_POINTS, 0, 5);
    glResumeTransformFeedback();
    glDrawArrays(GL_POINTS, kPoints / 2, kPoints / 2);
    glEndTransformFeedback();
    glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    glDisable(GL_RASTERIZER_DISCARD);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    GLuint written = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &written);
    say("written %u", written);
    glClearColor(0.1f, 0.2f, 0.1f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(points);
    glBindBuffer(GL_ARRAY_BUFFER, captured);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glDrawArrays(GL_POINTS, 0, kPoints);
    glDrawArrays(GL_LINE_STRIP, 0, kPoints);
    glDisableVertexAttribArray(0);
    const GLfloat corner[4] = {0.9f, 0.9f, 0, 100};
    glVertexAttrib4fv(0, corner);
    glDrawArrays(GL_POINTS, 0, 1);
}

}  // namespace
}  // namespace golden
