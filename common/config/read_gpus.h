// SPDX-License-Identifier: MIT
// The keys of wall.toml that say which GPUs of a machine draw its tiles. Any thread.
#pragma once

#include <string>
#include <vector>

#include "common/config/tree_reader.h"
#include "common/config/wall_config.h"

namespace wall::config {

/// Of one [[node.tile]]: "auto", a number, or a PCI address.
std::string read_gpu(TreeReader& read, const toml::table& tile);

/// Reads 'gpus' of each [[node]] of `root`, which are `nodes` in their order, and makes nodes of their GPUs.
void read_gpus(TreeReader& read, const toml::table& root, std::vector<NodeConfig>& nodes);

}  // namespace wall::config
