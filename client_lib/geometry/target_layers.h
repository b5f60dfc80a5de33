// SPDX-License-Identifier: MIT
// Where the pixels of what is drawn to lie: in layers on nodes; and which of them a rectangle touches. Pure; the
// caller's thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/ids.h"
#include "common/geom/pixel_rect.h"
#include "common/geom/rect.h"
#include "common/geom/view.h"

namespace wall::client {

using geom::PixelRect;

/// One layer of a target: a tile's, or a node's layer of the whole window.
struct TargetLayer {
    NodeIndex node;
    std::uint32_t slot = 0;
    PixelRect area;     ///< of the window: what is seen of it here
    geom::Rect pixels;  ///< the same, whole pixels, rounded outwards
    /// What it shows instead of its part of the picture: SurfaceLayout::views[view - 1]; 0: it shows that part.
    std::uint32_t view = 0;

    std::uint64_t bit() const { return std::uint64_t{1} << slot; }  ///< in a Block's mask
    bool is_whole_window() const;                                   ///< made by whole_window()
};

/// What a tile shows of a window's scene, instead of a part of its picture. Where it looks elsewhere all of the window
/// lies on the tile.
struct SurfaceView {
    geom::EyeView view;
    float window_pixels_x = 1, window_pixels_y = 1;  ///< that one of the tile's is as large as
    bool operator==(const SurfaceView&) const = default;
};

/// How a surface lies on the wall just now.
struct SurfaceLayout {
    std::uint32_t version = 0;
    std::uint32_t width = 0, height = 0;  ///< window
    geom::Rect rect;                      ///< canvas
    bool offscreen = false;               ///< on no tile, ever: a pixel buffer
    std::vector<TargetLayer> layers;
    std::vector<SurfaceView> views;  ///< that some of them show
};

/// Where something is drawn, in window pixels; nothing: it may be anywhere.
struct Reach {
    Reach() = default;
    Reach(const PixelRect& rect) : window(rect) {}  // NOLINT: in all of them
    Reach(std::nullopt_t) {}                        // NOLINT: all of them
    Reach(const std::optional<PixelRect>& rect, std::span<const std::optional<PixelRect>> by_view = {})  // NOLINT
        : window(rect), views(by_view) {}
    std::optional<PixelRect> window;                  ///< in the program's own picture
    std::span<const std::optional<PixelRect>> views;  ///< in each view; none: as there
    const std::optional<PixelRect>& on(const TargetLayer& layer) const {
        return layer.view == 0 || views.empty() ? window : views[layer.view - 1];
    }
    bool touches(const TargetLayer& layer) const {
        const auto& rect = on(layer);
        return !rect || rect->overlaps(layer.area);
    }
};

/// The layer of a node's tile that shows `part` of the canvas.
TargetLayer tile_layer(const SurfaceLayout& layout, NodeIndex node, std::uint32_t slot, const geom::Rect& part);
/// The layer of a node's tile that shows all of the window through a view.
TargetLayer view_layer(const SurfaceLayout& layout, NodeIndex node, std::uint32_t slot, std::uint32_t view);
/// The layer that a node has of the whole window, at the window's own resolution and apart from its tiles; only `part`
/// of the canvas is to be seen there.
TargetLayer whole_window(const SurfaceLayout& layout, NodeIndex node, const geom::Rect& part);
/// The same with all of a window of this size to be seen, wherever the window lies.
TargetLayer whole_window(std::uint32_t width, std::uint32_t height, NodeIndex node);

/// Some layers of one node.
struct NodeMask {
    NodeIndex node;
    std::uint64_t slots;  ///< a bit each
};
using NodeMasks = std::vector<NodeMask>;

/// The layers that something touches. Each node once.
NodeMasks nodes_touched(std::span<const TargetLayer> layers, const Reach& reach);
/// The same into a vector that is used again and again, so that no memory is asked for.
void nodes_touched(std::span<const TargetLayer> layers, const Reach& reach, NodeMasks& out);
/// On how many nodes the layers lie.
std::size_t count_nodes(std::span<const TargetLayer> layers);

}  // namespace wall::client
