// SPDX-License-Identifier: MIT
#include "walld/streams/pattern_label.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace wall::walld {
namespace {

constexpr std::size_t kLongestLine = 64;  // characters
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX, kThickness = 2, kMargin = 8;
constexpr double kScale = 1.5;

}  // namespace

PatternLabel pattern_label(const std::vector<std::string>& lines) {
    int width = 1, line_height = 1, below = 0;
    std::vector<std::string> shown;
    for (const auto& line : lines) {
        shown.push_back(line.substr(0, kLongestLine));
        std::ranges::replace_if(
            shown.back(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
        const auto size = cv::getTextSize(shown.back(), kFont, kScale, kThickness, &below);
        width = std::max(width, size.width);
        line_height = std::max(line_height, size.height + below + kMargin);
    }
    const int height = std::max(1, line_height * static_cast<int>(shown.size()));
    cv::Mat picture(height, width + 2 * kMargin, CV_8UC1, cv::Scalar(0));
    for (std::size_t i = 0; i < shown.size(); ++i)
        cv::putText(picture, shown[i], {kMargin, line_height * static_cast<int>(i + 1) - below - kMargin / 2}, kFont,
                    kScale, cv::Scalar(255), kThickness, cv::LINE_AA);
    return {static_cast<std::uint32_t>(picture.cols), static_cast<std::uint32_t>(picture.rows),
            std::string(reinterpret_cast<const char*>(picture.data), picture.total())};
}

}  // namespace wall::walld
