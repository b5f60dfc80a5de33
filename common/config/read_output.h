// SPDX-License-Identifier: MIT
// The keys of wall.toml that say where a tile is shown. Any thread.
#pragma once

#include <optional>

#include "common/config/tree_reader.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// Reads the window of one [[node.tile]]; none: the tile is headless.
std::optional<WindowConfig> read_output(TreeReader& read, const toml::table& tile);
/// Checks that the node's last tile, which `tile` describes, goes with the backend and with the tiles before it.
void check_output(TreeReader& read, const toml::table& tile, const NodeConfig& node);

}  // namespace wall::config
