// SPDX-License-Identifier: MIT
// GLSL programs: uniforms of all kinds, generic vertex attributes from memory and from buffers, samplers, gl_FragCoord,
// the fixed state that shaders see, and what is asked about programs.
#include <array>
#include <cmath>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

GLuint compiled(GLenum type, const char* source) {
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint status = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &status);
    if (!status) {
        GLchar log[1024];
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        say("does not compile: %s", log);
    }
    return shader;
}

GLuint program_of(const char* vertex, const char* fragment, const char* attribute1 = nullptr) {
    const GLuint program = glCreateProgram();
    for (const GLuint shader : {compiled(GL_VERTEX_SHADER, vertex), compiled(GL_FRAGMENT_SHADER, fragment)}) {
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    if (attribute1) glBindAttribLocation(program, 1, attribute1);
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) say("does not link");
    return program;
}

constexpr const char* kFixedVertex =
    "void main() { gl_Position = ftransform(); gl_FrontColor = gl_Color; gl_TexCoord[0] = gl_MultiTexCoord0; }";

struct Vertex {
    GLfloat place[3], normal[3];
};

/// A ring of quads, as triangles.
std::vector<Vertex> torus_strip(int steps) {
    std::vector<Vertex> out;
    const auto add = [&](int i, float r) {
        const float a = static_cast<float>(i) * 6.2831853f / static_cast<float>(steps);
        out.push_back({{std::cos(a) * r, std::sin(a) * r, 0.2f * std::sin(3 * a)}, {std::cos(a), std::sin(a), 0.5f}});
    };
    for (int i = 0; i < steps; ++i) {
        add(i, 0.5f), add(i, 0.9f), add(i + 1, 0.9f);
        add(i, 0.5f), add(i + 1, 0.9f), add(i + 1, 0.5f);
    }
    return out;
}

constexpr const char* kLitVertex =
    "#version 120\nattribute vec3 place; attribute vec3 bent; uniform mat4 projection; uniform mat3 turn; uniform vec3 "
    "light[2]; varying vec3 shade;\n"
    "void main() { vec3 n = normalize(turn * bent); shade = vec3(max(dot(n, light[0]), 0.0), max(dot(n, light[1]), "
    "0.0), 0.2);\n"
    "  gl_Position = projection * vec4(turn * place, 1.0); }";
constexpr const char* kLitFragment =
    "#version 120\nvarying vec3 shade; uniform vec4 tint; void main() { gl_FragColor = vec4(shade, 1.0) * tint; }";

void set_lit_uniforms(GLuint program, int frame) {
    const float c = std::cos(0.3f * static_cast<float>(frame)), s = std::sin(0.3f * static_cast<float>(frame));
    const GLfloat turn[] = {c, 0, -s, 0, 1, 0, s, 0, c}, lights[] = {0.6f, 0, 0.8f, 0, 0.8f, -0.6f};
    const GLfloat rows[] = {0.8f, 0, 0, 0, 0, 0.9f, 0, 0.05f, 0, 0, 0.5f, 0, 0, 0, 0.3f, 1};
    glUniformMatrix3fv(glGetUniformLocation(program, "turn"), 1, GL_FALSE, turn);
    glUniformMatrix4fv(glGetUniformLocation(program, "projection"), 1, GL_TRUE, rows);
    glUniform3fv(glGetUniformLocation(program, "light"), 2, lights);
    glUniform4f(glGetUniformLocation(program, "tint"), 1, 1, 0.8f, 1);
}

}  // namespace

SCENE(glsl_client_arrays, 4) {
    clear(0.1f, 0.1f, 0.2f);
    static GLuint program;
    if (frame == 0) program = program_of(kLitVertex, kLitFragment, "bent");
    glUseProgram(program);
    set_lit_uniforms(program, frame);
    const auto vertices = torus_strip(48);
    const auto place = static_cast<GLuint>(glGetAttribLocation(program, "place"));
    glEnable(GL_DEPTH_TEST);
    glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), vertices.data()->place);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), vertices.data()->normal);
    glEnableVertexAttribArray(place);
    glEnableVertexAttribArray(1);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
    glDisableVertexAttribArray(place);
    glDisableVertexAttribArray(1);
    glUseProgram(0);
    say_error("glsl_client_arrays");
}

