// SPDX-License-Identifier: MIT
#include "walld/streams/picture.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

namespace wall::walld {
namespace {

cv::Mat decode(const std::string& png) {
    return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}
cv::Vec3b rgb(unsigned char r, unsigned char g, unsigned char b) { return {b, g, r}; }

TilePicture plain(geom::Rect rect, std::string pixel) {
    TilePicture out{rect, {}};
    for (int i = 0; i < rect.width * rect.height; ++i) out.rgb += pixel;
    return out;
}

TEST(Picture, TilesStandAtTheirPlacesOnTheBackground) {
    PictureJob job{{0, 0, 8, 4}, 0x010203, {plain({0, 0, 4, 4}, "\xff\x10\x20"), plain({6, 0, 2, 2}, "\x30\xff\x40")}};
    const auto picture = decode(*compose_png(job));
    ASSERT_EQ(picture.size(), cv::Size(8, 4));
    EXPECT_EQ(picture.at<cv::Vec3b>(3, 3), rgb(0xff, 0x10, 0x20));
    EXPECT_EQ(picture.at<cv::Vec3b>(0, 5), rgb(1, 2, 3));
    EXPECT_EQ(picture.at<cv::Vec3b>(1, 7), rgb(0x30, 0xff, 0x40));
    EXPECT_EQ(picture.at<cv::Vec3b>(2, 7), rgb(1, 2, 3));
}

TEST(Picture, AViewCutsTiles) {
    PictureJob job{{2, 1, 3, 2}, 0, {plain({0, 0, 4, 4}, "\xff\xff\xff")}};
    const auto picture = decode(*compose_png(job));
    ASSERT_EQ(picture.size(), cv::Size(3, 2));
    EXPECT_EQ(picture.at<cv::Vec3b>(0, 1), rgb(255, 255, 255));
    EXPECT_EQ(picture.at<cv::Vec3b>(0, 2), rgb(0, 0, 0));
}

TEST(Picture, AMissingTileIsBackgroundAndAnEmptyViewAnError) {
    EXPECT_EQ(decode(*compose_png({{0, 0, 2, 2}, 0xffffff, {{{0, 0, 2, 2}, {}}}})).at<cv::Vec3b>(0, 0),
              rgb(255, 255, 255));
    EXPECT_FALSE(compose_png({}));
}

}  // namespace
}  // namespace wall::walld
