// SPDX-License-Identifier: MIT
// A program that draws a picture into a texture once, and shows it in every frame until it is ended: what it shows,
// only the nodes have. Also a second texture that it changes in part from memory after it was drawn, mipmaps, and a
// renderbuffer.
//
// drawn_once [--size WxH] [--anew-at N] [--by SHADERS]   --anew-at: draws the picture again in frame N; --by computing:
// a compute shader makes it, with numbers from a buffer that another has written
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "tests/golden/programs/window.h"

namespace {

constexpr int kTexels = 256;
constexpr auto kFrame = std::chrono::milliseconds(50);

GLuint make_texture() {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kTexels, kTexels, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

void quad(float x0, float y0, float x1, float y1) {
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(x0, y0);
    glTexCoord2f(1, 0), glVertex2f(x1, y0);
    glTexCoord2f(1, 1), glVertex2f(x1, y1);
    glTexCoord2f(0, 1), glVertex2f(x0, y1);
    glEnd();
}

/// Squares of many colours, one over the other, in the framebuffer that is bound.
void draw_squares() {
    glViewport(0, 0, kTexels, kTexels);
    glClearColor(0.1f, 0.2f, 0.3f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_TEXTURE_2D);
    for (int i = 0; i < 60; ++i) {
        const float x = static_cast<float>(i * 37 % 100) / 50 - 1, y = static_cast<float>(i * 61 % 100) / 50 - 1;
        glColor3f(static_cast<float>(i * 7 % 10) / 9, static_cast<float>(i * 3 % 10) / 9,
                  static_cast<float>(i % 10) / 9);
        quad(x, y, x + 0.3f, y + 0.3f);
    }
}

void draw_picture(GLuint framebuffer, GLuint texture) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    draw_squares();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glGenerateMipmap(GL_TEXTURE_2D);
}

void change_part(GLuint texture) {
    std::array<GLubyte, 40 * 40 * 4> part{};
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<GLubyte>(i * 13);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 100, 100, 40, 40, GL_RGBA, GL_UNSIGNED_BYTE, part.data());
}

void show(GLuint texture, float x0, float y0, float x1, float y1) {
    glBindTexture(GL_TEXTURE_2D, texture);
    quad(x0, y0, x1, y1);
}

/// A framebuffer whose picture is in a renderbuffer.
GLuint make_renderbuffer() {
    GLuint framebuffer = 0, renderbuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &renderbuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kTexels, kTexels);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
    return framebuffer;
}

/// Copies a part of it to the same part of the window.
void show_renderbuffer(GLuint framebuffer) {
    constexpr int kFrom = 20, kTo = 150;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(kFrom, kFrom, kTo, kTo, kFrom, kFrom, kTo, kTo, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

GLuint compute_program(const char* source) {
    const GLuint program = glCreateProgram(), shader = glCreateShader(GL_COMPUTE_SHADER);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glLinkProgram(program);
    return program;
}

/// The numbers are written anew in every frame from those of the frame before, the picture only when it is wanted.
class Computing {
public:
    void count() {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, numbers_);
        glUseProgram(counting_);
        glDispatchCompute(1, 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        glUseProgram(0);
    }
    void draw(GLuint texture) {
        count();
        glUseProgram(drawing_);
        glBindImageTexture(0, texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
        glDispatchCompute(kTexels / 16, kTexels / 16, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        glUseProgram(0);
        glBindTexture(GL_TEXTURE_2D, texture);
        glGenerateMipmap(GL_TEXTURE_2D);
    }

private:
    static GLuint make_numbers() {
        GLuint name = 0;
        glGenBuffers(1, &name);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
        glBufferData(GL_SHADER_STORAGE_BUFFER, 64 * sizeof(GLuint), nullptr, GL_DYNAMIC_COPY);
        return name;
    }
    const GLuint numbers_ = make_numbers();
    const GLuint counting_ = compute_program(
        "#version 430\nlayout(local_size_x = 64) in; layout(std430, binding = 0) buffer Numbers { uint n[]; };\n"
        "void main() { uint i = gl_LocalInvocationIndex; n[i] = (i * 2654435761u) >> 24; }");
    const GLuint drawing_ = compute_program(
        "#version 430\nlayout(local_size_x = 16, local_size_y = 16) in;\n"
        "layout(std430, binding = 0) readonly buffer Numbers { uint n[]; };\n"
        "layout(rgba8, binding = 0) writeonly uniform image2D picture;\n"
        "void main() { uvec2 at = gl_GlobalInvocationID.xy; uint i = (at.x / 32u + 8u * (at.y / 32u)) % 64u;\n"
        "  imageStore(picture, ivec2(at), vec4(float(n[i]) / 255.0, vec2(at) / 256.0, 1.0)); }");
};

}  // namespace

int main(int argc, char** argv) {
    golden::Size size{400, 300};
    int anew_at = -1;
    bool by_computing = false;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (std::string(argv[i]) == "--size") std::sscanf(argv[i + 1], "%dx%d", &size.width, &size.height);
        if (std::string(argv[i]) == "--by") by_computing = std::string(argv[i + 1]) == "computing";
        if (std::string(argv[i]) == "--anew-at") anew_at = std::atoi(argv[i + 1]);
    }
    const auto window = golden::Window::by_glx(size, {});
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    const GLuint whole = make_texture(), changed = make_texture(), renderbuffer = make_renderbuffer();
    std::optional<Computing> computing;
    if (by_computing) computing.emplace();
    for (int frame = 0;; ++frame) {
        if (computing) computing->count();
        if (frame == 0 || frame == anew_at) {
            for (const GLuint texture : {whole, changed})
                if (computing) computing->draw(texture);
                else draw_picture(framebuffer, texture);
            change_part(changed);
            glBindFramebuffer(GL_FRAMEBUFFER, renderbuffer);
            draw_squares();
            glBindFramebuffer(GL_FRAMEBUFFER, 0);
        }
        glViewport(0, 0, size.width, size.height);
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glColor3f(1, 1, 1);
        glEnable(GL_TEXTURE_2D);
        show(whole, -1, -1, 0.2f, 1);
        show(changed, 0.2f, -1, 1, 0.5f);
        show(whole, 0.4f, 0.6f, 0.7f, 0.9f);  // from the mipmaps
        show_renderbuffer(renderbuffer);
        window->swap();
        std::this_thread::sleep_for(kFrame);
    }
}
