// SPDX-License-Identifier: MIT
// EGL 1.5 for programs. Application threads; each has its own last error and current context.
#include "client_lib/vendor/egl/functions.h"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "client_lib/process/log.h"
#include "client_lib/process/process.h"
#include "client_lib/process/stats.h"
#include "client_lib/vendor/config_matrix.h"
#include "client_lib/vendor/egl/display.h"
#include "client_lib/vendor/guarded.h"

namespace wall::client::egl {
namespace {

using vendor::guarded;
using vendor::XConnection;

constexpr const char* kVendor = "WallGL";
constexpr const char* kVersion = "1.5 WallGL";
constexpr const char* kClientExtensions =
    "EGL_EXT_client_extensions EGL_EXT_device_base EGL_EXT_device_enumeration EGL_EXT_device_query "
    "EGL_EXT_platform_base EGL_EXT_platform_device EGL_KHR_client_get_all_proc_addresses EGL_KHR_platform_x11 "
    "EGL_EXT_platform_x11 EGL_EXT_platform_xcb EGL_MESA_platform_surfaceless";
constexpr const char* kClientApis = "OpenGL OpenGL_ES";
constexpr const char* kDisplayExtensions =
    "EGL_EXT_create_context_robustness EGL_KHR_create_context EGL_KHR_get_all_proc_addresses "
    "EGL_KHR_gl_colorspace EGL_KHR_no_config_context EGL_KHR_surfaceless_context";

constinit std::atomic<const __EGLapiExports*> glvnd{nullptr};
constinit std::mutex current_mutex;  // guards EglContext::current
/// The thread's context. Not destroyed at exit(): programs still draw in their own exit handlers.
constinit thread_local std::shared_ptr<EglContext>* current_slot = nullptr;
thread_local EGLint last_error = EGL_SUCCESS;

const std::shared_ptr<EglContext>& thread_context() {
    static const std::shared_ptr<EglContext>& none = *new std::shared_ptr<EglContext>;
    return current_slot ? *current_slot : none;
}

/// Sets the thread's error and answers `result`.
template <class R>
R refuse(EGLint error, R result) {
    log(LogLevel::debug, "egl_error code=0x%x", static_cast<unsigned>(error));
    last_error = error;
    return result;
}
EGLBoolean refuse(EGLint error) { return refuse(error, EGLBoolean{EGL_FALSE}); }

template <class R>
R succeed(R result) {
    last_error = EGL_SUCCESS;
    return result;
}
EGLBoolean succeed() { return succeed(EGLBoolean{EGL_TRUE}); }

/// The initialized display; null, and the error is set, if it is none.
EglDisplay* display_of(EGLDisplay handle) {
    auto* display = find_display(handle);
    if (!display) return refuse(EGL_BAD_DISPLAY, display);
    if (!display->initialized()) return refuse(EGL_NOT_INITIALIZED, static_cast<EglDisplay*>(nullptr));
    return display;
}

struct Attribute {
    EGLint name;
    EGLAttrib value;
};

template <class T>
std::vector<Attribute> read_list(const T* list) {
    std::vector<Attribute> attributes;
    for (const T* a = list; a && *a != EGL_NONE; a += 2) attributes.push_back({static_cast<EGLint>(a[0]), a[1]});
    return attributes;
}

// ---- displays and configurations ----

EGLBoolean initialize(EGLDisplay handle, EGLint* major, EGLint* minor) {
    return guarded("eglInitialize", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = find_display(handle);
        if (!display) return refuse(EGL_BAD_DISPLAY);
        if (!display->initialize()) return refuse(EGL_NOT_INITIALIZED);
        if (major) *major = 1;
        if (minor) *minor = 5;
        return succeed();
    });
}

EGLBoolean terminate(EGLDisplay handle) {
    return guarded("eglTerminate", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = find_display(handle);
        if (!display) return refuse(EGL_BAD_DISPLAY);
        display->terminate();
        return succeed();
    });
}

const char* query_string(EGLDisplay handle, EGLint name) {
    if (handle == EGL_NO_DISPLAY) {
        if (name == EGL_EXTENSIONS) return succeed(kClientExtensions);
        if (name == EGL_VERSION) return succeed(kVersion);
        return refuse(EGL_BAD_DISPLAY, static_cast<const char*>(nullptr));
    }
    if (!display_of(handle)) return nullptr;
    switch (name) {
        case EGL_VENDOR: return succeed(kVendor);
        case EGL_VERSION: return succeed(kVersion);
        case EGL_EXTENSIONS: return succeed(kDisplayExtensions);
        case EGL_CLIENT_APIS: return succeed(kClientApis);
        default: return refuse(EGL_BAD_PARAMETER, static_cast<const char*>(nullptr));
    }
}

