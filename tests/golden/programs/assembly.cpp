// SPDX-License-Identifier: MIT
// Assembly programs (GL_ARB_vertex_program, GL_ARB_fragment_program): how they place vertices, their parameters, the
// state and the textures that they read, fragment.position, and what is asked about them.
#include <array>
#include <cmath>
#include <string>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr GLenum kVertex = GL_VERTEX_PROGRAM_ARB, kFragment = GL_FRAGMENT_PROGRAM_ARB;

void load(GLenum target, const std::string& text) {
    glProgramStringARB(target, GL_PROGRAM_FORMAT_ASCII_ARB, static_cast<GLsizei>(text.size()), text.data());
    GLint position = 0;
    glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
    if (position != -1) say("error at %d", position);
}

/// A program that is bound from now on.
GLuint loaded(GLenum target, const std::string& text) {
    GLuint program = 0;
    glGenProgramsARB(1, &program);
    glBindProgramARB(target, program);
    load(target, text);
    return program;
}

std::string vertex_program(const std::string& placing) {
    return "!!ARBvp1.0\n" + placing +
           "MOV result.color, vertex.color;\nMOV result.texcoord[0], vertex.texcoord[0];\nEND\n";
}

const std::array<std::string, 8> kPlacings = {
    "OPTION ARB_position_invariant;\n",
    // rows of the matrix
    "PARAM mvp[4] = { state.matrix.mvp };\nATTRIB place = vertex.position;\nOUTPUT out = result.position;\n"
    "DP4 out.x, mvp[0], place; DP4 out.y, mvp[1], place; DP4 out.z, mvp[2], place; DP4 out.w, mvp[3], place;\n",
    // its columns
    "PARAM m[4] = { state.matrix.mvp.transpose };\nTEMP r;\nMUL r, m[0], vertex.position.x;\n"
    "MAD r, m[1], vertex.position.y, r;\nMAD r, m[2], vertex.position.z, r;\n"
    "MAD result.position, m[3], vertex.position.w, r;\n",
    // in two steps
    "TEMP eye;\nDP4 eye.x, state.matrix.modelview.row[0], vertex.position;\n"
    "DP4 eye.y, state.matrix.modelview.row[1], vertex.position;\n"
    "DP4 eye.z, state.matrix.modelview.row[2], vertex.position;\n"
    "DP4 eye.w, state.matrix.modelview.row[3], vertex.position;\n"
    "DP4 result.position.x, state.matrix.projection.row[0], eye;\n"
    "DP4 result.position.y, state.matrix.projection.row[1], eye;\n"
    "DP4 result.position.z, state.matrix.projection.row[2], eye;\n"
    "DP4 result.position.w, state.matrix.projection.row[3], eye;\n",
    // local parameters
    "PARAM m[4] = { program.local[2..5] };\nDP4 result.position.x, m[0], vertex.position;\n"
    "DP4 result.position.y, m[1], vertex.position;\nDP4 result.position.z, m[2], vertex.position;\n"
    "DP4 result.position.w, m[3], vertex.position;\n",
    // of the environment, with what the matrix lacks
    "TEMP r;\nDP3 r.x, program.env[8], vertex.position;\nDP3 r.y, program.env[9], vertex.position;\n"
    "MOV r.z, 0.25;\nMOV r.w, 1.0;\nADD result.position, r, program.env[10];\n",
    // not as a function of the vertex alone
    "TEMP r;\nMUL r, vertex.position, vertex.color.x;\nDP4 result.position.x, state.matrix.mvp.row[0], r;\n"
    "DP4 result.position.y, state.matrix.mvp.row[1], r;\nDP4 result.position.z, state.matrix.mvp.row[2], r;\n"
    "DP4 result.position.w, state.matrix.mvp.row[3], vertex.position;\n",
    // another attribute
    "DP4 result.position.x, state.matrix.mvp.row[0], vertex.attrib[6];\n"
    "DP4 result.position.y, state.matrix.mvp.row[1], vertex.attrib[6];\n"
    "DP4 result.position.z, state.matrix.mvp.row[2], vertex.attrib[6];\n"
    "DP4 result.position.w, state.matrix.mvp.row[3], vertex.attrib[6];\n",
};

