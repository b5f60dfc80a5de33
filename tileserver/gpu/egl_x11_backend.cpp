// SPDX-License-Identifier: MIT
// The EGL backend of a node with tiles in windows: on the X server's display, so that what layers are drawn with and
// what is shown are one context, and nothing is read back. Render thread.
#include <X11/Xlib.h>

#include <array>
#include <span>

#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/egl_context.h"
#include "tileserver/gpu/tile_windows.h"
#include "tileserver/gpu/x11_visual.h"

namespace wall::tileserver {
namespace {

constexpr EGLint kMaxConfigs = 512;

class EglX11Backend final : public GlBackend {
public:
    EglX11Backend(std::unique_ptr<X11Display> x, EGLDisplay display) : x_(std::move(x)), display_(display) {}
    ~EglX11Backend() override {
        windows_.reset();
        if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }
    Result<void> open(const WindowRequest& request);
    /// A window is current from the start, so that the context begins with a default framebuffer.
    Result<void> make_current() override { return windows_->select(0); }
    void* get_proc_address(const char* name) const override { return reinterpret_cast<void*>(eglGetProcAddress(name)); }
    std::string_view name() const override { return "egl"; }
    TileScreens* screens() override { return windows_.get(); }

private:
    std::unique_ptr<X11Display> x_;  // to the end
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
    std::unique_ptr<TileWindows> windows_;
};

EGLint attribute(EGLDisplay display, EGLConfig config, EGLint name) {
    EGLint value = 0;
    eglGetConfigAttrib(display, config, name, &value);
    return value;
}

/// Windows of 8 bits a channel, best of the screen's own visual. Null: there is none.
EGLConfig find_config(Display* x, EGLDisplay display) {
    constexpr std::array kWanted = {EGL_SURFACE_TYPE,
                                    EGL_WINDOW_BIT,
                                    EGL_RENDERABLE_TYPE,
                                    EGL_OPENGL_BIT,
                                    EGL_RED_SIZE,
                                    8,
                                    EGL_GREEN_SIZE,
                                    8,
                                    EGL_BLUE_SIZE,
                                    8,
                                    EGL_NONE};
    std::array<EGLConfig, kMaxConfigs> configs{};
    EGLint count = 0;
    if (eglChooseConfig(display, kWanted.data(), configs.data(), kMaxConfigs, &count) == EGL_FALSE) return nullptr;
    EGLConfig found = nullptr;
    const VisualID preferred = XVisualIDFromVisual(DefaultVisual(x, DefaultScreen(x)));
    for (const EGLConfig config : std::span(configs).first(static_cast<std::size_t>(count))) {
        const auto visual = static_cast<VisualID>(attribute(display, config, EGL_NATIVE_VISUAL_ID));
        const bool plain =
            attribute(display, config, EGL_RED_SIZE) == 8 && attribute(display, config, EGL_SAMPLES) == 0;
        if (!plain || true_color_visual(x, visual, kWindowDepth) == nullptr) continue;
        if (visual == preferred) return config;
        if (found == nullptr) found = config;
    }
    return found;
}

Result<void> EglX11Backend::open(const WindowRequest& request) {
    const std::string where = "the X display \"" + x_->name() + "\"";
    context_ = create_egl_context(display_);
    if (context_ == EGL_NO_CONTEXT)
        return fail("EGL offers no OpenGL 4.5 compatibility context on " + where + " (" +
                    egl_error("eglCreateContext") + ")");
    const EGLConfig config = find_config(x_->get(), display_);
    if (config == nullptr)
        return fail(where + " has no visual of " + std::to_string(kWindowDepth) + " bits a pixel that EGL can draw to");
    const WindowLook look{static_cast<unsigned long>(attribute(display_, config, EGL_NATIVE_VISUAL_ID)),
                          request.background};
    auto windows = TileWindows::open(*x_, {display_, config, context_}, request, look);
    if (!windows) return tl::unexpected(windows.error());
    windows_ = std::move(*windows);
    x_->suspend_screen_saver();
    return x_->check_requests("to suspend its screen saver");
}

}  // namespace

Result<std::unique_ptr<GlBackend>> open_window_backend(const WindowRequest& request) {
    auto x = X11Display::open(request.display);
    if (!x) return tl::unexpected(x.error());
    const char* known = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!has_word(known, "EGL_KHR_platform_x11") && !has_word(known, "EGL_EXT_platform_x11"))
        return fail("EGL cannot draw to X windows here (it lacks EGL_KHR_platform_x11)");
    const std::array<EGLAttrib, 3> screen = {EGL_PLATFORM_X11_SCREEN_KHR, DefaultScreen((*x)->get()), EGL_NONE};
    const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, (*x)->get(), screen.data());
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
        return fail("EGL cannot use the X display \"" + (*x)->name() + "\" (" + egl_error("eglInitialize") + ")");
    auto backend = std::make_unique<EglX11Backend>(std::move(*x), display);
    if (auto opened = backend->open(request); !opened) return tl::unexpected(opened.error());
    return backend;
}

}  // namespace wall::tileserver