EGLint get_error() { return std::exchange(last_error, EGL_SUCCESS); }

EGLBoolean give_configs(std::span<const Config* const> found, EGLConfig* configs, EGLint room, EGLint* count) {
    if (!count) return refuse(EGL_BAD_PARAMETER);
    *count = static_cast<EGLint>(found.size());
    if (configs) {
        *count = std::clamp(room, 0, *count);
        for (EGLint i = 0; i < *count; ++i) configs[i] = found[static_cast<std::size_t>(i)]->handle();
    }
    return succeed();
}

EGLBoolean get_configs(EGLDisplay handle, EGLConfig* configs, EGLint room, EGLint* count) {
    return guarded("eglGetConfigs", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        std::vector<const Config*> all;
        for (const auto& config : display->configs()) all.push_back(config.get());
        return give_configs(all, configs, room, count);
    });
}

EGLBoolean choose_config(EGLDisplay handle, const EGLint* list, EGLConfig* configs, EGLint room, EGLint* count) {
    return guarded("eglChooseConfig", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto found = choose_configs(*display, list);
        if (!found) return refuse(EGL_BAD_ATTRIBUTE);
        return give_configs(*found, configs, room, count);
    });
}

EGLBoolean get_config_attrib(EGLDisplay handle, EGLConfig config_handle, EGLint name, EGLint* value) {
    return guarded("eglGetConfigAttrib", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const Config* config = display->config(config_handle);
        if (!config) return refuse(EGL_BAD_CONFIG);
        const auto found = attribute(*config, name);
        if (!found || !value) return refuse(found ? EGL_BAD_PARAMETER : EGL_BAD_ATTRIBUTE);
        *value = *found;
        return succeed();
    });
}

// ---- devices: there is one, the wall (EGL_EXT_device_base) ----

constexpr const char* kDeviceExtensions = "EGL_EXT_device_query_name";

EGLDeviceEXT the_device() {
    static char device;
    return &device;
}

EGLBoolean query_devices(EGLint room, EGLDeviceEXT* devices, EGLint* count) {
    if (!count || (devices && room <= 0)) return refuse(EGL_BAD_PARAMETER);
    if (devices) devices[0] = the_device();
    *count = 1;
    return succeed();
}

EGLBoolean query_device_attrib(EGLDeviceEXT device, EGLint, EGLAttrib*) {
    return refuse(device == the_device() ? EGL_BAD_ATTRIBUTE : EGL_BAD_DEVICE_EXT);
}

const char* query_device_string(EGLDeviceEXT device, EGLint name) {
    constexpr const char* kNone = nullptr;
    if (device != the_device()) return refuse(EGL_BAD_DEVICE_EXT, kNone);
    switch (name) {
        case EGL_EXTENSIONS: return succeed(kDeviceExtensions);
        case EGL_VENDOR:
        case EGL_RENDERER_EXT: return succeed(kVendor);
        default: return refuse(EGL_BAD_PARAMETER, kNone);
    }
}

EGLBoolean query_display_attrib(EGLDisplay handle, EGLint name, EGLAttrib* value) {
    if (!display_of(handle)) return EGL_FALSE;
    if (name != EGL_DEVICE_EXT) return refuse(EGL_BAD_ATTRIBUTE);
    if (!value) return refuse(EGL_BAD_PARAMETER);
    *value = reinterpret_cast<EGLAttrib>(the_device());
    return succeed();
}

// ---- surfaces ----

/// False, and the error is set, for an attribute that a surface cannot have.
bool set_attributes(const std::vector<Attribute>& attributes, EglSurface& surface) {
    bool largest = false;
    for (const auto& [name, value] : attributes) {
        switch (name) {
            case EGL_RENDER_BUFFER: surface.single_buffered = value == EGL_SINGLE_BUFFER; break;
            case EGL_WIDTH:
            case EGL_HEIGHT:
                if (value < 0) return refuse(EGL_BAD_PARAMETER, false);
                (name == EGL_WIDTH ? surface.size.width : surface.size.height) = static_cast<std::uint32_t>(value);
                break;
            case EGL_LARGEST_PBUFFER: largest = value; break;
            case EGL_TEXTURE_FORMAT:
            case EGL_TEXTURE_TARGET:
                if (value != EGL_NO_TEXTURE) return refuse(EGL_BAD_MATCH, false);
                break;
            case EGL_GL_COLORSPACE:
                if (value != EGL_GL_COLORSPACE_LINEAR && value != EGL_GL_COLORSPACE_SRGB)
                    return refuse(EGL_BAD_MATCH, false);
                surface.srgb = value == EGL_GL_COLORSPACE_SRGB;
                break;
            case EGL_MIPMAP_TEXTURE:
            case EGL_VG_COLORSPACE:
            case EGL_VG_ALPHA_FORMAT: break;
            default: return refuse(EGL_BAD_ATTRIBUTE, false);
        }
    }
    constexpr std::uint32_t limit = vendor::kMaxPbufferExtent;
    if (!largest && (surface.size.width > limit || surface.size.height > limit)) return refuse(EGL_BAD_ALLOC, false);
    surface.size.width = std::clamp(surface.size.width, 1u, limit);
    surface.size.height = std::clamp(surface.size.height, 1u, limit);
    return true;
}