SCENE(glsl_buffers, 3) {
    clear(0.2f, 0.1f, 0.1f);
    static GLuint program, buffers[2];
    const auto vertices = torus_strip(30);
    if (frame == 0) {
        program = program_of(kLitVertex, kLitFragment, "bent");
        glGenBuffers(2, buffers);
        glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                     GL_STATIC_DRAW);
        std::vector<GLushort> order(vertices.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<GLushort>(order.size() - 1 - i);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(order.size() * 2), order.data(), GL_STATIC_DRAW);
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    if (frame == 2) {  // one vertex pulled out
        auto* mapped = static_cast<Vertex*>(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_WRITE));
        mapped[7].place[0] *= 1.3f;
        glUnmapBuffer(GL_ARRAY_BUFFER);
        const GLfloat twisted[3] = {-0.2f, 0.9f, 0.1f};
        glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(20 * sizeof(Vertex)), sizeof twisted, twisted);
    }
    glUseProgram(program);
    set_lit_uniforms(program, frame);
    const auto place = static_cast<GLuint>(glGetAttribLocation(program, "place"));
    glEnable(GL_DEPTH_TEST);
    glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(3 * sizeof(GLfloat)));
    glEnableVertexAttribArray(place);
    glEnableVertexAttribArray(1);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(vertices.size()), GL_UNSIGNED_SHORT, nullptr);
    glDisableVertexAttribArray(place);
    glDisableVertexAttribArray(1);
    glUseProgram(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    say_error("glsl_buffers");
}

SCENE(glsl_frag_coord, 2) {
    clear();
    static GLuint program;
    if (frame == 0)
        program =
            program_of(kFixedVertex,
                       "uniform float period; void main() { vec2 p = fract(gl_FragCoord.xy / period);\n"
                       "  if (distance(p, vec2(0.5)) > 0.45) discard; gl_FragColor = vec4(p, gl_FragCoord.z, 1.0); }");
    pixel_view(canvas);
    glUseProgram(program);
    glUniform1f(glGetUniformLocation(program, "period"), frame == 0 ? 16.0f : 7.0f);
    glRectf(5, 5, static_cast<GLfloat>(canvas.width - 9), static_cast<GLfloat>(canvas.height - 3));
    glUseProgram(0);
    glColor3f(1, 1, 0);
    glRectf(40, 40, 60, 50);
    say_error("glsl_frag_coord");
}

SCENE(glsl_fixed_state, 3) {
    clear(0, 0.1f, 0);
    static GLuint program, texture;
    if (frame == 0) {
        glGenTextures(1, &texture);
        checker_texture(texture, 16);
        program = program_of(
            "varying vec4 color; void main() { gl_Position = ftransform(); vec3 n = normalize(gl_NormalMatrix * "
            "gl_Normal);\n"
            "  vec3 l = normalize(gl_LightSource[0].position.xyz);\n"
            "  color = gl_FrontMaterial.diffuse * max(dot(n, l), 0.1) + gl_Color * 0.2; gl_TexCoord[0] = "
            "gl_TextureMatrix[0] * gl_MultiTexCoord0; }",
            "uniform sampler2D image; uniform bool inverted; varying vec4 color; void main() {\n"
            "  vec4 t = texture2D(image, gl_TexCoord[0].st); gl_FragColor = color * (inverted ? vec4(1.0) - t : t); }");
    }
    perspective_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, texture);
    const GLfloat position[] = {1, 1, 2, 0}, diffuse[] = {0.9f, 0.6f, 0.3f, 1};
    glLightfv(GL_LIGHT0, GL_POSITION, position);
    glMaterialfv(GL_FRONT, GL_DIFFUSE, diffuse);
    glMatrixMode(GL_TEXTURE);
    glActiveTexture(GL_TEXTURE0);
    glLoadIdentity();
    glScalef(static_cast<GLfloat>(frame + 1), 2, 1);
    glMatrixMode(GL_MODELVIEW);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "image"), 1);
    glUniform1i(glGetUniformLocation(program, "inverted"), frame == 1);
    glColor3f(0.5f, 0.5f, 1);
    lit_sphere();
    glUseProgram(0);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    say_error("glsl_fixed_state");
}

