// SPDX-License-Identifier: MIT
// Where projectors lie on a screen of any smooth shape, as a camera sees them: for a grid of each projector's pixels,
// the place in the camera's picture. From where the camera stands, a picture that is put there is right. Pure.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "tools/wallcalibrate/camera_lens.h"
#include "tools/wallcalibrate/gray_code.h"

namespace wall::calibrate {

/// A grid over a projector's pixels, from corner to corner, row by row.
struct SeenMesh {
    int columns = 0, rows = 0;
    std::vector<cv::Point2d> points;  ///< pixels of the ideal camera; NaN: the camera does not see it
};
bool is_seen(const cv::Point2d& point);

struct Seen {
    int width = 0, height = 0;  ///< pixels of the projector
    std::vector<Match> matches;
};

struct CurvedScreen {
    std::vector<SeenMesh> seen;  ///< of each projector
    double error = 0;            ///< pixels of the projectors: 95 % of all matches are off by less
};

/// The error says which projector (by its place in the list) does not fit. `lens`: nullptr bends nothing.
Result<CurvedScreen> find_curved_screen(const CameraLens* lens, std::span<const Seen> projectors);

}  // namespace wall::calibrate