EGLSurface create_window(EGLDisplay handle, EGLConfig config_handle, std::uint32_t window,
                         const std::vector<Attribute>& attributes) {
    auto* display = display_of(handle);
    if (!display) return EGL_NO_SURFACE;
    const Config* config = display->config(config_handle);
    if (!config) return refuse(EGL_BAD_CONFIG, EGL_NO_SURFACE);
    if (config->visual == 0) return refuse(EGL_BAD_MATCH, EGL_NO_SURFACE);
    auto surface = std::make_shared<EglSurface>();
    if (!set_attributes(attributes, *surface)) return EGL_NO_SURFACE;
    const auto size = display->connection()->size_of(window);
    if (!size) return refuse(EGL_BAD_NATIVE_WINDOW, EGL_NO_SURFACE);
    if (display->has_window(window)) return refuse(EGL_BAD_ALLOC, EGL_NO_SURFACE);
    surface->config = config;
    surface->native = window;
    surface->connection = display->connection();
    auto format = config->format;
    format.double_buffered = !surface->single_buffered;
    format.srgb = surface->srgb;
    surface->core = create_surface(vendor::window_surface(surface->connection, window, *size, format));
    return succeed(display->add(std::move(surface)));
}

EGLSurface create_offscreen(EGLDisplay handle, EGLConfig config_handle, std::shared_ptr<EglSurface> surface) {
    auto* display = find_display(handle);
    surface->config = display->config(config_handle);
    if (!surface->config) return refuse(EGL_BAD_CONFIG, EGL_NO_SURFACE);
    SurfaceOptions options;
    options.format = surface->config->format;
    options.format.srgb = surface->srgb;
    options.visible = false;
    options.size = surface->size;
    // EGL draws pbuffers and pixmaps in one buffer; the core's back buffer is that one, read and drawn alike.
    surface->core = create_surface(std::move(options));
    return succeed(display->add(std::move(surface)));
}

EGLSurface create_window_surface(EGLDisplay display, EGLConfig config, EGLNativeWindowType window, const EGLint* list) {
    return guarded("eglCreateWindowSurface", EGL_NO_SURFACE,
                   [&] { return create_window(display, config, static_cast<std::uint32_t>(window), read_list(list)); });
}

/// A platform's native handle is passed by address: Window* for X11, xcb_window_t* for XCB.
std::uint32_t native_id(const EglDisplay& display, const void* native) {
    if (display.platform() == Platform::xcb) return *static_cast<const std::uint32_t*>(native);
    return static_cast<std::uint32_t>(*static_cast<const unsigned long*>(native));
}

template <class T>
EGLSurface create_platform_window_surface(EGLDisplay handle, EGLConfig config, void* native, const T* list) {
    return guarded("eglCreatePlatformWindowSurface", EGL_NO_SURFACE, [&]() -> EGLSurface {
        auto* display = display_of(handle);
        if (!display) return EGL_NO_SURFACE;
        if (!native) return refuse(EGL_BAD_NATIVE_WINDOW, EGL_NO_SURFACE);
        return create_window(handle, config, native_id(*display, native), read_list(list));
    });
}

EGLSurface create_pbuffer_surface(EGLDisplay handle, EGLConfig config, const EGLint* list) {
    return guarded("eglCreatePbufferSurface", EGL_NO_SURFACE, [&]() -> EGLSurface {
        if (!display_of(handle)) return EGL_NO_SURFACE;
        auto surface = std::make_shared<EglSurface>();
        surface->kind = SurfaceKind::pbuffer;
        if (!set_attributes(read_list(list), *surface)) return EGL_NO_SURFACE;
        return create_offscreen(handle, config, std::move(surface));
    });
}

