// SPDX-License-Identifier: MIT
#include "client_lib/vendor/x_messages.h"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "client_lib/process/log.h"
#include "client_lib/vendor/x_reply.h"
#include "common/base/quoted.h"

namespace wall::client::vendor {
namespace {

constexpr std::uint32_t kMaxProtocols = 64;
constexpr int kMaxDepth = 32;  // of windows in windows

/// Answers of XCB carry errors; none reaches the program's error handler.
class Server {
public:
    explicit Server(const std::string& display)
        : connection_(xcb_connect(display.empty() ? nullptr : display.c_str(), nullptr)) {}
    ~Server() { xcb_disconnect(connection_); }
    Server(const Server&) = delete;

    bool open() const { return xcb_connection_has_error(connection_) == 0; }

    xcb_atom_t atom(const char* name) const {
        const auto reply = owned(xcb_intern_atom_reply(
            connection_, xcb_intern_atom(connection_, 1, static_cast<std::uint16_t>(std::strlen(name)), name),
            nullptr));
        return reply ? reply->atom : xcb_atom_t{XCB_ATOM_NONE};
    }
    bool has_protocol(xcb_window_t window, xcb_atom_t protocols, xcb_atom_t wanted) const {
        const auto reply = owned(xcb_get_property_reply(
            connection_, xcb_get_property(connection_, 0, window, protocols, XCB_ATOM_ATOM, 0, kMaxProtocols),
            nullptr));
        if (!reply || reply->format != 32) return false;
        const auto* atoms = static_cast<const xcb_atom_t*>(xcb_get_property_value(reply.get()));
        for (std::uint32_t i = 0; i < reply->value_len; ++i)
            if (atoms[i] == wanted) return true;
        return false;
    }
    /// None: it is the root, or gone.
    xcb_window_t parent(xcb_window_t window) const {
        const auto reply = owned(xcb_query_tree_reply(connection_, xcb_query_tree(connection_, window), nullptr));
        return reply && reply->parent != reply->root ? reply->parent : xcb_window_t{XCB_WINDOW_NONE};
    }
    std::unique_ptr<xcb_get_geometry_reply_t, void (*)(void*)> geometry(xcb_window_t window) const {
        return owned(xcb_get_geometry_reply(connection_, xcb_get_geometry(connection_, window), nullptr));
    }
    /// Waits until the server has it.
    bool send(xcb_window_t window, std::uint32_t mask, const void* event) const {
        const auto error = owned(xcb_request_check(
            connection_, xcb_send_event_checked(connection_, 0, window, mask, static_cast<const char*>(event))));
        return !error && open();
    }

private:
    xcb_connection_t* connection_;
};

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

constexpr std::int64_t kCloseTakes = 10'000;  // ms; then a program has not obeyed
constinit std::atomic<std::int64_t> close_asked_at{-kCloseTakes};

bool ask_to_close(const std::string& display, xcb_window_t window) {
    const Server server(display);
    if (!server.open()) return false;
    const auto protocols = server.atom("WM_PROTOCOLS"), close = server.atom("WM_DELETE_WINDOW");
    if (protocols == XCB_ATOM_NONE || close == XCB_ATOM_NONE) return false;  // nobody has ever named them
    for (int depth = 0; window != XCB_WINDOW_NONE && depth < kMaxDepth; window = server.parent(window), ++depth) {
        if (!server.has_protocol(window, protocols, close)) continue;
        xcb_client_message_event_t event{};
        event.response_type = XCB_CLIENT_MESSAGE;
        event.format = 32;
        event.window = window;
        event.type = protocols;
        event.data.data32[0] = close;
        event.data.data32[1] = XCB_CURRENT_TIME;
        close_asked_at = now_ms();
        return server.send(window, XCB_EVENT_MASK_NO_EVENT, &event);
    }
    return false;
}

void ask_to_redraw(const std::string& display, xcb_window_t window) {
    const Server server(display);
    if (!server.open()) return log(LogLevel::debug, "redraw_not_asked display=%s", in_quotes(display).c_str());
    const auto geometry = server.geometry(window);
    if (!geometry) return log(LogLevel::debug, "redraw_not_asked window=%u", window);
    struct {
        xcb_expose_event_t event{};
        char padding[32 - sizeof(xcb_expose_event_t)] = {};  // an event is 32 bytes
    } expose;
    expose.event.response_type = XCB_EXPOSE;
    expose.event.window = window;
    expose.event.width = geometry->width;
    expose.event.height = geometry->height;
    server.send(window, XCB_EVENT_MASK_EXPOSURE, &expose);
}

}  // namespace

WindowMessages window_messages(std::string display, xcb_window_t window) {
    return {[display, window] { return ask_to_close(display, window); },
            [display, window] { ask_to_redraw(display, window); }};
}

bool close_was_asked() { return now_ms() - close_asked_at < kCloseTakes; }

}  // namespace wall::client::vendor
