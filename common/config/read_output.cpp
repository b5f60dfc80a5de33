// SPDX-License-Identifier: MIT
#include "common/config/read_output.h"

#include <span>
#include <string>

namespace wall::config {
namespace {

constexpr std::int64_t kMaxPosition = 32767;  // X has 16 bits for it
constexpr std::int64_t kMaxGpu = 63;
constexpr std::size_t kLeastAddress = 7, kMostAddress = 16;  // "65:00.0", "00000000:65:00.0"

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

/// All tiles of a node are drawn by one GPU so far.
void check_gpu(TreeReader& read, const toml::table& tile, const NodeConfig& node) {
    const auto& last = node.tiles.back();
    const auto* key = tile.get("gpu");
    if (key && node.backend != Backend::egl)
        read.refuse(key->source(),
                    "'gpu' of a node with backend \"osmesa\", which draws without one: expected backend = "
                    "\"egl\"");
    if (key && last.window)
        read.refuse(key->source(),
                    "'gpu' of a tile in a window, which the X server's graphics card draws: expected none");
    if (last.gpu != node.tiles.front().gpu)
        read.refuse(key ? key->source() : tile.source(),
                    "tile '" + last.name + "' is drawn by GPU " + last.gpu + ", tile '" + node.tiles.front().name +
                        "' by " + node.tiles.front().gpu +
                        ": expected one GPU for all tiles of a node (or a node for each GPU)");
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

std::string read_gpu(TreeReader& read, const toml::table& tile) {
    const auto* node = tile.get("gpu");
    if (!node) return "auto";
    if (node->is_integer()) return std::to_string(read.integer(*node, "'gpu'", 0, kMaxGpu));
    const auto text = node->is_string() ? node->as_string()->get() : "";
    const bool is_address = text.size() >= kLeastAddress && text.size() <= kMostAddress &&
                            text.find_first_not_of("0123456789abcdef:.") == std::string::npos &&
                            text.find(':') != std::string::npos;
    if (text == "auto" || is_address) return text;
    read.refuse(node->source(),
                "'gpu': expected \"auto\", a number (`tileserver --gpus` lists them), or a PCI address such as "
                "\"0000:65:00.0\"");
    return "auto";
}

void check_output(TreeReader& read, const toml::table& tile, const NodeConfig& node) {
    check_gpu(read, tile, node);
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