void fan(float size, int corners = 9) {
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i <= corners; ++i) {
        const float angle = static_cast<float>(i) * 6.2831853f / static_cast<float>(corners);
        const float x = std::cos(angle) * size, y = std::sin(angle) * size;
        glColor3f(0.5f + 0.5f * std::cos(angle), 0.9f, 0.5f + 0.5f * std::sin(2 * angle));
        glTexCoord2f(0.5f + x, 0.5f + y);
        glVertexAttrib3fARB(6, x, y, 0);
        glVertex3f(x, y, 0);
    }
    glEnd();
}

/// The rows of a matrix as four parameters.
template <class Set>
void set_rows(int frame, int cell, Set&& set) {
    const float angle = 0.4f * static_cast<float>(frame + cell), c = 0.2f * std::cos(angle), s = 0.2f * std::sin(angle);
    const float x = static_cast<float>(cell % 4) * 0.5f - 0.75f, y = static_cast<float>(cell / 4) * 0.6f - 0.3f;
    set(0, c, -s, 0.0f, x);
    set(1, s, c, 0.0f, y);
    set(2, 0.0f, 0.0f, 1.0f, 0.0f);
    set(3, 0.0f, 0.0f, 0.0f, 1.0f);
}

}  // namespace

SCENE(assembly_positions, 3) {
    clear(0.1f, 0.1f, 0.2f);
    static std::array<GLuint, kPlacings.size()> programs;
    if (frame == 0)
        for (std::size_t i = 0; i < programs.size(); ++i) programs[i] = loaded(kVertex, vertex_program(kPlacings[i]));
    glEnable(kVertex);
    for (std::size_t i = 0; i < programs.size(); ++i) {
        const int cell = static_cast<int>(i);
        cell_view(cell, 4, 2);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        glRotatef(static_cast<float>(10 * frame + cell), 0, 0, 1);
        glBindProgramARB(kVertex, programs[i]);
        const auto local = [&](GLuint row, float x, float y, float z, float w) {
            glProgramLocalParameter4fARB(kVertex, 2 + row, x, y, z, w);
        };
        set_rows(frame, cell, local);
        glProgramEnvParameter4fARB(kVertex, 8, 0.2f, 0.05f * static_cast<float>(frame), 0, 0);
        glProgramEnvParameter4fARB(kVertex, 9, 0, 0.2f, 0, 0);
        glProgramEnvParameter4dARB(kVertex, 10, -0.25, 0.3, 0, 0);
        fan(0.8f);
    }
    // Each of several draws with parameters of its own.
    glBindProgramARB(kVertex, programs[4]);
    for (int i = 0; i < 5; ++i) {
        const float at = 0.35f * static_cast<float>(i) - 0.7f;
        const std::array<GLfloat, 16> rows = {0.08f, 0, 0, at, 0, 0.08f, 0, 0.02f * static_cast<float>(frame),
                                              0,     0, 1, 0,  0, 0,     0, 1};
        glProgramLocalParameters4fvEXT(kVertex, 2, 4, rows.data());
        fan(1, 3 + i);
    }
    glDisable(kVertex);
    say_error("assembly_positions");
}

