// SPDX-License-Identifier: MIT
// One window of a session on this node: its format, its place on the canvas, and a layer on each tile that it touches.
// Render thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/geom/rect.h"
#include "common/geom/tile_output.h"
#include "common/geom/view.h"
#include "common/wire/limits.h"
#include "tileserver/driver/layer.h"

namespace wall::tileserver {

/// A tile of this node; its slot is the bit in tile masks.
struct Tile {
    std::uint32_t slot = 0;
    geom::Rect rect;                                 ///< canvas
    std::shared_ptr<const geom::TileOutput> output;  ///< none: pixel for pixel
    geom::Eye eye = geom::Eye::both;                 ///< whose picture it shows
};

struct SurfaceFormat {
    LayerFormat layer;
    bool accum = false;
    bool stereo = false;  ///< it has buffers for each eye
    bool operator==(const SurfaceFormat&) const = default;
};

struct SurfacePlace {
    std::uint32_t layout_version = 0;
    std::uint32_t window_width = 0, window_height = 0;
    geom::Rect rect;            ///< canvas pixels that the whole window covers
    bool offscreen = false;     ///< on no tile
    bool whole_window = false;  ///< the layer of the whole window stays, if there is one
    bool shown_whole = false;   ///< there is only that layer, and tiles show parts of it
    bool operator==(const SurfacePlace&) const = default;
};

class SurfaceReplica {
public:
    SurfaceReplica(const Gl& gl, bool flip_y, const SurfaceFormat& format, PixelBudget& budget)
        : gl_(gl), flip_y_(flip_y), format_(format), budget_(budget) {}

    /// What tiles show instead of the program's own picture, by their slots: at its next place all of the window lies
    /// on each of those that it covers and that look elsewhere.
    using Views = std::map<std::uint32_t, geom::EyeView>;
    void look(Views views) { next_views_ = std::move(views); }
    /// Makes the layers anew where they differ; what stays in sight keeps its pixels. What the wall shows stays as it
    /// is until the first frame drawn there is shown. False: that is more than the session may have, and some layers
    /// are missing. No frame may wait to be shown: it would be lost.
    bool place(const SurfacePlace& place, const std::vector<Tile>& tiles);
    /// Whether place() itself may change what the wall shows.
    bool is_seen_at_once(const SurfacePlace& place) const {
        return !keeps_older() || place.shown_whole || place_.shown_whole;
    }
    /// Null if the surface does not reach the tile. The off-screen slot gives a layer of the whole window for any
    /// surface.
    Layer* layer(std::uint32_t slot, geom::Eye eye = geom::Eye::both);
    const Layer* layer(std::uint32_t slot, geom::Eye eye = geom::Eye::both) const {
        return layers_[index(slot, eye)].get();
    }

    /// Of a layer that holds a part of the window as a tile would that shows it.
    LayerGeometry geometry_of_part(const geom::Rect& window_pixels) const;
    /// A layer for PartialLayers. Null: over the budget.
    std::unique_ptr<Layer> make_partial(const LayerGeometry& geometry);

    /// The layer that has all of the window's pixels as they are; null: none here does.
    Layer* whole_layer(geom::Eye eye);

    /// What the wall shows on the tile, if anything.
    const Layer* shown_layer(const Tile& tile) const;

    /// The layer of the whole window, if tiles show parts of it; where shown_layer() gives one, that comes first.
    const Layer* shown_whole_layer(geom::Eye eye) const {
        return place_.shown_whole ? layer(wire::kOffscreenSlot, eye) : nullptr;
    }

    const SurfaceFormat& format() const { return format_; }
    const SurfacePlace& where() const { return place_; }
    bool on_tiles() const;

    /// A frame has been drawn and waits to be shown.
    void finish_frame(std::uint32_t frame);
    void show_frame();
    /// A frame has been drawn in the layer of the whole window alone, for nobody to be shown.
    void swap_offscreen();
    std::optional<std::uint32_t> waiting_frame() const { return waiting_; }
    /// The last one on show; 0: none.
    std::uint32_t shown_frame() const { return shown_; }
    /// It has something on show: without a back buffer, whatever there is.
    bool shows_something() const { return shown_ > 0 || !format_.layer.double_buffered; }

private:
    /// How it lies on a tile that it has `area` in common with.
    static LayerGeometry geometry_on(const Tile& tile, const geom::Rect& area, const SurfacePlace& place,
                                     const Views& views);
    /// By slot those of the left eye, which are all that most windows have, then those of the right one.
    static constexpr std::size_t kLayers = std::size_t{2} * wire::kMaxTilesPerNode;
    using Layers = std::array<std::unique_ptr<Layer>, kLayers>;
    std::size_t index(std::uint32_t slot, geom::Eye eye) const {
        return slot + (format_.stereo && eye == geom::Eye::right ? std::size_t{wire::kMaxTilesPerNode} : 0);
    }
    std::span<const geom::Eye> eyes() const;

    /// Without a back buffer, and before the first frame, there is nothing to keep.
    bool keeps_older() const { return format_.layer.double_buffered && shown_once_; }
    /// With the content of `older`, if there is one. Null: over the budget.
    std::unique_ptr<Layer> make_layer(const LayerGeometry& geometry, geom::Eye eye, const Layer* older);
    /// The layer of the whole window gets what the tiles' layers hold. False: over the budget.
    bool gather_whole();
    void replace(std::size_t index, std::unique_ptr<Layer> layer);
    void forget_older();
    /// The two eyes' layers on a tile know each other.
    void pair_eyes(std::uint32_t slot);

    const Gl& gl_;
    bool flip_y_;
    SurfaceFormat format_;
    PixelBudget& budget_;
    SurfacePlace place_;
    Views next_views_;
    Layers layers_;  ///< that are drawn on
    std::optional<std::uint32_t> waiting_;
    std::uint32_t shown_ = 0;
    bool shown_once_ = false;
    bool reaches_tiles_ = false;  ///< the place has something in common with a tile

    // Of a move that is not shown yet.
    Layers older_;                   ///< that are shown, where they are others
    std::bitset<kLayers> replaced_;  ///< where others are drawn on than shown
};

}  // namespace wall::tileserver
