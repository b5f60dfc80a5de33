// SPDX-License-Identifier: MIT
// How far, in pixels of the wall, what is drawn may lie from where it belongs, where that makes a program's stream
// smaller (docs/lossy-geometry.md). Pure.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

namespace wall {

inline constexpr double kMostLossyPixels = 16;

inline bool is_lossy_bound(double pixels) { return pixels >= 0 && pixels <= kMostLossyPixels; }

/// Of WALLGL_LOSSY_PIXELS and --lossy-pixels; nothing: it is no such number.
inline std::optional<float> lossy_pixels_of_text(const std::string& text) {
    float pixels = 0;
    char extra = 0;
    if (std::sscanf(text.c_str(), "%f%c", &pixels, &extra) != 1 || !is_lossy_bound(pixels)) return std::nullopt;
    return pixels;
}

}  // namespace wall
