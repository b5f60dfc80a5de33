// SPDX-License-Identifier: MIT
// The EGL backend: no window system, no surface; all drawing goes to framebuffer objects. Render thread.
#include <array>

#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/egl_context.h"

namespace wall::tileserver {
namespace {

template <class Function>
Function extension(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// The first device that is not a software rasterizer; no display if there is none.
EGLDisplay gpu_display() {
    const auto query_devices = extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto query_string = extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const auto get_display = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (query_devices == nullptr || query_string == nullptr || get_display == nullptr) return EGL_NO_DISPLAY;
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_FALSE) return EGL_NO_DISPLAY;
    for (EGLint i = 0; i < count; ++i) {
        const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
        if (has_word(query_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
        const EGLDisplay display = get_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) return display;
    }
    return EGL_NO_DISPLAY;
}

EGLDisplay surfaceless_display() {
    const auto get_display = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (get_display == nullptr) return EGL_NO_DISPLAY;
    const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE ? display : EGL_NO_DISPLAY;
}

class EglBackend final : public GlBackend {
public:
    EglBackend(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
    ~EglBackend() override {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
    Result<void> make_current() override {
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE)
            return fail(egl_error("eglMakeCurrent"));
        return {};
    }
    void* get_proc_address(const char* name) const override { return reinterpret_cast<void*>(eglGetProcAddress(name)); }
    std::string_view name() const override { return "egl"; }

private:
    EGLDisplay display_;  // shared by the process (EGL gives the same one each time), so never terminated
    EGLContext context_;
};

}  // namespace

Result<std::unique_ptr<GlBackend>> open_egl_backend() {
    for (const auto find_display : {gpu_display, surfaceless_display}) {
        const EGLDisplay display = find_display();
        if (display == EGL_NO_DISPLAY) continue;
        const EGLContext context = create_egl_context(display);
        if (context != EGL_NO_CONTEXT) return std::make_unique<EglBackend>(display, context);
    }
    return fail("EGL offers no OpenGL 4.5 compatibility context without a window (" + egl_error("eglCreateContext") +
                ")");
}

}  // namespace wall::tileserver
