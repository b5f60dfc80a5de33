// SPDX-License-Identifier: MIT
#include "client_lib/vendor/glx/drawable.h"

#include <vector>

#include "client_lib/vendor/x_messages.h"

namespace wall::client::glx {

using vendor::XConnection;

Drawables& Drawables::get() {
    static Drawables& only = *new Drawables;  // lives for ever: no static destructors
    return only;
}

std::shared_ptr<Drawable> Drawables::find(Display* display, XID id) {
    const auto connection = XConnection::of(display);
    std::lock_guard lock(mutex_);
    const auto found = all_.find({connection.get(), id});
    return found != all_.end() ? found->second : nullptr;
}

std::shared_ptr<Drawable> Drawables::add_window(Display* display, XID id, const Config& config) {
    const auto connection = XConnection::of(display);
    const auto size = connection->size_of(static_cast<xcb_window_t>(id));
    if (!size) return nullptr;
    auto drawable = std::make_shared<Drawable>();
    drawable->id = id;
    drawable->config = &config;
    drawable->display = display;
    drawable->connection = connection;
    drawable->surface =
        create_surface(vendor::window_surface(connection, static_cast<xcb_window_t>(id), *size, config.format));
    std::lock_guard lock(mutex_);
    return all_.try_emplace({connection.get(), id}, std::move(drawable)).first->second;
}

std::shared_ptr<Drawable> Drawables::find_or_adopt(Display* display, XID id, const Config& config) {
    auto known = find(display, id);
    if (!known || vendor::close_was_asked()) drop_destroyed_windows();
    if (known) return known;
    return add_window(display, id, config);
}

std::shared_ptr<Drawable> Drawables::create_window(Display* display, XID window, const Config& config) {
    auto drawable = find_or_adopt(display, window, config);
    if (drawable) drawable->made_by_glx = true;
    return drawable;
}

std::shared_ptr<Drawable> Drawables::create_offscreen(Display* display, DrawableKind kind, const Config& config,
                                                      Extent size) {
    auto drawable = std::make_shared<Drawable>();
    drawable->display = display;
    drawable->connection = XConnection::of(display);
    drawable->id = drawable->connection->new_id();
    drawable->kind = kind;
    drawable->config = &config;
    drawable->size = size;
    drawable->made_by_glx = true;
    SurfaceOptions options;
    options.format = config.format;
    options.visible = false;
    options.size = size;
    drawable->surface = create_surface(std::move(options));
    std::lock_guard lock(mutex_);
    all_[{drawable->connection.get(), drawable->id}] = drawable;
    return drawable;
}

bool Drawables::destroy(Display* display, XID id) {
    const auto connection = XConnection::of(display);
    std::shared_ptr<Drawable> last;  // declared first: its surface ends after the lock
    std::lock_guard lock(mutex_);
    const auto found = all_.find({connection.get(), id});
    if (found == all_.end()) return false;
    last = std::move(found->second);
    all_.erase(found);
    return true;
}

void Drawables::now_current(const std::shared_ptr<Drawable>& drawable) {
    if (!drawable) return;
    std::lock_guard lock(mutex_);
    ++drawable->current_in;
}

void Drawables::no_longer_current(const std::shared_ptr<Drawable>& drawable) {
    if (!drawable) return;
    std::lock_guard lock(mutex_);
    --drawable->current_in;
}

void Drawables::drop_destroyed_windows() {
    std::vector<std::pair<Key, std::shared_ptr<Drawable>>> idle;
    {
        std::lock_guard lock(mutex_);
        for (const auto& [key, drawable] : all_)
            if (drawable->kind == DrawableKind::window && drawable->current_in == 0) idle.emplace_back(key, drawable);
    }
    for (const auto& [key, drawable] : idle) {
        if (drawable->connection->size_of(static_cast<xcb_window_t>(key.id))) continue;
        std::lock_guard lock(mutex_);
        if (drawable->current_in == 0) all_.erase(key);
    }
}

}  // namespace wall::client::glx
