// SPDX-License-Identifier: MIT
#include "tileserver/render/test_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wall::tileserver {
namespace {

struct Color {
    std::uint8_t red, green, blue;
};
constexpr Color kBlack{0, 0, 0}, kWhite{255, 255, 255}, kDark{24, 24, 24}, kThin{128, 128, 128}, kEdge{255, 48, 48},
    kRound{48, 255, 48};
constexpr std::int32_t kThinEvery = 100, kThickEvery = 500, kEdgeWidth = 2, kSteps = 16;
constexpr double kRoundShare = 0.45;  // of the shorter side, the circle's radius

/// The colour of a pixel at a place of the canvas.
using Paint = Color (*)(const TestPattern&, const geom::Rect&, std::int32_t x, std::int32_t y);

bool at_edge(const geom::Rect& area, std::int32_t x, std::int32_t y) {
    return x < area.x + kEdgeWidth || y < area.y + kEdgeWidth || x >= area.right() - kEdgeWidth ||
           y >= area.bottom() - kEdgeWidth;
}

Color grid(const TestPattern&, const geom::Rect& area, std::int32_t x, std::int32_t y) {
    if (at_edge(area, x, y)) return kEdge;
    const double from_middle =
        std::hypot(x - (area.x + (area.width - 1) / 2.0), y - (area.y + (area.height - 1) / 2.0));
    if (std::abs(from_middle - kRoundShare * std::min(area.width, area.height)) < 1) return kRound;
    const auto thick = [](std::int32_t at) { return (at + 1) % kThickEvery <= 2; };
    if (thick(x) || thick(y)) return kWhite;
    return x % kThinEvery == 0 || y % kThinEvery == 0 ? kThin : kDark;
}

/// Four bands, smooth above and in steps below.
Color ramps(const TestPattern&, const geom::Rect& area, std::int32_t x, std::int32_t y) {
    const auto band = 8 * (y - area.y) / area.height;
    const auto along = x - area.x, last = std::max(1, area.width - 1);
    const auto value = band % 2 == 0 ? 255 * along / last : 255 * (kSteps * along / area.width) / (kSteps - 1);
    const auto level = static_cast<std::uint8_t>(value);
    const std::array<Color, 4> colors{{{level, level, level}, {level, 0, 0}, {0, level, 0}, {0, 0, level}}};
    return colors[static_cast<std::size_t>(band / 2)];
}

/// The label as large as the tile lets it be, in whole pixels.
Color names(const TestPattern& pattern, const geom::Rect& area, std::int32_t x, std::int32_t y) {
    if (at_edge(area, x, y)) return kEdge;
    const auto& label = pattern.label;
    if (label.width == 0 || label.height == 0) return kBlack;
    const auto scale = std::max(1, std::min(area.width * 9 / 10 / label.width, area.height * 9 / 10 / label.height));
    const auto floor_div = [](std::int32_t a, std::int32_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); };
    const auto column = floor_div(x - area.x - (area.width - scale * label.width) / 2, scale);
    const auto row = floor_div(y - area.y - (area.height - scale * label.height) / 2, scale);
    if (column < 0 || row < 0 || column >= label.width || row >= label.height) return kBlack;
    const auto level = static_cast<std::uint8_t>(label.bytes[static_cast<std::size_t>(row * label.width + column)]);
    return {level, level, level};
}

Color white(const TestPattern&, const geom::Rect&, std::int32_t, std::int32_t) { return kWhite; }
Color black(const TestPattern&, const geom::Rect&, std::int32_t, std::int32_t) { return kBlack; }

Color code(const TestPattern& pattern, const geom::Rect&, std::int32_t x, std::int32_t y) {
    const auto place = static_cast<std::uint32_t>(pattern.rows ? y : x);
    const bool bright = ((place ^ place >> 1) >> pattern.bit & 1) != 0;
    return bright != pattern.inverted ? kWhite : kBlack;
}

constexpr std::array<Paint, 6> kPaints{grid, ramps, names, white, black, code};  // by Kind

}  // namespace

std::vector<std::byte> pattern_pixels(const TestPattern& pattern, const geom::Rect& area) {
    std::vector<std::byte> out;
    out.reserve(std::size_t{4} * static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height));
    const Paint paint = kPaints[static_cast<std::size_t>(pattern.kind)];
    for (std::int32_t y = area.y; y < area.bottom(); ++y) {
        for (std::int32_t x = area.x; x < area.right(); ++x) {
            const Color color = paint(pattern, area, x, y);
            for (const std::uint8_t value : {color.red, color.green, color.blue, std::uint8_t{255}})
                out.push_back(std::byte{value});
        }
    }
    return out;
}

}  // namespace wall::tileserver
