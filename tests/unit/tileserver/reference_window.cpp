// SPDX-License-Identifier: MIT
#include "tests/unit/tileserver/reference_window.h"

#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/osmesa.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "common/base/assert.h"

namespace wall::tileserver::test {

ReferenceWindow::ReferenceWindow(int width, int height, bool alpha, int samples)
    : width_(width), height_(height), samples_(samples) {
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    WALL_ASSERT(eglInitialize(display_, nullptr, nullptr) == EGL_TRUE);
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_ALPHA_SIZE,
                             alpha ? 8 : 0,
                             EGL_DEPTH_SIZE,
                             24,
                             EGL_STENCIL_SIZE,
                             8,
                             EGL_SAMPLES,
                             samples,
                             EGL_NONE};
    EGLConfig configs[64];
    EGLint count = 0;
    eglChooseConfig(display_, wanted, configs, 64, &count);
    EGLConfig chosen = nullptr;
    for (EGLint i = 0; i < count && chosen == nullptr; ++i) {
        EGLint alpha_bits = 0, red_bits = 0;
        eglGetConfigAttrib(display_, configs[i], EGL_ALPHA_SIZE, &alpha_bits);
        eglGetConfigAttrib(display_, configs[i], EGL_RED_SIZE, &red_bits);
        if (alpha_bits == (alpha ? 8 : 0) && red_bits == 8) chosen = configs[i];
    }
    WALL_ASSERT(chosen != nullptr);
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    surface_ = eglCreatePbufferSurface(display_, chosen, size);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                              4,
                              EGL_CONTEXT_MINOR_VERSION,
                              5,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                              EGL_NONE};
    context_ = eglCreateContext(display_, chosen, EGL_NO_CONTEXT, version);
    WALL_ASSERT(context_ != EGL_NO_CONTEXT);
    make_current();
    gl_.load([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
}

ReferenceWindow::~ReferenceWindow() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglDestroySurface(display_, surface_);
}

void ReferenceWindow::make_current() {
    WALL_ASSERT(eglMakeCurrent(display_, surface_, surface_, context_) == EGL_TRUE);
}

Pixels ReferenceWindow::read() const {
    if (samples_ == 0) return read_pixels(gl_, width_, height_);
    GLuint framebuffer = 0, texture = 0;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &texture);
    gl_.TextureStorage2D(texture, 1, GL_RGBA8, width_, height_);
    gl_.CreateFramebuffers(1, &framebuffer);
    gl_.NamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, texture, 0);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.BlitNamedFramebuffer(0, framebuffer, 0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                             GL_NEAREST);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    auto pixels = read_pixels(gl_, width_, height_);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    gl_.DeleteFramebuffers(1, &framebuffer);
    gl_.DeleteTextures(1, &texture);
    return pixels;
}

namespace {

template <class Function>
Function osmesa(const char* name) {
    static void* library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    return library != nullptr ? reinterpret_cast<Function>(dlsym(library, name)) : nullptr;
}

}  // namespace

std::unique_ptr<AccumReference> AccumReference::open(int width, int height) {
    const auto create = osmesa<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    if (create == nullptr) return nullptr;
    const int wanted[] = {OSMESA_FORMAT,
                          OSMESA_RGBA,
                          OSMESA_DEPTH_BITS,
                          24,
                          OSMESA_STENCIL_BITS,
                          8,
                          OSMESA_ACCUM_BITS,
                          16,
                          OSMESA_PROFILE,
                          OSMESA_COMPAT_PROFILE,
                          OSMESA_CONTEXT_MAJOR_VERSION,
                          3,
                          OSMESA_CONTEXT_MINOR_VERSION,
                          0,
                          0};
    std::unique_ptr<AccumReference> window(new AccumReference);
    window->width_ = width;
    window->height_ = height;
    window->memory_.resize(static_cast<std::size_t>(width) * height * 4);
    window->context_ = create(wanted, nullptr);
    const auto make_current = osmesa<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    WALL_ASSERT(make_current(static_cast<OSMesaContext>(window->context_), window->memory_.data(), GL_UNSIGNED_BYTE,
                             width, height) == GL_TRUE);
    const auto get = osmesa<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress");
    window->gl_.load([get](const char* name) { return reinterpret_cast<void*>(get(name)); });
    return window;
}

AccumReference::~AccumReference() {
    osmesa<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")(nullptr, nullptr, 0, 0, 0);
    osmesa<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")(static_cast<OSMesaContext>(context_));
}

Pixels AccumReference::read() const { return read_pixels(gl_, width_, height_); }

Pixels read_pixels(const Gl& gl, int width, int height) {
    Pixels pixels(static_cast<std::size_t>(width) * height * 4);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
}

std::size_t count_different(const Pixels& a, const Pixels& b) {
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) count += std::memcmp(&a[i], &b[i], 4) != 0 ? 1 : 0;
    return count;
}

void write_ppm(const char* path, const Pixels& pixels, int width, int height) {
    std::FILE* file = std::fopen(path, "wb");
    if (file == nullptr) return;
    std::fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x) std::fwrite(&pixels[(static_cast<std::size_t>(y) * width + x) * 4], 1, 3, file);
    std::fclose(file);
}

}  // namespace wall::tileserver::test