// The X pixmap's own pixels are not touched: what is drawn can be read back with glReadPixels only.
EGLSurface create_pixmap(EGLDisplay handle, EGLConfig config, std::uint32_t pixmap,
                         const std::vector<Attribute>& attributes) {
    auto* display = display_of(handle);
    if (!display) return EGL_NO_SURFACE;
    const auto size = display->connection() ? display->connection()->size_of(pixmap) : std::nullopt;
    if (!size) return refuse(EGL_BAD_NATIVE_PIXMAP, EGL_NO_SURFACE);
    auto surface = std::make_shared<EglSurface>();
    surface->kind = SurfaceKind::pixmap;
    if (!set_attributes(attributes, *surface)) return EGL_NO_SURFACE;
    surface->native = pixmap;
    surface->size = *size;
    return create_offscreen(handle, config, std::move(surface));
}

EGLSurface create_pixmap_surface(EGLDisplay display, EGLConfig config, EGLNativePixmapType pixmap, const EGLint* list) {
    return guarded("eglCreatePixmapSurface", EGL_NO_SURFACE,
                   [&] { return create_pixmap(display, config, static_cast<std::uint32_t>(pixmap), read_list(list)); });
}

template <class T>
EGLSurface create_platform_pixmap_surface(EGLDisplay handle, EGLConfig config, void* native, const T* list) {
    return guarded("eglCreatePlatformPixmapSurface", EGL_NO_SURFACE, [&]() -> EGLSurface {
        auto* display = display_of(handle);
        if (!display) return EGL_NO_SURFACE;
        if (!native) return refuse(EGL_BAD_NATIVE_PIXMAP, EGL_NO_SURFACE);
        return create_pixmap(handle, config, native_id(*display, native), read_list(list));
    });
}

EGLSurface create_pbuffer_from_client_buffer(EGLDisplay, EGLenum, EGLClientBuffer, EGLConfig, const EGLint*) {
    return refuse(EGL_BAD_PARAMETER, EGL_NO_SURFACE);  // OpenVG only
}

EGLBoolean destroy_surface(EGLDisplay handle, EGLSurface surface) {
    return guarded("eglDestroySurface", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        return display->remove_surface(surface) ? succeed() : refuse(EGL_BAD_SURFACE);
    });
}

std::optional<EGLint> surface_attribute(const EglSurface& surface, EGLint name) {
    switch (name) {
        case EGL_WIDTH: return static_cast<EGLint>(surface.size_now().width);
        case EGL_HEIGHT: return static_cast<EGLint>(surface.size_now().height);
        case EGL_CONFIG_ID: return surface.config->id;
        case EGL_LARGEST_PBUFFER: return EGL_FALSE;
        case EGL_TEXTURE_FORMAT:
        case EGL_TEXTURE_TARGET: return EGL_NO_TEXTURE;
        case EGL_MIPMAP_TEXTURE:
        case EGL_MIPMAP_LEVEL: return 0;
        case EGL_RENDER_BUFFER: return surface.single_buffered ? EGL_SINGLE_BUFFER : EGL_BACK_BUFFER;
        case EGL_SWAP_BEHAVIOR: return surface.swap_behavior;
        case EGL_MULTISAMPLE_RESOLVE: return EGL_MULTISAMPLE_RESOLVE_DEFAULT;
        case EGL_HORIZONTAL_RESOLUTION:
        case EGL_VERTICAL_RESOLUTION: return EGL_UNKNOWN;
        case EGL_PIXEL_ASPECT_RATIO: return EGL_DISPLAY_SCALING;
        case EGL_GL_COLORSPACE: return surface.srgb ? EGL_GL_COLORSPACE_SRGB : EGL_GL_COLORSPACE_LINEAR;
        case EGL_VG_COLORSPACE: return EGL_VG_COLORSPACE_sRGB;
        case EGL_VG_ALPHA_FORMAT: return EGL_VG_ALPHA_FORMAT_NONPRE;
        default: return std::nullopt;
    }
}

EGLBoolean query_surface(EGLDisplay handle, EGLSurface surface_handle, EGLint name, EGLint* value) {
    return guarded("eglQuerySurface", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto surface = display->surface(surface_handle);
        if (!surface) return refuse(EGL_BAD_SURFACE);
        const auto found = surface_attribute(*surface, name);
        if (!found) return refuse(EGL_BAD_ATTRIBUTE);
        if (value) *value = *found;
        return succeed();
    });
}

EGLBoolean surface_attrib(EGLDisplay handle, EGLSurface surface_handle, EGLint name, EGLint value) {
    return guarded("eglSurfaceAttrib", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto surface = display->surface(surface_handle);
        if (!surface) return refuse(EGL_BAD_SURFACE);
        if (name == EGL_SWAP_BEHAVIOR) surface->swap_behavior = value;
        else if (name != EGL_MIPMAP_LEVEL && name != EGL_MULTISAMPLE_RESOLVE) return refuse(EGL_BAD_ATTRIBUTE);
        return succeed();
    });
}

EGLBoolean bind_tex_image(EGLDisplay, EGLSurface, EGLint) { return refuse(EGL_BAD_SURFACE); }

