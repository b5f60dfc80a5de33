// SPDX-License-Identifier: MIT
// The keys of wall.toml that say where a tile is shown. Any thread.
#pragma once

#include "common/config/tree_reader.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// Reads where one [[node.tile]] is shown: in a window, on a monitor without a window system, or nowhere.
void read_output(TreeReader& read, const toml::table& tile, TileConfig& out);
/// Checks that the node's last tile, which `tile` describes, goes with the backend and with the tiles before it.
void check_output(TreeReader& read, const toml::table& tile, const NodeConfig& node);

}  // namespace wall::config
