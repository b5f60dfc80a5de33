// SPDX-License-Identifier: MIT
// EGL's objects. A handle is the address of one of these; every handle that comes in is looked up, since programs pass
// stale and unset ones. Any thread.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "client_lib/context/core.h"
#include "client_lib/vendor/x_connection.h"

namespace wall::client::egl {

enum class Platform { x11, xcb, surfaceless, device };  // the last two have no windows

struct Config {
    EGLint id = 0;
    SurfaceFormat format;
    std::uint32_t visual = 0;  ///< 0: not for windows
    EGLConfig handle() const { return const_cast<Config*>(this); }
};

enum class SurfaceKind { window, pbuffer, pixmap };

struct EglSurface {
    SurfaceKind kind = SurfaceKind::window;
    const Config* config = nullptr;
    std::uint32_t native = 0;  ///< X id of a window or pixmap
    std::shared_ptr<vendor::XConnection> connection;
    std::shared_ptr<ClientSurface> core;
    Extent size;  ///< pbuffer, pixmap
    bool single_buffered = false;
    bool srgb = false;  ///< EGL_GL_COLORSPACE_SRGB
    EGLint swap_behavior = EGL_BUFFER_DESTROYED;
    EGLint swap_interval = 1;

    Extent size_now() const;
};

struct EglContext {
    std::shared_ptr<Context> core;
    const Config* config = nullptr;
    EGLenum api = EGL_OPENGL_API;
    EGLint major = 1;                        ///< as it was asked for
    std::shared_ptr<EglSurface> draw, read;  ///< while current; null without one
    std::shared_ptr<ClientSurface> nothing;  ///< what the core has in place of no surface
    bool current = false;                    ///< in some thread
};

struct EglSync {
    bool signaled = false;
};

class EglDisplay {
public:
    EglDisplay(Platform platform, void* native, int screen) : platform_(platform), native_(native), screen_(screen) {}

    Platform platform() const { return platform_; }
    EGLDisplay handle() { return this; }
    /// Opens X if the program named no display, and makes the configurations. False: there is no X server.
    bool initialize();
    bool initialized() const { return initialized_; }
    /// All handles become invalid; what is current lives until it is released.
    void terminate();

    const std::shared_ptr<vendor::XConnection>& connection() const { return connection_; }
    const std::vector<std::unique_ptr<Config>>& configs() const { return configs_; }
    /// These answer null for a handle that is none of this display's.
    const Config* config(EGLConfig handle) const;
    std::shared_ptr<EglSurface> surface(EGLSurface handle) const;
    std::shared_ptr<EglContext> context(EGLContext handle) const;
    std::shared_ptr<EglSync> sync(EGLSync handle) const;

    EGLSurface add(std::shared_ptr<EglSurface> surface);
    EGLContext add(std::shared_ptr<EglContext> context);
    EGLSync add(std::shared_ptr<EglSync> sync);
    bool remove_surface(EGLSurface handle);
    bool remove_context(EGLContext handle);
    bool remove_sync(EGLSync handle);
    bool has_window(std::uint32_t window) const;

    /// True for the same display that the program names again.
    bool is(Platform platform, const void* native, int screen) const {
        return platform == platform_ && native == native_ && screen == screen_;
    }

private:
    template <class T>
    using Handles = std::unordered_map<const void*, std::shared_ptr<T>>;
    xcb_screen_t* open_screen();
    void make_configs(std::uint32_t opaque_visual, std::uint32_t argb_visual);

    const Platform platform_;
    void* const native_;
    const int screen_;  ///< -1: the display's default
    std::shared_ptr<vendor::XConnection> connection_;
    std::vector<std::unique_ptr<Config>> configs_;
    bool initialized_ = false;

    mutable std::mutex mutex_;  // guards what follows
    Handles<EglSurface> surfaces_;
    Handles<EglContext> contexts_;
    Handles<EglSync> syncs_;
};

/// The display of these arguments, made at the first call; lives for ever, as EGL says.
EglDisplay* find_or_make_display(Platform platform, void* native, int screen);
/// Null if the handle is none of ours.
EglDisplay* find_display(EGLDisplay handle);

/// eglGetConfigAttrib's answer; nothing for an unknown attribute.
std::optional<EGLint> attribute(const Config& config, EGLint name);
/// As eglChooseConfig, best first; nothing if an attribute is unknown.
std::optional<std::vector<const Config*>> choose_configs(const EglDisplay& display, const EGLint* attributes);

}  // namespace wall::client::egl
