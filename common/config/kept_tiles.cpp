// SPDX-License-Identifier: MIT
#include "common/config/kept_tiles.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/config/eyes.h"

namespace wall::config {
namespace {

using Nodes = std::vector<NodeConfig*>;  // of one tileserver

struct Kept {
    std::uint32_t slot = 0;
    std::string node;
};

Nodes nodes_of(WallConfig& wall, const std::string& process) {
    Nodes out;
    for (auto& node : wall.nodes)
        if (node.process == process) out.push_back(&node);
    return out;
}

bool headless(const NodeConfig& node) { return std::ranges::all_of(node.tiles, is_headless); }

/// With the picture of its right eye, if it has one.
void move(const std::string& tile, NodeConfig& from, NodeConfig& to) {
    const auto goes = [&](const TileConfig& t) { return t.name == tile || t.name == companion_name(tile); };
    const auto gpu = to.gpu();
    for (auto& moved : from.tiles)
        if (goes(moved)) to.tiles.emplace_back(moved).gpu = gpu;
    std::erase_if(from.tiles, goes);
}

void keep_gpus(const Nodes& nodes, const std::map<std::string, Kept>& kept) {
    for (NodeConfig* node : nodes) {
        for (const auto& tile : std::vector(node->tiles)) {
            const auto known = kept.find(tile.name);
            if (!tile.dealt || known == kept.end() || known->second.node == node->name) continue;
            const auto to = std::ranges::find(nodes, known->second.node, &NodeConfig::name);
            const auto with_it = std::ranges::count_if(node->tiles, &TileConfig::dealt);
            if (to != nodes.end() && with_it > 1) move(tile.name, *node, **to);
        }
    }
}

/// Those that are new get the first that are free.
void keep_slots(const Nodes& nodes, const std::map<std::string, Kept>& kept) {
    std::vector<TileConfig*> tiles, fresh;
    for (NodeConfig* node : nodes)
        for (auto& tile : node->tiles) tiles.push_back(&tile);
    std::set<std::uint32_t> taken;
    for (TileConfig* tile : tiles) {
        const auto known = kept.find(tile->name);
        if (known == kept.end()) fresh.push_back(tile);
        else taken.insert(tile->slot = known->second.slot);
    }
    std::uint32_t next = 0;
    for (TileConfig* tile : fresh) {
        while (taken.contains(next)) ++next;
        taken.insert(tile->slot = next);
    }
    for (TileConfig* tile : tiles) {
        const auto right = std::ranges::find(tiles, companion_name(tile->name), &TileConfig::name);
        if (right != tiles.end()) tile->output.right_slot = (*right)->slot;
    }
}

}  // namespace

void keep_tiles(WallConfig& next, const WallConfig& now) {
    std::set<std::string> processes;
    for (const auto& node : now.nodes) processes.insert(node.process);
    for (const auto& process : processes) {
        const auto before = now.nodes_of(process);
        const auto nodes = nodes_of(next, process);
        if (!std::ranges::all_of(before, headless)) continue;
        if (!std::ranges::all_of(nodes, [](const NodeConfig* node) { return headless(*node); })) continue;
        std::map<std::string, Kept> kept;
        for (const auto& node : before)
            for (const auto& tile : node.tiles)
                if (!tile.arriving) kept.emplace(tile.name, Kept{tile.slot, node.name});
        keep_gpus(nodes, kept);
        keep_slots(nodes, kept);
    }
}

}  // namespace wall::config
