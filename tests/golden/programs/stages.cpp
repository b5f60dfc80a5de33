// SPDX-License-Identifier: MIT
// What OpenGL 4 adds to the way of vertices: tessellated patches, draws of as many vertices as were captured, draws
// whose arguments lie in buffers, functions chosen by name; and draw buffers that blend each in its own way. All of
// them reach over tiles' borders.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Source {
    GLenum type;
    const char* text;
};

/// Attribute 0 is `place`; `captured` goes to buffers, if there is any.
GLuint linked(std::initializer_list<Source> sources, const std::vector<const char*>& captured = {}) {
    const GLuint program = glCreateProgram();
    for (const Source& source : sources) {
        const GLuint shader = glCreateShader(source.type);
        glShaderSource(shader, 1, &source.text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glBindAttribLocation(program, 0, "place");
    if (!captured.empty())
        glTransformFeedbackVaryings(program, static_cast<GLsizei>(captured.size()), captured.data(),
                                    GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

using Place = std::array<GLfloat, 4>;

GLuint buffer_of(const std::vector<Place>& places) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(places.size() * sizeof(Place)), places.data(),
                 GL_DYNAMIC_COPY);
    return buffer;
}

void take_places_from(GLuint buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
}

void end_arrays() {
    glDisableVertexAttribArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glUseProgram(0);
}

constexpr const char* kPlain = "#version 400\nin vec4 place; void main() { gl_Position = place; }";
constexpr const char* kYellow = "#version 400\nout vec4 color; void main() { color = vec4(1.0, 0.9, 0.2, 1.0); }";

/// A grid of `columns` x `columns` squares over most of the window, four corners each.
std::vector<Place> corners(int columns) {
    std::vector<Place> out;
    const float step = 1.8f / static_cast<float>(columns);
    for (int i = 0; i < columns * columns; ++i) {
        const float x = -0.9f + step * static_cast<float>(i % columns),
                    y = -0.9f + step * static_cast<float>(i / columns);
        for (const auto& [dx, dy] : {std::array{0.f, 0.f}, {0.9f, 0.f}, {0.9f, 0.9f}, {0.f, 0.9f}})
            out.push_back({x + dx * step, y + dy * step, 0, 1});
    }
    return out;
}

}  // namespace

/// Waves: each patch of four corners becomes a bent mesh, as fine as a control shader says; then without one, by the
/// default levels; then lines and points.
SCENE(tessellated_patches, 4) {
    clear(0, 0, 0.2f);
    constexpr const char* kControl =
        "#version 400\nlayout(vertices = 4) out; uniform float level;\n"
        "void main() { gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
        "  for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = level + float(i);\n"
        "  gl_TessLevelInner[0] = level; gl_TessLevelInner[1] = level + 1.0; }";
    const auto evaluation = [](const char* layout) {
        return std::string("#version 400\nlayout(") + layout +
               ") in; flat out vec3 tone; void main() { vec2 at = gl_TessCoord.xy; tone = vec3(at, 0.5);\n"
               "  vec4 p = mix(mix(gl_in[0].gl_Position, gl_in[1].gl_Position, at.x),\n"
               "               mix(gl_in[3].gl_Position, gl_in[2].gl_Position, at.x), at.y);\n"
               "  gl_Position = p + vec4(0.05 * sin(6.0 * p.y), 0.05 * sin(7.0 * p.x), 0, 0); }";
    };
    constexpr const char* kTone =
        "#version 400\nflat in vec3 tone; out vec4 color; void main() { color = vec4(tone, 1); }";
    static GLuint programs[4], places;
    if (frame == 0) {
        constexpr const char* kLayouts[] = {"quads, equal_spacing", "quads, fractional_odd_spacing, cw",
                                            "isolines, equal_spacing", "quads, equal_spacing, point_mode"};
        for (int i = 0; i < 4; ++i) {
            const std::string text = evaluation(kLayouts[i]);
            if (i == 1)
                programs[i] = linked({{GL_VERTEX_SHADER, kPlain},
                                      {GL_TESS_EVALUATION_SHADER, text.c_str()},
                                      {GL_FRAGMENT_SHADER, kTone}});
            else
                programs[i] = linked({{GL_VERTEX_SHADER, kPlain},
                                      {GL_TESS_CONTROL_SHADER, kControl},
                                      {GL_TESS_EVALUATION_SHADER, text.c_str()},
                                      {GL_FRAGMENT_SHADER, kTone}});
        }
        places = buffer_of(corners(4));
        GLint mode = 0;
        glGetProgramiv(programs[2], GL_TESS_GEN_MODE, &mode);
        say("isolines %d", mode == GL_ISOLINES);
    }
    glUseProgram(programs[frame]);
    if (frame != 1) glUniform1f(glGetUniformLocation(programs[frame], "level"), 5);
    const GLfloat outer[] = {3, 4.5f, 6, 2.5f}, inner[] = {4, 3.5f};
    glPatchParameterfv(GL_PATCH_DEFAULT_OUTER_LEVEL, outer);
    glPatchParameterfv(GL_PATCH_DEFAULT_INNER_LEVEL, inner);
    glPatchParameteri(GL_PATCH_VERTICES, 4);
    take_places_from(places);
    glDrawArrays(GL_PATCHES, 0, 64);
    say_error("patches");
    glDrawArrays(GL_TRIANGLES, 0, 3);
    say_error("triangles");
    end_arrays();
}

/// Two objects in turns: one is paused while the other captures; what they have is drawn without a count.
SCENE(captured_by_objects, 3) {
    clear(0.1f, 0, 0.1f);
    static GLuint turn, show, places, buffers[2], objects[2];
    if (frame == 0) {
        turn = linked({{GL_VERTEX_SHADER,
                        "#version 400\nin vec4 place; uniform float angle; out vec4 turned; void main() {\n"
                        "  float c = cos(angle), s = sin(angle);\n"
                        "  turned = vec4(mat2(c, s, -s, c) * place.xy, place.zw); gl_Position = turned; }"},
                       {GL_FRAGMENT_SHADER, kYellow}},
                      {"turned"});
        show = linked({{GL_VERTEX_SHADER, kPlain}, {GL_FRAGMENT_SHADER, kYellow}});
        places = buffer_of(corners(6));
        glGenTransformFeedbacks(2, objects);
        for (int i = 0; i < 2; ++i) {
            buffers[i] = buffer_of(std::vector<Place>(200));
            glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, objects[i]);
            glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffers[i]);
        }
    }
    glUseProgram(turn);
    const GLint angle = glGetUniformLocation(turn, "angle");
    take_places_from(places);
    glEnable(GL_RASTERIZER_DISCARD);
    for (int part = 0; part < 2; ++part)
        for (int i = 0; i < 2; ++i) {
            glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, objects[i]);
            if (part == 0) glBeginTransformFeedback(GL_TRIANGLES);
            else glResumeTransformFeedback();
            glUniform1f(angle, 0.2f * static_cast<float>(i + frame) + 0.1f * static_cast<float>(part));
            glDrawArrays(GL_TRIANGLES, 12 * part, 12 + 6 * i);
            if (part == 0) glPauseTransformFeedback();
            else glEndTransformFeedback();
        }
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    glDisable(GL_RASTERIZER_DISCARD);
    glUseProgram(show);
    for (int i = 0; i < 2; ++i) {
        take_places_from(buffers[i]);
        glDrawTransformFeedback(i == 0 ? GL_TRIANGLES : GL_LINE_STRIP, objects[i]);
    }
    say_error("objects");
    end_arrays();
}