EGLBoolean swap(EGLDisplay handle, EGLSurface surface_handle) {
    return guarded("eglSwapBuffers", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto surface = display->surface(surface_handle);
        if (!surface) return refuse(EGL_BAD_SURFACE);
        if (surface->kind != SurfaceKind::window || surface->single_buffered) flush_current(false);
        else swap_buffers(*surface->core);
        return succeed();
    });
}

EGLBoolean copy_buffers(EGLDisplay, EGLSurface, EGLNativePixmapType) {
    return guarded("eglCopyBuffers", EGLBoolean{EGL_FALSE}, [] {
        if (stats().count_unsupported("eglCopyBuffers")) log(LogLevel::warn, "unsupported function=eglCopyBuffers");
        return refuse(EGL_BAD_NATIVE_PIXMAP);
    });
}

EGLBoolean swap_interval(EGLDisplay handle, EGLint interval) {
    return guarded("eglSwapInterval", EGLBoolean{EGL_FALSE}, [&] {
        if (!display_of(handle)) return EGLBoolean{EGL_FALSE};
        const auto& current = thread_context();
        if (!current) return refuse(EGL_BAD_CONTEXT);
        if (!current->draw) return refuse(EGL_BAD_SURFACE);
        current->draw->swap_interval = std::clamp(interval, 0, 1);
        return succeed();
    });
}

// ---- contexts ----

/// What eglCreateContext asks for, or the error.
struct ContextWish {
    ContextOptions options;
    EGLAttrib profile = EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT;
    EGLint error = EGL_SUCCESS;
};

/// False: one of them is unknown, or none of OpenGL ES.
bool read_context_flags(EGLAttrib flags, ContextOptions& o) {
    constexpr EGLAttrib kCommon = EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR;
    constexpr EGLAttrib kDesktop =
        kCommon | EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR | EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR;
    o.robust = flags & EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR;
    o.debug = flags & EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR;
    o.forward_compatible = flags & EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR;
    return (flags & ~(o.es ? kCommon : kDesktop)) == 0;
}

/// The words of desktop contexts, those of OpenGL ES and those of both (EGL 1.5, 3.7.1.1; EGL_KHR_create_context,
/// EGL_EXT_create_context_robustness).
bool read_context_attribute(const Attribute& attribute, ContextWish& wish) {
    auto& o = wish.options;
    const EGLAttrib value = attribute.value;
    switch (attribute.name) {
        case EGL_CONTEXT_MAJOR_VERSION: o.major = static_cast<int>(value); return true;
        case EGL_CONTEXT_MINOR_VERSION: o.minor = static_cast<int>(value); return true;
        case EGL_CONTEXT_OPENGL_PROFILE_MASK: wish.profile = value; return !o.es;
        case EGL_CONTEXT_OPENGL_DEBUG: o.debug = value; return true;
        case EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE: o.forward_compatible = value; return !o.es;
        case EGL_CONTEXT_FLAGS_KHR: return read_context_flags(value, o);
        case EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY:
        case EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT:
            o.notifies_of_resets = value == EGL_LOSE_CONTEXT_ON_RESET;
            return o.notifies_of_resets || value == EGL_NO_RESET_NOTIFICATION;
        case EGL_CONTEXT_OPENGL_ROBUST_ACCESS:
        case EGL_CONTEXT_OPENGL_ROBUST_ACCESS_EXT: o.robust = value; return true;
        case EGL_CONTEXT_PRIORITY_LEVEL_IMG: return true;  // a hint
        default: return false;
    }
}

/// Whether what is asked for exists at all: a version, a profile.
bool is_possible(const ContextWish& wish) {
    const auto& o = wish.options;
    if (o.es) return o.major > 0 && o.minor >= 0;
    static constexpr int kLastMinor[] = {5, 1, 3, 6};  // of 1.x, 2.x, 3.x, 4.x
    if (o.major < 1 || o.major > 4 || o.minor < 0 || o.minor > kLastMinor[o.major - 1]) return false;
    const bool has_profiles = o.major * 10 + o.minor >= 32;
    const bool profile = o.core_profile || wish.profile == EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT;
    return (!has_profiles || profile) && (!o.forward_compatible || o.major >= 3);
}

ContextWish read_context_attributes(const EGLint* list, bool es) {
    ContextWish wish;
    wish.options.es = es;
    // Nothing behind the first mistake is looked at: there may be no end of the list.
    for (const EGLint* a = list; a && *a != EGL_NONE && wish.error == EGL_SUCCESS; a += 2)
        if (!read_context_attribute({a[0], a[1]}, wish)) wish.error = EGL_BAD_ATTRIBUTE;
    auto& o = wish.options;
    o.core_profile = !es && o.major * 10 + o.minor >= 32 && wish.profile == EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT;
    if (wish.error == EGL_SUCCESS && !is_possible(wish)) wish.error = EGL_BAD_MATCH;
    return wish;
}

