// SPDX-License-Identifier: MIT
// A [[node]] whose tiles several GPUs draw is a node of the wall for each of them: programs send each what lies on its
// tiles, hold objects only where they draw with them, and walld presents a frame when all have it (docs/gpus.md,
// O3.1, O3.2). Pure; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/wall_config.h"

namespace wall::config {

inline constexpr const char* kAnyGpu = "auto";

/// Else it is a PCI address.
bool is_gpu_number(const std::string& gpu);

/// Says which GPU draws each tile of "auto", if there are several: 0 to `gpus` - 1, or, if that is 0, those that other
/// tiles name. In the canvas' order, the one with the fewest pixels so far gets the next tile; of several, that whose
/// tiles lie farthest away. So neighbours are drawn by different GPUs, which share what is costly in one place of the
/// wall (OCTAVIS 5.3: 1.32 times faster than blocks of tiles).
void deal_out(std::vector<TileConfig>& tiles, std::uint32_t gpus);

/// One for each GPU that draws a tile, in the order of the tiles: NODE/gpu0, NODE/0000:65:00.0. The first listens where
/// the node does, the others on the ports behind that, or at PATH.1, PATH.2, ... With one GPU it is the same node.
std::vector<NodeConfig> split_by_gpu(const NodeConfig& node);

}  // namespace wall::config