/// Two streams of a geometry shader go to two buffers, with room left between; how many they were is counted of each.
SCENE(streams_of_vertices, 2) {
    clear(0, 0.1f, 0);
    static GLuint split, show, places, buffers[2], queries[2], object;
    if (frame == 0) {
        split = linked({{GL_VERTEX_SHADER, kPlain},
                        {GL_GEOMETRY_SHADER,
                         "#version 400\nlayout(points) in; layout(points, max_vertices = 3) out;\n"
                         "layout(stream = 0) out vec4 left; layout(stream = 1) out vec4 right;\n"
                         "void main() { vec4 p = gl_in[0].gl_Position;\n"
                         "  if (p.x < 0.2) { left = p; EmitStreamVertex(0); EndStreamPrimitive(0); }\n"
                         "  else for (int i = 0; i < 2; ++i) {\n"
                         "    right = p + vec4(0.03 * i, 0.05, 0, 0); EmitStreamVertex(1); EndStreamPrimitive(1); } }"},
                        {GL_FRAGMENT_SHADER, kYellow}},
                       {"left", "gl_SkipComponents4", "gl_NextBuffer", "right"});
        show = linked({{GL_VERTEX_SHADER, kPlain}, {GL_FRAGMENT_SHADER, kYellow}});
        places = buffer_of(corners(5));
        for (GLuint& buffer : buffers) buffer = buffer_of(std::vector<Place>(400));
        glGenQueries(2, queries);
        glGenTransformFeedbacks(1, &object);
    }
    glUseProgram(split);
    take_places_from(places);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, object);
    for (GLuint i = 0; i < 2; ++i) glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, i, buffers[i]);
    glEnable(GL_RASTERIZER_DISCARD);
    for (GLuint i = 0; i < 2; ++i) glBeginQueryIndexed(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, i, queries[i]);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, frame == 0 ? 100 : 50);
    glEndTransformFeedback();
    for (GLuint i = 0; i < 2; ++i) glEndQueryIndexed(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, i);
    glDisable(GL_RASTERIZER_DISCARD);
    for (GLuint i = 0; i < 2; ++i) {
        GLuint written = 0;
        glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &written);
        say("stream %u: %u", i, written);
    }
    glUseProgram(show);
    glPointSize(5);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 2 * sizeof(Place), nullptr);
    glDrawTransformFeedbackStream(GL_POINTS, object, 0);
    take_places_from(buffers[1]);
    glDrawTransformFeedbackStream(GL_POINTS, object, 1);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    say_error("streams");
    glPointSize(1);
    end_arrays();
}

