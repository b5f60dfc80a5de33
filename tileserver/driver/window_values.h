// SPDX-License-Identifier: MIT
// From the state that is told in window pixels to what the driver must be told for one layer: the viewport offset and
// scaled so that the layer shows its part, and all that follows from it (DESIGN, section 5: layers). Pure.
#pragma once

#include <array>
#include <cstdint>

#include "gen/glstate/state.gen.h"
#include "tileserver/driver/render_target.h"

namespace wall::tileserver {

struct WindowValues {
    struct Box {
        float x = 0, y = 0, width = 0, height = 0;
        bool operator==(const Box&) const = default;
    };
    struct IntBox {
        std::int32_t x = 0, y = 0, width = 0, height = 0;
        bool operator==(const IntBox&) const = default;
    };
    static constexpr std::size_t kViewports = 1 + glstate::el::viewport_rest::count;
    /// Layer pixels, y up, like the scissor boxes; of each that shaders may choose.
    std::array<Box, kViewports> viewports{};
    std::array<IntBox, kViewports> scissors{};
    std::uint32_t scissor_enabled = 0;        ///< a bit for each
    std::array<std::uint32_t, 32> stipple{};  ///< row 0 at the bottom, first pixel in the highest bit of the first byte
    std::array<float, 2> pixel_zoom{1, 1};
};

WindowValues window_values(const LayerGeometry& geometry, const glstate::State& state);

/// A window position in the layer's pixels.
struct LayerPoint {
    double x, y;
};
LayerPoint layer_point(const LayerGeometry& geometry, double x, double y);

/// A corner of a rectangle of whole window pixels in whole layer pixels, rounded as those of layer_box().
struct LayerEdge {
    std::int32_t x, y;
};
LayerEdge layer_edge(const LayerGeometry& geometry, double x, double y);

/// A rectangle of whole window pixels in whole layer pixels. Edges are rounded on the surface before the layer's offset
/// is taken off, so neighbouring rectangles and neighbouring layers neither overlap nor leave a gap.
WindowValues::IntBox layer_box(const LayerGeometry& geometry, const WindowValues::IntBox& window);

}  // namespace wall::tileserver
