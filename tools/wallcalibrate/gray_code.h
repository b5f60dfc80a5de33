// SPDX-License-Identifier: MIT
// From photographs of Gray codes (`wallctl pattern code`) to which pixel of a projector each pixel of the camera sees.
// Pure.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace wall::calibrate {

/// One photograph of a series. All show one projector alone; the others are black meanwhile.
struct Shot {
    enum class Kind { white, black, code };
    Kind kind = Kind::white;
    int bit = 0;            ///< of a code; 0 changes most often
    bool rows = false;      ///< it tells rows, not columns
    bool inverted = false;  ///< dark where it would be bright
    /// Such as "white" or "y-3-inverted"; photographs are called TILE-NAME.png.
    std::string name() const;
};
/// All that a projector of that many pixels needs, in the order in which they are best taken.
std::vector<Shot> shots_of(int width, int height);

/// The middle of a camera's pixel and of the projector's that is seen there, in pixels.
struct Match {
    cv::Point2d camera, output;
};
/// A photograph in grey, 8 bits; all of one size.
using Photograph = std::function<Result<cv::Mat>(const Shot&)>;
/// What the camera sees of a projector. Pixels at which any bit is hard to tell are left out.
Result<std::vector<Match>> decode(int width, int height, const Photograph& photograph);

}  // namespace wall::calibrate