SCENE(glsl_values, 2) {
    clear(0.3f, 0.3f, 0.3f);
    static GLuint program;
    if (frame == 0)
        program = program_of(
            "#version 120\nattribute vec4 way; varying vec4 color; void main() { gl_Position = gl_Vertex; color = way; "
            "}",
            "#version 120\nuniform mat2x3 skew; uniform ivec2 counts = ivec2(3, 5); uniform bvec3 flags; uniform vec2 "
            "pairs[3]; varying vec4 color;\n"
            "void main() { vec3 v = skew * pairs[2] + vec3(flags) * 0.25; gl_FragColor = vec4(v + color.rgb * "
            "float(counts.x) / float(counts.y), 1.0); }",
            "way");
    glUseProgram(program);
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    const GLfloat skew[] = {0.1f, 0.2f, 0.3f, 0.3f, 0.1f, 0}, pairs[] = {0, 0, 0, 0, 0.5f, 1};
    glUniformMatrix2x3fv(at("skew"), 1, GL_FALSE, skew);
    glUniform2fv(at("pairs"), 3, pairs);
    glUniform3f(at("flags"), 1, 0, 5);
    if (frame == 1) glUniform2i(at("counts"), 4, 5);
    const GLfloat corners[4][2] = {{-0.8f, -0.7f}, {0.8f, -0.6f}, {0.7f, 0.8f}, {-0.6f, 0.7f}};
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 4; ++i) {
        glVertexAttrib3f(1, i == 0, i == 1, i == 2);
        glVertex2fv(corners[i]);
    }
    glEnd();
    // What was set and what linking told.
    GLint counts[2], flags[3], active = 0;
    glGetUniformiv(program, at("counts"), counts);
    glGetUniformiv(program, at("flags"), flags);
    glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &active);
    say("counts %d %d, flags %d %d %d, %d uniforms", counts[0], counts[1], flags[0], flags[1], flags[2], active);
    for (GLuint i = 0; i < static_cast<GLuint>(active); ++i) {
        GLchar name[64];
        GLint size;
        GLenum type;
        glGetActiveUniform(program, i, sizeof name, nullptr, &size, &type, name);
        say("uniform %s: %d of 0x%04x", name, size, type);
    }
    say("pairs[1] %d pairs[3] %d", at("pairs[1]") >= 0, at("pairs[3]"));
    GLfloat way[4];
    glGetVertexAttribfv(1, GL_CURRENT_VERTEX_ATTRIB, way);
    say("way %g %g %g %g", way[0], way[1], way[2], way[3]);
    glUniform1f(at("skew"), 1);
    say_error("a wrong type");
    glUseProgram(0);
    glUniform1f(0, 1);
    say_error("no program");
}

SCENE(glsl_in_lists, 2) {
    clear();
    static GLuint program;
    if (frame == 0) {
        program = program_of(kFixedVertex,
                             "uniform vec4 tint; uniform float more[2]; void main() { gl_FragColor = tint + "
                             "vec4(more[0], more[1], 0.0, 0.0); }");
        glNewList(1, GL_COMPILE);
        glUseProgram(program);
        glUniform4f(glGetUniformLocation(program, "tint"), 0.2f, 0.4f, 0.6f, 1);
        const GLfloat more[] = {0.5f, 0};
        glUniform1fv(glGetUniformLocation(program, "more"), 2, more);
        glRectf(-0.9f, -0.9f, -0.1f, 0.9f);
        glUseProgram(0);
        glEndList();
    }
    GLfloat tint[4] = {};
    glGetUniformfv(program, glGetUniformLocation(program, "tint"), tint);
    say("tint %.5g", static_cast<double>(tint[0]));
    glCallList(1);
    glColor3f(1, 1, 1);
    glRectf(0.1f, -0.5f, 0.9f, 0.5f);
    say_error("glsl_in_lists");
}

