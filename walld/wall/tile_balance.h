// SPDX-License-Identifier: MIT
// Which tile another GPU of the same tileserver had better draw, by what drawing each takes now (O5.3, which
// shares screens out by measured cost). Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/ids.h"

namespace wall::walld {

/// A tile's share of its GPU's time, 0 to 1.
struct TileLoad {
    std::string tile;
    NodeIndex node;  ///< of the GPU that draws it
    double load = 0;
    bool stays = false;  ///< wall.toml says which GPU draws it, or it has been tried
};

struct BetterPlace {
    std::string tile;
    NodeIndex to;
    double gain = 0;  ///< by so much the busiest GPU's load falls
};

/// The move after which the busiest of `gpus` is least busy; nothing: none that gains as much as a move must. A GPU
/// whose tiles take little of its time is left alone: then nothing waits for it.
std::optional<BetterPlace> better_place(const std::vector<NodeIndex>& gpus, const std::vector<TileLoad>& tiles);

}  // namespace wall::walld
