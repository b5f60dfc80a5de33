// SPDX-License-Identifier: MIT
#include "common/config/eyes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace wall::config {
namespace {

constexpr std::array kLayouts{geom::StereoLayout::side_by_side, geom::StereoLayout::over_under,
                              geom::StereoLayout::rows, geom::StereoLayout::anaglyph};

void read_stereo(TreeReader& read, const toml::table& table, TileConfig& tile) {
    const auto& source = table.get("stereo")->source();
    const auto name = read.text(table, "stereo");
    const auto* found =
        std::ranges::find(kLayouts, name, [](geom::StereoLayout layout) { return std::string(geom::name_of(layout)); });
    if (found == kLayouts.end())
        return read.refuse(
            source, "'stereo' is '" + name + "': expected \"side-by-side\", \"over-under\", \"rows\" or \"anaglyph\"");
    if (table.get("eye"))
        read.refuse(table.get("eye")->source(), "'eye' beside 'stereo': expected one of them: the output shows both");
    tile.output.stereo = *found;
    tile.eye = geom::Eye::left;
    const bool sides = *found == geom::StereoLayout::side_by_side;
    const auto pixels = sides ? tile.output.width : tile.output.height;
    if (*found != geom::StereoLayout::anaglyph && pixels % 2 != 0)
        read.refuse(source, "'stereo' is '" + name + "' on an output of " + std::to_string(pixels) +
                                (sides ? " columns" : " rows") + ": expected an even number, half for each eye");
}

/// For the eye of a person who looks at both of them.
bool shows_other_eye(const TileConfig& tile, const TileConfig& other) {
    return other.eye != geom::Eye::both && other.eye != tile.eye && geom::overlaps(tile.rect, other.rect);
}

}  // namespace

void read_eyes(TreeReader& read, const toml::table& table, TileConfig& tile) {
    if (table.get("stereo")) return read_stereo(read, table, tile);
    const auto* node = table.get("eye");
    if (!node) return;
    const auto name = read.text(table, "eye");
    if (name == "left") tile.eye = geom::Eye::left;
    else if (name == "right") tile.eye = geom::Eye::right;
    else read.refuse(node->source(), "'eye' is '" + name + "': expected \"left\" or \"right\"");
}

void check_eyes(TreeReader& read, std::span<const DescribedTile> tiles) {
    for (const auto& [table, tile] : tiles) {
        if (tile->eye == geom::Eye::both || tile->output.stereo != geom::StereoLayout::none) continue;
        const bool seen_by_both =
            std::ranges::any_of(tiles, [&](const auto& other) { return shows_other_eye(*tile, *other.tile); });
        if (!seen_by_both)
            read.refuse(table->get("eye")->source(),
                        "tile '" + tile->name +
                            "' is for one eye, and the other sees nothing there: expected a tile with 'eye' = \"" +
                            (tile->eye == geom::Eye::left ? "right" : "left") + "\" whose 'rect' overlaps it");
    }
}

std::string companion_name(const std::string& tile) { return tile + "/right"; }

void add_companions(NodeConfig& node) {
    const std::size_t described = node.tiles.size();
    for (std::size_t i = 0; i < described; ++i) {
        if (node.tiles[i].output.stereo == geom::StereoLayout::none) continue;
        TileConfig right{companion_name(node.tiles[i].name), node.tiles[i].output.right_slot, node.tiles[i].rect};
        right.output = geom::plain_output(right.rect);
        right.gpu = node.tiles[i].gpu;
        right.view = node.tiles[i].view;
        right.eye = geom::Eye::right;
        node.tiles.push_back(std::move(right));
    }
}

TileConfig* companion_of(const TileConfig& tile, std::vector<TileConfig>& tiles) {
    if (tile.output.stereo == geom::StereoLayout::none) return nullptr;
    const auto found = std::ranges::find(tiles, tile.output.right_slot, &TileConfig::slot);
    return found == tiles.end() ? nullptr : &*found;
}

}  // namespace wall::config
