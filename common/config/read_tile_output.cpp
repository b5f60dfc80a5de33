// SPDX-License-Identifier: MIT
#include "common/config/read_tile_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace wall::config {
namespace {

constexpr double kMostMillimetres = 100'000;
constexpr double kLeastGamma = 0.1, kMostGamma = 10;
constexpr double kMostBlack = 0.5;                                              // of white's light
constexpr double kMostMatrix = 16;                                              // of a colour matrix's numbers
constexpr std::array<const char*, 4> kEdges{"left", "right", "top", "bottom"};  // as in geom::Blend::Edge

std::uint32_t read_rotation(TreeReader& read, const toml::table& table) {
    const auto* node = table.get("rotation");
    if (!node) return 0;
    const auto value = node->is_integer() ? node->as_integer()->get() : -1;
    if (value == 0 || value == 90 || value == 180 || value == 270) return static_cast<std::uint32_t>(value);
    read.refuse(node->source(),
                "'rotation': expected the degrees that the monitor is turned clockwise, as seen from "
                "in front of it: 0, 90, 180 or 270");
    return 0;
}

void read_pixels(TreeReader& read, const toml::table& table, TileConfig& tile) {
    auto& output = tile.output;
    output.width = tile.rect.width;
    output.height = tile.rect.height;
    if (geom::is_sideways(output.rotation)) std::swap(output.width, output.height);
    const auto* node = table.get("pixels");
    if (!node) return;
    const auto size =
        read.numbers(*node, "'pixels'", "[width, height] of the output, as the monitor itself counts them", 2, 2, 1,
                     geom::kMaxOutputExtent);
    output.width = static_cast<std::int32_t>(size[0]);
    output.height = static_cast<std::int32_t>(size[1]);
    if (static_cast<float>(output.width) != size[0] || static_cast<float>(output.height) != size[1])
        read.refuse(node->source(), "'pixels': expected whole numbers");
}

geom::Blend read_blend(TreeReader& read, const toml::table& table) {
    const auto& blend = read.section(table, "blend");
    read.only(blend, "'blend'", {"left", "right", "top", "bottom", "gamma", "black"});
    geom::Blend out;
    for (std::size_t i = 0; i < kEdges.size(); ++i)
        out.ramps[i] = static_cast<float>(read.integer(blend, kEdges[i], 0, kMaxCanvas, 0));
    out.gamma = static_cast<float>(read.number(blend, "gamma", kLeastGamma, kMostGamma, out.gamma));
    out.black = static_cast<float>(read.number(blend, "black", 0, kMostBlack, 0));
    return out;
}

void read_curves(TreeReader& read, const toml::node& node, geom::ColorCorrection& out) {
    constexpr auto kExpected =
        "2 to 256 numbers from 0 to 1, at equal steps from black to white, or three such arrays for red, green and "
        "blue";
    const auto* array = node.as_array();
    const bool each = array && array->size() == out.curves.size() && array->get(0)->is_array();
    for (std::size_t i = 0; i < out.curves.size(); ++i)
        out.curves[i] =
            read.numbers(each ? *array->get(i) : node, "'curve'", kExpected, 2, geom::kMaxCurvePoints, 0, 1);
}

geom::ColorCorrection read_color(TreeReader& read, const toml::table& table) {
    const auto& color = read.section(table, "color");
    read.only(color, "'color'", {"matrix", "gamma", "curve"});
    geom::ColorCorrection out;
    out.gamma = static_cast<float>(read.number(color, "gamma", kLeastGamma, kMostGamma, out.gamma));
    if (const auto* matrix = color.get("matrix")) {
        const auto values = read.numbers(*matrix, "'matrix'", "9 numbers, row by row", out.matrix.size(),
                                         out.matrix.size(), -kMostMatrix, kMostMatrix);
        std::ranges::copy(values, out.matrix.begin());
    }
    if (const auto* curve = color.get("curve")) read_curves(read, *curve, out);
    return out;
}

/// Pixels of the canvas.
struct Bezels {
    double left = 0, right = 0, top = 0, bottom = 0;
};

Bezels read_bezels(TreeReader& read, const DescribedTile& described) {
    const auto* bezel = described.table->get("bezel_mm");
    const auto* size = described.table->get("size_mm");
    if (size)
        read.numbers(*size, "'size_mm'", "[width, height] of the picture in millimetres, as it hangs", 2, 2, 1,
                     kMostMillimetres);
    if (!bezel) return {};
    if (!size) {
        read.refuse(bezel->source(),
                    "'bezel_mm': expected 'size_mm' beside it, the picture's [width, height] in "
                    "millimetres, as it hangs");
        return {};
    }
    constexpr auto kExpected = "millimetres, or [left, right, top, bottom] of them, as the monitor hangs";
    std::vector<float> mm;
    if (bezel->is_number()) mm.assign(4, static_cast<float>(read.number(*bezel, "'bezel_mm'", 0, kMostMillimetres)));
    else mm = read.numbers(*bezel, "'bezel_mm'", kExpected, 4, 4, 0, kMostMillimetres);
    const auto picture = read.numbers(*size, "'size_mm'", "[width, height]", 2, 2, 1, kMostMillimetres);
    const auto& rect = described.tile->rect;
    const double x = rect.width / static_cast<double>(picture[0]), y = rect.height / static_cast<double>(picture[1]);
    return {mm[0] * x, mm[1] * x, mm[2] * y, mm[3] * y};
}

/// How far tiles move along one axis. `begin`, `end`: of a rect on it; `across`: whether two lie beside each other.
template <class Begin, class End, class Across, class Before, class After>
std::vector<double> shifts(std::span<const DescribedTile> tiles, Begin begin, End end, Across across, Before before,
                           After after) {
    std::vector<std::size_t> order(tiles.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return begin(tiles[i].tile->rect); });
    std::vector<double> out(tiles.size(), 0);
    for (std::size_t at = 0; at < order.size(); ++at) {
        const std::size_t i = order[at];
        for (const std::size_t j : std::span(order).first(at)) {
            const auto &mine = tiles[i].tile->rect, &other = tiles[j].tile->rect;
            if (end(other) > begin(mine) || !across(mine, other)) continue;
            out[i] = std::max(out[i], out[j] + after(j) + before(i));
        }
    }
    return out;
}

}  // namespace

