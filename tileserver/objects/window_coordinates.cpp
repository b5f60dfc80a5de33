// SPDX-License-Identifier: MIT
#include "tileserver/objects/window_coordinates.h"

#include <cstdint>

namespace wall::tileserver {

std::array<float, 4> window_of(const LayerGeometry& g, bool upper_left, bool whole_centers) {
    if (g.window_width == 0 || g.window_height == 0) return {1, 1, 0, 0};
    const std::int32_t y = upper_left ? g.area.y - g.surface.y : g.offset_y();
    if (!g.scaled()) return {1, 1, static_cast<float>(g.offset_x()), static_cast<float>(y)};
    const double sx = 1 / g.scale_x(), sy = 1 / g.scale_y();
    const double middle = whole_centers ? 0.5 : 0;  // that the layer's pixels lack
    return {static_cast<float>(sx), static_cast<float>(sy), static_cast<float>((g.offset_x() + middle) * sx - middle),
            static_cast<float>((y + middle) * sy - middle)};
}

}  // namespace wall::tileserver
