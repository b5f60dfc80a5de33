// SPDX-License-Identifier: MIT
#include "common/glstate/raster_place.h"

#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>

#include "common/glstate/view_change.h"

namespace wall::glstate {
namespace {

Vec4 times(const ViewChange& change, const Vec4& clip) {
    Vec4 out;
    for (std::size_t row = 0; row < 4; ++row) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += change[4 * i + row] * static_cast<double>(clip[i]);
        out[row] = static_cast<float>(sum);
    }
    return out;
}

}  // namespace

bool in_view_volume(const State& s, const Vec4& clip) {
    const float nearest = s.transform.clip_control.depth == GL_ZERO_TO_ONE ? 0 : -clip[3];
    if (!s.transform.depth_clamp && (clip[2] > clip[3] || clip[2] < nearest)) return false;
    return !(clip[0] > clip[3] || clip[0] < -clip[3] || clip[1] > clip[3] || clip[1] < -clip[3]);
}

Vec4 window_position(const State& s, const Vec4& clip) {
    const auto& v = s.window.viewport;
    const auto& range = s.transform.depth_range;
    const float d = clip[3] == 0.0f ? 1.0f : 1.0f / clip[3];
    const float half_width = 0.5f * static_cast<float>(v.width), half_height = 0.5f * static_cast<float>(v.height);
    const bool from_zero = s.transform.clip_control.depth == GL_ZERO_TO_ONE;
    const double depths = range.far_value - range.near_value;
    const auto z_scale = static_cast<float>(from_zero ? depths : 0.5 * depths);
    const auto z_offset = static_cast<float>(from_zero ? range.near_value : 0.5 * (range.far_value + range.near_value));
    const float up = s.transform.clip_control.origin == GL_LOWER_LEFT ? 1.0f : -1.0f;
    Vec4 out{clip[0] * d * half_width + (half_width + static_cast<float>(v.x)),
             up * clip[1] * d * half_height + (half_height + static_cast<float>(v.y)), clip[2] * d * z_scale + z_offset,
             clip[3]};
    if (s.transform.depth_clamp) {
        const auto [low, high] =
            std::minmax({static_cast<float>(range.near_value), static_cast<float>(range.far_value)});
        out[2] = std::clamp(out[2], low, high);
    }
    return out;
}

Vec4 raster_clip(const State& s, const Vec4& clip) {
    return view_change(geom::EyeView{}, s.matrix.projection) ? clip : Vec4{};
}

std::optional<SeenRaster> raster_in_view(const geom::EyeView& view, const State& s, const Vec4& own) {
    const Vec4& clip = s.raster.raster_clip;
    const auto change = clip[3] == 0.0f ? std::nullopt : view_change(view, s.matrix.projection);
    if (!change) return std::nullopt;
    const Vec4 there = times(*change, clip), first = window_position(s, clip);
    return SeenRaster{in_view_volume(s, there), window_position(s, there), own[0] - first[0], own[1] - first[1]};
}

}  // namespace wall::glstate