/// The context to share with; null and an error: it is none, or one of another API (EGL 1.5, 3.7.1).
std::shared_ptr<EglContext> find_sharing(const EglDisplay& display, EGLContext handle, EGLenum api) {
    auto context = display.context(handle);
    if (context && context->api == api) return context;
    return refuse(EGL_BAD_CONTEXT, std::shared_ptr<EglContext>());
}

EGLContext refuse_version(const ContextOptions& options) {
    if (options.es && stats().count_unsupported("OpenGL ES context"))
        log(LogLevel::warn, "unsupported feature=opengl_es_context version=%d.%d", options.major, options.minor);
    return refuse(EGL_BAD_MATCH, EGL_NO_CONTEXT);
}

EGLContext create_context_handle(EGLDisplay handle, EGLConfig config_handle, EGLContext share, const EGLint* list) {
    return guarded("eglCreateContext", EGL_NO_CONTEXT, [&]() -> EGLContext {
        auto* display = display_of(handle);
        if (!display) return EGL_NO_CONTEXT;
        const Config* config = display->config(config_handle);
        if (!config && config_handle != EGL_NO_CONFIG_KHR) return refuse(EGL_BAD_CONFIG, EGL_NO_CONTEXT);
        const EGLenum api = glvnd.load()->getCurrentApi();
        auto wish = read_context_attributes(list, api == EGL_OPENGL_ES_API);
        if (wish.error != EGL_SUCCESS) return refuse(wish.error, EGL_NO_CONTEXT);
        std::shared_ptr<EglContext> sharing;
        if (share != EGL_NO_CONTEXT && !(sharing = find_sharing(*display, share, api))) return EGL_NO_CONTEXT;
        if (sharing) wish.options.share = sharing->core.get();
        auto core = client::create_context(wish.options);
        if (!core) return refuse_version(wish.options);
        auto context = std::make_shared<EglContext>();
        context->api = api;
        context->core = std::move(core);
        context->config = config;
        context->major = wish.options.major;
        return succeed(display->add(std::move(context)));
    });
}

EGLBoolean destroy_context_handle(EGLDisplay handle, EGLContext context) {
    return guarded("eglDestroyContext", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        return display->remove_context(context) ? succeed() : refuse(EGL_BAD_CONTEXT);
    });
}

/// The thread's context is not current any more.
void let_go() {
    const std::unique_ptr<std::shared_ptr<EglContext>> slot(std::exchange(current_slot, nullptr));
    if (!slot) return;
    auto& context = **slot;
    context.draw = context.read = nullptr;
    std::lock_guard lock(current_mutex);
    context.current = false;
}

void thread_ends() {
    client::make_current(nullptr, nullptr, nullptr);
    let_go();
}

EGLBoolean release() {
    thread_ends();
    return succeed();
}

/// EGL_KHR_surfaceless_context.
std::shared_ptr<ClientSurface> no_surface() {
    SurfaceOptions options;
    options.visible = false;
    options.stands_for_none = true;
    options.size = {1, 1};
    return create_surface(std::move(options));
}

EGLBoolean bind(const std::shared_ptr<EglContext>& context, std::shared_ptr<EglSurface> draw,
                std::shared_ptr<EglSurface> read) {
    const bool again = context == thread_context();
    {
        std::lock_guard lock(current_mutex);
        if (context->current && !again) return refuse(EGL_BAD_ACCESS);
        context->current = true;
    }
    const auto give_up = [&] {
        if (!again) {
            std::lock_guard lock(current_mutex);
            context->current = false;
        }
        let_go();
    };
    try {
        if (!draw && !context->nothing) context->nothing = no_surface();
        if (!client::make_current(context->core, draw ? draw->core : context->nothing,
                                  read ? read->core : context->nothing)) {
            give_up();
            return refuse(EGL_BAD_ALLOC);  // the wall cannot be reached
        }
    } catch (...) {
        if (!again) give_up();
        throw;
    }
    if (!again) {
        let_go();
        current_slot = new std::shared_ptr<EglContext>(context);
        at_thread_end(thread_ends);
    }
    context->draw = std::move(draw);
    context->read = std::move(read);
    return succeed();
}

