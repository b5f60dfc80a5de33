// SPDX-License-Identifier: MIT
#include "tileserver/session/surface.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {

/// Whose layers there are on each tile.
std::span<const geom::Eye> SurfaceReplica::eyes() const {
    static constexpr std::array kTwo = {geom::Eye::left, geom::Eye::right};
    static constexpr std::array kOne = {geom::Eye::both};
    return format_.stereo ? std::span<const geom::Eye>(kTwo) : kOne;
}

std::unique_ptr<Layer> SurfaceReplica::make_layer(const LayerGeometry& geometry, geom::Eye eye, const Layer* older) {
    const auto pixels = pixels_taken(geometry, format_.layer);
    if (pixels > budget_.left) forget_older();
    if (pixels > budget_.left) return nullptr;
    LayerFormat format = format_.layer;
    format.eye = eye;
    auto layer = std::make_unique<Layer>(gl_, flip_y_, geometry, format, budget_);
    if (older && older->geometry().view == geometry.view && older->geometry().scale_x() == geometry.scale_x() &&
        older->geometry().scale_y() == geometry.scale_y())
        layer->take_content(*older);
    return layer;
}

/// The layer that was there stays in sight.
void SurfaceReplica::replace(std::size_t index, std::unique_ptr<Layer> layer) {
    if (keeps_older()) {
        if (!replaced_[index]) older_[index] = std::move(layers_[index]);
        replaced_.set(index);
    }
    layers_[index] = std::move(layer);
}

void SurfaceReplica::forget_older() {
    for (auto& layer : older_) layer.reset();
    replaced_.reset();
}

void SurfaceReplica::pair_eyes(std::uint32_t slot) {
    if (!format_.stereo) return;
    Layer* const left = layers_[index(slot, geom::Eye::left)].get();
    Layer* const right = layers_[index(slot, geom::Eye::right)].get();
    if (left != nullptr) left->set_other_eye(right);
    if (right != nullptr) right->set_other_eye(left);
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
    for (const geom::Eye eye : eyes())
        if (!(place.whole_window || place.shown_whole) || !same_size) layers_[index(wire::kOffscreenSlot, eye)].reset();
    std::bitset<kLayers> wanted;
    bool affordable = !place.shown_whole || layers_[wire::kOffscreenSlot] || gather_whole();
    reaches_tiles_ = false;
    for (const Tile& tile : tiles) {
        const geom::Rect area = place.offscreen ? geom::Rect{} : geom::intersect(place.rect, tile.rect);
        if (area.empty() || tile.slot >= wire::kTileSlots) continue;
        reaches_tiles_ = true;
        if (place.shown_whole) continue;
        const LayerGeometry geometry = geometry_on(tile, area, place, views);
        for (const geom::Eye eye : eyes()) {
            const std::size_t at = index(tile.slot, eye);
            wanted.set(at);
            const Layer* now = layers_[at].get();
            if (now == nullptr || !(now->geometry() == geometry)) replace(at, make_layer(geometry, eye, now));
            affordable = affordable && layers_[at] != nullptr;
        }
        pair_eyes(tile.slot);
    }
    for (std::uint32_t slot = 0; slot < wire::kTileSlots; ++slot)
        for (const geom::Eye eye : eyes())
            if (const std::size_t at = index(slot, eye); !wanted[at] && layers_[at]) replace(at, nullptr);
    return affordable;
}

/// At another scale they begin with nothing.
bool SurfaceReplica::gather_whole() {
    for (const geom::Eye eye : eyes()) {
        Layer* whole = layer(wire::kOffscreenSlot, eye);
        if (whole == nullptr) return false;
        for (std::uint32_t slot = 0; slot < wire::kTileSlots; ++slot)
            if (const Layer* tile = layers_[index(slot, eye)].get(); tile != nullptr && !tile->geometry().scaled())
                whole->take_content(*tile);
    }
    return true;
}

const Layer* SurfaceReplica::shown_layer(const Tile& tile) const {
    const std::size_t at = index(tile.slot, tile.eye);
    return (replaced_[at] ? older_ : layers_)[at].get();
}

LayerGeometry SurfaceReplica::geometry_of_part(const geom::Rect& part) const {
    const geom::Rect canvas{place_.rect.x + part.x, place_.rect.bottom() - part.bottom(), part.width, part.height};
    return {place_.rect, canvas, place_.window_width, place_.window_height, {}};
}

std::unique_ptr<Layer> SurfaceReplica::make_partial(const LayerGeometry& geometry) {
    const LayerFormat format{.double_buffered = false, .alpha = true, .srgb = format_.layer.srgb};
    if (pixels_taken(geometry, format) > budget_.left) return nullptr;
    return std::make_unique<Layer>(gl_, flip_y_, geometry, format, budget_);
}

Layer* SurfaceReplica::layer(std::uint32_t slot, geom::Eye eye) {
    auto& layer = layers_[index(slot, eye)];
    if (!layer && slot == wire::kOffscreenSlot && place_.window_width != 0 && place_.window_height != 0) {
        const geom::Rect window{0, 0, static_cast<std::int32_t>(place_.window_width),
                                static_cast<std::int32_t>(place_.window_height)};
        const bool right = format_.stereo && eye == geom::Eye::right;
        layer = make_layer({window, window, place_.window_width, place_.window_height},
                           right ? geom::Eye::right : eyes().front(), nullptr);
        pair_eyes(slot);
    }
    return layer.get();
}

Layer* SurfaceReplica::whole_layer(geom::Eye eye) {
    if (place_.offscreen || place_.shown_whole) return layer(wire::kOffscreenSlot, eye);
    for (std::uint32_t slot = 0; slot < wire::kTileSlots; ++slot)
        if (Layer* tile = layers_[index(slot, eye)].get(); tile != nullptr &&
                                                           tile->geometry().area == tile->geometry().surface &&
                                                           !tile->geometry().scaled() && !tile->geometry().view)
            return tile;
    return nullptr;
}

bool SurfaceReplica::on_tiles() const {
    if (place_.shown_whole) return reaches_tiles_;
    return std::any_of(layers_.begin(), layers_.begin() + wire::kTileSlots,
                       [](const auto& layer) { return layer != nullptr; });
}

void SurfaceReplica::finish_frame(std::uint32_t frame) {
    for (auto& layer : layers_)
        if (layer) layer->finish_frame();
    waiting_ = frame;
}

void SurfaceReplica::swap_offscreen() {
    for (const geom::Eye eye : eyes()) {
        Layer* layer = layers_[index(wire::kOffscreenSlot, eye)].get();
        if (layer == nullptr) continue;
        layer->finish_frame();
        layer->show_frame();
    }
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