SCENE(assembly_arrays, 3) {
    clear(0.2f, 0.1f, 0.1f);
    constexpr int kSteps = 400;
    static GLuint buffer;
    static std::array<GLuint, 3> programs;
    if (frame == 0) {
        std::vector<GLfloat> places;
        for (int i = 0; i < kSteps; ++i)
            for (const float r : {0.5f, 0.9f}) {
                const float a = static_cast<float>(i) * 6.2831853f / (kSteps - 1);
                places.insert(places.end(), {std::cos(a) * r, std::sin(a) * r, 0.2f * std::sin(5 * a)});
            }
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(places.size() * sizeof(GLfloat)), places.data(),
                     GL_STATIC_DRAW);
        programs = {loaded(kVertex, vertex_program(kPlacings[0])), loaded(kVertex, vertex_program(kPlacings[1])),
                    loaded(kVertex, vertex_program(kPlacings[7]))};
    }
    glEnable(kVertex);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    for (int i = 0; i < 3; ++i) {
        cell_view(i, 2, 2);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        glRotatef(static_cast<float>(20 * frame + 30 * i), 1, 1, 0);
        glBindProgramARB(kVertex, programs[static_cast<std::size_t>(i)]);
        glColor3f(0.9f, 0.3f * static_cast<float>(i), 0.4f);
        if (i < 2) glVertexPointer(3, GL_FLOAT, 0, nullptr), glEnableClientState(GL_VERTEX_ARRAY);
        else glVertexAttribPointerARB(6, 3, GL_FLOAT, GL_FALSE, 0, nullptr), glEnableVertexAttribArrayARB(6);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 2 * kSteps);
        glDisableClientState(GL_VERTEX_ARRAY);
        glDisableVertexAttribArrayARB(6);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glDisable(kVertex);
    say_error("assembly_arrays");
}

SCENE(assembly_textures, 2) {
    clear(0.1f, 0.2f, 0.1f);
    static GLuint textures[4];
    static std::array<GLuint, 6> programs;
    if (frame == 0) {
        glGenTextures(4, textures);
        glActiveTexture(GL_TEXTURE1);
        checker_texture(textures[0], 32);
        glActiveTexture(GL_TEXTURE3);
        glBindTexture(GL_TEXTURE_CUBE_MAP, textures[1]);
        for (GLenum face = 0; face < 6; ++face)
            glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGB8, 8, 8, 0, GL_RGB, GL_UNSIGNED_BYTE,
                         random_image(8 * 8 * 3 + face).data());
        glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glActiveTexture(GL_TEXTURE4);
        glBindTexture(GL_TEXTURE_3D, textures[2]);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_RGB8, 4, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE,
                     random_image(4 * 4 * 4 * 3).data());
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_RECTANGLE, textures[3]);
        glTexImage2D(GL_TEXTURE_RECTANGLE, 0, GL_RGB8, 20, 10, 0, GL_RGB, GL_UNSIGNED_BYTE,
                     random_image(20 * 10 * 3).data());
        glTexParameteri(GL_TEXTURE_RECTANGLE, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        const std::string head = "!!ARBfp1.0\nTEMP r;\n", end = "MOV result.color, r;\nEND\n";
        programs = {
            loaded(kFragment, head + "TEX r, fragment.texcoord[0], texture[1], 2D;\nMUL r, r, fragment.color;\n" + end),
            loaded(kFragment, head +
                                  "MAD r, fragment.texcoord[0], {2, 2, 0, 0}, {-1, -1, 0.7, 0};\n"
                                  "TEX r, r, texture[3], CUBE;\n" +
                                  end),
            loaded(kFragment, head +
                                  "MOV r, fragment.texcoord[0];\nMOV r.z, program.local[0].x;\n"
                                  "TEX r, r, texture[4], 3D;\n" +
                                  end),
            loaded(kFragment, head + "MUL r, fragment.texcoord[0], {20, 10, 1, 1};\nTEX r, r, texture, RECT;\n" + end),
            loaded(kFragment, head +
                                  "TXP r, fragment.texcoord[0], texture[1], 2D;\nSUB r, r, program.env[3];\n"
                                  "KIL r;\nADD r, r, program.env[3];\n" +
                                  end),
            loaded(kFragment, head +
                                  "TXB r, fragment.texcoord[0], texture[1], 2D; # a comment: texture[2], 2D;\n"
                                  "LRP_SAT r, 0.5, r, fragment.color.primary;\n" +
                                  end),
        };
    }
    glEnable(kFragment);
    for (std::size_t i = 0; i < programs.size(); ++i) {
        cell_view(static_cast<int>(i), 3, 2);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        glBindProgramARB(kFragment, programs[i]);
        glProgramLocalParameter4dARB(kFragment, 0, 0.3 + 0.2 * frame, 0, 0, 0);
        const GLfloat least[] = {0.1f, 0.3f, 0.2f * static_cast<float>(frame), 0};
        glProgramEnvParameter4fvARB(kFragment, 3, least);
        fan(0.9f, 12);
    }
    glDisable(kFragment);
    say_error("assembly_textures");
}