EGLBoolean make_current_handles(EGLDisplay handle, EGLSurface draw, EGLSurface read, EGLContext context_handle) {
    return guarded("eglMakeCurrent", EGLBoolean{EGL_FALSE}, [&] {
        if (context_handle == EGL_NO_CONTEXT) {
            if (draw != EGL_NO_SURFACE || read != EGL_NO_SURFACE) return refuse(EGL_BAD_MATCH);
            return find_display(handle) ? release() : refuse(EGL_BAD_DISPLAY);
        }
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto context = display->context(context_handle);
        if (!context) return refuse(EGL_BAD_CONTEXT);
        if (draw == EGL_NO_SURFACE && read == EGL_NO_SURFACE) return egl::bind(context, nullptr, nullptr);
        if (draw == EGL_NO_SURFACE || read == EGL_NO_SURFACE) return refuse(EGL_BAD_MATCH);
        auto to = display->surface(draw), from = display->surface(read);
        if (!to || !from) return refuse(EGL_BAD_SURFACE);
        return bind(context, std::move(to), std::move(from));
    });
}

EGLBoolean release_thread() {
    return guarded("eglReleaseThread", EGLBoolean{EGL_FALSE}, [] { return thread_context() ? release() : succeed(); });
}

EGLBoolean query_context(EGLDisplay handle, EGLContext context_handle, EGLint name, EGLint* value) {
    return guarded("eglQueryContext", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto context = display->context(context_handle);
        if (!context) return refuse(EGL_BAD_CONTEXT);
        switch (name) {
            case EGL_CONFIG_ID: *value = context->config ? context->config->id : 0; break;
            case EGL_CONTEXT_CLIENT_TYPE: *value = static_cast<EGLint>(context->api); break;
            case EGL_CONTEXT_CLIENT_VERSION: *value = context->major; break;
            case EGL_RENDER_BUFFER:
                *value = context->draw ? *surface_attribute(*context->draw, EGL_RENDER_BUFFER) : EGL_NONE;
                break;
            default: return refuse(EGL_BAD_ATTRIBUTE);
        }
        return succeed();
    });
}

EGLBoolean wait_client() {
    return guarded("eglWaitClient", EGLBoolean{EGL_FALSE}, [] {
        flush_current(false);
        return succeed();
    });
}

EGLBoolean wait_native(EGLint) { return succeed(); }

// ---- sync objects: everything before one is drawn when a wait for it returns ----

EGLSync create_sync(EGLDisplay handle, EGLenum type, const EGLAttrib*) {
    return guarded("eglCreateSync", EGL_NO_SYNC, [&]() -> EGLSync {
        auto* display = display_of(handle);
        if (!display) return EGL_NO_SYNC;
        if (type != EGL_SYNC_FENCE) return refuse(EGL_BAD_ATTRIBUTE, EGL_NO_SYNC);
        if (!thread_context()) return refuse(EGL_BAD_MATCH, EGL_NO_SYNC);
        return succeed(display->add(std::make_shared<EglSync>()));
    });
}

EGLBoolean destroy_sync(EGLDisplay handle, EGLSync sync) {
    return guarded("eglDestroySync", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        return display->remove_sync(sync) ? succeed() : refuse(EGL_BAD_PARAMETER);
    });
}

EGLint client_wait_sync(EGLDisplay handle, EGLSync sync_handle, EGLint, EGLTime) {
    return guarded("eglClientWaitSync", EGLint{EGL_FALSE}, [&]() -> EGLint {
        auto* display = display_of(handle);
        if (!display) return EGL_FALSE;
        const auto sync = display->sync(sync_handle);
        if (!sync) return refuse(EGL_BAD_PARAMETER, EGLint{EGL_FALSE});
        if (!sync->signaled) flush_current(true);
        sync->signaled = true;
        return succeed(EGLint{EGL_CONDITION_SATISFIED});
    });
}

EGLBoolean wait_sync(EGLDisplay handle, EGLSync sync, EGLint) {
    return guarded("eglWaitSync", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        return display->sync(sync) ? succeed() : refuse(EGL_BAD_PARAMETER);  // commands run in order anyway
    });
}

EGLBoolean get_sync_attrib(EGLDisplay handle, EGLSync sync_handle, EGLint name, EGLAttrib* value) {
    return guarded("eglGetSyncAttrib", EGLBoolean{EGL_FALSE}, [&] {
        auto* display = display_of(handle);
        if (!display) return EGLBoolean{EGL_FALSE};
        const auto sync = display->sync(sync_handle);
        if (!sync || !value) return refuse(EGL_BAD_PARAMETER);
        switch (name) {
            case EGL_SYNC_TYPE: *value = EGL_SYNC_FENCE; break;
            case EGL_SYNC_CONDITION: *value = EGL_SYNC_PRIOR_COMMANDS_COMPLETE; break;
            case EGL_SYNC_STATUS:
                if (!sync->signaled) flush_current(true);
                sync->signaled = true;
                *value = EGL_SIGNALED;
                break;
            default: return refuse(EGL_BAD_ATTRIBUTE);
        }
        return succeed();
    });
}

