// SPDX-License-Identifier: MIT
// golden_scenes NAME [--frames=N] [--pause] [--raw=FILE] [--read-from=N]
//   draws a scene and writes each frame to standard output as PNM, just before it is shown; lines of results go to
//   standard error behind "= ". --pause waits for a line on standard input after each frame. --raw also appends each
//   frame as RGBA bytes, bottom row first, to FILE. --read-from: frames before that one are not read.
// golden_scenes --list                                     prints NAME FRAMES swaps|flushes tiles|whole of each scene.
#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>

#include "tests/golden/programs/window.h"

namespace golden {

std::vector<Scene>& scenes() {
    static std::vector<Scene> all;
    return all;
}

void say(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    std::fputs("= ", stderr);
    std::vfprintf(stderr, format, arguments);
    std::fputc('\n', stderr);
    va_end(arguments);
}

void say_error(const char* where) {
    if (const GLenum error = glGetError()) say("%s: error 0x%04x", where, error);
}

namespace {

struct Options {
    std::string scene, raw;
    std::optional<int> frames;
    int read_from = 0;
    bool pause = false, list = false;
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--list") options.list = true;
        else if (argument == "--pause") options.pause = true;
        else if (argument.starts_with("--frames=")) options.frames = std::stoi(argument.substr(9));
        else if (argument.starts_with("--read-from=")) options.read_from = std::stoi(argument.substr(12));
        else if (argument.starts_with("--raw=")) options.raw = argument.substr(6);
        else options.scene = argument;
    }
    return options;
}

std::vector<unsigned char> read_pixels(Size size) {
    std::vector<unsigned char> rgba(static_cast<std::size_t>(size.width * size.height * 4));
    glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
}

/// What is made of a window's samples, by way of a texture: Mesa 22.3's glReadPixels gives the first one of each pixel.
std::vector<unsigned char> read_samples(Size size) {
    std::vector<unsigned char> rgba(static_cast<std::size_t>(size.width * size.height * 4));
    glPushAttrib(GL_TEXTURE_BIT);
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 0, 0, size.width, size.height, 0);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    glPopAttrib();
    glDeleteTextures(1, &texture);
    return rgba;
}

/// The buffer as it is, whatever pixel transfer the scene has left; one of OpenGL ES leaves none.
std::vector<unsigned char> read_frame(const Scene& scene, Size size) {
    if (scene.needs.es) return read_pixels(size);
    glPushAttrib(GL_PIXEL_MODE_BIT);
    glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    for (const GLenum name :
         {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS})
        glPixelStorei(name, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (const GLenum name : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE}) glPixelTransferf(name, 1);
    for (const GLenum name : {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS}) glPixelTransferf(name, 0);
    glPixelTransferi(GL_MAP_COLOR, 0);
    if (scene.needs.read) glReadBuffer(scene.needs.read);
    auto rgba = scene.needs.samples ? read_samples(size) : read_pixels(size);
    glPopClientAttrib();
    glPopAttrib();
    return rgba;
}

void write_pnm(const std::vector<unsigned char>& rgba, Size size) {
    std::vector<unsigned char> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (int y = size.height - 1; y >= 0; --y)
        for (int x = 0; x < size.width; ++x) {
            const unsigned char* pixel = &rgba[static_cast<std::size_t>(y * size.width + x) * 4];
            rgb.insert(rgb.end(), pixel, pixel + 3);
        }
    std::printf("P6\n%d %d\n255\n", size.width, size.height);
    std::fwrite(rgb.data(), 1, rgb.size(), stdout);
    std::fflush(stdout);
}

void append(const std::string& path, const std::vector<unsigned char>& bytes) {
    if (std::FILE* file = std::fopen(path.c_str(), "ab")) {
        std::fwrite(bytes.data(), 1, bytes.size(), file);
        std::fclose(file);
    }
}

bool swaps(const Scene& scene) { return scene.needs.double_buffered && !scene.needs.read; }

void run(const Scene& scene, const Options& options) {
    const Size size;
    if (scene.needs.srgb) unsetenv("MESA_EXTENSION_OVERRIDE");
    const auto window =
        scene.needs.egl || scene.needs.es ? Window::by_egl(size, scene.needs) : Window::by_glx(size, scene.needs);
    for (int frame = 0; frame < options.frames.value_or(scene.frames); ++frame) {
        restart_random();
        scene.draw(frame, size);
        say_error("end of frame");
        if (frame >= options.read_from) {
            const auto pixels = read_frame(scene, size);
            if (!options.raw.empty()) append(options.raw, pixels);
            write_pnm(pixels, size);
        }
        if (swaps(scene)) window->swap();
        glFinish();
        if (options.pause && std::getchar() == EOF) return;
    }
}

int main(int argc, char** argv) {
    const Options options = parse(argc, argv);
    auto all = scenes();
    std::sort(all.begin(), all.end(), [](const Scene& a, const Scene& b) { return a.name < b.name; });
    if (options.list) {
        for (const Scene& scene : all)
            std::printf("%s %d %s %s\n", scene.name.c_str(), scene.frames, swaps(scene) ? "swaps" : "flushes",
                        scene.needs.whole ? "whole" : "tiles");
        return 0;
    }
    const auto found = std::find_if(all.begin(), all.end(), [&](const Scene& s) { return s.name == options.scene; });
    if (found == all.end()) {
        std::fprintf(stderr, "golden_scenes: no scene '%s'; --list names them\n", options.scene.c_str());
        return 2;
    }
    run(*found, options);
    return 0;
}

}  // namespace
}  // namespace golden

int main(int argc, char** argv) {
    try {
        return golden::main(argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "golden_scenes: %s\n", problem.what());
        return 1;
    }
}
