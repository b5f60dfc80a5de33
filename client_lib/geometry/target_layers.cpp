// SPDX-License-Identifier: MIT
#include "client_lib/geometry/target_layers.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/wire/limits.h"

namespace wall::client {

bool TargetLayer::is_whole_window() const { return slot == wire::kOffscreenSlot; }

TargetLayer tile_layer(const SurfaceLayout& layout, NodeIndex node, std::uint32_t slot, const geom::Rect& part) {
    const float sx = static_cast<float>(layout.width) / static_cast<float>(layout.rect.width);
    const float sy = static_cast<float>(layout.height) / static_cast<float>(layout.rect.height);
    const auto height = static_cast<float>(layout.height);
    const PixelRect area{static_cast<float>(part.x - layout.rect.x) * sx,
                         height - static_cast<float>(part.bottom() - layout.rect.y) * sy,
                         static_cast<float>(part.right() - layout.rect.x) * sx,
                         height - static_cast<float>(part.y - layout.rect.y) * sy};
    const int x0 = static_cast<int>(std::floor(area.x0)), y0 = static_cast<int>(std::floor(area.y0));
    const geom::Rect pixels{x0, y0, static_cast<int>(std::ceil(area.x1)) - x0,
                            static_cast<int>(std::ceil(area.y1)) - y0};
    return {node, slot, area, pixels};
}

TargetLayer view_layer(const SurfaceLayout& layout, NodeIndex node, std::uint32_t slot, std::uint32_t view) {
    TargetLayer layer = tile_layer(layout, node, slot, layout.rect);
    layer.view = view;
    return layer;
}

TargetLayer whole_window(const SurfaceLayout& layout, NodeIndex node, const geom::Rect& part) {
    return tile_layer(layout, node, wire::kOffscreenSlot, part);
}

TargetLayer whole_window(std::uint32_t width, std::uint32_t height, NodeIndex node) {
    const geom::Rect all{0, 0, static_cast<int>(width), static_cast<int>(height)};
    return whole_window({.width = width, .height = height, .rect = all}, node, all);
}

void nodes_touched(std::span<const TargetLayer> layers, const Reach& reach, NodeMasks& out) {
    out.clear();
    for (const TargetLayer& layer : layers) {
        if (!reach.touches(layer)) continue;
        auto mask = std::find_if(out.rbegin(), out.rend(), [&](const NodeMask& m) { return m.node == layer.node; });
        NodeMask& of_node = mask != out.rend() ? *mask : out.emplace_back(NodeMask{layer.node, 0});
        of_node.slots |= layer.bit();
    }
}

std::size_t count_nodes(std::span<const TargetLayer> layers) {
    std::uint64_t seen = 0;
    for (const TargetLayer& layer : layers) seen |= std::uint64_t{1} << (layer.node.value & 63);
    return static_cast<std::size_t>(std::popcount(seen));
}

NodeMasks nodes_touched(std::span<const TargetLayer> layers, const Reach& reach) {
    NodeMasks out;
    nodes_touched(layers, reach, out);
    return out;
}

}  // namespace wall::client
