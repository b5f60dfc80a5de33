// SPDX-License-Identifier: MIT
// What the vendors ask of an X server, over the application's own connection and in its own thread: the size of a
// window is then right after any request that the program made before. XCB replies carry errors, so a window that is
// gone never reaches the program's X error handler.
#pragma once

#include <X11/Xlib.h>
#include <xcb/xcb.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "client_lib/context/core.h"

namespace wall::client::vendor {

class XConnection {
public:
    /// The one of this display; it is closed when the program closes the display.
    static std::shared_ptr<XConnection> of(Display* display);
    /// The one of an XCB connection. Nobody tells when it is closed: the program must not use its surfaces then.
    static std::shared_ptr<XConnection> of(xcb_connection_t* connection);

    /// `display`: the name of its server; empty: DISPLAY.
    XConnection(xcb_connection_t* connection, std::string display)
        : connection_(connection), display_(std::move(display)) {}

    const std::string& display_name() const { return display_; }
    bool open() const { return connection_.load() != nullptr; }
    /// Size of a window or pixmap; nothing if there is no such drawable (any more).
    std::optional<Extent> size_of(xcb_drawable_t drawable) const;
    std::string title_of(xcb_window_t window) const;
    std::uint32_t new_id() const;
    void close() { connection_ = nullptr; }

private:
    std::atomic<xcb_connection_t*> connection_;
    const std::string display_;
};

/// Options of a surface that is an X window: its size is asked for at each frame, and messages reach it.
SurfaceOptions window_surface(std::shared_ptr<XConnection> connection, xcb_window_t window, Extent size,
                              const SurfaceFormat& format);

}  // namespace wall::client::vendor
