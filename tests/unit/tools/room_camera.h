// SPDX-License-Identifier: MIT
// What a camera photographs in a made up room while a projector shows a test picture, and what its tiles give the
// places of the canvas. For tests of the calibration.
#pragma once

#include <opencv2/imgproc.hpp>

#include "tileserver/render/test_pattern.h"
#include "tools/wallcalibrate/gray_code.h"
#include "tools/wallcalibrate/wall_plan.h"

namespace wall::calibrate {

/// For each pixel of the camera, the place of a projector's picture that lights what it sees, as cv::remap wants it
/// (middles of pixels are whole; -1000: none).
struct LightMaps {
    cv::Mat x, y;
};

/// A projector of width x height pixels alone, with noise of that many levels, a light that is brighter on the left,
/// and a room that is not dark.
inline Photograph photograph(LightMaps maps, int width, int height, double noise, std::uint64_t seed) {
    cv::Mat shade(maps.x.size(), CV_32F);
    for (int x = 0; x < shade.cols; ++x)
        shade.col(x).setTo(0.75f - 0.35f * static_cast<float>(x) / static_cast<float>(shade.cols));
    return [=, random = cv::RNG(seed)](const Shot& shot) mutable -> Result<cv::Mat> {
        using tileserver::TestPattern;
        const TestPattern pattern{.kind = shot.kind == Shot::Kind::white   ? TestPattern::Kind::white
                                          : shot.kind == Shot::Kind::black ? TestPattern::Kind::black
                                                                           : TestPattern::Kind::code,
                                  .bit = static_cast<std::uint32_t>(shot.bit),
                                  .rows = shot.rows,
                                  .inverted = shot.inverted};
        const auto pixels = tileserver::pattern_pixels(pattern, {0, 0, width, height});
        const cv::Mat all(height, width, CV_8UC4, const_cast<std::byte*>(pixels.data()));
        cv::Mat shown, light, out;
        cv::extractChannel(all, shown, 0);
        shown.convertTo(shown, CV_32F);
        cv::remap(shown, light, maps.x, maps.y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
        cv::GaussianBlur(light, light, {5, 5}, 0.8);
        cv::Mat noisy(light.size(), CV_32F);
        random.fill(noisy, cv::RNG::NORMAL, 0, noise);
        light = light.mul(shade) + noisy + cv::Scalar(18);
        light.convertTo(out, CV_8U);
        return out;
    };
}

inline geom::TileOutput output_of(const PlannedTile& tile) {
    return {.width = tile.width, .height = tile.height, .warp = std::make_shared<const geom::Warp>(tile.warp)};
}

/// Where on the canvas is what a tile shows at a pixel of its output_of().
inline cv::Point2d canvas_at(const PlannedTile& tile, const geom::TileOutput& output, const cv::Point2d& pixel) {
    const auto at = geom::place_in_tile(
        output, {static_cast<float>(pixel.x / tile.width), static_cast<float>(pixel.y / tile.height)});
    return {tile.rect.x + static_cast<double>(at.x) * tile.rect.width,
            tile.rect.y + static_cast<double>(at.y) * tile.rect.height};
}

/// The share of light that a tile gives a place of the canvas, as the nodes blend it (docs/walls.md). NaN: none.
inline double weight_at(const PlannedTile& tile, const cv::Point2d& canvas) {
    const auto& r = tile.rect;
    if (!(canvas.x >= r.x && canvas.y >= r.y && canvas.x <= r.right() && canvas.y <= r.bottom())) return 0;
    const std::array<double, 4> inside{canvas.x - r.x, r.right() - canvas.x, canvas.y - r.y, r.bottom() - canvas.y};
    double weight = 1;
    for (std::size_t edge = 0; edge < 4; ++edge) {
        if (tile.ramps[edge] == 0) continue;
        const double t = std::clamp(inside[edge] / tile.ramps[edge], 0.0, 1.0);
        weight *= t * t * (3 - 2 * t);
    }
    return weight;
}

inline double percentile(std::vector<double> values, std::size_t percent) {
    std::ranges::sort(values);
    return values[values.size() * percent / 100];
}

}  // namespace wall::calibrate
