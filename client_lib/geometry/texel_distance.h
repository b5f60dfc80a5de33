// SPDX-License-Identifier: MIT
// How far from the texels of an image those fragments lie that look them up. Pure.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace wall::client {

/// A vertex of a polygon that faces the window (all have the same w): where it lies, in window pixels, and where the
/// image is looked up for it, in texels.
struct LookingVertex {
    float x = 0, y = 0, texel_x = 0, texel_y = 0;
};

struct TexelDistance {
    std::int32_t x = 0, y = 0;  ///< window pixels from the image's first texel
    bool operator==(const TexelDistance&) const = default;
};

/// A fragment may look that far beside the texel that lies under it, in pixels: the nearest one is the same then, and a
/// smooth lookup takes none but its neighbours.
inline constexpr float kBesideTexel = 0.25f;

/// Of all fragments of the polygons, if it is the same for all, in whole pixels, and they lie on the image. Between the
/// vertices both are affine, so that none differs by more than they do.
inline std::optional<TexelDistance> texel_distance(std::span<const LookingVertex> vertices, std::int32_t width,
                                                   std::int32_t height) {
    constexpr float kMost = 1e6;
    if (vertices.empty()) return std::nullopt;
    const LookingVertex& first = vertices.front();
    const float dx = std::round(first.x - first.texel_x), dy = std::round(first.y - first.texel_y);
    const auto within = [](float at, std::int32_t size) {
        return at >= -kBesideTexel && at <= static_cast<float>(size) + kBesideTexel;
    };
    const bool same = std::ranges::all_of(vertices, [&](const LookingVertex& v) {
        return std::abs(v.x - v.texel_x - dx) <= kBesideTexel && std::abs(v.y - v.texel_y - dy) <= kBesideTexel &&
               within(v.texel_x, width) && within(v.texel_y, height);
    });
    if (!same || std::abs(dx) > kMost || std::abs(dy) > kMost) return std::nullopt;
    return TexelDistance{static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dy)};
}

}  // namespace wall::client
