// SPDX-License-Identifier: MIT
// What OpenGL 3 adds to the way of vertices: captured by transform feedback and drawn from, made by geometry shaders,
// looked up in textures that are buffers. All of them reach over tiles' borders.
#include <array>
#include <cmath>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Source {
    GLenum type;
    const char* text;
};

/// Attribute 0 is `place`; `captured` goes to a buffer, if it is not null.
GLuint linked(std::initializer_list<Source> sources, const char* captured = nullptr) {
    const GLuint program = glCreateProgram();
    for (const Source& source : sources) {
        const GLuint shader = glCreateShader(source.type);
        glShaderSource(shader, 1, &source.text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glBindAttribLocation(program, 0, "place");
    if (captured) glTransformFeedbackVaryings(program, 1, &captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

using Place = std::array<GLfloat, 4>;
constexpr int kPlaces = 60;

/// On a spiral around the middle.
std::vector<Place> spiral() {
    std::vector<Place> places;
    for (int i = 0; i < kPlaces; ++i) {
        const float t = static_cast<float>(i), radius = 0.1f + 0.014f * t;
        places.push_back({radius * std::cos(0.45f * t), radius * std::sin(0.45f * t), 0, 1});
    }
    return places;
}

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

constexpr const char* kYellow = "#version 150\nout vec4 color; void main() { color = vec4(1.0, 0.9, 0.2, 1.0); }";

}  // namespace

/// Every frame turns what the frame before has captured, from one buffer to the other and back.
SCENE(captured_vertices, 5) {
    clear(0, 0.1f, 0.1f);
    static GLuint turn, show, buffers[2];
    if (frame == 0) {
        turn = linked({{GL_VERTEX_SHADER,
                        "#version 150\nin vec4 place; out vec4 turned; void main() {\n"
                        "  turned = vec4(mat2(0.9, 0.4, -0.4, 0.9) * place.xy, place.zw); gl_Position = turned; }"},
                       {GL_FRAGMENT_SHADER, kYellow}},
                      "turned");
        show = linked({{GL_VERTEX_SHADER, "#version 150\nin vec4 place; void main() { gl_Position = place; }"},
                       {GL_FRAGMENT_SHADER, kYellow}});
        for (GLuint& buffer : buffers) buffer = buffer_of(spiral());
    }
    const GLuint from = buffers[frame % 2], to = buffers[(frame + 1) % 2];
    const bool seen = frame == 3;  // what is captured may be drawn as well
    GLuint query = 0;
    glGenQueries(1, &query);
    glUseProgram(turn);
    take_places_from(from);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, to);
    if (!seen) glEnable(GL_RASTERIZER_DISCARD);
    glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
    glBeginTransformFeedback(GL_TRIANGLES);
    glDrawArrays(GL_TRIANGLES, 0, kPlaces / 2);
    glDrawArrays(GL_TRIANGLES, kPlaces / 2, kPlaces / 2);
    glEndTransformFeedback();
    glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    glDisable(GL_RASTERIZER_DISCARD);
    if (!seen) {
        glUseProgram(show);
        take_places_from(to);
        glDrawArrays(GL_TRIANGLES, 0, kPlaces);
    }
    GLuint written = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &written);
    say("%u triangles captured", written);
    glDeleteQueries(1, &query);
    if (frame == 4) {
        Place last{};
        glBindBuffer(GL_ARRAY_BUFFER, to);
        glGetBufferSubData(GL_ARRAY_BUFFER, (kPlaces - 1) * sizeof(Place), sizeof(Place), last.data());
        say("the last one is at %.5g %.5g", static_cast<double>(last[0]), static_cast<double>(last[1]));
    }
    end_arrays();
}

/// A geometry shader makes a square of each point, in the colour that a buffer has for it.
SCENE(squares_of_points, 3) {
    clear(0.1f, 0.1f, 0);
    static GLuint program, places, colors, texture;
    if (frame == 0) {
        program = linked(
            {{GL_VERTEX_SHADER, "#version 150\nin vec4 place; void main() { gl_Position = place; }"},
             {GL_GEOMETRY_SHADER,
              "#version 150\nlayout(points) in; layout(triangle_strip, max_vertices = 4) out;\n"
              "uniform samplerBuffer colors; uniform float size; flat out vec4 shade;\n"
              "void main() { for (int i = 0; i < 4; ++i) {\n"
              "  shade = texelFetch(colors, gl_PrimitiveIDIn);\n"
              "  gl_Position = gl_in[0].gl_Position + size * vec4(i % 2 * 2 - 1, i / 2 * 2 - 1, 0, 0);\n"
              "  EmitVertex(); } EndPrimitive(); }"},
             {GL_FRAGMENT_SHADER, "#version 150\nflat in vec4 shade; out vec4 color; void main() { color = shade; }"}});
        places = buffer_of(spiral());
        std::vector<Place> shades;
        for (int i = 0; i < kPlaces; ++i)
            shades.push_back(
                {static_cast<float>(i % 4) / 3, static_cast<float>(i % 7) / 6, 1 - static_cast<float>(i) / kPlaces, 1});
        colors = buffer_of(shades);
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_BUFFER, texture);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, colors);
    }
    if (frame == 2) {
        const Place white{1, 1, 1, 1};
        glBindBuffer(GL_TEXTURE_BUFFER, colors);
        glBufferSubData(GL_TEXTURE_BUFFER, 20 * sizeof(Place), sizeof(Place), white.data());
    }
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "colors"), 0);
    glUniform1f(glGetUniformLocation(program, "size"), 0.03f + 0.03f * static_cast<float>(frame));
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    take_places_from(places);
    glDrawArrays(GL_POINTS, 0, kPlaces);
    end_arrays();
}

}  // namespace golden
