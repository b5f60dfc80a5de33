// SPDX-License-Identifier: MIT
// Tiles for two eyes (docs/walls.md, "Stereo"): the keys of wall.toml that say which eye a tile is for, or that its
// output shows both, for which it has a companion. Any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/config/read_tile_output.h"
#include "common/config/tree_reader.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// `eye` and `stereo` of one [[node.tile]], whose output has been read.
void read_eyes(TreeReader& read, const toml::table& table, TileConfig& tile);
/// A tile for one eye has one for the other where it lies.
void check_eyes(TreeReader& read, std::span<const DescribedTile> tiles);

/// Each tile whose output shows both eyes is for the left one; behind all others comes a tile for the right one, whose
/// pictures the output shows as well. After the tiles have been dealt out to GPUs.
void add_companions(NodeConfig& node);
/// The tile's, among those of its node; null: it has none.
TileConfig* companion_of(const TileConfig& tile, std::vector<TileConfig>& tiles);
/// What it is called.
std::string companion_name(const std::string& tile);

}  // namespace wall::config
