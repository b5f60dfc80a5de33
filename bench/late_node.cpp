// SPDX-License-Identifier: MIT
// A program with large objects, half of them vertices in buffers and half textures, all of which it uses in every
// frame. It prints a line for each frame: when it was done, and how long it took, in seconds. bench/late_node.py kills
// its node meanwhile. Any GLX. `late_node --help` tells the options.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bench/gl_window.h"

namespace {

constexpr int kBufferBytes = 8 << 20, kTextureSide = 1024;  // 4 MiB a texture
constexpr int kTextureBytes = 4 * kTextureSide * kTextureSide;
constexpr int kSide = 256;  // pixels of the window

struct Vertex {
    float x, y, s, t;
};

/// Noise, so that no two objects are alike.
std::vector<std::uint32_t> noise(std::size_t bytes, std::uint32_t seed) {
    std::vector<std::uint32_t> out(bytes / sizeof(std::uint32_t));
    for (std::uint32_t& word : out) word = seed = seed * 1664525 + 1013904223;
    return out;
}

GLuint make_buffer(std::uint32_t seed) {
    auto content = noise(kBufferBytes, seed);
    const Vertex square[] = {{-1, -1, 0, 0}, {1, -1, 1, 0}, {1, 1, 1, 1}, {-1, 1, 0, 1}};
    std::memcpy(content.data(), square, sizeof square);
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(GL_ARRAY_BUFFER, name);
    glBufferData(GL_ARRAY_BUFFER, kBufferBytes, content.data(), GL_STATIC_DRAW);
    return name;
}

GLuint make_texture(std::uint32_t seed) {
    const auto content = noise(kTextureBytes, seed);
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kTextureSide, kTextureSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, content.data());
    return name;
}

void draw(const std::vector<GLuint>& buffers, const std::vector<GLuint>& textures) {
    for (std::size_t i = 0; i < textures.size(); ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glBindBuffer(GL_ARRAY_BUFFER, buffers[i % buffers.size()]);
        glVertexPointer(2, GL_FLOAT, sizeof(Vertex), nullptr);
        glTexCoordPointer(2, GL_FLOAT, sizeof(Vertex), reinterpret_cast<const void*>(offsetof(Vertex, s)));
        glDrawArrays(GL_QUADS, 0, 4);
    }
}

double seconds() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

}  // namespace

int main(int argc, char** argv) {
    int megabytes = 256;
    if (argc == 3 && std::strcmp(argv[1], "--megabytes") == 0) megabytes = std::atoi(argv[2]);
    else if (argc != 1) megabytes = 0;
    if (megabytes < 16) {
        std::fputs(
            "usage: late_node [--megabytes N]\n"
            "Draws with N MiB (at least 16, else 256) of buffers and textures until it is ended, and prints of\n"
            "each frame when it was done and how long it took.\n",
            stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, 0};
    wall::bench::GlWindow window("late_node", kSide, kSide, kAttributes);
    if (!window.current()) return 1;
    std::vector<GLuint> buffers, textures;
    const std::size_t half = static_cast<std::size_t>(megabytes) << 19;
    std::uint32_t seed = 1;
    for (std::size_t bytes = 0; bytes < half; bytes += kBufferBytes) buffers.push_back(make_buffer(seed++));
    for (std::size_t bytes = 0; bytes < half; bytes += kTextureBytes) textures.push_back(make_texture(seed++));
    glEnable(GL_TEXTURE_2D);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    for (double before = seconds();;) {
        glClear(GL_COLOR_BUFFER_BIT);
        draw(buffers, textures);
        window.swap();
        glFinish();
        const double now = seconds();
        std::printf("%.4f %.4f\n", now, now - before);
        std::fflush(stdout);
        before = now;
    }
}
