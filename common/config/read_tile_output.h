// SPDX-License-Identifier: MIT
// The keys of wall.toml that say how a tile's output shows its part of the canvas (docs/walls.md). Any thread.
#pragma once

#include <span>

#include "common/config/tree_reader.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// Reads rotation, pixels, warp, blend and color of one [[node.tile]], whose rect is known.
void read_tile_output(TreeReader& read, const toml::table& table, TileConfig& tile);

/// Of the whole wall, in the order of wall.toml.
struct DescribedTile {
    const toml::table* table;
    TileConfig* tile;
};
/// What bezels hide belongs to the canvas: a tile with `bezel_mm` moves by its bezels and those of its neighbours to
/// the left and above, at the density that `size_mm` says. Rects are as if there were none.
void place_behind_bezels(TreeReader& read, std::span<const DescribedTile> tiles);
/// An edge can only fade where another tile shows the same.
void check_blends(TreeReader& read, std::span<const DescribedTile> tiles);

}  // namespace wall::config
