// SPDX-License-Identifier: MIT
// What shaders write at places that they address: images, blocks of storage, atomic counters; by compute shaders, by
// fragments of framebuffer objects and by those of the window. All of them reach over tiles' borders.
#include <array>
#include <initializer_list>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Source {
    GLenum type;
    const char* text;
};

/// Attribute 0 is `place`.
GLuint linked(std::initializer_list<Source> sources) {
    const GLuint program = glCreateProgram();
    for (const Source& source : sources) {
        const GLuint shader = glCreateShader(source.type);
        glShaderSource(shader, 1, &source.text, nullptr);
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

constexpr int kTexels = 256;

GLuint texture_of(GLenum format, int width = kTexels, int height = kTexels) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

GLuint buffer_of(GLenum target, const std::vector<GLuint>& words) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(words.size() * sizeof(GLuint)), words.data(), GL_DYNAMIC_COPY);
    return buffer;
}

void say_words(const char* what, GLenum target, std::size_t count) {
    std::vector<GLuint> words(count);
    glGetBufferSubData(target, 0, static_cast<GLsizeiptr>(count * sizeof(GLuint)), words.data());
    for (std::size_t i = 0; i < count; ++i) say("%s %zu: %u", what, i, words[i]);
}

/// The texture over all of the window; moved a little, so that no pixel's centre lies between two texels.
void show(GLuint texture) {
    glUseProgram(0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glEnable(GL_TEXTURE_2D);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    glTranslatef(0.0003f, 0.0003f, 0);
    unit_square();
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glDisable(GL_TEXTURE_2D);
}

void square(float x0, float y0, float x1, float y1) {
    glBegin(GL_QUADS);
    glVertex2f(x0, y0), glVertex2f(x1, y0), glVertex2f(x1, y1), glVertex2f(x0, y1);
    glEnd();
}

constexpr const char* kPlain = "#version 130\nin vec4 place; void main() { gl_Position = place; }";

}  // namespace

/// A compute shader fills a texture, which the window then shows; in the second frame only a part of it anew.
SCENE(computed_texture, 3) {
    clear(0.1f, 0.1f, 0.2f);
    static GLuint program, texture;
    if (frame == 0) {
        program = linked({{GL_COMPUTE_SHADER,
                           "#version 430\nlayout(local_size_x = 8, local_size_y = 4) in;\n"
                           "layout(rgba8, binding = 3) writeonly uniform image2D picture; uniform float turn;\n"
                           "void main() { ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                           "  float ring = fract(length(vec2(at) - 128.0) / 32.0 + turn);\n"
                           "  imageStore(picture, at, vec4(ring, vec2(at) / 256.0, 1.0)); }"}});
        texture = texture_of(GL_RGBA8);
        GLint size[3] = {};
        glGetProgramiv(program, GL_COMPUTE_WORK_GROUP_SIZE, size);
        say("groups of %d x %d x %d", size[0], size[1], size[2]);
    }
    glUseProgram(program);
    glUniform1f(glGetUniformLocation(program, "turn"), 0.3f * static_cast<float>(frame));
    glBindImageTexture(3, texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    if (frame < 2) glDispatchCompute(frame == 0 ? 32 : 11, frame == 0 ? 64 : 23, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    show(texture);
    std::array<GLubyte, 4> texel{};
    std::vector<GLubyte> all(4 * kTexels * kTexels);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, all.data());
    for (std::size_t i = 0; i < 4; ++i) texel[i] = all[4 * (20 * kTexels + 30) + i];
    say("texel %d %d %d %d", texel[0], texel[1], texel[2], texel[3]);
    say_error("computed");
}

/// Blocks of storage are written and read by turns; what they hold is drawn as vertices, and is the arguments of a draw
/// and of a dispatch.
SCENE(computed_vertices, 3) {
    clear(0.0f, 0.1f, 0.1f);
    static GLuint program, drawing, places, arguments;
    constexpr GLuint kPlaces = 96;
    if (frame == 0) {
        program =
            linked({{GL_COMPUTE_SHADER,
                     "#version 430\nlayout(local_size_x = 32) in;\n"
                     "layout(std430, binding = 5) buffer Places { vec4 place[]; };\n"
                     "layout(std430, binding = 1) buffer Arguments { uint draw[4]; uint groups[3]; };\n"
                     "void main() { uint i = gl_GlobalInvocationID.x; float t = float(i);\n"
                     "  vec2 at = (0.1 + 0.009 * t) * vec2(cos(0.4 * t), sin(0.4 * t));\n"
                     "  place[i] = vec4(at + place[i].zw * 0.5, 0.05, 1.0) ;\n"
                     "  if (i == 0u) { draw[0] = 96u; draw[1] = 1u; groups[0] = 3u; groups[1] = groups[2] = 1u; }\n"
                     "}"}});
        drawing = linked(
            {{GL_VERTEX_SHADER, "#version 130\nin vec4 place; void main() { gl_Position = vec4(place.xy, 0.0, 1.0); }"},
             {GL_FRAGMENT_SHADER, "#version 130\nout vec4 color; void main() { color = vec4(1.0, 0.9, 0.2, 1.0); }"}});
        places = buffer_of(GL_SHADER_STORAGE_BUFFER, std::vector<GLuint>(4 * kPlaces));
        arguments = buffer_of(GL_SHADER_STORAGE_BUFFER, {0, 0, 0, 0, 3, 1, 1, 0});
        glShaderStorageBlockBinding(program, 2, 1);  // there are two
        say_error("binding");
    }
    glUseProgram(program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, places);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, arguments);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments);
    glDispatchComputeIndirect(16);
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    glUseProgram(drawing);
    glBindBuffer(GL_ARRAY_BUFFER, places);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, arguments);
    glDrawArraysIndirect(GL_TRIANGLE_STRIP, nullptr);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    glDisableVertexAttribArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glUseProgram(0);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, arguments);
    say_words("argument", GL_SHADER_STORAGE_BUFFER, 7);
    say_error("vertices");
}

