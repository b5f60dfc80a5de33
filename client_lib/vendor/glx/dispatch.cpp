// SPDX-License-Identifier: MIT
// The vendor-neutral stubs of GLX extension functions: each finds the vendor that its arguments belong to, which need
// not be us, and calls that vendor's implementation through GLVND.
#include <array>
#include <atomic>
#include <cstring>
#include <optional>

#include "client_lib/vendor/glx/functions.h"

namespace wall::client::glx {
namespace {

constinit std::atomic<const __GLXapiExports*> glvnd{nullptr};

enum Stub : std::size_t {
    ChooseFBConfigSGIX,
    CreateContextWithConfigSGIX,
    CreateGLXPixmapWithConfigSGIX,
    GetFBConfigAttribSGIX,
    GetFBConfigFromVisualSGIX,
    GetSwapIntervalMESA,
    GetVisualFromFBConfigSGIX,
    SwapIntervalEXT,
    SwapIntervalMESA,
    SwapIntervalSGI,
    kStubs
};

constinit std::array<std::atomic<int>, kStubs> indices{-1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

const __GLXapiExports& api() { return *glvnd.load(std::memory_order_relaxed); }

/// The vendor's implementation; null if it has none.
template <class F>
F* implementation(__GLXvendorInfo* vendor, Stub stub) {
    const int index = indices[stub];
    return vendor && index >= 0 ? reinterpret_cast<F*>(api().fetchDispatchEntry(vendor, index)) : nullptr;
}

GLXFBConfig* choose_fb_config(Display* display, int screen, int* attributes, int* count) {
    auto* vendor = api().getDynDispatch(display, screen);
    auto* call = implementation<GLXFBConfig*(Display*, int, int*, int*)>(vendor, ChooseFBConfigSGIX);
    GLXFBConfig* configs = call ? call(display, screen, attributes, count) : nullptr;
    for (int i = 0; configs && i < *count; ++i) api().addVendorFBConfigMapping(display, configs[i], vendor);
    return configs;
}

GLXContext create_context(Display* display, GLXFBConfig config, int type, GLXContext share, Bool direct) {
    auto* vendor = api().vendorFromFBConfig(display, config);
    auto* call =
        implementation<GLXContext(Display*, GLXFBConfig, int, GLXContext, Bool)>(vendor, CreateContextWithConfigSGIX);
    GLXContext context = call ? call(display, config, type, share, direct) : nullptr;
    if (context) api().addVendorContextMapping(display, context, vendor);
    return context;
}

GLXPixmap create_pixmap(Display* display, GLXFBConfig config, Pixmap pixmap) {
    auto* vendor = api().vendorFromFBConfig(display, config);
    auto* call = implementation<GLXPixmap(Display*, GLXFBConfig, Pixmap)>(vendor, CreateGLXPixmapWithConfigSGIX);
    const GLXPixmap made = call ? call(display, config, pixmap) : None;
    if (made != None) api().addVendorDrawableMapping(display, made, vendor);
    return made;
}

int get_attrib(Display* display, GLXFBConfig config, int name, int* value) {
    auto* vendor = api().vendorFromFBConfig(display, config);
    auto* call = implementation<int(Display*, GLXFBConfig, int, int*)>(vendor, GetFBConfigAttribSGIX);
    return call ? call(display, config, name, value) : GLX_BAD_VISUAL;
}

GLXFBConfig config_from_visual(Display* display, XVisualInfo* visual) {
    auto* vendor = api().getDynDispatch(display, visual->screen);
    auto* call = implementation<GLXFBConfig(Display*, XVisualInfo*)>(vendor, GetFBConfigFromVisualSGIX);
    GLXFBConfig config = call ? call(display, visual) : nullptr;
    if (config) api().addVendorFBConfigMapping(display, config, vendor);
    return config;
}

int get_interval_mesa() {
    auto* call = implementation<int()>(api().getCurrentDynDispatch(), GetSwapIntervalMESA);
    return call ? call() : 0;
}

XVisualInfo* visual_from_config(Display* display, GLXFBConfig config) {
    auto* vendor = api().vendorFromFBConfig(display, config);
    auto* call = implementation<XVisualInfo*(Display*, GLXFBConfig)>(vendor, GetVisualFromFBConfigSGIX);
    return call ? call(display, config) : nullptr;
}

void interval_ext(Display* display, GLXDrawable drawable, int interval) {
    auto* vendor = api().vendorFromDrawable(display, drawable);
    auto* call = implementation<void(Display*, GLXDrawable, int)>(vendor, SwapIntervalEXT);
    if (call) call(display, drawable, interval);
}

int interval_mesa(unsigned interval) {
    auto* call = implementation<int(unsigned)>(api().getCurrentDynDispatch(), SwapIntervalMESA);
    return call ? call(interval) : GLX_BAD_CONTEXT;
}

int interval_sgi(int interval) {
    auto* call = implementation<int(int)>(api().getCurrentDynDispatch(), SwapIntervalSGI);
    return call ? call(interval) : GLX_BAD_CONTEXT;
}

struct Row {
    Stub stub;
    const char* name;
    Function function;
};

template <class F>
Row row(Stub stub, const char* name, F* function) {
    return {stub, name, reinterpret_cast<Function>(function)};
}

std::optional<Row> find(const char* name) {
    static const Row rows[] = {
        row(ChooseFBConfigSGIX, "glXChooseFBConfigSGIX", choose_fb_config),
        row(CreateContextWithConfigSGIX, "glXCreateContextWithConfigSGIX", create_context),
        row(CreateGLXPixmapWithConfigSGIX, "glXCreateGLXPixmapWithConfigSGIX", create_pixmap),
        row(GetFBConfigAttribSGIX, "glXGetFBConfigAttribSGIX", get_attrib),
        row(GetFBConfigFromVisualSGIX, "glXGetFBConfigFromVisualSGIX", config_from_visual),
        row(GetSwapIntervalMESA, "glXGetSwapIntervalMESA", get_interval_mesa),
        row(GetVisualFromFBConfigSGIX, "glXGetVisualFromFBConfigSGIX", visual_from_config),
        row(SwapIntervalEXT, "glXSwapIntervalEXT", interval_ext),
        row(SwapIntervalMESA, "glXSwapIntervalMESA", interval_mesa),
        row(SwapIntervalSGI, "glXSwapIntervalSGI", interval_sgi),
    };
    for (const Row& r : rows)
        if (std::strcmp(r.name, name) == 0) return r;
    return std::nullopt;
}

}  // namespace

void start_dispatch(const __GLXapiExports& exports) { glvnd = &exports; }

Function dispatch_stub(const char* name) {
    const auto found = find(name);
    return found ? found->function : nullptr;
}

void set_dispatch_index(const char* name, int index) {
    if (const auto found = find(name)) indices[found->stub] = index;
}

}  // namespace wall::client::glx
