// SPDX-License-Identifier: MIT
#include "common/config/wall_config.h"

#include <algorithm>

namespace wall::config {

const char* name_of(Backend backend) { return backend == Backend::egl ? "egl" : "osmesa"; }

const char* output_name(const TileConfig& tile) { return tile.window ? "window" : "headless"; }

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

}  // namespace wall::config