/// Fragments of a framebuffer object count themselves, by atomic counters and in an image of numbers.
SCENE(counted_fragments, 2) {
    clear(0.2f, 0.1f, 0.1f);
    static GLuint program, showing, counters, counts, color, framebuffer;
    if (frame == 0) {
        program = linked({{GL_VERTEX_SHADER, kPlain},
                          {GL_FRAGMENT_SHADER,
                           "#version 420\nlayout(binding = 2) uniform atomic_uint left;\n"
                           "layout(binding = 2, offset = 4) uniform atomic_uint right;\n"
                           "layout(r32ui, binding = 1) uniform coherent uimage2D counts; out vec4 color;\n"
                           "void main() { ivec2 at = ivec2(gl_FragCoord.xy);\n"
                           "  if (at.x < 100) atomicCounterIncrement(left); else atomicCounterIncrement(right);\n"
                           "  imageAtomicAdd(counts, at / 16, 1u); color = vec4(0.3, 0.5, 0.7, 1.0); }"}});
        showing = linked({{GL_VERTEX_SHADER, kPlain},
                          {GL_FRAGMENT_SHADER,
                           "#version 420\nuniform usampler2D counts; out vec4 color; void main() {\n"
                           "  uint n = texelFetch(counts, ivec2(gl_FragCoord.xy) / 25, 0).r;\n"
                           "  color = vec4(float(n % 256u) / 255.0, float(n / 256u) / 3.0, 0.2, 1.0); }"}});
        counts = texture_of(GL_R32UI, 16, 16);
        color = texture_of(GL_RGBA8);
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
        counters = buffer_of(GL_ATOMIC_COUNTER_BUFFER, {5, 6, 7});
        GLint buffers = 0, binding = 0;
        glGetProgramiv(program, GL_ACTIVE_ATOMIC_COUNTER_BUFFERS, &buffers);
        glGetActiveAtomicCounterBufferiv(program, 0, GL_ATOMIC_COUNTER_BUFFER_BINDING, &binding);
        say("%d buffers of counters, at %d", buffers, binding);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kTexels, kTexels);
    glUseProgram(program);
    glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 2, counters);
    glBindImageTexture(1, counts, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    for (int i = 0; i < 6; ++i) square(-0.9f + 0.2f * static_cast<float>(i), -0.8f, 0.4f, 0.1f * static_cast<float>(i));
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
    glUseProgram(showing);
    glBindTexture(GL_TEXTURE_2D, counts);
    square(-1, -1, 1, 1);
    glUseProgram(0);
    glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, counters);
    say_words("counter", GL_ATOMIC_COUNTER_BUFFER, 3);
    say_error("counted");
}

/// The same with fragments of the window, which depth hides in part; something was drawn before in the same frame.
SCENE(window_fragments, 3, {.whole = true}) {
    clear(0.1f, 0.2f, 0.1f);
    static GLuint program, counters, seen;
    if (frame == 0) {
        program = linked({{GL_VERTEX_SHADER, kPlain},
                          {GL_FRAGMENT_SHADER,
                           "#version 420\nlayout(early_fragment_tests) in;\n"
                           "layout(binding = 0) uniform atomic_uint all;\n"
                           "layout(rgba8, binding = 0) writeonly uniform image2D seen; out vec4 color;\n"
                           "void main() { atomicCounterIncrement(all);\n"
                           "  imageStore(seen, ivec2(gl_FragCoord.xy),\n"
                           "             vec4(fract(gl_FragCoord.xy / 40.0), 0.5, 1.0));\n"
                           "  color = vec4(fract(gl_FragCoord.xy / 100.0), 0.3, 1.0); }"}});
        counters = buffer_of(GL_ATOMIC_COUNTER_BUFFER, {0});
        seen = texture_of(GL_RGBA8, 400, 300);
        glBindImageTexture(0, seen, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
        glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, counters);
    }
    glColor3f(0.9f, 0.4f, 0.1f);
    square(-0.7f, -0.9f, -0.2f, 0.9f);
    glUseProgram(program);
    square(-0.5f, -0.6f + 0.1f * static_cast<float>(frame), 0.8f, 0.5f);
    glUseProgram(0);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, counters);
    say_words("fragments", GL_ATOMIC_COUNTER_BUFFER, 1);
    if (frame == 2) {
        glColor3f(1, 1, 1);
        glBindTexture(GL_TEXTURE_2D, seen);
        glEnable(GL_TEXTURE_2D);
        glBegin(GL_QUADS);
        glTexCoord2f(0, 0), glVertex2f(0, 0);
        glTexCoord2f(1, 0), glVertex2f(1, 0);
        glTexCoord2f(1, 1), glVertex2f(1, 1);
        glTexCoord2f(0, 1), glVertex2f(0, 1);
        glEnd();
        glDisable(GL_TEXTURE_2D);
    }
    say_error("window");
}

}  // namespace golden