// A shader that looks at no matrix draws where its vertices say, whatever made the list of them; and the other way
// round.
SCENE(glsl_list_elsewhere, 2) {
    clear();
    static GLuint program;
    const auto corner = [](float x, float y) {
        glBegin(GL_QUADS);
        glVertex2f(x, y), glVertex2f(x + 0.4f, y), glVertex2f(x + 0.4f, y + 0.5f), glVertex2f(x, y + 0.5f);
        glEnd();
    };
    if (frame == 0) {
        program = program_of("void main() { gl_Position = gl_Vertex; gl_FrontColor = gl_Color; }",
                             "void main() { gl_FragColor = gl_Color; }");
        glNewList(1, GL_COMPILE);
        corner(-0.9f, 0.3f);
        corner(0.5f, -0.9f);
        glEndList();
        glUseProgram(program);
        glNewList(2, GL_COMPILE);
        corner(0.4f, 0.4f);
        glEndList();
        glUseProgram(0);
    }
    glTranslatef(frame == 0 ? 5.0f : -1.2f, 0, 0);
    glColor3f(0.2f, 0.9f, 0.4f);
    glUseProgram(program);
    glCallList(1);
    glUseProgram(0);
    glLoadIdentity();
    glTranslatef(frame == 0 ? -1.2f : 0.1f, frame == 0 ? -1.2f : 0, 0);
    glColor3f(0.9f, 0.5f, 0.1f);
    glCallList(2);
    glLoadIdentity();
    say_error("glsl_list_elsewhere");
}

// ARB_shader_objects, and images that come compressed.
SCENE(glsl_raster_positions, 2) {  // where shaders put them, lit by nobody but themselves
    clear(0.15f, 0.1f, 0.15f);
    perspective_view(canvas);
    const auto bits = random_image(8 * 16);
    static GLuint moved, placed;
    if (frame == 0) {
        moved = program_of(
            "uniform vec4 by;\nvoid main() { gl_Position = gl_ModelViewProjectionMatrix * (gl_Vertex + by);\n"
            "gl_FrontColor = vec4(gl_Normal, 1.0); gl_TexCoord[0] = gl_Color; }",
            "void main() { gl_FragColor = gl_Color; }");
        placed =
            program_of("void main() { gl_Position = vec4(gl_Vertex.xy * 0.3, 0.2, 1.0); gl_FrontColor = gl_Color; }",
                       "void main() { gl_FragColor = gl_Color; }");
    }
    for (int i = 0; i < 30; ++i) {
        glUseProgram(i % 2 ? moved : placed);
        if (i % 2) glUniform4f(glGetUniformLocation(moved, "by"), 0.1f * static_cast<float>(i % 5), -0.2f, 0, 0);
        glNormal3f(random_unit(), 0.2f, 0.9f);
        glColor3f(random_unit(), random_unit(), random_unit());
        glRasterPos3f(random_unit() * 4 - 2, random_unit() * 3 - 1.5f, random_unit() * 3 - 1.5f);
        if (i % 3) glUseProgram(0);
        glBitmap(16, 16, 8, 8, 0, 0, bits.data());
        GLboolean valid = 0;
        GLfloat window[4] = {}, colour[4] = {}, coordinates[4] = {};
        glGetBooleanv(GL_CURRENT_RASTER_POSITION_VALID, &valid);
        if (valid) {
            glGetFloatv(GL_CURRENT_RASTER_POSITION, window);
            glGetFloatv(GL_CURRENT_RASTER_COLOR, colour);
            glGetFloatv(GL_CURRENT_RASTER_TEXTURE_COORDS, coordinates);
        }
        say("raster %d %.4g %.4g %.4g %.4g colour %.4g %.4g coordinates %.4g %.4g", valid, window[0], window[1],
            window[2], window[3], colour[0], colour[2], coordinates[0], coordinates[1]);
    }
    glUseProgram(0);
    say_error("glsl_raster_positions");
}

