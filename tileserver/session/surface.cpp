// SPDX-License-Identifier: MIT
#include "tileserver/session/surface.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {

std::unique_ptr<Layer> SurfaceReplica::make_layer(const LayerGeometry& geometry, const Layer* older) {
    const auto pixels = pixels_taken(geometry, format_.layer);
    if (pixels > budget_.left) forget_older();
    if (pixels > budget_.left) return nullptr;
    auto layer = std::make_unique<Layer>(gl_, flip_y_, geometry, format_.layer, budget_);
    if (older && older->geometry().view == geometry.view && older->geometry().scale_x() == geometry.scale_x() &&
        older->geometry().scale_y() == geometry.scale_y())
        layer->take_content(*older);
    return layer;
}

/// The layer that was there stays in sight.
void SurfaceReplica::replace(std::uint32_t slot, std::unique_ptr<Layer> layer) {
    if (keeps_older()) {
        if (!replaced_[slot]) older_[slot] = std::move(layers_[slot]);
        replaced_.set(slot);
    }
    layers_[slot] = std::move(layer);
}

void SurfaceReplica::forget_older() {
    for (auto& layer : older_) layer.reset();
    replaced_.reset();
}

LayerGeometry SurfaceReplica::geometry_on(const Tile& tile, const geom::Rect& area, const SurfacePlace& place,
                                          const Views& views) {
    const auto found = views.find(tile.slot);
    const auto view = found == views.end() ? std::nullopt : std::optional(found->second);
    if (!view || !view->elsewhere) return {place.rect, area, place.window_width, place.window_height, view};
    if (area != tile.rect) return {place.rect, area, place.window_width, place.window_height, {}};
    return {tile.rect, tile.rect, place.window_width, place.window_height, view};
}

bool SurfaceReplica::place(const SurfacePlace& place, const std::vector<Tile>& tiles) {
    const bool same_size = place.window_width == place_.window_width && place.window_height == place_.window_height;
    place_ = place;
    const Views views = std::exchange(next_views_, {});
    if (!(place.whole_window || place.shown_whole) || !same_size) layers_[wire::kOffscreenSlot].reset();
    std::bitset<wire::kMaxTilesPerNode> wanted;
    bool affordable = !place.shown_whole || layers_[wire::kOffscreenSlot] || gather_whole();
    reaches_tiles_ = false;
    for (const Tile& tile : tiles) {
        const geom::Rect area = place.offscreen ? geom::Rect{} : geom::intersect(place.rect, tile.rect);
        if (area.empty() || tile.slot >= wire::kOffscreenSlot) continue;
        reaches_tiles_ = true;
        if (place.shown_whole) continue;
        const LayerGeometry geometry = geometry_on(tile, area, place, views);
        wanted.set(tile.slot);
        const Layer* now = layers_[tile.slot].get();
        if (now == nullptr || !(now->geometry() == geometry)) replace(tile.slot, make_layer(geometry, now));
        affordable = affordable && layers_[tile.slot] != nullptr;
    }
    for (std::uint32_t slot = 0; slot < wire::kOffscreenSlot; ++slot)
        if (!wanted[slot] && layers_[slot]) replace(slot, nullptr);
    return affordable;
}

/// At another scale they begin with nothing.
bool SurfaceReplica::gather_whole() {
    Layer* whole = layer(wire::kOffscreenSlot);
    if (whole == nullptr) return false;
    for (std::uint32_t slot = 0; slot < wire::kOffscreenSlot; ++slot)
        if (const Layer* tile = layers_[slot].get(); tile != nullptr && !tile->geometry().scaled())
            whole->take_content(*tile);
    return true;
}

const Layer* SurfaceReplica::shown_layer(std::uint32_t slot) const {
    return (replaced_[slot] ? older_ : layers_)[slot].get();
}

Layer* SurfaceReplica::layer(std::uint32_t slot) {
    auto& layer = layers_[slot];
    if (!layer && slot == wire::kOffscreenSlot && place_.window_width != 0 && place_.window_height != 0) {
        const geom::Rect window{0, 0, static_cast<std::int32_t>(place_.window_width),
                                static_cast<std::int32_t>(place_.window_height)};
        layer = make_layer({window, window, place_.window_width, place_.window_height}, nullptr);
    }
    return layer.get();
}

Layer* SurfaceReplica::whole_layer() {
    if (place_.offscreen || place_.shown_whole) return layer(wire::kOffscreenSlot);
    for (std::uint32_t slot = 0; slot < wire::kOffscreenSlot; ++slot)
        if (Layer* tile = layers_[slot].get(); tile != nullptr && tile->geometry().area == tile->geometry().surface &&
                                               !tile->geometry().scaled() && !tile->geometry().view)
            return tile;
    return nullptr;
}

bool SurfaceReplica::on_tiles() const {
    if (place_.shown_whole) return reaches_tiles_;
    return std::any_of(layers_.begin(), layers_.begin() + wire::kOffscreenSlot,
                       [](const auto& layer) { return layer != nullptr; });
}

void SurfaceReplica::finish_frame(std::uint32_t frame) {
    for (auto& layer : layers_)
        if (layer) layer->finish_frame();
    waiting_ = frame;
}

void SurfaceReplica::swap_offscreen() {
    Layer* layer = layers_[wire::kOffscreenSlot].get();
    if (layer == nullptr) return;
    layer->finish_frame();
    layer->show_frame();
}

void SurfaceReplica::show_frame() {
    shown_once_ = true;
    for (auto& layer : layers_)
        if (layer) layer->show_frame();
    shown_ = waiting_.value_or(shown_);
    waiting_.reset();
    forget_older();
}

}  // namespace wall::tileserver
