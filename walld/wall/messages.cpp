// SPDX-License-Identifier: MIT
#include "walld/wall/messages.h"

#include "common/base/stereo.h"

namespace wall::walld {
namespace {

void warp_to_proto(const geom::Warp& warp, proto::TileOutput::Warp& out) {
    if (warp.columns == 0) {
        out.mutable_homography()->Add(warp.homography.begin(), warp.homography.end());
        return;
    }
    out.set_columns(warp.columns);
    out.set_rows(warp.rows);
    for (const geom::Point& point : warp.points) {
        out.add_points(point.x);
        out.add_points(point.y);
    }
}

void map_to_proto(const geom::LightMap::Map& map, proto::TileOutput::Map& out) {
    out.set_width(map.width);
    out.set_height(map.height);
    out.set_channels(map.channels);
    out.set_values(map.values.data(), map.values.size());
}

}  // namespace

proto::TileOutput to_proto(const geom::TileOutput& output) {
    proto::TileOutput out;
    out.set_rotation(output.rotation);
    out.set_width(static_cast<std::uint32_t>(output.width));
    out.set_height(static_cast<std::uint32_t>(output.height));
    if (output.warp) warp_to_proto(*output.warp, *out.mutable_warp());
    if (output.blend) {
        auto& blend = *out.mutable_blend();
        const auto& ramps = output.blend->ramps;
        blend.set_left(ramps[geom::Blend::left]);
        blend.set_right(ramps[geom::Blend::right]);
        blend.set_top(ramps[geom::Blend::top]);
        blend.set_bottom(ramps[geom::Blend::bottom]);
        blend.set_gamma(output.blend->gamma);
        blend.set_black(output.blend->black);
    }
    if (output.light) {
        map_to_proto(output.light->share, *out.mutable_share());
        map_to_proto(output.light->lift, *out.mutable_lift());
    }
    if (output.color) {
        auto& color = *out.mutable_color();
        const auto& [matrix, gamma, curves] = *output.color;
        color.mutable_matrix()->Add(matrix.begin(), matrix.end());
        color.set_gamma(gamma);
        color.mutable_red()->Add(curves[0].begin(), curves[0].end());
        color.mutable_green()->Add(curves[1].begin(), curves[1].end());
        color.mutable_blue()->Add(curves[2].begin(), curves[2].end());
    }
    out.set_stereo(static_cast<std::uint32_t>(output.stereo));
    out.set_right_slot(output.right_slot);
    return out;
}

proto::View to_proto(const geom::View& view) {
    proto::View out;
    const auto values = geom::values_of(view);
    out.mutable_values()->Add(values.begin(), values.end());
    return out;
}

std::optional<proto::Stereo> checked(const proto::Stereo& told) {
    return is_sound({told.separation(), told.screen()}) ? std::optional(told) : std::nullopt;
}

}  // namespace wall::walld
