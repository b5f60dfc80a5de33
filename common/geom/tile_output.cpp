// SPDX-License-Identifier: MIT
#include "common/geom/tile_output.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace wall::geom {
namespace {

constexpr float kNearInfinity = 1e-4f;  // of a homography's w, to the largest of the output

bool all_finite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

std::array<float, 3> times(const std::array<float, 9>& m, Point p) {
    return {m[0] * p.x + m[1] * p.y + m[2], m[3] * p.x + m[4] * p.y + m[5], m[6] * p.x + m[7] * p.y + m[8]};
}

/// A homography folds nowhere but at infinity.
const char* wrong_with_homography(const std::array<float, 9>& m) {
    if (!all_finite(m)) return "has a number that is none";
    const float determinant =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    if (determinant == 0) return "makes a line or a point of the output";
    float least = INFINITY, most = -INFINITY;
    for (const Point corner : {Point{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        const float w = times(m, corner)[2];
        least = std::min(least, w);
        most = std::max(most, w);
    }
    const float largest = std::max(std::abs(least), std::abs(most));
    if (least * most <= 0 || std::min(std::abs(least), std::abs(most)) < kNearInfinity * largest)
        return "puts a part of the output at infinity or beyond";
    return nullptr;
}

/// Twice the area, with a sign for the side that it turns to.
float area(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// A cell whose four corners turn the same way is not folded anywhere.
const char* wrong_with_mesh(const Warp& warp) {
    if (warp.columns < 2 || warp.rows < 2) return "has a mesh of fewer than 2 columns or rows";
    if (warp.columns > kMaxMeshPoints || warp.rows > kMaxMeshPoints / warp.columns)
        return "has a mesh of more than 65536 points";
    if (warp.points.size() != std::size_t{warp.columns} * warp.rows)
        return "has another number of points than columns times rows";
    for (const Point& point : warp.points)
        if (std::isinf(point.x) || std::isinf(point.y) || std::isnan(point.x) != std::isnan(point.y))
            return "has a point that is none";
    float way = 0;
    for (std::uint32_t row = 0; row + 1 < warp.rows; ++row) {
        for (std::uint32_t column = 0; column + 1 < warp.columns; ++column) {
            const Point* top = &warp.points[std::size_t{row} * warp.columns + column];
            const Point* bottom = top + warp.columns;
            if (std::isnan(top[0].x + top[1].x + bottom[0].x + bottom[1].x)) continue;
            for (const float corner : {area(top[0], top[1], bottom[0]), area(top[1], bottom[1], top[0]),
                                       area(bottom[1], bottom[0], top[1]), area(bottom[0], top[0], bottom[1])}) {
                if (way == 0) way = corner;
                if (corner == 0 || (corner > 0) != (way > 0)) return "is folded: a cell of its mesh turns over";
            }
        }
    }
    return nullptr;
}

Point warped(const Warp& warp, Point at) {
    if (warp.columns == 0) {
        const auto [x, y, w] = times(warp.homography, at);
        return {x / w, y / w};
    }
    const auto cell = [](float place, std::uint32_t count) {
        const float along = place * static_cast<float>(count - 1);
        const float first = std::clamp(std::floor(along), 0.0f, static_cast<float>(count - 2));
        return std::pair(static_cast<std::uint32_t>(first), along - first);
    };
    const auto [column, x] = cell(at.x, warp.columns);
    const auto [row, y] = cell(at.y, warp.rows);
    const auto mix = [](Point a, Point b, float t) { return Point{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; };
    const Point* top = &warp.points[std::size_t{row} * warp.columns + column];
    const Point* bottom = top + warp.columns;
    return mix(mix(top[0], top[1], x), mix(bottom[0], bottom[1], x), y);
}

}  // namespace

const char* wrong_with(const Warp& warp) {
    return warp.columns == 0 ? wrong_with_homography(warp.homography) : wrong_with_mesh(warp);
}

const char* wrong_with(const LightMap& light) {
    for (const auto* map : {&light.share, &light.lift}) {
        if (map->width == 0 && map->height == 0 && map->values.empty()) continue;
        constexpr auto kMost = static_cast<std::uint32_t>(kMaxOutputExtent);
        if (map->width == 0 || map->height == 0 || map->width > kMost || map->height > kMost)
            return "is too large, or nothing";
        if (map->channels != 1 && map->channels != 3) return "has neither one nor three values a place";
        if (map->values.size() != std::size_t{map->width} * map->height * map->channels)
            return "has another number of values than places";
    }
    return nullptr;
}

bool TileOutput::operator==(const TileOutput& other) const {
    const bool same_warp = warp == other.warp || (warp && other.warp && *warp == *other.warp);
    const bool same_light = light == other.light || (light && other.light && *light == *other.light);
    return rotation == other.rotation && width == other.width && height == other.height && same_warp &&
           blend == other.blend && same_light && color == other.color && stereo == other.stereo &&
           right_slot == other.right_slot;
}

const char* name_of(StereoLayout layout) {
    switch (layout) {
        case StereoLayout::side_by_side: return "side-by-side";
        case StereoLayout::over_under: return "over-under";
        case StereoLayout::rows: return "rows";
        case StereoLayout::anaglyph: return "anaglyph";
        case StereoLayout::none: break;
    }
    return "";
}

TileOutput plain_output(const Rect& tile) { return {.width = tile.width, .height = tile.height}; }

bool is_sideways(std::uint32_t rotation) { return rotation % 180 != 0; }

bool is_plain(const TileOutput& output, const Rect& tile) { return output == plain_output(tile); }

Point place_in_tile(const TileOutput& output, Point of_output) {
    const Point flat = output.warp ? warped(*output.warp, of_output) : of_output;
    switch (output.rotation) {
        case 90: return {1 - flat.y, flat.x};
        case 180: return {1 - flat.x, 1 - flat.y};
        case 270: return {flat.y, 1 - flat.x};
        default: return flat;
    }
}

}  // namespace wall::geom
