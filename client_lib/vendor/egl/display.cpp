// SPDX-License-Identifier: MIT
#include "client_lib/vendor/egl/display.h"

#include <X11/Xlib-xcb.h>

#include <algorithm>

#include "client_lib/vendor/config_matrix.h"

namespace wall::client::egl {
namespace {

struct Displays {
    std::mutex mutex;
    std::vector<std::unique_ptr<EglDisplay>> all;
};

Displays& displays() {
    static Displays& only = *new Displays;  // lives for ever: no static destructors
    return only;
}

xcb_screen_t* screen_of(xcb_connection_t* connection, int number) {
    auto at = xcb_setup_roots_iterator(xcb_get_setup(connection));
    for (; at.rem > 0; --number, xcb_screen_next(&at))
        if (number == 0) return at.data;
    return nullptr;
}

/// A visual with an alpha channel; 0 if the screen has none.
std::uint32_t argb_visual_of(xcb_screen_t* screen) {
    for (auto depth = xcb_screen_allowed_depths_iterator(screen); depth.rem; xcb_depth_next(&depth)) {
        if (depth.data->depth != 32) continue;
        for (auto visual = xcb_depth_visuals_iterator(depth.data); visual.rem; xcb_visualtype_next(&visual))
            if (visual.data->_class == XCB_VISUAL_CLASS_TRUE_COLOR) return visual.data->visual_id;
    }
    return 0;
}

template <class Map>
auto lookup(const Map& map, const void* handle) -> typename Map::mapped_type {
    const auto found = map.find(handle);
    return found != map.end() ? found->second : nullptr;
}

template <class Map>
void* insert(Map& map, typename Map::mapped_type object) {
    void* handle = object.get();
    map[handle] = std::move(object);
    return handle;
}

}  // namespace

Extent EglSurface::size_now() const {
    if (kind != SurfaceKind::window) return size;
    return connection->size_of(native).value_or(surface_size(*core));
}

xcb_screen_t* EglDisplay::open_screen() {
    if (platform_ == Platform::xcb && native_) {
        connection_ = vendor::XConnection::of(static_cast<xcb_connection_t*>(native_));
        return screen_of(static_cast<xcb_connection_t*>(native_), std::max(0, screen_));
    }
    auto* display = static_cast<Display*>(platform_ == Platform::x11 ? native_ : nullptr);
    if (!display) display = XOpenDisplay(nullptr);  // stays open: the program names no display of its own
    if (!display) return nullptr;
    connection_ = vendor::XConnection::of(display);
    return screen_of(XGetXCBConnection(display), screen_ < 0 ? DefaultScreen(display) : screen_);
}

bool EglDisplay::initialize() {
    if (initialized_) return true;
    if (platform_ == Platform::surfaceless || platform_ == Platform::device) {
        if (configs_.empty()) make_configs(0, 0);
    } else if (!connection_ || !connection_->open()) {  // the program may open another display at the same address
        auto* screen = open_screen();
        if (!screen) return false;
        if (configs_.empty()) make_configs(screen->root_visual, argb_visual_of(screen));
    }
    return initialized_ = true;
}

void EglDisplay::make_configs(std::uint32_t opaque_visual, std::uint32_t argb_visual) {
    const auto add = [&](const SurfaceFormat& format, std::uint32_t visual) {
        const auto id = static_cast<EGLint>(configs_.size() + 1);
        configs_.push_back(std::make_unique<Config>(Config{id, format, visual}));
    };
    for (const auto& format : vendor::format_matrix(false, false)) add(format, opaque_visual);
    if (argb_visual != 0)
        for (const auto& format : vendor::format_matrix(true, false)) add(format, argb_visual);
}

void EglDisplay::terminate() {
    Handles<EglSurface> surfaces;
    Handles<EglContext> contexts;
    std::lock_guard lock(mutex_);
    initialized_ = false;
    surfaces.swap(surfaces_);
    contexts.swap(contexts_);
    syncs_.clear();
}

const Config* EglDisplay::config(EGLConfig handle) const {
    const auto found = std::find_if(configs_.begin(), configs_.end(), [&](const auto& c) { return c.get() == handle; });
    return found != configs_.end() ? found->get() : nullptr;
}

std::shared_ptr<EglSurface> EglDisplay::surface(EGLSurface handle) const {
    std::lock_guard lock(mutex_);
    return lookup(surfaces_, handle);
}

std::shared_ptr<EglContext> EglDisplay::context(EGLContext handle) const {
    std::lock_guard lock(mutex_);
    return lookup(contexts_, handle);
}

std::shared_ptr<EglSync> EglDisplay::sync(EGLSync handle) const {
    std::lock_guard lock(mutex_);
    return lookup(syncs_, handle);
}

EGLSurface EglDisplay::add(std::shared_ptr<EglSurface> surface) {
    std::lock_guard lock(mutex_);
    return insert(surfaces_, std::move(surface));
}

EGLContext EglDisplay::add(std::shared_ptr<EglContext> context) {
    std::lock_guard lock(mutex_);
    return insert(contexts_, std::move(context));
}

EGLSync EglDisplay::add(std::shared_ptr<EglSync> sync) {
    std::lock_guard lock(mutex_);
    return insert(syncs_, std::move(sync));
}

bool EglDisplay::remove_surface(EGLSurface handle) {
    std::shared_ptr<EglSurface> last;  // declared first: the surface ends after the lock
    std::lock_guard lock(mutex_);
    last = lookup(surfaces_, handle);
    return surfaces_.erase(handle) > 0;
}

bool EglDisplay::remove_context(EGLContext handle) {
    std::shared_ptr<EglContext> last;
    std::lock_guard lock(mutex_);
    last = lookup(contexts_, handle);
    return contexts_.erase(handle) > 0;
}

bool EglDisplay::remove_sync(EGLSync handle) {
    std::lock_guard lock(mutex_);
    return syncs_.erase(handle) > 0;
}

bool EglDisplay::has_window(std::uint32_t window) const {
    std::lock_guard lock(mutex_);
    return std::any_of(surfaces_.begin(), surfaces_.end(), [&](const auto& entry) {
        return entry.second->kind == SurfaceKind::window && entry.second->native == window;
    });
}

EglDisplay* find_or_make_display(Platform platform, void* native, int screen) {
    std::lock_guard lock(displays().mutex);
    for (const auto& display : displays().all)
        if (display->is(platform, native, screen)) return display.get();
    displays().all.push_back(std::make_unique<EglDisplay>(platform, native, screen));
    return displays().all.back().get();
}

EglDisplay* find_display(EGLDisplay handle) {
    std::lock_guard lock(displays().mutex);
    for (const auto& display : displays().all)
        if (display.get() == handle) return display.get();
    return nullptr;
}

}  // namespace wall::client::egl
