// SPDX-License-Identifier: MIT
#include "tools/wallview/png.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace wall::wallview {

Result<void> save_png(const codec::FrameView& picture, const std::string& path) {
    if (picture.width == 0) return fail("there is no picture yet");
    // OpenCV wants pointers that it may write through; it only reads here.
    const cv::Mat rgba(static_cast<int>(picture.height), static_cast<int>(picture.width), CV_8UC4,
                       const_cast<std::byte*>(picture.pixels), static_cast<std::size_t>(picture.stride));
    cv::Mat bgr;
    cv::cvtColor(rgba, bgr, cv::COLOR_RGBA2BGR);
    try {
        if (cv::imwrite(path, bgr)) return {};
    } catch (const cv::Exception& error) {
        return fail(path + ": " + error.what());
    }
    return fail(path + ": cannot be written");
}

}  // namespace wall::wallview
