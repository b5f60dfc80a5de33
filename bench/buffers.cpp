// SPDX-License-Identifier: MIT
// A mesh in buffer objects: what programs draw since OpenGL 1.5. One draw of 1,001,000 triangles a frame, by fixed
// function or a shader, from a buffer that never changes or is written anew for every frame; or many draws of small
// meshes. Any GLX. `buffers --help` tells the options; bench/buffers.py measures it on a wall.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "bench/gl_window.h"
#include "bench/off_window.h"

namespace {

struct Options {
    int columns = 1001, rows = 500;  // 1,001,000 triangles
    int frames = 60;
    int width = 600, height = 600;
    int draws = 0;  ///< a frame, of small meshes; 0: one of the large one
    bool glsl = false, rewrite = false;
    bool off_window = false;  ///< drawn to a framebuffer object, and brought to the window from there
    bool as_texture = false;  ///< on a rectangle
};

struct Vertex {
    float x, y, z, nx, ny, nz;
};

struct Mesh {
    GLuint vertices = 0, indices = 0;
    GLsizei count = 0;
    std::vector<Vertex> content;
};

constexpr int kSmallMeshes = 1000;
constexpr int kSmallColumns = 4, kSmallRows = 3;

Vertex vertex(int columns, int rows, int column, int row) {
    const float x = 2.0f * static_cast<float>(column) / static_cast<float>(columns) - 1;
    const float y = 2.0f * static_cast<float>(row) / static_cast<float>(rows) - 1;
    return {x, y, 0.1f * std::sin(6 * x) * std::cos(4 * y), -0.4f * std::cos(6 * x), 0.2f * y, 1};
}

Mesh make_mesh(int columns, int rows) {
    Mesh mesh;
    std::vector<std::uint32_t> indices;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) mesh.content.push_back(vertex(columns, rows, column, row));
    const auto at = [&](int column, int row) { return static_cast<std::uint32_t>(row * (columns + 1) + column); };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            indices.insert(indices.end(), {at(column, row), at(column + 1, row), at(column, row + 1),
                                           at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)});
    mesh.count = static_cast<GLsizei>(indices.size());
    glGenBuffers(1, &mesh.vertices);
    glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.content.size() * sizeof(Vertex)), mesh.content.data(),
                 GL_STATIC_DRAW);
    glGenBuffers(1, &mesh.indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
    return mesh;
}

void draw(const Mesh& mesh) {
    glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), nullptr);
    glNormalPointer(GL_FLOAT, sizeof(Vertex), reinterpret_cast<const void*>(offsetof(Vertex, nx)));
    glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
}

void rewrite(Mesh& mesh, float time) {
    for (Vertex& v : mesh.content) v.z = 0.1f * std::sin(6 * v.x + time);
    glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
    glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(mesh.content.size() * sizeof(Vertex)),
                    mesh.content.data());
}

void draw_many(const std::vector<Mesh>& meshes, int draws) {
    for (int i = 0; i < draws; ++i) {
        const float place = static_cast<float>(i) / static_cast<float>(draws);
        glLoadIdentity();
        glTranslatef(2 * place - 1, std::sin(50 * place), 0);
        glScalef(0.02f, 0.02f, 1);
        draw(meshes[static_cast<std::size_t>(i) % meshes.size()]);
    }
}

void use_program() {
    const GLuint program = glCreateProgram();
    glAttachShader(program, wall::bench::shader(GL_VERTEX_SHADER,
                                                "varying float light;\n"
                                                "void main() {\n"
                                                "    light = max(normalize(gl_NormalMatrix * gl_Normal).z, 0.0);\n"
                                                "    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;\n"
                                                "}\n"));
    glAttachShader(program,
                   wall::bench::shader(GL_FRAGMENT_SHADER,
                                       "varying float light;\n"
                                       "void main() { gl_FragColor = vec4(vec3(0.2 + 0.8 * light), 1.0); }\n"));
    glLinkProgram(program);
    glUseProgram(program);
}

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0; };
        const auto number = [&](const char* name, int& value) {
            if (!is(name) || i + 1 >= argc) return false;
            value = std::atoi(argv[++i]);
            return true;
        };
        if (is("--glsl")) o.glsl = true;
        else if (is("--rewrite")) o.rewrite = true;
        else if (is("--off-window")) o.off_window = true;
        else if (is("--as-texture")) o.off_window = o.as_texture = true;
        else if (number("--frames", o.frames) || number("--draws", o.draws)) continue;
        else if (is("--size") && i + 1 < argc && std::sscanf(argv[++i], "%dx%d", &o.width, &o.height) == 2) continue;
        else if (is("--mesh") && i + 1 < argc && std::sscanf(argv[++i], "%dx%d", &o.columns, &o.rows) == 2) continue;
        else return false;
    }
    return o.frames > 0 && o.width > 0 && o.height > 0 && o.columns > 0 && o.rows > 0 && o.draws >= 0;
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (!parse(argc, argv, o)) {
        std::fputs(
            "usage: buffers [--glsl] [--rewrite] [--off-window | --as-texture] [--draws N] [--frames N] [--size WxH]\n"
            "               [--mesh COLUMNSxROWS]\n"
            "Draws N frames of a lit mesh of 1,001,000 triangles in buffer objects and prints frames/s.\n"
            "--glsl: by a shader. --rewrite: its vertices are written anew for every frame.\n"
            "--off-window: it is drawn to a framebuffer object, and copied to the window as it is. --as-texture: it\n"
            "comes there as a texture on a rectangle.\n"
            "--mesh COLUMNSxROWS: of twice as many triangles; 1001x500 if it is not given.\n"
            "--draws: instead, so many draws a frame of 1000 meshes of 24 triangles, each at a place of its own.\n",
            stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, 0};
    wall::bench::GlWindow window("buffers", static_cast<unsigned>(o.width), static_cast<unsigned>(o.height),
                                 kAttributes);
    if (!window.current()) return 1;
    glViewport(0, 0, o.width, o.height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_NORMALIZE);
    if (o.glsl) use_program();
    std::vector<Mesh> meshes;
    for (int i = 0; i < (o.draws != 0 ? kSmallMeshes : 1); ++i)
        meshes.push_back(o.draws != 0 ? make_mesh(kSmallColumns, kSmallRows) : make_mesh(o.columns, o.rows));
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);

    std::optional<wall::bench::OffWindow> picture;
    if (o.off_window) picture.emplace(o.width, o.height, o.as_texture);
    auto start = std::chrono::steady_clock::now();
    const int warm_up = o.off_window ? 10 : 3;  // the nodes get the buffers, and what is a habit has become one
    for (int frame = -warm_up; frame < o.frames; ++frame) {
        if (frame == 0) glFinish(), start = std::chrono::steady_clock::now();
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        if (o.rewrite) rewrite(meshes[0], 0.05f * static_cast<float>(frame));
        if (o.draws != 0) draw_many(meshes, o.draws);
        else draw(meshes[0]);
        if (picture) picture->show();
        window.swap();
    }
    glFinish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%d frames in %.2f s: %.1f frames/s\n", o.frames, seconds.count(), o.frames / seconds.count());
}