// What a fragment program knows of its own place, and what else is drawn with one.
SCENE(assembly_places, 3) {
    clear();
    static std::array<GLuint, 3> programs;
    if (frame == 0) {
        const std::string pattern =
            "MUL r, r, {0.05, 0.0625, 1, 1};\nFRC r.xy, r;\nMOV r.w, 1;\nMOV result.color, r;\nEND\n";
        programs = {
            loaded(kFragment, "!!ARBfp1.0\nTEMP r;\nMOV r, fragment.position;\n" + pattern),
            loaded(kFragment, "!!ARBfp1.0\nATTRIB here = fragment . position;\nTEMP r;\nMOV r, here.yxzw;\n" + pattern),
            loaded(kFragment, "!!ARBfp1.0\nTEMP r;\nMOV r, fragment.position.xxzw; # fragment.position\n" + pattern),
        };
    }
    glEnable(kFragment);
    for (int i = 0; i < 3; ++i) {
        cell_view(i, 2, 2);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        glBindProgramARB(kFragment, programs[static_cast<std::size_t>(i)]);
        fan(0.7f + 0.1f * static_cast<float>(frame), 7);
    }
    pixel_view(canvas);
    glBindProgramARB(kFragment, programs[0]);
    const auto image = random_image(40 * 30 * 3);
    glRasterPos2f(static_cast<float>(canvas.width) / 2 - 20, 11);
    glDrawPixels(40, 30, GL_RGB, GL_UNSIGNED_BYTE, image.data());
    glDisable(kFragment);
    say_error("assembly_places");
}

SCENE(assembly_state, 3) {
    clear(0.15f, 0.15f, 0.1f);
    static GLuint lit, tinted, list;
    if (frame == 0) {
        lit = loaded(kVertex,
                     "!!ARBvp1.0\nOPTION ARB_position_invariant;\nTEMP n, d;\n"
                     "DP3 n.x, state.matrix.modelview.invtrans.row[0], vertex.normal;\n"
                     "DP3 n.y, state.matrix.modelview.invtrans.row[1], vertex.normal;\n"
                     "DP3 n.z, state.matrix.modelview.invtrans.row[2], vertex.normal;\n"
                     "DP3 d, n, state.light[1].position;\nMAX d, d, 0.0;\n"
                     "MUL d, d, state.light[1].diffuse;\nMAD d, d, state.material.diffuse, state.lightmodel.ambient;\n"
                     "DP4 d.z, state.matrix.program[2].row[0], d;\nMOV result.color, d;\n"
                     "DP4 result.texcoord[0].x, state.matrix.texture[0].row[0], vertex.texcoord[0];\nEND\n");
        tinted = loaded(kFragment,
                        "!!ARBfp1.0\nTEMP r;\nMUL r, fragment.color, state.fog.color;\n"
                        "ADD result.color, r, program.local[7];\nEND\n");
        list = glGenLists(1);
        glNewList(list, GL_COMPILE);
        glBindProgramARB(kFragment, tinted);
        glProgramLocalParameter4fARB(kFragment, 7, 0.2f, 0, 0.1f, 0);
        glEnable(kFragment);
        glEndList();
        GLint mode = 0;
        glMatrixMode(GL_MATRIX2_ARB);
        glGetIntegerv(GL_MATRIX_MODE, &mode);
        say("matrix mode %x", static_cast<unsigned>(mode));
    }
    const GLfloat toward[] = {0.6f, 0, 0.8f, 0}, colour[] = {0.9f, 0.7f, 0.5f, 1}, fog[] = {0.8f, 1, 0.6f, 1};
    glMatrixMode(GL_MATRIX2_ARB);
    glLoadIdentity();
    glScalef(0.3f, 1, 1);
    glPushMatrix();
    glTranslatef(0.1f * static_cast<float>(frame), 0, 0);
    GLfloat matrix[16];
    GLint depth = 0;
    glGetFloatv(GL_TRANSPOSE_CURRENT_MATRIX_ARB, matrix);
    glGetIntegerv(GL_CURRENT_MATRIX_STACK_DEPTH_ARB, &depth);
    say("current matrix %.5g %.5g, depth %d", static_cast<double>(matrix[0]), static_cast<double>(matrix[3]), depth);
    glPushAttrib(GL_ENABLE_BIT);
    glEnable(kVertex);
    glBindProgramARB(kVertex, lit);
    perspective_view(canvas);
    glLightfv(GL_LIGHT1, GL_POSITION, toward);
    glLightfv(GL_LIGHT1, GL_DIFFUSE, colour);
    glMaterialfv(GL_FRONT, GL_DIFFUSE, colour);
    glFogfv(GL_FOG_COLOR, fog);
    glRotatef(static_cast<float>(30 * frame), 0, 1, 0);
    if (frame > 0) glCallList(list);
    lit_sphere();
    glPopAttrib();
    say("enabled %d %d", glIsEnabled(kVertex), glIsEnabled(kFragment));
    glMatrixMode(GL_MATRIX2_ARB);
    glPopMatrix();
    glMatrixMode(GL_MODELVIEW);
    say_error("assembly_state");
}

