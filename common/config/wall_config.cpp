// SPDX-License-Identifier: MIT
#include "common/config/wall_config.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace wall::config {

const char* name_of(Backend backend) { return backend == Backend::egl ? "egl" : "osmesa"; }

const char* output_name(const TileConfig& tile) {
    if (tile.kms) return "kms";
    return tile.window ? "window" : "headless";
}

namespace {

/// The same screens for the same tiles. The size of a window cannot change.
bool same_screen(const TileConfig& a, const TileConfig& b) {
    const bool same_window = !a.window || (a.output.width == b.output.width && a.output.height == b.output.height);
    return a.name == b.name && a.rect == b.rect && a.window == b.window && a.kms == b.kms && same_window;
}

}  // namespace

bool draws_as(const NodeConfig& a, const NodeConfig& b) {
    const bool headless = std::ranges::all_of(a.tiles, is_headless) && std::ranges::all_of(b.tiles, is_headless);
    return a.name == b.name && a.process == b.process && a.part == b.part && a.backend == b.backend &&
           a.listen == b.listen && a.triangle_order == b.triangle_order && a.roles == b.roles &&
           a.partial_codec == b.partial_codec && a.gpu() == b.gpu() &&
           (headless || std::ranges::equal(a.tiles, b.tiles, same_screen));
}

bool same_tiles(const NodeConfig& a, const NodeConfig& b) {
    const auto drawn = [](const TileConfig& tile) {
        return std::tie(tile.name, tile.slot, tile.rect, tile.view, tile.eye);
    };
    return std::ranges::equal(a.tiles, b.tiles, {}, drawn, drawn);
}

const TileConfig* NodeConfig::tile(std::uint32_t slot) const {
    const auto found = std::ranges::find(tiles, slot, &TileConfig::slot);
    return found == tiles.end() ? nullptr : &*found;
}

geom::Rect WallConfig::canvas() const {
    geom::Rect out;
    for (const auto& node : nodes) {
        for (const auto& tile : node.tiles) {
            out.width = std::max(out.width, tile.rect.right());
            out.height = std::max(out.height, tile.rect.bottom());
        }
    }
    return out;
}

const NodeConfig* WallConfig::find_node(std::string_view node) const {
    const auto found = std::ranges::find(nodes, node, &NodeConfig::name);
    return found == nodes.end() ? nullptr : &*found;
}

std::vector<NodeConfig> WallConfig::nodes_of(std::string_view process) const {
    std::vector<NodeConfig> out;
    std::ranges::copy_if(nodes, std::back_inserter(out), [&](const auto& node) { return node.process == process; });
    return out;
}

}  // namespace wall::config
