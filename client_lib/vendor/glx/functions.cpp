// SPDX-License-Identifier: MIT
// GLX 1.4 and its extensions for programs. Never calls back into GLVND: it holds a lock while it calls us. Application
// threads.
#include "client_lib/vendor/glx/functions.h"

#include <X11/Xmd.h>
// (Xmd.h names the types that glxproto.h uses)
#include <GL/glxproto.h>
#include <X11/Xutil.h>

#include <algorithm>

#include "client_lib/vendor/config_matrix.h"
#include "client_lib/vendor/glx/config.h"
#include "client_lib/vendor/glx/context.h"
#include "client_lib/vendor/glx/drawable.h"
#include "client_lib/vendor/glx/error.h"
#include "client_lib/vendor/guarded.h"

namespace wall::client::glx {
namespace {

using vendor::guarded;
using vendor::XConnection;

constexpr const char* kVendor = "WallGL";
constexpr const char* kVersion = "1.4";
constexpr const char* kExtensions =
    "GLX_ARB_create_context GLX_ARB_create_context_profile GLX_ARB_framebuffer_sRGB GLX_ARB_get_proc_address "
    "GLX_ARB_multisample GLX_EXT_create_context_es_profile GLX_EXT_create_context_es2_profile "
    "GLX_EXT_framebuffer_sRGB GLX_EXT_swap_control GLX_EXT_visual_info GLX_EXT_visual_rating GLX_MESA_swap_control "
    "GLX_SGI_swap_control "
    "GLX_SGIX_fbconfig ";

// Errors of ARB extensions, counted from the extension's first error like those in glxproto.h.
constexpr int kGLXBadProfileARB = 13;

/// The array is the program's to XFree, which frees.
template <class T>
T* for_x_free(const std::vector<T>& values) {
    auto* array = static_cast<T*>(malloc(std::max<std::size_t>(1, values.size()) * sizeof(T)));
    if (array) std::copy(values.begin(), values.end(), array);
    return array;
}

GLXFBConfig* config_array(std::span<const Config* const> configs, int* count) {
    std::vector<GLXFBConfig> handles;
    for (const Config* config : configs) handles.push_back(config->handle());
    *count = static_cast<int>(handles.size());
    return handles.empty() ? nullptr : for_x_free(handles);
}

bool valid_screen(Display* display, int screen) { return screen >= 0 && screen < ScreenCount(display); }

XVisualInfo* visual_info(Display* display, const Config& config) {
    XVisualInfo wanted{};
    wanted.visualid = config.visual;
    wanted.screen = config.screen;
    int count = 0;
    return XGetVisualInfo(display, VisualIDMask | VisualScreenMask, &wanted, &count);
}

// ---- configurations ----

GLXFBConfig* get_fb_configs(Display* display, int screen, int* count) {
    return guarded("glXGetFBConfigs", static_cast<GLXFBConfig*>(nullptr), [&]() -> GLXFBConfig* {
        *count = 0;
        return valid_screen(display, screen) ? config_array(Screen::of(display, screen).configs(), count) : nullptr;
    });
}

GLXFBConfig* choose_fb_config(Display* display, int screen, const int* attributes, int* count) {
    return guarded("glXChooseFBConfig", static_cast<GLXFBConfig*>(nullptr), [&]() -> GLXFBConfig* {
        *count = 0;
        if (!valid_screen(display, screen)) return nullptr;
        return config_array(choose_configs(Screen::of(display, screen), attributes), count);
    });
}

int get_fb_config_attrib(Display*, GLXFBConfig handle, int name, int* value) {
    return guarded("glXGetFBConfigAttrib", GLX_BAD_ATTRIBUTE, [&] {
        const Config* config = Config::from(handle);
        if (!config) return static_cast<int>(GLXBadFBConfig);
        const auto found = attribute(*config, name);
        if (!found) return GLX_BAD_ATTRIBUTE;
        *value = *found;
        return 0;
    });
}

XVisualInfo* get_visual_from_fb_config(Display* display, GLXFBConfig handle) {
    return guarded("glXGetVisualFromFBConfig", static_cast<XVisualInfo*>(nullptr), [&] {
        const Config* config = Config::from(handle);
        return config ? visual_info(display, *config) : nullptr;
    });
}

XVisualInfo* choose_visual_info(Display* display, int screen, int* attributes) {
    return guarded("glXChooseVisual", static_cast<XVisualInfo*>(nullptr), [&]() -> XVisualInfo* {
        if (!valid_screen(display, screen)) return nullptr;
        auto& all = Screen::of(display, screen);
        const Config* config = choose_visual(all, attributes);
        if (!config) return nullptr;
        all.choose_for_visual(*config);
        return visual_info(display, *config);
    });
}

int get_config(Display* display, XVisualInfo* visual, int name, int* value) {
    return guarded("glXGetConfig", GLX_BAD_VISUAL, [&] {
        if (!valid_screen(display, visual->screen)) return GLX_BAD_SCREEN;
        const Config* config = Screen::of(display, visual->screen).of_visual(visual->visualid);
        if (!config) {
            if (name != GLX_USE_GL) return GLX_BAD_VISUAL;
            *value = 0;
            return 0;
        }
        const auto found = visual_attribute(*config, name);
        if (!found) return GLX_BAD_ATTRIBUTE;
        *value = *found;
        return 0;
    });
}

// ---- contexts ----

GLXContext make_context(Display* display, const Config* config, GLXContext share, ContextOptions options, int request) {
    if (!config) {
        send_glx_error(display, GLXBadFBConfig, 0, request);
        return nullptr;
    }
    std::shared_ptr<GlxContext> sharing;
    if (share && !(sharing = find_context(share))) {
        send_glx_error(display, GLXBadContext, 0, request);
        return nullptr;
    }
    if (sharing) options.share = sharing->core.get();
    const auto context = create_context(*config, options);
    if (!context) {
        send_glx_error(display, GLXBadFBConfig, 0, request);
        return nullptr;
    }
    return context->handle();
}

GLXContext create_context_of_visual(Display* display, XVisualInfo* visual, GLXContext share, Bool) {
    return guarded("glXCreateContext", GLXContext{}, [&]() -> GLXContext {
        const Config* config = valid_screen(display, visual->screen)
                                   ? Screen::of(display, visual->screen).of_visual(visual->visualid)
                                   : nullptr;
        if (!config) {
            send_x_error(display, BadValue, visual->visualid, X_GLXCreateContext);
            return nullptr;
        }
        return make_context(display, config, share, {}, X_GLXCreateContext);
    });
}

GLXContext create_new_context(Display* display, GLXFBConfig handle, int render_type, GLXContext share, Bool) {
    return guarded("glXCreateNewContext", GLXContext{}, [&]() -> GLXContext {
        if (render_type != GLX_RGBA_TYPE) {
            send_x_error(display, BadValue, 0, X_GLXCreateNewContext);
            return nullptr;
        }
        return make_context(display, Config::from(handle), share, {}, X_GLXCreateNewContext);
    });
}

/// What glXCreateContextAttribsARB asks for, or the error to send.
struct ContextWish {
    ContextOptions options;
    int x_error = 0;
    int glx_error = -1;
};

/// A version of OpenGL that there is.
bool is_version(int major, int minor) {
    static constexpr int kLastMinor[] = {5, 1, 3, 6};  // of 1.x, 2.x, 3.x, 4.x
    return major >= 1 && major <= 4 && minor >= 0 && minor <= kLastMinor[major - 1];
}
bool is_es_version(int major, int minor) {
    static constexpr int kLastMinor[] = {1, 0, 2};
    return major >= 1 && major <= 3 && minor >= 0 && minor <= kLastMinor[major - 1];
}

ContextWish read_context_attributes(const int* attributes) {
    constexpr int kKnownFlags =
        GLX_CONTEXT_DEBUG_BIT_ARB | GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB | GLX_CONTEXT_ROBUST_ACCESS_BIT_ARB;
    ContextWish wish;
    bool unknown_strategy = false;
    int flags = 0, profile = GLX_CONTEXT_CORE_PROFILE_BIT_ARB, render_type = GLX_RGBA_TYPE;
    for (const int* a = attributes; a && *a != None; a += 2) {
        switch (a[0]) {
            case GLX_CONTEXT_MAJOR_VERSION_ARB: wish.options.major = a[1]; break;
            case GLX_CONTEXT_MINOR_VERSION_ARB: wish.options.minor = a[1]; break;
            case GLX_CONTEXT_FLAGS_ARB: flags = a[1]; break;
            case GLX_CONTEXT_PROFILE_MASK_ARB: profile = a[1]; break;
            case GLX_RENDER_TYPE: render_type = a[1]; break;
            case GLX_CONTEXT_RESET_NOTIFICATION_STRATEGY_ARB:
                wish.options.notifies_of_resets = a[1] == GLX_LOSE_CONTEXT_ON_RESET_ARB;
                if (!wish.options.notifies_of_resets && a[1] != GLX_NO_RESET_NOTIFICATION_ARB) unknown_strategy = true;
                break;
            default: wish.x_error = BadValue;
        }
    }
    auto& o = wish.options;
    const int version = o.major * 10 + o.minor;
    o.debug = flags & GLX_CONTEXT_DEBUG_BIT_ARB;
    o.forward_compatible = flags & GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB;
    o.robust = flags & GLX_CONTEXT_ROBUST_ACCESS_BIT_ARB;
    o.core_profile = version >= 32 && profile == GLX_CONTEXT_CORE_PROFILE_BIT_ARB;
    o.es = profile == GLX_CONTEXT_ES2_PROFILE_BIT_EXT;
    const bool desktop =
        profile == GLX_CONTEXT_CORE_PROFILE_BIT_ARB || profile == GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB;
    if (o.es ? !is_es_version(o.major, o.minor) : !desktop) wish.glx_error = kGLXBadProfileARB;
    if (flags & ~kKnownFlags) wish.x_error = BadValue;
    if (unknown_strategy || render_type == GLX_COLOR_INDEX_TYPE || (o.forward_compatible && o.major < 3) ||
        (!o.es && !is_version(o.major, o.minor)))
        wish.x_error = BadMatch;
    else if (render_type != GLX_RGBA_TYPE) wish.x_error = BadValue;
    return wish;
}

GLXContext create_context_attribs(Display* display, GLXFBConfig handle, GLXContext share, Bool, const int* attributes) {
    return guarded("glXCreateContextAttribsARB", GLXContext{}, [&]() -> GLXContext {
        const auto wish = read_context_attributes(attributes);
        if (wish.x_error != 0 || wish.glx_error >= 0) {
            if (wish.x_error != 0) send_x_error(display, wish.x_error, 0, X_GLXCreateContextAttribsARB);
            else send_glx_error(display, wish.glx_error, 0, X_GLXCreateContextAttribsARB);
            return nullptr;
        }
        return make_context(display, Config::from(handle), share, wish.options, X_GLXCreateContextAttribsARB);
    });
}

void destroy_context_handle(Display* display, GLXContext handle) {
    guarded("glXDestroyContext", [&] {
        const auto context = find_usable_context(handle);
        if (!context) return send_glx_error(display, GLXBadContext, 0, X_GLXDestroyContext);
        destroy_context(context);
        Drawables::get().drop_destroyed_windows();
    });
}

Bool make_context_current_of(Display* display, GLXDrawable draw, GLXDrawable read, GLXContext handle) {
    return guarded("glXMakeContextCurrent", Bool{False}, [&]() -> Bool {
        if (!handle && (draw != None || read != None)) {
            send_x_error(display, BadMatch, draw, X_GLXMakeContextCurrent);
            return False;
        }
        if (!handle) return make_context_current(nullptr, nullptr, nullptr) == MakeCurrentResult::done;
        const auto context = find_usable_context(handle);
        if (!context) {
            send_glx_error(display, GLXBadContext, 0, X_GLXMakeContextCurrent);
            return False;
        }
        const bool without = draw == None && read == None;  // as of OpenGL 3.0 (GLX_ARB_create_context)
        if ((draw == None || read == None) && !without) {
            send_x_error(display, BadMatch, 0, X_GLXMakeContextCurrent);
            return False;
        }
        auto& drawables = Drawables::get();
        auto to = without ? nullptr : drawables.find_or_adopt(display, draw, *context->config);
        auto from = read == draw ? to : drawables.find_or_adopt(display, read, *context->config);
        if (!without && (!to || !from)) {
            send_glx_error(display, GLXBadDrawable, to ? read : draw, X_GLXMakeContextCurrent);
            return False;
        }
        const auto result = make_context_current(context, std::move(to), std::move(from));
        if (result == MakeCurrentResult::context_in_use) send_x_error(display, BadAccess, 0, X_GLXMakeContextCurrent);
        return result == MakeCurrentResult::done;
    });
}

Bool make_current_of(Display* display, GLXDrawable drawable, GLXContext handle) {
    return make_context_current_of(display, drawable, drawable, handle);
}

int query_context(Display* display, GLXContext handle, int name, int* value) {
    return guarded("glXQueryContext", GLX_BAD_ATTRIBUTE, [&] {
        const auto context = find_context(handle);
        if (!context) {
            send_glx_error(display, GLXBadContext, 0, X_GLXQueryContext);
            return static_cast<int>(GLX_BAD_CONTEXT);
        }
        switch (name) {
            case GLX_FBCONFIG_ID: *value = context->config->id; return 0;
            case GLX_RENDER_TYPE: *value = GLX_RGBA_TYPE; return 0;
            case GLX_SCREEN: *value = context->config->screen; return 0;
            default: return GLX_BAD_ATTRIBUTE;
        }
    });
}

void copy_context_state(Display* display, GLXContext from_handle, GLXContext to_handle, unsigned long mask) {
    guarded("glXCopyContext", [&] {
        const auto from = find_context(from_handle), to = find_context(to_handle);
        if (!from || !to) return send_glx_error(display, GLXBadContext, 0, X_GLXCopyContext);
        if (to->current || (from->current && from.get() != thread_context()))
            return send_x_error(display, BadAccess, 0, X_GLXCopyContext);
        client::copy_context(*from->core, *to->core, static_cast<std::uint32_t>(mask));
    });
}

Bool is_direct(Display*, GLXContext handle) {
    return guarded("glXIsDirect", Bool{False}, [&] { return Bool{find_context(handle) != nullptr}; });
}

// ---- drawables ----

GLXWindow create_window(Display* display, GLXFBConfig handle, Window window, const int*) {
    return guarded("glXCreateWindow", GLXWindow{0}, [&]() -> GLXWindow {
        const Config* config = Config::from(handle);
        if (!config) {
            send_glx_error(display, GLXBadFBConfig, 0, X_GLXCreateWindow);
            return None;
        }
        const auto drawable = Drawables::get().create_window(display, window, *config);
        if (!drawable) send_x_error(display, BadWindow, window, X_GLXCreateWindow);
        return drawable ? drawable->id : None;
    });
}

GLXPbuffer create_pbuffer(Display* display, GLXFBConfig handle, const int* attributes) {
    return guarded("glXCreatePbuffer", GLXPbuffer{0}, [&]() -> GLXPbuffer {
        const Config* config = Config::from(handle);
        if (!config) {
            send_glx_error(display, GLXBadFBConfig, 0, X_GLXCreatePbuffer);
            return None;
        }
        int width = 0, height = 0;
        bool preserved = true, largest = false;
        for (const int* a = attributes; a && *a != None; a += 2) {
            if (a[0] == GLX_PBUFFER_WIDTH) width = a[1];
            if (a[0] == GLX_PBUFFER_HEIGHT) height = a[1];
            if (a[0] == GLX_PRESERVED_CONTENTS) preserved = a[1];
            if (a[0] == GLX_LARGEST_PBUFFER) largest = a[1];
        }
        const bool fits = width <= vendor::kMaxPbufferExtent && height <= vendor::kMaxPbufferExtent;
        if (width < 0 || height < 0 || (!fits && !largest)) {
            send_x_error(display, width < 0 || height < 0 ? BadValue : BadAlloc, 0, X_GLXCreatePbuffer);
            return None;
        }
        const Extent size{static_cast<std::uint32_t>(std::clamp(width, 1, vendor::kMaxPbufferExtent)),
                          static_cast<std::uint32_t>(std::clamp(height, 1, vendor::kMaxPbufferExtent))};
        const auto drawable = Drawables::get().create_offscreen(display, DrawableKind::pbuffer, *config, size);
        drawable->preserved_contents = preserved;
        return drawable->id;
    });
}

// The X pixmap's own pixels are not touched: drawing into a GLXPixmap can be read back with glReadPixels only.
GLXPixmap make_pixmap(Display* display, const Config* config, Pixmap pixmap, int request) {
    if (!config) {
        send_glx_error(display, GLXBadFBConfig, 0, request);
        return None;
    }
    const auto size = XConnection::of(display)->size_of(static_cast<xcb_drawable_t>(pixmap));
    if (!size) {
        send_x_error(display, BadPixmap, pixmap, request);
        return None;
    }
    return Drawables::get().create_offscreen(display, DrawableKind::pixmap, *config, *size)->id;
}

GLXPixmap create_pixmap(Display* display, GLXFBConfig handle, Pixmap pixmap, const int*) {
    return guarded("glXCreatePixmap", GLXPixmap{0},
                   [&] { return make_pixmap(display, Config::from(handle), pixmap, X_GLXCreatePixmap); });
}

GLXPixmap create_glx_pixmap(Display* display, XVisualInfo* visual, Pixmap pixmap) {
    return guarded("glXCreateGLXPixmap", GLXPixmap{0}, [&] {
        const Config* config = valid_screen(display, visual->screen)
                                   ? Screen::of(display, visual->screen).of_visual(visual->visualid)
                                   : nullptr;
        return make_pixmap(display, config, pixmap, X_GLXCreateGLXPixmap);
    });
}

void destroy_drawable(Display* display, XID id, const char* function, int glx_error, int request) {
    guarded(function, [&] {
        if (!Drawables::get().destroy(display, id)) send_glx_error(display, glx_error, id, request);
    });
}

void destroy_pbuffer(Display* display, GLXPbuffer id) {
    destroy_drawable(display, id, "glXDestroyPbuffer", GLXBadPbuffer, X_GLXDestroyPbuffer);
}
void destroy_pixmap(Display* display, GLXPixmap id) {
    destroy_drawable(display, id, "glXDestroyPixmap", GLXBadPixmap, X_GLXDestroyPixmap);
}

/// False: there is no such window.
bool is_x_window(Display* display, XID id) {
    return XConnection::of(display)->size_of(static_cast<xcb_drawable_t>(id)).has_value();
}

/// A window that is gone has taken its GLX window with it.
void destroy_window(Display* display, GLXWindow id) {
    guarded("glXDestroyWindow", [&] {
        const bool there = is_x_window(display, id);
        if (!Drawables::get().destroy(display, id) || !there)
            send_glx_error(display, GLXBadWindow, id, X_GLXDestroyWindow);
    });
}

void query_drawable(Display* display, GLXDrawable id, int name, unsigned int* value) {
    guarded("glXQueryDrawable", [&] {
        const auto drawable = Drawables::get().find(display, id);
        const auto extent = drawable && drawable->kind != DrawableKind::window
                                ? std::optional(drawable->size)
                                : XConnection::of(display)->size_of(static_cast<xcb_drawable_t>(id));
        if (!extent) return send_glx_error(display, GLXBadDrawable, id, X_GLXGetDrawableAttributes);
        switch (name) {
            case GLX_WIDTH: *value = extent->width; break;
            case GLX_HEIGHT: *value = extent->height; break;
            case GLX_PRESERVED_CONTENTS: *value = drawable && drawable->preserved_contents; break;
            case GLX_LARGEST_PBUFFER: *value = 0; break;
            case GLX_FBCONFIG_ID: *value = drawable ? static_cast<unsigned>(drawable->config->id) : 0; break;
            case GLX_SWAP_INTERVAL_EXT: *value = drawable ? static_cast<unsigned>(drawable->swap_interval) : 1; break;
            case GLX_MAX_SWAP_INTERVAL_EXT: *value = 1; break;
            case GLX_EVENT_MASK: *value = drawable ? static_cast<unsigned>(drawable->event_mask) : 0; break;
            default: break;
        }
    });
}

void select_event(Display* display, GLXDrawable id, unsigned long mask) {
    guarded("glXSelectEvent", [&] {
        if (const auto drawable = Drawables::get().find(display, id)) drawable->event_mask = mask;
    });
}

void get_selected_event(Display* display, GLXDrawable id, unsigned long* mask) {
    guarded("glXGetSelectedEvent", [&] {
        const auto drawable = Drawables::get().find(display, id);
        *mask = drawable ? drawable->event_mask : 0;
    });
}

void swap(Display* display, GLXDrawable id) {
    guarded("glXSwapBuffers", [&] {
        const auto* current = thread_context();
        const bool is_current = current && current->draw && current->draw->id == id;
        const auto drawable = is_current ? current->draw : Drawables::get().find(display, id);
        if (drawable && drawable->config->format.double_buffered) return swap_buffers(*drawable->surface);
        if (!drawable && !is_x_window(display, id)) send_glx_error(display, GLXBadDrawable, id, X_GLXSwapBuffers);
    });
}

// What X and the wall draw is not ordered among each other: one is not seen on the other.
void wait_gl() {
    guarded("glXWaitGL", [] { flush_current(false); });
}
void wait_x() {}

// ---- strings ----

const char* string_of(int name) {
    switch (name) {
        case GLX_VENDOR: return kVendor;
        case GLX_VERSION: return kVersion;
        case GLX_EXTENSIONS: return kExtensions;
        default: return nullptr;
    }
}

const char* get_client_string(Display*, int name) { return string_of(name); }
const char* query_server_string(Display*, int, int name) { return string_of(name); }
const char* query_extensions_string(Display*, int) { return kExtensions; }

void use_x_font_lists(Font font, int first, int count, int list_base) {
    guarded("glXUseXFont", [&] {
        const auto* current = thread_context();
        if (!current || !current->draw) return;
        // GLX has no display argument here: the font belongs to the server of the current drawable.
        use_x_font(current->draw->display, font, first, count, list_base);
    });
}

// ---- swap control ----

void swap_interval_ext(Display* display, GLXDrawable id, int interval) {
    guarded("glXSwapIntervalEXT", [&] {
        const auto drawable = Drawables::get().find(display, id);
        if (!drawable) return send_glx_error(display, GLXBadDrawable, id, 0);
        if (interval < 0) return send_x_error(display, BadValue, 0, 0);
        drawable->swap_interval = std::min(interval, 1);
    });
}

int set_current_interval(int interval, int least) {
    const auto* current = thread_context();
    if (!current || !current->draw) return GLX_BAD_CONTEXT;
    if (interval < least) return GLX_BAD_VALUE;
    current->draw->swap_interval = std::min(interval, 1);
    return 0;
}

int swap_interval_mesa(unsigned interval) { return set_current_interval(static_cast<int>(interval), 0); }
int swap_interval_sgi(int interval) { return set_current_interval(interval, 1); }
int get_swap_interval_mesa() {
    const auto* current = thread_context();
    return current && current->draw ? current->draw->swap_interval : 0;
}

// ---- SGIX_fbconfig ----

GLXFBConfig get_fb_config_from_visual(Display* display, XVisualInfo* visual) {
    return guarded("glXGetFBConfigFromVisualSGIX", GLXFBConfig{}, [&]() -> GLXFBConfig {
        if (!valid_screen(display, visual->screen)) return nullptr;
        const Config* config = Screen::of(display, visual->screen).of_visual(visual->visualid);
        return config ? config->handle() : nullptr;
    });
}

GLXPixmap create_pixmap_with_config(Display* display, GLXFBConfig handle, Pixmap pixmap) {
    return create_pixmap(display, handle, pixmap, nullptr);
}

template <class F>
constexpr NamedFunction named(const char* name, F* function) {
    return {name, reinterpret_cast<Function>(function)};
}

}  // namespace

std::span<const NamedFunction> core_functions() {
    static const NamedFunction table[] = {
        named("glXChooseFBConfig", choose_fb_config),
        named("glXChooseVisual", choose_visual_info),
        named("glXCopyContext", copy_context_state),
        named("glXCreateContext", create_context_of_visual),
        named("glXCreateContextAttribsARB", create_context_attribs),
        named("glXCreateGLXPixmap", create_glx_pixmap),
        named("glXCreateNewContext", create_new_context),
        named("glXCreatePbuffer", create_pbuffer),
        named("glXCreatePixmap", create_pixmap),
        named("glXCreateWindow", create_window),
        named("glXDestroyContext", destroy_context_handle),
        named("glXDestroyGLXPixmap", destroy_pixmap),
        named("glXDestroyPbuffer", destroy_pbuffer),
        named("glXDestroyPixmap", destroy_pixmap),
        named("glXDestroyWindow", destroy_window),
        named("glXGetClientString", get_client_string),
        named("glXGetConfig", get_config),
        named("glXGetFBConfigAttrib", get_fb_config_attrib),
        named("glXGetFBConfigs", get_fb_configs),
        named("glXGetSelectedEvent", get_selected_event),
        named("glXGetVisualFromFBConfig", get_visual_from_fb_config),
        named("glXIsDirect", is_direct),
        named("glXMakeContextCurrent", make_context_current_of),
        named("glXMakeCurrent", make_current_of),
        named("glXQueryContext", query_context),
        named("glXQueryDrawable", query_drawable),
        named("glXQueryExtensionsString", query_extensions_string),
        named("glXQueryServerString", query_server_string),
        named("glXSelectEvent", select_event),
        named("glXSwapBuffers", swap),
        named("glXUseXFont", use_x_font_lists),
        named("glXWaitGL", wait_gl),
        named("glXWaitX", wait_x),
    };
    return table;
}

std::span<const NamedFunction> extension_functions() {
    static const NamedFunction table[] = {
        named("glXChooseFBConfigSGIX", choose_fb_config),
        named("glXCreateContextWithConfigSGIX", create_new_context),
        named("glXCreateGLXPixmapWithConfigSGIX", create_pixmap_with_config),
        named("glXGetFBConfigAttribSGIX", get_fb_config_attrib),
        named("glXGetFBConfigFromVisualSGIX", get_fb_config_from_visual),
        named("glXGetSwapIntervalMESA", get_swap_interval_mesa),
        named("glXGetVisualFromFBConfigSGIX", get_visual_from_fb_config),
        named("glXSwapIntervalEXT", swap_interval_ext),
        named("glXSwapIntervalMESA", swap_interval_mesa),
        named("glXSwapIntervalSGI", swap_interval_sgi),
    };
    return table;
}

}  // namespace wall::client::glx