// A shader takes the place of the program of its stage, and of no other.
SCENE(assembly_and_shaders, 2) {
    clear(0.1f, 0, 0.1f);
    static GLuint placed, coloured, shader_program;
    if (frame == 0) {
        placed = loaded(kVertex, vertex_program("TEMP r;\nMUL r, vertex.position, {0.5, 1, 1, 1};\n" + kPlacings[1] +
                                                "DP4 out.x, mvp[0], r;\n"));
        coloured = loaded(kFragment, "!!ARBfp1.0\nSUB result.color, 1, fragment.color;\nEND\n");
        const GLuint shader = glCreateShader(GL_FRAGMENT_SHADER);
        const char* source = "void main() { gl_FragColor = vec4(gl_Color.gbr, 1.0); }";
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        shader_program = glCreateProgram();
        glAttachShader(shader_program, shader);
        glLinkProgram(shader_program);
    }
    glBindProgramARB(kVertex, placed);
    glBindProgramARB(kFragment, coloured);
    for (int i = 0; i < 4; ++i) {
        cell_view(i, 2, 2);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        (i & 1) != 0 ? glEnable(kVertex) : glDisable(kVertex);
        (i & 2) != 0 ? glEnable(kFragment) : glDisable(kFragment);
        glUseProgram(frame == 0 ? 0 : shader_program);
        fan(0.8f, 5);
    }
    glUseProgram(0);
    glDisable(kVertex);
    glDisable(kFragment);
    say_error("assembly_and_shaders");
}

