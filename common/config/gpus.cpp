// SPDX-License-Identifier: MIT
#include "common/config/gpus.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace wall::config {
namespace {

/// What a GPU draws so far.
struct Hand {
    std::int64_t pixels = 0;
    std::vector<geom::Rect> tiles;
};

std::int64_t area(const geom::Rect& rect) { return std::int64_t{rect.width} * rect.height; }

/// Between the middles, times two and squared; as far as can be if there is none.
std::int64_t nearest(const std::vector<geom::Rect>& tiles, const geom::Rect& to) {
    std::int64_t out = std::numeric_limits<std::int64_t>::max();
    for (const auto& tile : tiles) {
        const std::int64_t x = std::int64_t{tile.x} + tile.right() - to.x - to.right();
        const std::int64_t y = std::int64_t{tile.y} + tile.bottom() - to.y - to.bottom();
        out = std::min(out, x * x + y * y);
    }
    return out;
}

net::Address behind(net::Address address, std::uint16_t part) {
    if (address.is_unix()) address.path += "." + std::to_string(part);
    else if (address.port != 0) address.port = static_cast<std::uint16_t>(address.port + part);
    return address;
}

}  // namespace

bool is_gpu_number(const std::string& gpu) { return gpu.find_first_not_of("0123456789") == std::string::npos; }

void deal_out(std::vector<TileConfig>& tiles, std::uint32_t gpus) {
    std::map<std::string, Hand> hands;
    for (std::uint32_t gpu = 0; gpu < gpus; ++gpu) hands[std::to_string(gpu)];
    std::vector<TileConfig*> rest;
    for (auto& tile : tiles) {
        if (tile.gpu == kAnyGpu) {
            rest.push_back(&tile);
            continue;
        }
        auto& hand = hands[tile.gpu];
        hand.pixels += area(tile.rect);
        hand.tiles.push_back(tile.rect);
    }
    if (hands.empty()) return;
    std::ranges::stable_sort(rest, {}, [](const TileConfig* tile) { return std::pair(tile->rect.y, tile->rect.x); });
    for (auto* tile : rest) {
        auto& [gpu, hand] = *std::ranges::min_element(hands, {}, [&](const auto& of_gpu) {
            return std::pair(of_gpu.second.pixels, -nearest(of_gpu.second.tiles, tile->rect));
        });
        tile->gpu = gpu;
        tile->dealt = true;
        hand.pixels += area(tile->rect);
        hand.tiles.push_back(tile->rect);
    }
}

std::vector<NodeConfig> split_by_gpu(const NodeConfig& node) {
    std::vector<NodeConfig> out;
    for (const auto& tile : node.tiles) {
        auto of_gpu = std::ranges::find(out, tile.gpu, &NodeConfig::gpu);
        if (of_gpu == out.end()) {
            auto& added = out.emplace_back(node);
            added.name += (is_gpu_number(tile.gpu) ? "/gpu" : "/") + tile.gpu;
            added.tiles.clear();
            added.part = static_cast<std::uint16_t>(out.size() - 1);
            if (added.part != 0) added.listen = behind(node.listen, added.part);
            of_gpu = out.end() - 1;
        }
        of_gpu->tiles.push_back(tile);
    }
    return out.size() <= 1 ? std::vector{node} : out;
}

}  // namespace wall::config
