// SPDX-License-Identifier: MIT
#include "tileserver/render/test_pattern.h"

#include <gtest/gtest.h>

#include <set>

namespace wall::tileserver {
namespace {

using Kind = TestPattern::Kind;

/// A picture of a part of the canvas, asked by the canvas's pixels.
class Picture {
public:
    Picture(const TestPattern& pattern, const geom::Rect& area) : area_(area), pixels_(pattern_pixels(pattern, area)) {
        EXPECT_EQ(pixels_.size(), std::size_t{4} * area.width * area.height);
    }
    /// 0xRRGGBB
    std::uint32_t at(std::int32_t x, std::int32_t y) const {
        const auto* pixel = &pixels_[std::size_t{4} * ((y - area_.y) * area_.width + x - area_.x)];
        EXPECT_EQ(std::to_integer<unsigned>(pixel[3]), 255u);
        return std::to_integer<std::uint32_t>(pixel[0]) << 16 | std::to_integer<std::uint32_t>(pixel[1]) << 8 |
               std::to_integer<std::uint32_t>(pixel[2]);
    }

private:
    geom::Rect area_;
    std::vector<std::byte> pixels_;
};

constexpr std::uint32_t kWhite = 0xffffff, kThin = 0x808080, kEdge = 0xff3030, kRound = 0x30ff30;

TEST(TestPattern, GridLiesOnTheCanvasAndEndsAtTheTile) {
    const Picture grid({.kind = Kind::grid}, {450, 30, 200, 100});
    EXPECT_EQ(grid.at(450, 77), kEdge);
    EXPECT_EQ(grid.at(649, 77), kEdge);
    EXPECT_EQ(grid.at(500, 80), kWhite) << "a thick line, where it is on all tiles";
    EXPECT_EQ(grid.at(499, 80), kWhite);
    EXPECT_EQ(grid.at(501, 80), kWhite);
    EXPECT_EQ(grid.at(600, 80), kThin);
    EXPECT_EQ(grid.at(470, 100), kThin);
    EXPECT_EQ(grid.at(549 + 45, 79), kRound) << "0.45 of the height to the right of the middle";
}

TEST(TestPattern, RampsGoFromDarkToBrightInEachColour) {
    const Picture ramps({.kind = Kind::ramps}, {100, 0, 256, 80});
    EXPECT_EQ(ramps.at(100, 5), 0u);
    EXPECT_EQ(ramps.at(355, 5), kWhite);
    EXPECT_EQ(ramps.at(100 + 77, 5), 0x4d4d4du);
    EXPECT_EQ(ramps.at(100 + 77, 25), 0x4d0000u);
    EXPECT_EQ(ramps.at(100 + 77, 45), 0x004d00u);
    EXPECT_EQ(ramps.at(100 + 77, 65), 0x00004du);
    std::set<std::uint32_t> steps;
    for (int x = 100; x < 356; ++x) steps.insert(ramps.at(x, 15));
    EXPECT_EQ(steps.size(), 16u);
    EXPECT_EQ(*steps.rbegin(), kWhite);
}

TEST(TestPattern, NamesAreAsLargeAsTheyCanBeInTheMiddle) {
    TestPattern names{.kind = Kind::names};
    names.label = {2, 1, std::string("\xff\x40", 2)};
    const Picture picture(names, {1000, 0, 100, 60});  // 45 times as large
    EXPECT_EQ(picture.at(1005, 30), kWhite);
    EXPECT_EQ(picture.at(1049, 30), kWhite);
    EXPECT_EQ(picture.at(1050, 30), 0x404040u);
    EXPECT_EQ(picture.at(1094, 30), 0x404040u);
    EXPECT_EQ(picture.at(1004, 30), 0u);
    EXPECT_EQ(picture.at(1095, 30), 0u);
    EXPECT_EQ(picture.at(1050, 6), 0u);
    EXPECT_EQ(Picture({.kind = Kind::names}, {0, 0, 9, 9}).at(4, 4), 0u) << "without a label";
}

/// From one place to the next only one bit changes, and all bits together tell the place.
TEST(TestPattern, CodeTellsEachColumn) {
    constexpr geom::Rect kArea{0, 0, 64, 3};
    std::vector<std::uint32_t> codes(64);
    for (std::uint32_t bit = 0; bit < 6; ++bit) {
        const Picture shown({.kind = Kind::code, .bit = bit}, kArea),
            inverted({.kind = Kind::code, .bit = bit, .inverted = true}, kArea);
        for (int x = 0; x < 64; ++x) {
            EXPECT_NE(shown.at(x, 1), inverted.at(x, 1));
            codes[x] |= (shown.at(x, 2) == kWhite ? 1u : 0u) << bit;
        }
    }
    EXPECT_EQ(std::set<std::uint32_t>(codes.begin(), codes.end()).size(), 64u);
    for (int x = 1; x < 64; ++x) EXPECT_EQ(std::popcount(codes[x] ^ codes[x - 1]), 1) << x;
    const Picture rows({.kind = Kind::code, .bit = 0, .rows = true}, {0, 0, 3, 8});
    EXPECT_NE(rows.at(0, 0), rows.at(0, 1));
    EXPECT_EQ(rows.at(0, 1), rows.at(2, 1));
}

TEST(TestPattern, AllBrightAndAllDark) {
    EXPECT_EQ(Picture({.kind = Kind::white}, {0, 0, 4, 4}).at(3, 3), kWhite);
    EXPECT_EQ(Picture({.kind = Kind::black}, {0, 0, 4, 4}).at(0, 0), 0u);
}

}  // namespace
}  // namespace wall::tileserver