void read_tile_output(TreeReader& read, const toml::table& table, TileConfig& tile) {
    tile.output.rotation = read_rotation(read, table);
    read_pixels(read, table, tile);
    if (table.get("warp")) tile.warp_file = read.text(table, "warp");
    if (table.get("mpcdi")) tile.mpcdi_file = read.text(table, "mpcdi");
    for (const char* key : {"warp", "blend", "rotation"})
        if (table.get("mpcdi") && table.get(key))
            read.refuse(table.get(key)->source(),
                        TreeReader::quoted(key) + ": expected none beside 'mpcdi', which says that");
    if (table.get("blend")) tile.output.blend = read_blend(read, table);
    if (table.get("color")) tile.output.color = read_color(read, table);
}

void place_behind_bezels(TreeReader& read, std::span<const DescribedTile> tiles) {
    std::vector<Bezels> bezels;
    for (const auto& tile : tiles) bezels.push_back(read_bezels(read, tile));
    const auto beside = [](const geom::Rect& a, const geom::Rect& b) { return a.y < b.bottom() && b.y < a.bottom(); };
    const auto above = [](const geom::Rect& a, const geom::Rect& b) { return a.x < b.right() && b.x < a.right(); };
    const auto x = shifts(
        tiles, [](const auto& r) { return r.x; }, [](const auto& r) { return r.right(); }, beside,
        [&](std::size_t i) { return bezels[i].left; }, [&](std::size_t i) { return bezels[i].right; });
    const auto y = shifts(
        tiles, [](const auto& r) { return r.y; }, [](const auto& r) { return r.bottom(); }, above,
        [&](std::size_t i) { return bezels[i].top; }, [&](std::size_t i) { return bezels[i].bottom; });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        auto& rect = tiles[i].tile->rect;
        rect.x += static_cast<std::int32_t>(std::lround(x[i]));
        rect.y += static_cast<std::int32_t>(std::lround(y[i]));
        if (rect.right() > kMaxCanvas || rect.bottom() > kMaxCanvas)
            read.refuse(tiles[i].table->source(),
                        "tile '" + tiles[i].tile->name + "' lies beyond 32768 pixels with the bezels before it");
    }
}

void check_blends(TreeReader& read, std::span<const DescribedTile> tiles) {
    for (const auto& [table, tile] : tiles) {
        if (!tile->output.blend) continue;
        const auto& ramps = tile->output.blend->ramps;
        const auto& rect = tile->rect;
        for (std::size_t i = 0; i < kEdges.size(); ++i) {
            const auto ramp = static_cast<std::int32_t>(ramps[i]);
            if (ramp == 0) continue;
            const bool upright = i < 2;
            const auto opposite = static_cast<std::int32_t>(ramps[i ^ 1]);
            if (const auto extent = upright ? rect.width : rect.height; ramp > extent - opposite) {
                read.refuse(table->get("blend")->source(),
                            "tile '" + tile->name + "' is " + std::to_string(extent) +
                                " pixels from edge to edge: expected ramps that have room beside each other");
                return;
            }
            geom::Rect strip = rect;
            (upright ? strip.width : strip.height) = ramp;
            if (i == geom::Blend::right) strip.x = rect.right() - ramp;
            if (i == geom::Blend::bottom) strip.y = rect.bottom() - ramp;
            const bool shared = std::ranges::any_of(tiles, [&](const DescribedTile& other) {
                return other.tile != tile && geom::overlaps(other.tile->rect, strip);
            });
            if (shared) continue;
            read.refuse(table->get("blend")->source(),
                        "'" + std::string(kEdges[i]) + "' of 'blend': no other tile shows any of these " +
                            std::to_string(ramp) + " pixels: expected rects that overlap");
        }
    }
}

}  // namespace wall::config
