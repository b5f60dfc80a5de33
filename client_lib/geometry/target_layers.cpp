// SPDX-License-Identifier: MIT
#include "client_lib/geometry/target_layers.h"

#include <algorithm>
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

/// Layers mostly come in the order of their nodes, and then one look at the last node is enough; a search for each
/// would take a thousand nodes a million looks.
void nodes_touched(std::span<const TargetLayer> layers, const Reach& reach, NodeMasks& out) {
    out.clear();
    bool in_order = true;  // so far
    for (const TargetLayer& layer : layers) {
        if (!reach.touches(layer)) continue;
        if (out.empty() || (in_order && out.back().node < layer.node)) {
            out.push_back({layer.node, layer.bit()});
        } else if (out.back().node == layer.node) {
            out.back().slots |= layer.bit();
        } else if (const auto known = std::ranges::find(out, layer.node, &NodeMask::node); known != out.end()) {
            known->slots |= layer.bit();
        } else {
            in_order = false;
            out.push_back({layer.node, layer.bit()});
        }
    }
}

std::size_t count_nodes(std::span<const TargetLayer> layers) {
    if (!std::ranges::is_sorted(layers, {}, &TargetLayer::node)) return nodes_touched(layers, std::nullopt).size();
    std::size_t nodes = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) nodes += i == 0 || layers[i].node != layers[i - 1].node ? 1 : 0;
    return nodes;
}

NodeMasks nodes_touched(std::span<const TargetLayer> layers, const Reach& reach) {
    NodeMasks out;
    nodes_touched(layers, reach, out);
    return out;
}

}  // namespace wall::client
