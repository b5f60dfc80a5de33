// SPDX-License-Identifier: MIT
// Integer rectangles on the canvas: origin top left, y down, half open. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

namespace wall::geom {

struct Rect {
    std::int32_t x = 0, y = 0, width = 0, height = 0;  // pixels

    constexpr std::int32_t right() const { return x + width; }
    constexpr std::int32_t bottom() const { return y + height; }
    constexpr bool empty() const { return width <= 0 || height <= 0; }
    bool operator==(const Rect&) const = default;
};

/// The common part; empty (all zero) if there is none.
constexpr Rect intersect(const Rect& a, const Rect& b) {
    const auto x0 = std::max(a.x, b.x), y0 = std::max(a.y, b.y);
    const auto x1 = std::min(a.right(), b.right()), y1 = std::min(a.bottom(), b.bottom());
    if (x1 <= x0 || y1 <= y0) return {};
    return {x0, y0, x1 - x0, y1 - y0};
}

constexpr bool overlaps(const Rect& a, const Rect& b) { return !intersect(a, b).empty(); }

}  // namespace wall::geom
