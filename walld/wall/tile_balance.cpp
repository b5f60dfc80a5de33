// SPDX-License-Identifier: MIT
#include "walld/wall/tile_balance.h"

#include <algorithm>
#include <map>

namespace wall::walld {
namespace {

constexpr double kBusy = 0.3;        // a GPU's load from which on it may be what a wall waits for
constexpr double kLeastGain = 0.15;  // of the busiest GPU's load; measurements differ by some hundredths

}  // namespace

std::optional<BetterPlace> better_place(const std::vector<NodeIndex>& gpus, const std::vector<TileLoad>& tiles) {
    if (gpus.empty()) return std::nullopt;
    std::map<NodeIndex, double> loads;
    for (const NodeIndex gpu : gpus) loads[gpu] = 0;
    for (const auto& tile : tiles) loads[tile.node] += tile.load;
    const auto by_load = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto [busiest, most] = *std::ranges::max_element(loads, by_load);
    if (most < kBusy || std::ranges::count(tiles, busiest, &TileLoad::node) < 2) return std::nullopt;
    std::optional<BetterPlace> best;
    for (const auto& tile : tiles) {
        if (tile.node != busiest || tile.stays) continue;
        for (const auto& [to, load] : loads) {
            if (to == busiest) continue;
            auto after = loads;
            after[busiest] -= tile.load;
            after[to] += tile.load;
            const double gain = most - std::ranges::max_element(after, by_load)->second;
            if (gain >= kLeastGain * most && (!best || gain > best->gain)) best = {tile.tile, to, gain};
        }
    }
    return best;
}

}  // namespace wall::walld
