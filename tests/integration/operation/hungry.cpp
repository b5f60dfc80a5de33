// SPDX-License-Identifier: MIT
// A program that wants much: textures that it keeps, one more with each frame, or one that it writes anew for each
// frame. What it draws tells that it goes on.
//
// hungry [--size WxH] [--keep MIB] [--write MIB] [--fps N]     runs until it is ended
//   --keep: textures of a MiB each, until it has so many
//   --write: of such textures, written anew for each frame
#include <GL/gl.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/golden/programs/window.h"

namespace {

constexpr int kTexels = 512;  // a side: a MiB

struct Options {
    golden::Size size{400, 300};
    unsigned keep = 0, write = 0, fps = 20;
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        const auto number = static_cast<unsigned>(std::atoi(argv[i + 1]));
        if (name == "--size") std::sscanf(argv[i + 1], "%dx%d", &options.size.width, &options.size.height);
        if (name == "--keep") options.keep = number;
        if (name == "--write") options.write = number;
        if (name == "--fps") options.fps = number;
    }
    return options;
}

/// Of noise, so that none is like another.
class Textures {
public:
    explicit Textures(unsigned count) : names_(count), texels_(std::size_t{kTexels} * kTexels) {
        if (count > 0) glGenTextures(static_cast<GLsizei>(count), names_.data());
    }
    void write(unsigned number) {
        for (auto& texel : texels_) texel = static_cast<std::uint32_t>(random_());
        glBindTexture(GL_TEXTURE_2D, names_[number]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kTexels, kTexels, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels_.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    }
    void draw(unsigned number) const {
        glBindTexture(GL_TEXTURE_2D, names_[number]);
        glBegin(GL_QUADS);
        glTexCoord2f(0, 0), glVertex2f(-1, -1);
        glTexCoord2f(1, 0), glVertex2f(1, -1);
        glTexCoord2f(1, 1), glVertex2f(1, 1);
        glTexCoord2f(0, 1), glVertex2f(-1, 1);
        glEnd();
    }

private:
    std::vector<GLuint> names_;
    std::vector<std::uint32_t> texels_;
    std::minstd_rand random_{std::random_device{}()};
};

}  // namespace

int main(int argc, char** argv) {
    const Options options = parse(argc, argv);
    const auto window = golden::Window::by_glx(options.size, {});
    Textures kept(options.keep), written(options.write);
    glEnable(GL_TEXTURE_2D);
    const auto start = std::chrono::steady_clock::now();
    for (unsigned frame = 0;; ++frame) {
        glClear(GL_COLOR_BUFFER_BIT);
        if (frame < options.keep) kept.write(frame);
        for (unsigned i = 0; i < options.keep && i <= frame; ++i) kept.draw(i);
        for (unsigned i = 0; i < options.write; ++i) {
            written.write(i);
            written.draw(i);
        }
        window->swap();
        if (options.fps != 0)
            std::this_thread::sleep_until(start + std::chrono::milliseconds(1000) * (frame + 1) / options.fps);
    }
}
