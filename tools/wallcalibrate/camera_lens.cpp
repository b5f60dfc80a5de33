// SPDX-License-Identifier: MIT
#include "tools/wallcalibrate/camera_lens.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace wall::calibrate {
namespace {

constexpr std::size_t kFewestBoards = 5;
constexpr double kLargestError = 2;  // pixels, root mean square: beyond, it is no lens of this model
constexpr int kHalfWindow = 5;       // pixels around a corner in which it is made exact
constexpr int kMaxExtent = 1 << 16;  // of a photograph
constexpr int kMaxDistortion = 14;   // numbers, of OpenCV's model

/// The corners of a board that lies there, its squares being the unit.
std::vector<cv::Point3f> board_of(const cv::Size& corners) {
    std::vector<cv::Point3f> out;
    for (int y = 0; y < corners.height; ++y)
        for (int x = 0; x < corners.width; ++x) out.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
    return out;
}

}  // namespace

std::vector<cv::Point2d> straight(const CameraLens& lens, std::span<const cv::Point2d> seen) {
    const cv::Point2d half(0.5, 0.5);
    std::vector<cv::Point2d> middles, out;
    if (seen.empty()) return out;
    for (const auto& at : seen) middles.push_back(at - half);
    cv::undistortPoints(middles, out, lens.matrix, lens.distortion, cv::noArray(), lens.matrix);
    for (auto& at : out) at += half;
    return out;
}

Result<CameraLens> find_lens(std::span<const cv::Mat> photographs, const cv::Size& corners) {
    std::vector<std::vector<cv::Point2f>> found;
    CameraLens out;
    for (const cv::Mat& photograph : photographs) {
        if (out.picture.empty()) out.picture = photograph.size();
        if (photograph.size() != out.picture || photograph.type() != CV_8UC1)
            return fail("photographs of a board: expected grey ones of one size");
        std::vector<cv::Point2f> at;
        if (!cv::findChessboardCorners(photograph, corners, at)) continue;
        cv::cornerSubPix(photograph, at, {kHalfWindow, kHalfWindow}, {-1, -1},
                         {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-3});
        found.push_back(std::move(at));
    }
    if (found.size() < kFewestBoards)
        return fail(std::to_string(found.size()) + " of " + std::to_string(photographs.size()) +
                    " photographs show a whole board of " + std::to_string(corners.width) + "x" +
                    std::to_string(corners.height) + " inner corners: expected at least " +
                    std::to_string(kFewestBoards) + ", from different sides, and in the picture's corners, too");
    cv::Mat matrix, distortion, turned, moved;
    const std::vector<std::vector<cv::Point3f>> boards(found.size(), board_of(corners));
    out.error = cv::calibrateCamera(boards, found, out.picture, matrix, distortion, turned, moved);
    if (out.error > kLargestError)
        return fail("the boards are off by " + std::to_string(out.error) +
                    " pixels with the best lens: expected a flat board, and sharp photographs of one zoom and focus");
    out.matrix = cv::Matx33d(matrix);
    out.distortion.assign(distortion.begin<double>(), distortion.end<double>());
    return out;
}

Result<CameraLens> read_lens(const std::filesystem::path& path) {
    const std::string name = path.string();
    const auto refused = [&name](const char* what) {
        return fail(name + ": " + what + ": expected what `wallctl calibrate lens` or OpenCV's calibration wrote");
    };
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return refused("cannot be read");  // OpenCV would print it, too
    try {
        const cv::FileStorage file(name, cv::FileStorage::READ | cv::FileStorage::FORMAT_YAML);
        if (!file.isOpened()) return refused("cannot be read");
        CameraLens out;
        cv::Mat matrix, distortion;
        file["image_width"] >> out.picture.width;
        file["image_height"] >> out.picture.height;
        file["camera_matrix"] >> matrix;
        file["distortion_coefficients"] >> distortion;
        const auto sound = [](int extent) { return extent > 0 && extent <= kMaxExtent; };
        if (!sound(out.picture.width) || !sound(out.picture.height)) return refused("has no image_width and _height");
        if (matrix.size() != cv::Size(3, 3) || matrix.type() != CV_64FC1 || !cv::checkRange(matrix))
            return refused("has no camera_matrix of 3x3 numbers");
        out.matrix = cv::Matx33d(matrix);
        if (!(out.matrix(0, 0) > 0 && out.matrix(1, 1) > 0)) return refused("has a camera_matrix that sees nothing");
        const auto count = static_cast<int>(distortion.total());
        if (count > kMaxDistortion || (count > 0 && (distortion.type() != CV_64FC1 || !cv::checkRange(distortion))) ||
            (count != 0 && count != 4 && count != 5 && count != 8 && count != 12 && count != 14))
            return refused("has no distortion_coefficients of 4, 5, 8, 12 or 14 numbers");
        if (count > 0) out.distortion.assign(distortion.begin<double>(), distortion.end<double>());
        return out;
    } catch (const cv::Exception& wrong) {
        return refused(wrong.err.c_str());
    }
}

std::string lens_text(const CameraLens& lens) {
    cv::FileStorage file(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    file << "image_width" << lens.picture.width << "image_height" << lens.picture.height;
    file << "camera_matrix" << cv::Mat(lens.matrix) << "distortion_coefficients" << cv::Mat(lens.distortion);
    file << "avg_reprojection_error" << lens.error;
    return file.releaseAndGetString();
}

}  // namespace wall::calibrate
