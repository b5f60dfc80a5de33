// SPDX-License-Identifier: MIT
#include "common/config/read_output.h"

#include <span>
#include <string>

namespace wall::config {
namespace {

constexpr std::int64_t kMaxPosition = 32767;  // X has 16 bits for it

/// Keys that mean nothing without a window, or beside another key.
void refuse_key(TreeReader& read, const toml::table& tile, std::string_view key, std::string_view why) {
    if (const auto* node = tile.get(key)) read.refuse(node->source(), TreeReader::quoted(key) + " " + std::string(why));
}

std::string display_text(const WindowConfig& window) {
    return window.display.empty() ? "$DISPLAY" : "display \"" + window.display + "\"";
}

/// Two windows of a node, of which `tile` describes the second.
void check_beside(TreeReader& read, const toml::table& tile, const TileConfig& second, const TileConfig& first) {
    const auto &mine = *second.window, &others = *first.window;
    if (others.display != mine.display) {
        const auto* key = tile.get("display");
        read.refuse(key ? key->source() : tile.source(),
                    "tile '" + second.name + "' is on " + display_text(mine) + ", tile '" + first.name + "' on " +
                        display_text(others) + ": expected one display for all windows of a node (or a node for each)");
    }
    if (!mine.monitor.empty() && others.monitor == mine.monitor)
        read.refuse(tile.get("monitor")->source(), "monitor '" + mine.monitor + "' shows tile '" + first.name +
                                                       "' already: expected one tile for a monitor");
}

}  // namespace

std::optional<WindowConfig> read_output(TreeReader& read, const toml::table& tile) {
    const auto output = read.text(tile, "output", "headless");
    if (output == "headless") {
        for (const auto* key : {"display", "monitor", "position"})
            refuse_key(read, tile, key, "is of a tile in a window: expected output = \"window\" beside it");
        return {};
    }
    if (output != "window")
        read.refuse(tile.get("output")->source(), "'output' is '" + output + "': expected \"headless\" or \"window\"");
    WindowConfig out;
    if (tile.get("display")) out.display = read.text(tile, "display");
    if (tile.get("monitor")) {
        out.monitor = read.text(tile, "monitor");
        refuse_key(read, tile, "position", "beside 'monitor': expected one of them");
    }
    const auto position = read.position(tile, "position", kMaxPosition);
    out.x = position[0];
    out.y = position[1];
    return out;
}

void check_output(TreeReader& read, const toml::table& tile, const NodeConfig& node) {
    const auto& last = node.tiles.back();
    if (!last.window) return;
    if (node.backend != Backend::egl)
        read.refuse(tile.get("output")->source(),
                    "'output' is 'window' on a node with backend \"osmesa\", which draws into memory only: "
                    "expected backend = \"egl\" or output = \"headless\"");
    for (const auto& other : std::span(node.tiles).first(node.tiles.size() - 1))
        if (other.window) check_beside(read, tile, last, other);
}

}  // namespace wall::config
