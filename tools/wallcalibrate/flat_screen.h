// SPDX-License-Identifier: MIT
// Where projectors lie on a flat screen, as a camera with a lens that bends lines sees them: from each projector's
// pixels to the picture that an ideal camera would take there are then homographies, and the lens is what makes them
// fit best. Pure.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "tools/wallcalibrate/gray_code.h"

namespace wall::calibrate {

/// Radial distortion around the picture's middle: a point at distance r from there, in halves of the picture's larger
/// side, is seen by an ideal camera at r (1 + k1 r² + k2 r⁴).
struct Lens {
    cv::Size picture;
    double k1 = 0, k2 = 0;
    /// In pixels of the ideal camera.
    cv::Point2d straight(const cv::Point2d& seen) const;
};

struct FlatScreen {
    Lens lens;
    std::vector<cv::Matx33d> from_output;  ///< of each projector: from its pixels to the ideal camera's
    double error = 0;                      ///< pixels of the projectors: 95 % of all matches are off by less
};

/// The error says which projector (by its place in the list) does not fit.
Result<FlatScreen> find_flat_screen(const cv::Size& picture, std::span<const std::vector<Match>> projectors);

cv::Point2d apply(const cv::Matx33d& homography, const cv::Point2d& point);

}  // namespace wall::calibrate
