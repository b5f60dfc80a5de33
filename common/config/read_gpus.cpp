// SPDX-License-Identifier: MIT
#include "common/config/read_gpus.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "common/config/gpus.h"
#include "common/config/read_roles.h"

namespace wall::config {
namespace {

constexpr std::int64_t kMostGpus = 64;
constexpr std::size_t kMostPort = 65535;
constexpr std::size_t kLeastAddress = 7, kMostAddress = 16;  // "65:00.0", "00000000:65:00.0"

/// Monitors are plugged into one card, so nobody else can say which one draws their tiles; and EGL's numbers are not
/// the kernel's.
void check_cards(TreeReader& read, const toml::table& table, const NodeConfig& node, std::uint32_t gpus) {
    if (std::ranges::none_of(node.tiles, [](const auto& tile) { return tile.kms.has_value(); })) return;
    if (gpus != 0)
        read.refuse(table.get("gpus")->source(),
                    "'gpus' of a node with tiles on monitors without a window system: expected 'gpu' of each tile, "
                    "the address of the card that its monitor is plugged into");
    const bool named = std::ranges::any_of(node.tiles, [](const auto& tile) { return tile.gpu != kAnyGpu; });
    for (auto tile = node.tiles.begin(); const auto* of_tile : tile_tables(read, table)) {
        const auto& [gpu, name] = std::tie(tile->gpu, tile->name);
        ++tile;
        if (gpu != kAnyGpu && is_gpu_number(gpu))
            read.refuse(of_tile->get("gpu")->source(),
                        "tile '" + name +
                            "' names its GPU by a number in a node with tiles on monitors without a window system: "
                            "expected the card's address, such as \"0000:65:00.0\" (`tileserver --monitors`)");
        if (named && gpu == kAnyGpu)
            read.refuse(of_tile->source(), "tile '" + name +
                                               "' says no 'gpu', others of its node do: expected the address of the "
                                               "card that its monitor is plugged into");
    }
}

void check(TreeReader& read, const toml::table& table, const NodeConfig& node, std::uint32_t gpus) {
    const auto in_window = std::ranges::any_of(node.tiles, [](const auto& tile) { return tile.window.has_value(); });
    if (gpus != 0 && node.backend != Backend::egl)
        read.refuse(table.get("gpus")->source(),
                    "'gpus' of a node with backend \"osmesa\", which draws without one: expected backend = \"egl\"");
    if (gpus != 0 && node.tiles.empty())
        read.refuse(table.get("gpus")->source(),
                    "'gpus' of a node without tiles: expected a [[node]] for each GPU that renders");
    if (gpus != 0 && in_window)
        read.refuse(table.get("gpus")->source(),
                    "'gpus' of a node with tiles in windows, which the X server's graphics card draws: expected a "
                    "[[node]] of their own for these");
    for (auto tile = node.tiles.begin(); const auto* of_tile : tile_tables(read, table)) {
        const auto& [gpu, name] = std::tie(tile->gpu, tile->name);
        ++tile;
        if (gpu == kAnyGpu) continue;
        const auto& where = of_tile->get("gpu")->source();
        if (node.backend != Backend::egl)
            read.refuse(where,
                        "'gpu' of a node with backend \"osmesa\", which draws without one: expected backend = \"egl\"");
        else if (in_window)
            read.refuse(where,
                        "'gpu' in a node with tiles in windows, which the X server's graphics card draws: expected a "
                        "[[node]] of their own for these");
        else if (gpus != 0 && !is_gpu_number(gpu))
            read.refuse(where, "tile '" + name +
                                   "' names its GPU by its address in a node with 'gpus': expected a "
                                   "number, or no 'gpus'");
        else if (gpus != 0 && std::stoul(gpu) >= gpus)
            read.refuse(where, "tile '" + name + "' is drawn by GPU " + gpu + " of " + std::to_string(gpus) +
                                   ": expected a number from 0 to " + std::to_string(gpus - 1));
    }
}

/// Slots, one for each tile and behind them one for each that companions of theirs will have.
void number(std::vector<TileConfig>& tiles) {
    std::uint32_t slot = 0;
    for (auto& tile : tiles) tile.slot = slot++;
    for (auto& tile : tiles)
        if (tile.output.stereo != geom::StereoLayout::none) tile.output.right_slot = slot++;
}

}  // namespace

std::string read_gpu(TreeReader& read, const toml::table& tile) {
    const auto* node = tile.get("gpu");
    if (!node) return kAnyGpu;
    if (node->is_integer()) return std::to_string(read.integer(*node, "'gpu'", 0, kMostGpus - 1));
    const auto text = node->is_string() ? node->as_string()->get() : "";
    const bool is_address = text.size() >= kLeastAddress && text.size() <= kMostAddress &&
                            text.find_first_not_of("0123456789abcdef:.") == std::string::npos &&
                            text.find(':') != std::string::npos;
    if (text == kAnyGpu || is_address) return text;
    read.refuse(node->source(),
                "'gpu': expected \"auto\", a number (`tileserver --gpus` lists them), or a PCI address such as "
                "\"0000:65:00.0\"");
    return kAnyGpu;
}

void read_gpus(TreeReader& read, const toml::table& root, std::vector<NodeConfig>& nodes) {
    if (read.error()) return;
    std::vector<NodeConfig> out;
    for (auto node = nodes.begin(); const auto* table : read.tables(root, "node", "[[node]]")) {
        const auto gpus =
            table->get("gpus") ? static_cast<std::uint32_t>(read.integer(*table, "gpus", 1, kMostGpus, 1)) : 0;
        check(read, *table, *node, gpus);
        check_cards(read, *table, *node, gpus);
        if (read.error()) return;
        number(node->tiles);
        deal_out(node->tiles, gpus);
        const auto of_gpus = split_by_gpu(*node);
        if (!node->listen.is_unix() && node->listen.port + of_gpus.size() - 1 > kMostPort)
            read.refuse(table->source(), "node '" + node->name + "' listens on a port for each of its " +
                                             std::to_string(of_gpus.size()) +
                                             " GPUs: expected a port in 'listen' that has them behind it");
        out.insert(out.end(), of_gpus.begin(), of_gpus.end());
        ++node;
    }
    nodes = std::move(out);
    for (auto node = nodes.begin(); node != nodes.end(); ++node)
        if (std::ranges::count(nodes.begin(), node, node->name, &NodeConfig::name) > 0)
            read.refuse(root.source(), "two nodes are called '" + node->name +
                                           "', one of them for a GPU of [[node]] '" + node->process +
                                           "': expected unique names");
}

}  // namespace wall::config
