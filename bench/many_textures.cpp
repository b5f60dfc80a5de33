// SPDX-License-Identifier: MIT
// A program with many large textures: defines them, draws a frame with all of them, says so, and goes on showing it
// until it is ended. Any GLX. bench/share.py runs several of it at once.
#include <unistd.h>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bench/gl_window.h"

namespace {

struct Options {
    int textures = 16, texels = 1024;  // 16 of 1024x1024 RGBA: 64 MiB
    unsigned seed = 1;
    int window = 128, global = 0;
};

constexpr GLenum kGlobalTexture2d = 0x1D002;  // GL_WALLGL_global_texture

bool parse(int argc, char** argv, Options& o) {
    for (int i = 1; i < argc; i += 2) {
        const auto number = [&](const char* name, auto& value) {
            if (std::strcmp(argv[i], name) != 0 || i + 1 >= argc) return false;
            value = static_cast<std::remove_reference_t<decltype(value)>>(std::atoi(argv[i + 1]));
            return true;
        };
        if (!number("--textures", o.textures) && !number("--texels", o.texels) && !number("--seed", o.seed) &&
            !number("--window", o.window) && !number("--global", o.global))
            return false;
    }
    return o.textures > 0 && o.texels > 0 && o.window > 0;
}

/// Noise, so that nothing in between can compress it.
std::vector<std::uint32_t> image(const Options& o, int number) {
    std::vector<std::uint32_t> texels(static_cast<std::size_t>(o.texels) * static_cast<std::size_t>(o.texels));
    std::uint32_t state = o.seed * 7919u + static_cast<std::uint32_t>(number) + 1;
    for (auto& texel : texels) {
        state ^= state << 13, state ^= state >> 17, state ^= state << 5;
        texel = state;
    }
    return texels;
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    if (!parse(argc, argv, o)) {
        std::fputs(
            "usage: many_textures [--textures N] [--texels SIDE] [--seed S] [--window PIXELS] [--global 1]\n"
            "Shows N textures of SIDE x SIDE RGBA noise side by side. Equal seeds make equal textures.\n"
            "--global: the processes of a parallel program share them by name (GL_WALLGL_global_texture).\n",
            stderr);
        return 2;
    }
    constexpr int kAttributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, 0};
    const auto side = static_cast<unsigned>(o.window);
    wall::bench::GlWindow window("many_textures", side, side, kAttributes);
    if (!window.current()) return 1;

    glEnable(GL_TEXTURE_2D);
    std::vector<GLuint> names(static_cast<std::size_t>(o.textures));
    glGenTextures(o.textures, names.data());
    for (int i = 0; i < o.textures; ++i) {
        glBindTexture(o.global != 0 ? kGlobalTexture2d : GL_TEXTURE_2D, names[static_cast<std::size_t>(i)]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, o.texels, o.texels, 0, GL_RGBA, GL_UNSIGNED_BYTE, image(o, i).data());
    }
    for (int frame = 0;; ++frame) {
        glClear(GL_COLOR_BUFFER_BIT);
        for (int i = 0; i < o.textures; ++i) {
            const float bottom = 2.0f * static_cast<float>(i) / static_cast<float>(o.textures) - 1,
                        top = bottom + 2.0f / static_cast<float>(o.textures);
            glBindTexture(GL_TEXTURE_2D, names[static_cast<std::size_t>(i)]);
            glBegin(GL_QUADS);
            glTexCoord2f(0, 0), glVertex2f(-1, bottom);
            glTexCoord2f(1, 0), glVertex2f(1, bottom);
            glTexCoord2f(1, 1), glVertex2f(1, top);
            glTexCoord2f(0, 1), glVertex2f(-1, top);
            glEnd();
        }
        window.swap();
        if (frame == 0) {
            glFinish();
            std::puts("drawn");
            std::fflush(stdout);
        }
        usleep(200000);
    }
}
