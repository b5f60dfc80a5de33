// SPDX-License-Identifier: MIT
// A camera whose lens is known beforehand, from photographs of a chessboard: what curved screens need, where the lens
// cannot be told from the screen. The file is OpenCV's own (camera_matrix, distortion_coefficients), so that what its
// tools have found is good as well. Pure, but for the file.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace wall::calibrate {

struct CameraLens {
    cv::Size picture;    ///< pixels
    cv::Matx33d matrix;  ///< focal lengths and principal point, pixels; OpenCV's: middles of pixels are whole
    std::vector<double> distortion;  ///< OpenCV's: k1, k2, p1, p2, k3, ...; none: it bends nothing
    double error = 0;                ///< root mean square of the corners from which it was found, pixels
};

/// Where an ideal camera at the same place sees them, of the same matrix. Pixels whose middles are halves, as a Match
/// counts them.
std::vector<cv::Point2d> straight(const CameraLens& lens, std::span<const cv::Point2d> seen);

/// From photographs in grey, of one size, of a board with so many inner corners. An error: too few show all of it.
Result<CameraLens> find_lens(std::span<const cv::Mat> photographs, const cv::Size& corners);

Result<CameraLens> read_lens(const std::filesystem::path& file);
/// The file's content.
std::string lens_text(const CameraLens& lens);

}  // namespace wall::calibrate