// What is said about programs, good and bad.
SCENE(assembly_queries, 1) {
    clear();
    const GLuint program = loaded(kVertex, vertex_program(kPlacings[1]));
    for (const GLenum word :
         {GL_PROGRAM_LENGTH_ARB, GL_PROGRAM_FORMAT_ARB, GL_PROGRAM_INSTRUCTIONS_ARB, GL_PROGRAM_TEMPORARIES_ARB,
          GL_PROGRAM_PARAMETERS_ARB, GL_PROGRAM_ATTRIBS_ARB, GL_PROGRAM_ADDRESS_REGISTERS_ARB,
          GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB, GL_PROGRAM_TEX_INSTRUCTIONS_ARB}) {
        GLint value = -7;
        glGetProgramivARB(kVertex, word, &value);
        say("%x: %d", word, value);
        say_error("a word");
    }
    std::array<char, 1024> text{};
    glGetProgramStringARB(kVertex, GL_PROGRAM_STRING_ARB, text.data());
    say("%s", text.data());
    GLfloat value[4];
    glProgramLocalParameter4fARB(kVertex, 5, 1, 2, 3, 4);
    glGetProgramLocalParameterfvARB(kVertex, 5, value);
    say("local %g %g", static_cast<double>(value[0]), static_cast<double>(value[3]));
    glProgramEnvParameter4fARB(kVertex, 100000, 1, 2, 3, 4);
    say_error("no such parameter");
    glProgramStringARB(kVertex, GL_PROGRAM_FORMAT_ASCII_ARB, 23, "!!ARBvp1.0\nNONSENSE;\nEND");
    say_error("nonsense");
    GLint at = 0;
    glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &at);
    say("at %d", at);
    glBindProgramARB(kFragment, program);
    say_error("a program of the other target");
    glBindProgramARB(kFragment, 0);
    glEnable(kFragment);
    fan(1);
    say_error("a draw without a string");
    glDisable(kFragment);
    glDeleteProgramsARB(1, &program);
    GLint bound = 1;
    glGetProgramivARB(kVertex, GL_PROGRAM_BINDING_ARB, &bound);
    say("bound %d", bound);
    load(kVertex, vertex_program(kPlacings[0]));
    glEnable(kVertex);
    fan(0.5f);
    glDisable(kVertex);
    say_error("assembly_queries");
}

SCENE(assembly_raster_positions, 2) {  // where programs put them, with the colours and coordinates that they make
    clear(0.1f, 0.15f, 0.15f);
    perspective_view(canvas);
    const auto bits = random_image(8 * 16);
    static std::array<GLuint, 3> programs;
    if (frame == 0)
        programs = {loaded(kVertex, vertex_program(kPlacings[1])), loaded(kVertex, vertex_program(kPlacings[6])),
                    loaded(kVertex,
                           "!!ARBvp1.0\nOPTION ARB_position_invariant;\nMOV result.color, vertex.normal;\n"
                           "MUL result.texcoord[0], vertex.texcoord[0], { 2, 3, 1, 1 };\n"
                           "MOV result.fogcoord.x, { 0.25 };\nEND\n")};
    for (int i = 0; i < 30; ++i) {
        (i % 4 ? glEnable : glDisable)(kVertex);
        glBindProgramARB(kVertex, programs[i % 3]);
        glNormal3f(0.3f, 0.2f, 0.9f);
        glColor3f(random_unit(), random_unit(), random_unit());
        glTexCoord2f(random_unit(), random_unit());
        glRasterPos3f(random_unit() * 4 - 2, random_unit() * 3 - 1.5f, random_unit() * 3 - 1.5f);
        glDisable(kVertex);
        glBitmap(16, 16, 8, 8, 2, 1, bits.data());
        GLboolean valid = 0;
        GLfloat window[4] = {}, colour[4] = {}, coordinates[4] = {}, distance = 0;
        glGetBooleanv(GL_CURRENT_RASTER_POSITION_VALID, &valid);
        if (valid) {
            glGetFloatv(GL_CURRENT_RASTER_POSITION, window);
            glGetFloatv(GL_CURRENT_RASTER_COLOR, colour);
            glGetFloatv(GL_CURRENT_RASTER_TEXTURE_COORDS, coordinates);
            glGetFloatv(GL_CURRENT_RASTER_DISTANCE, &distance);
        }
        say("raster %d %.4g %.4g %.4g %.4g colour %.4g %.4g coordinates %.4g %.4g distance %.4g", valid, window[0],
            window[1], window[2], window[3], colour[0], colour[2], coordinates[0], coordinates[1], distance);
    }
    say_error("assembly_raster_positions");
}

}  // namespace golden
