// SPDX-License-Identifier: MIT
#include "tileserver/render/surface.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {

std::unique_ptr<Layer> Surface::make_layer(const LayerGeometry& geometry, std::unique_ptr<Layer> older) {
    if (older && older->geometry() == geometry) return older;
    if (std::int64_t{geometry.area.width} * geometry.area.height > budget_.left) return nullptr;
    auto layer = std::make_unique<Layer>(gl_, flip_y_, geometry, format_.layer, budget_);
    if (older && older->geometry().scale_x() == geometry.scale_x() && older->geometry().scale_y() == geometry.scale_y()) layer->take_content(*older);
    return layer;
}

bool Surface::place(const SurfacePlace& place, const std::vector<Tile>& tiles) {
    place_ = place;
    layers_[wire::kOffscreenSlot].reset();
    std::array<bool, wire::kMaxTilesPerNode> wanted{};
    bool affordable = true;
    for (const Tile& tile : tiles) {
        const geom::Rect area = place.offscreen ? geom::Rect{} : geom::intersect(place.rect, tile.rect);
        if (area.empty() || tile.slot >= wire::kOffscreenSlot) continue;
        auto& layer = layers_[tile.slot];
        layer = make_layer({place.rect, area, place.window_width, place.window_height}, std::move(layer));
        wanted[tile.slot] = true;
        affordable = affordable && layer != nullptr;
    }
    for (std::size_t slot = 0; slot < layers_.size(); ++slot)
        if (!wanted[slot]) layers_[slot].reset();
    return affordable;
}

Layer* Surface::layer(std::uint32_t slot) {
    auto& layer = layers_[slot];
    if (!layer && slot == wire::kOffscreenSlot && place_.window_width != 0 && place_.window_height != 0) {
        const geom::Rect window{0, 0, static_cast<std::int32_t>(place_.window_width), static_cast<std::int32_t>(place_.window_height)};
        layer = make_layer({window, window, place_.window_width, place_.window_height}, nullptr);
    }
    return layer.get();
}

bool Surface::on_tiles() const {
    return std::any_of(layers_.begin(), layers_.begin() + wire::kOffscreenSlot, [](const auto& layer) { return layer != nullptr; });
}

void Surface::finish_frame(std::uint32_t frame) {
    for (auto& layer : layers_)
        if (layer) layer->finish_frame();
    waiting_ = frame;
}

void Surface::show_frame() {
    for (auto& layer : layers_)
        if (layer) layer->show_frame();
    waiting_.reset();
}

}  // namespace wall::tileserver
