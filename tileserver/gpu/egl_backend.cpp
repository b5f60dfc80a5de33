// SPDX-License-Identifier: MIT
// The EGL backend: no window system, no surface; all drawing goes to framebuffer objects. Render thread.
#include <functional>
#include <vector>

#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/egl_context.h"
#include "tileserver/gpu/gpu_devices.h"

namespace wall::tileserver {
namespace {

/// None: the driver has none for it.
EGLDisplay display_of(const GpuDevice& gpu) {
    const auto get_display = egl_extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (get_display == nullptr) return EGL_NO_DISPLAY;
    const EGLDisplay display = get_display(EGL_PLATFORM_DEVICE_EXT, gpu.egl, nullptr);
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE ? display : EGL_NO_DISPLAY;
}

EGLDisplay surfaceless_display() {
    const auto get_display = egl_extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
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

Result<std::unique_ptr<GlBackend>> open_egl_backend(std::string_view gpu) {
    const auto gpus = gpu_devices();
    const auto chosen = choose_gpu(gpus, gpu);
    if (!chosen) return tl::unexpected(chosen.error());
    // Without a choice the next one does, and at last the software renderer.
    std::vector<std::function<EGLDisplay()>> ways;
    for (std::size_t i = *chosen; i < gpus.size() && (i == *chosen || gpu == kAnyGpu); ++i)
        ways.push_back([&gpus, i] { return display_of(gpus[i]); });
    if (gpus.empty() || gpu == kAnyGpu) ways.push_back(surfaceless_display);
    for (const auto& find_display : ways) {
        const EGLDisplay display = find_display();
        if (display == EGL_NO_DISPLAY) continue;
        const EGLContext context = create_egl_context(display);
        if (context != EGL_NO_CONTEXT) return std::make_unique<EglBackend>(display, context);
    }
    return fail("EGL offers no OpenGL 4.5 compatibility context without a window (" + egl_error("eglCreateContext") +
                ")");
}

}  // namespace wall::tileserver
