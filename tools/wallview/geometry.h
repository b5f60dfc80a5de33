// SPDX-License-Identifier: MIT
// Where a picture lies in a window. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/geom/rect.h"

namespace wall::wallview {

/// The largest rectangle of the picture's proportions in the middle of the window; sizes in pixels.
constexpr geom::Rect letterbox(std::int32_t width, std::int32_t height, std::int32_t window_width,
                               std::int32_t window_height) {
    if (width <= 0 || height <= 0) return {};
    const bool wide = std::int64_t{window_width} * height <=
                      std::int64_t{window_height} * width;  // the window's width is what limits it
    const auto w = wide ? window_width : static_cast<std::int32_t>(std::int64_t{window_height} * width / height);
    const auto h = wide ? static_cast<std::int32_t>(std::int64_t{window_width} * height / width) : window_height;
    return {(window_width - w) / 2, (window_height - h) / 2, w, h};
}

}  // namespace wall::wallview
