// SPDX-License-Identifier: MIT
#include "walld/wall/placement.h"

#include <algorithm>
#include <vector>

namespace wall::walld {
namespace {

/// A free place that cannot move further up or left touches the canvas's or a window's edge: only those are tried.
std::vector<std::int32_t> starts(std::span<const geom::Rect> taken, std::int32_t first,
                                 std::int32_t (geom::Rect::*edge)() const) {
    std::vector<std::int32_t> out{first};
    for (const auto& rect : taken) out.push_back((rect.*edge)());
    std::ranges::sort(out);
    return out;
}

std::int32_t cascaded(std::int32_t room, std::uint32_t step) {
    if (room <= 0) return 0;
    return static_cast<std::int32_t>((std::int64_t{step} * kCascadeStep) % (room + 1));
}

}  // namespace

geom::Rect place(const geom::Rect& canvas, std::span<const geom::Rect> taken, std::int32_t width, std::int32_t height,
                 std::uint32_t cascade) {
    const auto columns = starts(taken, canvas.x, &geom::Rect::right);
    for (const auto y : starts(taken, canvas.y, &geom::Rect::bottom)) {
        for (const auto x : columns) {
            const geom::Rect candidate{x, y, width, height};
            if (x < canvas.x || y < canvas.y || candidate.right() > canvas.right() ||
                candidate.bottom() > canvas.bottom())
                continue;
            if (std::ranges::none_of(taken, [&](const auto& rect) { return geom::overlaps(rect, candidate); }))
                return candidate;
        }
    }
    return {canvas.x + cascaded(canvas.width - width, cascade), canvas.y + cascaded(canvas.height - height, cascade),
            width, height};
}

}  // namespace wall::walld
