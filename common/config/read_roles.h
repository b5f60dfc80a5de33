// SPDX-License-Identifier: MIT
// `role` of a [[node]], and what follows from it.
#pragma once

#include <vector>

#include "common/config/tree_reader.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// A word, or several: what the node does for programs whose geometry is dealt to nodes; without it it renders and
/// displays.
Roles read_roles(TreeReader& read, const toml::table& node);

/// The node's [[node.tile]], at least one; a node that shows nothing may have none.
std::vector<const toml::table*> tile_tables(TreeReader& read, const toml::table& node);

}  // namespace wall::config