/// Arguments of draws lie in a buffer, behind each other; instances begin behind others.
SCENE(indirect_draws, 3) {
    clear(0.2f, 0.1f, 0);
    static GLuint program, places, offsets, indices, commands;
    if (frame == 0) {
        program = linked({{GL_VERTEX_SHADER,
                           "#version 400\nin vec4 place; in vec2 offset; void main() {\n"
                           "  gl_Position = place * vec4(0.3, 0.3, 1, 1) + vec4(offset, 0, 0); }"},
                          {GL_FRAGMENT_SHADER, kYellow}});
        places = buffer_of(corners(3));
        std::vector<Place> moves;
        for (int i = 0; i < 9; ++i)
            moves.push_back({0.6f * static_cast<float>(i % 3 - 1), 0.6f * static_cast<float>(i / 3 - 1), 0, 0});
        offsets = buffer_of(moves);
        std::vector<GLushort> order;
        for (GLushort i = 0; i < 9; ++i)
            for (const int corner : {0, 1, 2, 0, 2, 3}) order.push_back(static_cast<GLushort>(4 * i + corner));
        glGenBuffers(1, &indices);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(order.size() * sizeof(GLushort)), order.data(),
                     GL_STATIC_DRAW);
        glGenBuffers(1, &commands);
    }
    const GLuint words[] = {12, 2, 4, 0, 24, 4, 6, 0, 0, 7};  // of a draw of arrays, then of one of indices
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands);
    glBufferData(GL_DRAW_INDIRECT_BUFFER, sizeof words, words, GL_STREAM_DRAW);
    glUseProgram(program);
    take_places_from(places);
    const auto place = static_cast<GLuint>(glGetAttribLocation(program, "offset"));
    glBindBuffer(GL_ARRAY_BUFFER, offsets);
    glVertexAttribPointer(place, 2, GL_FLOAT, GL_FALSE, sizeof(Place), nullptr);
    glVertexAttribDivisor(place, 1);
    glEnableVertexAttribArray(place);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
    if (frame == 0) glDrawArraysIndirect(GL_TRIANGLES, nullptr);
    if (frame == 1)
        glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(std::uintptr_t{16}));
    if (frame == 2) glDrawArraysInstancedBaseInstance(GL_LINE_LOOP, 0, 4, 3, 6);
    say_error("indirect");
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(std::uintptr_t{24}));
    say_error("beyond the buffer");
    glVertexAttribDivisor(place, 0);
    glDisableVertexAttribArray(place);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    end_arrays();
}