EGLImage create_image(EGLDisplay, EGLContext, EGLenum, EGLClientBuffer, const EGLAttrib*) {
    return refuse(EGL_BAD_PARAMETER, EGL_NO_IMAGE);
}
EGLBoolean destroy_image(EGLDisplay, EGLImage) { return refuse(EGL_BAD_PARAMETER); }

template <class F>
constexpr NamedFunction named(const char* name, F* function) {
    return {name, reinterpret_cast<Function>(function)};
}

}  // namespace

void start(const __EGLapiExports& exports) { glvnd = &exports; }

EGLDisplay get_platform_display(EGLenum platform, void* native, const EGLAttrib* list) {
    return guarded("eglGetPlatformDisplay", EGL_NO_DISPLAY, [&]() -> EGLDisplay {
        int screen = -1;
        for (const auto& [name, value] : read_list(list)) {
            if (name != EGL_PLATFORM_X11_SCREEN_KHR && name != EGL_PLATFORM_XCB_SCREEN_EXT)
                return refuse(EGL_BAD_ATTRIBUTE, EGL_NO_DISPLAY);
            screen = static_cast<int>(value);
        }
        switch (platform) {
            case EGL_NONE:
            case EGL_PLATFORM_X11_KHR: return succeed(find_or_make_display(Platform::x11, native, screen)->handle());
            case EGL_PLATFORM_XCB_EXT: return succeed(find_or_make_display(Platform::xcb, native, screen)->handle());
            case EGL_PLATFORM_DEVICE_EXT:
                if (native != the_device()) return refuse(EGL_BAD_PARAMETER, EGL_NO_DISPLAY);
                return succeed(find_or_make_display(Platform::device, native, 0)->handle());
            case EGL_PLATFORM_SURFACELESS_MESA:
                return succeed(find_or_make_display(Platform::surfaceless, nullptr, 0)->handle());
            default: return succeed(EGL_NO_DISPLAY);  // another vendor may know it
        }
    });
}

std::span<const NamedFunction> functions() {
    static const NamedFunction table[] = {
        named("eglBindTexImage", bind_tex_image),
        named("eglChooseConfig", choose_config),
        named("eglClientWaitSync", client_wait_sync),
        named("eglCopyBuffers", copy_buffers),
        named("eglCreateContext", create_context_handle),
        named("eglCreateImage", create_image),
        named("eglCreatePbufferFromClientBuffer", create_pbuffer_from_client_buffer),
        named("eglCreatePbufferSurface", create_pbuffer_surface),
        named("eglCreatePixmapSurface", create_pixmap_surface),
        named("eglCreatePlatformPixmapSurface", create_platform_pixmap_surface<EGLAttrib>),
        named("eglCreatePlatformPixmapSurfaceEXT", create_platform_pixmap_surface<EGLint>),
        named("eglCreatePlatformWindowSurface", create_platform_window_surface<EGLAttrib>),
        named("eglCreatePlatformWindowSurfaceEXT", create_platform_window_surface<EGLint>),
        named("eglCreateSync", create_sync),
        named("eglCreateWindowSurface", create_window_surface),
        named("eglDestroyContext", destroy_context_handle),
        named("eglDestroyImage", destroy_image),
        named("eglDestroySurface", destroy_surface),
        named("eglDestroySync", destroy_sync),
        named("eglGetConfigAttrib", get_config_attrib),
        named("eglGetConfigs", get_configs),
        named("eglGetError", get_error),
        named("eglGetSyncAttrib", get_sync_attrib),
        named("eglInitialize", initialize),
        named("eglMakeCurrent", make_current_handles),
        named("eglQueryContext", query_context),
        named("eglQueryDeviceAttribEXT", query_device_attrib),
        named("eglQueryDeviceStringEXT", query_device_string),
        named("eglQueryDevicesEXT", query_devices),
        named("eglQueryDisplayAttribEXT", query_display_attrib),
        named("eglQueryDisplayAttribKHR", query_display_attrib),
        named("eglQueryString", query_string),
        named("eglQuerySurface", query_surface),
        named("eglReleaseTexImage", bind_tex_image),
        named("eglReleaseThread", release_thread),
        named("eglSurfaceAttrib", surface_attrib),
        named("eglSwapBuffers", swap),
        named("eglSwapInterval", swap_interval),
        named("eglTerminate", terminate),
        named("eglWaitClient", wait_client),
        named("eglWaitGL", wait_client),
        named("eglWaitNative", wait_native),
        named("eglWaitSync", wait_sync),
    };
    return table;
}

}  // namespace wall::client::egl