SCENE(compressed_texture, 2) {
    clear(0.1f, 0, 0.1f);
    static GLhandleARB program;
    if (frame == 0) {
        program = glCreateProgramObjectARB();
        const GLhandleARB shader = glCreateShaderObjectARB(GL_FRAGMENT_SHADER_ARB);
        const GLcharARB* source =
            "uniform sampler2D image; void main() { gl_FragColor = texture2D(image, gl_TexCoord[0].st); }";
        glShaderSourceARB(shader, 1, &source, nullptr);
        glCompileShaderARB(shader);
        glAttachObjectARB(program, shader);
        glDeleteObjectARB(shader);
        glLinkProgramARB(program);
        GLint type = 0, attached = 0;
        glGetObjectParameterivARB(program, GL_OBJECT_TYPE_ARB, &type);
        glGetObjectParameterivARB(program, GL_OBJECT_ATTACHED_OBJECTS_ARB, &attached);
        say("type 0x%04x, %d attached", type, attached);
    }
    unsigned char blocks[4 * 4 * 16];
    restart_random();
    for (unsigned char& byte : blocks) byte = static_cast<unsigned char>(random_bits());
    const GLenum formats[] = {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_COMPRESSED_RGBA_S3TC_DXT1_EXT,
                              GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT};
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (frame == 1) glUseProgramObjectARB(program);
    else glEnable(GL_TEXTURE_2D);
    for (int i = 0; i < 4; ++i) {
        const GLsizei bytes = i < 2 ? 4 * 4 * 8 : 4 * 4 * 16;
        glCompressedTexImage2D(GL_TEXTURE_2D, 0, formats[i], 16, 16, 0, bytes, blocks);
        if (frame == 1)
            glCompressedTexSubImage2D(GL_TEXTURE_2D, 0, 4, 8, 8, 4, formats[i], i < 2 ? 16 : 32, blocks + 40);
        GLint compressed = 0, size = 0;
        glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_COMPRESSED, &compressed);
        glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_COMPRESSED_IMAGE_SIZE, &size);
        unsigned char texels[16 * 16 * 4];
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
        say("%d, %d bytes, %d %d %d %d, %d %d %d %d", compressed, size, texels[0], texels[1], texels[2], texels[3],
            texels[404], texels[405], texels[406],
            texels[407] / 4);  // llvmpipe, which Mesa asks, approximates the alphas of DXT5
        cell_view(i, 2, 2);
        unit_square();
    }
    glUseProgramObjectARB(0);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_BLEND);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, formats[0], 16, 16, 0, 3, blocks);
    say_error("a wrong size");
}

// Pixels that pass the depth test, over all tiles.
SCENE(occlusion, 2) {
    clear();
    glClear(GL_DEPTH_BUFFER_BIT);
    pixel_view(canvas);
    glEnable(GL_DEPTH_TEST);
    const auto box = [](GLfloat x, GLfloat y, GLfloat width, GLfloat height, GLfloat z) {
        glBegin(GL_QUADS);
        glVertex3f(x, y, z), glVertex3f(x + width, y, z), glVertex3f(x + width, y + height, z),
            glVertex3f(x, y + height, z);
        glEnd();
    };
    glColor3f(0.2f, 0.3f, 0.9f);
    box(50, 40, 200, 180, 0.5f);
    GLuint query;
    glGenQueries(1, &query);
    GLint bits = 0, current = 0;
    glGetQueryiv(GL_SAMPLES_PASSED, GL_QUERY_COUNTER_BITS, &bits);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glGetQueryiv(GL_SAMPLES_PASSED, GL_CURRENT_QUERY, &current);
    glColor3f(0.9f, 0.6f, 0.1f);
    box(150, 100, 200, 150, frame == 0 ? -0.5f : 0.7f);
    box(10, 10, 8, 8, 0);
    glEndQuery(GL_SAMPLES_PASSED);
    glColor3f(1, 1, 1);
    box(300, 20, 50, 50, 0);  // not counted
    GLuint samples = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples);
    say("%d bits: %s, current %s, %u samples", bits, bits >= 32 ? "enough" : "few", current ? "yes" : "no", samples);
    glBeginQuery(GL_SAMPLES_PASSED, 0);
    say_error("query 0");
    glDeleteQueries(1, &query);
    glDisable(GL_DEPTH_TEST);
    say_error("occlusion");
}

}  // namespace golden