/// Which function a variable names, and doubles that floats could not tell apart.
SCENE(chosen_functions, 3) {
    clear();
    static GLuint program, places;
    if (frame == 0) {
        program = linked({{GL_VERTEX_SHADER, kPlain},
                          {GL_FRAGMENT_SHADER,
                           "#version 400\nuniform dvec2 near; out vec4 color; subroutine vec3 Tone(vec2 at);\n"
                           "subroutine(Tone) vec3 across(vec2 at) { return vec3(fract(at.x / 40.0), 0.3, 0.1); }\n"
                           "subroutine(Tone) vec3 along(vec2 at) { return vec3(0.1, fract(at.y / 40.0), 0.5); }\n"
                           "subroutine uniform Tone tone;\n"
                           "void main() { float more = near.x < near.y ? 1.0 : 0.0;\n"
                           "  color = vec4(tone(gl_FragCoord.xy), 1) * vec4(1, more, 1, 1); }"}});
        places = buffer_of(corners(3));
    }
    glUseProgram(program);
    const GLuint function = glGetSubroutineIndex(program, GL_FRAGMENT_SHADER, frame == 1 ? "along" : "across");
    if (frame < 2) glUniformSubroutinesuiv(GL_FRAGMENT_SHADER, 1, &function);
    glUniform2d(glGetUniformLocation(program, "near"), 1, 1 + 1e-12 * (frame == 2 ? -1 : 1));
    take_places_from(places);
    glDrawArrays(GL_QUADS, 0, 36);
    say_error("functions");
    end_arrays();
}

/// Two colours at once, each blended in its own way with what is there.
SCENE(blended_buffers, 2) {
    clear(0.3f, 0.3f, 0.3f);
    static GLuint program, places, framebuffer, images[2];
    if (frame == 0) {
        program = linked({{GL_VERTEX_SHADER, kPlain},
                          {GL_FRAGMENT_SHADER,
                           "#version 400\nlayout(location = 0) out vec4 a; layout(location = 1) out vec4 b;\n"
                           "void main() { a = vec4(0.5, 0.25, 0, 0.5); b = vec4(0, 0.5, 0.5, 0.5); }"}});
        places = buffer_of(corners(2));
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glGenTextures(2, images);
        for (GLuint i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, images[i]);
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 200, 300, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D, images[i], 0);
        }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glBlendFunci(1, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (frame == 1) glBlendEquationi(0, GL_FUNC_REVERSE_SUBTRACT);
    glViewport(0, 0, 200, 300);
    glUseProgram(program);
    take_places_from(places);
    glDrawArrays(GL_QUADS, 0, 16);
    end_arrays();
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ZERO);
    glDisable(GL_BLEND);
    glViewport(0, 0, canvas.width, canvas.height);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    for (GLuint i = 0; i < 2; ++i) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        const auto x = static_cast<GLint>(200 * i);
        glBlitFramebuffer(0, 0, 200, 300, x, 0, x + 200, 300, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    say_error("blended");
}

}  // namespace golden
