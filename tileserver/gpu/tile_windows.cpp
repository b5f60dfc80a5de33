// SPDX-License-Identifier: MIT
#include "tileserver/gpu/tile_windows.h"

#include <X11/Xlib.h>

#include "tileserver/gpu/egl_context.h"

namespace wall::tileserver {

Result<std::unique_ptr<TileWindows>> TileWindows::open(const X11Display& display, const EglHandles& egl,
                                                       const WindowRequest& request, const WindowLook& look) {
    std::unique_ptr<TileWindows> out(new TileWindows(display, egl));
    for (const WindowSpec& spec : request.windows)
        if (auto added = out->add(spec, look); !added) return tl::unexpected(added.error());
    if (auto selected = out->select(0); !selected) return tl::unexpected(selected.error());
    return out;
}

TileWindows::~TileWindows() {
    eglMakeCurrent(egl_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    for (const Entry& entry : windows_)
        if (entry.surface != EGL_NO_SURFACE) eglDestroySurface(egl_.display, entry.surface);
}

Result<void> TileWindows::add(const WindowSpec& spec, const WindowLook& look) {
    auto window = TileWindow::open(display_, spec, look);
    if (!window) return tl::unexpected(window.error());
    windows_.push_back({std::move(*window), EGL_NO_SURFACE});
    Entry& entry = windows_.back();
    unsigned long id = entry.window->id();
    entry.surface = eglCreatePlatformWindowSurface(egl_.display, egl_.config, &id, nullptr);
    const std::size_t index = windows_.size() - 1;
    if (entry.surface == EGL_NO_SURFACE) return failed(index, "eglCreatePlatformWindowSurface");
    if (auto selected = select(index); !selected) return selected;
    // One thread shows them all. Were each to wait for its monitor, n monitors would show every n-th picture; so only
    // the first waits, and the others are swapped right after it.
    if (eglSwapInterval(egl_.display, index == 0 ? 1 : 0) == EGL_FALSE) return failed(index, "eglSwapInterval");
    return {};
}

Result<void> TileWindows::failed(std::size_t i, const char* call) const {
    if (display_.lost()) return display_.check_requests("");
    return fail("tile '" + windows_[i].window->tile() + "': " + egl_error(call));
}

Result<void> TileWindows::take_events() {
    while (XPending(display_.get()) > 0) {
        XEvent event;
        XNextEvent(display_.get(), &event);
        for (const Entry& entry : windows_)
            if (entry.window->id() == event.xany.window) entry.window->take(event);
    }
    if (display_.lost()) return display_.check_requests("");
    for (const Entry& entry : windows_)
        if (entry.window->gone()) return fail("the window of tile '" + entry.window->tile() + "' was destroyed");
    return {};
}

Result<void> TileWindows::select(std::size_t i) {
    if (current_ == i) return {};
    if (eglMakeCurrent(egl_.display, windows_[i].surface, windows_[i].surface, egl_.context) == EGL_FALSE)
        return failed(i, "eglMakeCurrent");
    current_ = i;
    return {};
}

Result<void> TileWindows::swap(std::size_t i) {
    if (eglSwapBuffers(egl_.display, windows_[i].surface) == EGL_FALSE) return failed(i, "eglSwapBuffers");
    return {};
}

}  // namespace wall::tileserver
