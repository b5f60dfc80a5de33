// SPDX-License-Identifier: MIT
#include "client_lib/vendor/x_connection.h"

#include <X11/Xlib-xcb.h>
#include <X11/Xlibint.h>
#undef min
#undef max

#include <cstdlib>
#include <mutex>
#include <unordered_map>

#include "client_lib/vendor/x_messages.h"
#include "client_lib/vendor/x_reply.h"

namespace wall::client::vendor {
namespace {

/// Lives for ever: the library has no static destructors.
struct Connections {
    std::mutex mutex;
    std::unordered_map<const void*, std::shared_ptr<XConnection>> by_handle;
};

Connections& connections() {
    static Connections& all = *new Connections;
    return all;
}

extern "C" int wallgl_display_closes(Display* display, XExtCodes*) {
    auto& all = connections();
    std::lock_guard lock(all.mutex);
    const auto found = all.by_handle.find(display);
    if (found == all.by_handle.end()) return 0;
    found->second->close();
    all.by_handle.erase(found);
    return 0;
}

std::string text_property(xcb_connection_t* connection, xcb_window_t window, xcb_atom_t name) {
    constexpr std::uint32_t kMaxWords = 64;
    const auto cookie = xcb_get_property(connection, 0, window, name, XCB_GET_PROPERTY_TYPE_ANY, 0, kMaxWords);
    xcb_generic_error_t* error = nullptr;
    const auto reply = owned(xcb_get_property_reply(connection, cookie, &error));
    const auto failed = owned(error);
    if (!reply || reply->format != 8) return {};
    return {static_cast<const char*>(xcb_get_property_value(reply.get())),
            static_cast<std::size_t>(xcb_get_property_value_length(reply.get()))};
}

}  // namespace

std::shared_ptr<XConnection> XConnection::of(Display* display) {
    auto& all = connections();
    std::lock_guard lock(all.mutex);
    auto& entry = all.by_handle[display];
    if (entry) return entry;
    entry = std::make_shared<XConnection>(XGetXCBConnection(display), DisplayString(display));
    if (XExtCodes* codes = XAddExtension(display)) XESetCloseDisplay(display, codes->extension, wallgl_display_closes);
    return entry;
}

std::shared_ptr<XConnection> XConnection::of(xcb_connection_t* connection) {
    auto& all = connections();
    std::lock_guard lock(all.mutex);
    auto& entry = all.by_handle[connection];
    if (!entry) entry = std::make_shared<XConnection>(connection, std::string());
    return entry;
}

std::optional<Extent> XConnection::size_of(xcb_drawable_t drawable) const {
    auto* connection = connection_.load();
    if (!connection || drawable == XCB_NONE) return std::nullopt;
    xcb_generic_error_t* error = nullptr;
    const auto reply = owned(xcb_get_geometry_reply(connection, xcb_get_geometry(connection, drawable), &error));
    const auto failed = owned(error);
    if (!reply) return std::nullopt;
    return Extent{reply->width, reply->height};
}

std::string XConnection::title_of(xcb_window_t window) const {
    auto* connection = connection_.load();
    return connection ? text_property(connection, window, XCB_ATOM_WM_NAME) : std::string();
}

std::uint32_t XConnection::new_id() const {
    auto* connection = connection_.load();
    return connection ? xcb_generate_id(connection) : 0;
}

namespace {

NativeWindow native_window(const std::string& display, xcb_window_t window) {
    const char* const usual = std::getenv("DISPLAY");
    return {display.empty() && usual != nullptr ? usual : display, window};
}

}  // namespace

SurfaceOptions window_surface(std::shared_ptr<XConnection> connection, xcb_window_t window, Extent size,
                              const SurfaceFormat& format) {
    SurfaceOptions options;
    options.format = format;
    options.size = size;
    options.title = connection->title_of(window);
    options.native = native_window(connection->display_name(), window);
    options.messages = window_messages(connection->display_name(), window);
    options.query_size = [connection = std::move(connection), window] { return connection->size_of(window); };
    return options;
}

}  // namespace wall::client::vendor
