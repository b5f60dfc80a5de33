// SPDX-License-Identifier: MIT
// GLX drawables: X windows (a GLXWindow has its window's own XID), pbuffers and pixmaps, each with a surface. Any
// thread.
#pragma once

#include <GL/glx.h>

#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "client_lib/context/core.h"
#include "client_lib/vendor/glx/config.h"
#include "client_lib/vendor/x_connection.h"

namespace wall::client::glx {

enum class DrawableKind { window, pbuffer, pixmap };

struct Drawable {
    XID id = 0;
    DrawableKind kind = DrawableKind::window;
    const Config* config = nullptr;
    Display* display = nullptr;  ///< valid while the connection is open
    std::shared_ptr<vendor::XConnection> connection;
    std::shared_ptr<ClientSurface> surface;
    Extent size;  ///< pbuffer, pixmap
    bool preserved_contents = true;
    bool made_by_glx = false;  ///< glXCreateWindow and the like, not a bare X window
    int current_in = 0;        ///< contexts that have it current
    int swap_interval = 1;
    unsigned long event_mask = 0;
};

class Drawables {
public:
    static Drawables& get();

    std::shared_ptr<Drawable> find(Display* display, XID id);
    /// The drawable for making a context with `config` current; a bare X window gets one here. Null: no such window.
    std::shared_ptr<Drawable> find_or_adopt(Display* display, XID id, const Config& config);
    /// A GLXWindow. Null: no such window.
    std::shared_ptr<Drawable> create_window(Display* display, XID window, const Config& config);
    /// A pbuffer, or a pixmap of the size that its X pixmap has.
    std::shared_ptr<Drawable> create_offscreen(Display* display, DrawableKind kind, const Config& config, Extent size);
    /// False if there is none. The surface lives on while it is current.
    bool destroy(Display* display, XID id);

    void now_current(const std::shared_ptr<Drawable>& drawable);
    void no_longer_current(const std::shared_ptr<Drawable>& drawable);
    /// Forgets bare windows that the program has destroyed: X does not tell us. Costs a round trip for each that is
    /// idle.
    void drop_destroyed_windows();

private:
    struct Key {
        const void* connection;
        XID id;
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& k) const { return std::hash<const void*>{}(k.connection) * 31 + k.id; }
    };
    std::shared_ptr<Drawable> add_window(Display* display, XID id, const Config& config);

    std::mutex mutex_;
    std::unordered_map<Key, std::shared_ptr<Drawable>, KeyHash> all_;
};

}  // namespace wall::client::glx
