// SPDX-License-Identifier: MIT
// Plain Mesa: a pbuffer with its own context, the picture that a program would get in a window.
#pragma once

#include <EGL/egl.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "tileserver/gpu/gl.h"

namespace wall::tileserver::test {

using Pixels = std::vector<std::uint8_t>;  ///< RGBA, bottom row first

class ReferenceWindow {
public:
    /// `samples`: of a pixel; 0: it has no sample buffers.
    ReferenceWindow(int width, int height, bool alpha = false, int samples = 0);
    ~ReferenceWindow();
    ReferenceWindow(const ReferenceWindow&) = delete;

    void make_current();
    const Gl& gl() const { return gl_; }
    /// Of samples what a blit makes of them: Mesa 22.3's glReadPixels gives the first one of each pixel.
    Pixels read() const;

private:
    int width_, height_, samples_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLSurface surface_ = EGL_NO_SURFACE;
    EGLContext context_ = EGL_NO_CONTEXT;
    Gl gl_;
};

/// Plain Mesa with an accumulation buffer, which no EGL configuration has: off-screen Mesa. Null where that is not
/// installed.
class AccumReference {
public:
    static std::unique_ptr<AccumReference> open(int width, int height);
    ~AccumReference();
    AccumReference(const AccumReference&) = delete;

    const Gl& gl() const { return gl_; }
    Pixels read() const;

private:
    AccumReference() = default;
    int width_ = 0, height_ = 0;
    void* context_ = nullptr;
    Pixels memory_;
    Gl gl_;
};

Pixels read_pixels(const Gl& gl, int width, int height);
/// Number of pixels that differ in any channel.
std::size_t count_different(const Pixels& a, const Pixels& b);
void write_ppm(const char* path, const Pixels& pixels, int width, int height);

}  // namespace wall::tileserver::test
