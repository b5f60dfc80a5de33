// SPDX-License-Identifier: MIT
#include "common/geom/tile_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wall::geom {
namespace {

using ::testing::HasSubstr;
using ::testing::IsNull;

constexpr Rect kTile{100, 0, 40, 30};

void expect_at(Point point, float x, float y) {
    EXPECT_FLOAT_EQ(point.x, x);
    EXPECT_FLOAT_EQ(point.y, y);
}

/// Columns and rows of points where they are without a warp.
Warp flat_mesh(std::uint32_t columns, std::uint32_t rows) {
    Warp out{.columns = columns, .rows = rows};
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
            out.points.push_back({static_cast<float>(column) / static_cast<float>(columns - 1),
                                  static_cast<float>(row) / static_cast<float>(rows - 1)});
    return out;
}

TEST(TileOutput, IsPlainIfItShowsPixelForPixel) {
    EXPECT_TRUE(is_plain(plain_output(kTile), kTile));
    auto output = plain_output(kTile);
    output.width *= 2;
    EXPECT_FALSE(is_plain(output, kTile));
    output = plain_output(kTile);
    output.rotation = 180;
    EXPECT_FALSE(is_plain(output, kTile));
    output = plain_output(kTile);
    output.blend.emplace();
    EXPECT_FALSE(is_plain(output, kTile));
}

TEST(TileOutput, IsTheSameIfItsWarpSaysTheSame) {
    auto a = plain_output(kTile), b = a;
    a.warp = std::make_shared<const Warp>(flat_mesh(3, 2));
    EXPECT_FALSE(a == b);
    b.warp = std::make_shared<const Warp>(flat_mesh(3, 2));
    EXPECT_TRUE(a == b);
    b.warp = std::make_shared<const Warp>(flat_mesh(2, 3));
    EXPECT_FALSE(a == b);
}

TEST(TileOutput, IsTheSameIfItsLightIs) {
    auto a = plain_output(kTile), b = a;
    a.light = std::make_shared<const LightMap>(LightMap{{1, 1, 1, {9}}, {}});
    EXPECT_FALSE(a == b);
    b.light = std::make_shared<const LightMap>(LightMap{{1, 1, 1, {9}}, {}});
    EXPECT_TRUE(a == b);
    EXPECT_FALSE(is_plain(a, kTile));
}

TEST(LightMap, IsRefusedIfItIsNone) {
    EXPECT_EQ(wrong_with(LightMap{}), nullptr);
    EXPECT_EQ(wrong_with(LightMap{{2, 1, 3, {1, 2, 3, 4, 5, 6}}, {1, 1, 1, {7}}}), nullptr);
    EXPECT_THAT(wrong_with(LightMap{{2, 1, 1, {1}}, {}}), HasSubstr("another number"));
    EXPECT_THAT(wrong_with(LightMap{{1, 1, 2, {1, 2}}, {}}), HasSubstr("neither one nor three"));
    EXPECT_THAT(wrong_with(LightMap{{}, {1u << 31, 2, 1, {}}}), HasSubstr("too large"));
    EXPECT_THAT(wrong_with(LightMap{{}, {0, 2, 1, {}}}), HasSubstr("nothing"));
}

/// A monitor's own top left corner hangs top right when it is turned clockwise once.
TEST(TileOutput, TurnsClockwise) {
    TileOutput output{.width = 30, .height = 40};
    const auto corner = [&](std::uint32_t rotation) {
        output.rotation = rotation;
        return place_in_tile(output, {0, 0});
    };
    expect_at(corner(0), 0, 0);
    expect_at(corner(90), 1, 0);
    expect_at(corner(180), 1, 1);
    expect_at(corner(270), 0, 1);
    output.rotation = 90;
    expect_at(place_in_tile(output, {0.25f, 0.5f}), 0.5f, 0.25f);
}

TEST(Warp, ThatSaysNothingChangesNothing) {
    TileOutput output{.width = 40, .height = 30};
    output.warp = std::make_shared<const Warp>();
    expect_at(place_in_tile(output, {0.3f, 0.7f}), 0.3f, 0.7f);
    output.warp = std::make_shared<const Warp>(flat_mesh(5, 4));
    expect_at(place_in_tile(output, {0.3f, 0.7f}), 0.3f, 0.7f);
    expect_at(place_in_tile(output, {0, 0}), 0, 0);
    expect_at(place_in_tile(output, {1, 1}), 1, 1);
}

TEST(Warp, OfACellIsLinearAlongItsSides) {
    Warp warp = flat_mesh(2, 2);
    warp.points = {{0, 0}, {1, 0.2f}, {0.1f, 1}, {1, 1}};
    TileOutput output{.width = 40, .height = 30, .warp = std::make_shared<const Warp>(warp)};
    expect_at(place_in_tile(output, {0.5f, 0}), 0.5f, 0.1f);
    expect_at(place_in_tile(output, {0, 0.5f}), 0.05f, 0.5f);
    expect_at(place_in_tile(output, {0.5f, 0.5f}), 0.525f, 0.55f);
}

TEST(Warp, ShowsNothingInCellsWithoutAPoint) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    auto mesh = flat_mesh(4, 4);
    mesh.points[0] = {kNone, kNone};
    EXPECT_EQ(wrong_with(mesh), nullptr);
    auto output = plain_output(kTile);
    output.warp = std::make_shared<const Warp>(mesh);
    EXPECT_TRUE(std::isnan(place_in_tile(output, {0.2f, 0.2f}).x));
    EXPECT_NEAR(place_in_tile(output, {0.5f, 0.2f}).x, 0.5f, 1e-6f);
}

TEST(Warp, IsRefusedIfItFolds) {
    EXPECT_THAT(wrong_with(flat_mesh(5, 4)), IsNull());
    auto folded = flat_mesh(5, 4);
    std::swap(folded.points[6], folded.points[7]);
    EXPECT_THAT(wrong_with(folded), HasSubstr("folded"));
    auto flat = flat_mesh(5, 4);
    flat.points[1] = flat.points[0];
    EXPECT_THAT(wrong_with(flat), HasSubstr("folded"));
    auto mirrored = flat_mesh(5, 4);  // behind a screen
    for (Point& point : mirrored.points) point.x = 1 - point.x;
    EXPECT_THAT(wrong_with(mirrored), IsNull());
}

TEST(Warp, IsRefusedIfItsMeshIsNone) {
    EXPECT_THAT(wrong_with({.columns = 1, .rows = 5, .points = std::vector<Point>(5)}), HasSubstr("fewer than 2"));
    EXPECT_THAT(wrong_with({.columns = 1u << 31, .rows = 4}), HasSubstr("more than"));
    EXPECT_THAT(wrong_with({.columns = 4, .rows = 1u << 30}), HasSubstr("more than"));
    auto short_by_one = flat_mesh(4, 4);
    short_by_one.points.pop_back();
    EXPECT_THAT(wrong_with(short_by_one), HasSubstr("columns times rows"));
    auto nowhere = flat_mesh(4, 4);
    nowhere.points[5].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(wrong_with(nowhere), HasSubstr("none"));
}

TEST(Warp, IsRefusedIfItsHomographyIsNone) {
    EXPECT_THAT(wrong_with({.homography = {1, 0, 0, 2, 0, 0, 0, 0, 1}}), HasSubstr("line"));
    EXPECT_THAT(wrong_with({.homography = {1, 0, 0, 0, 1, 0, -2, 0, 1}}), HasSubstr("infinity"));
    EXPECT_THAT(wrong_with({.homography = {1, 0, 0, 0, 1, 0, -1, 0, 1}}), HasSubstr("infinity"));
    EXPECT_THAT(wrong_with({.homography = {1, 0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::infinity()}}),
                HasSubstr("none"));
    EXPECT_THAT(wrong_with({.homography = {1, 0.1f, 0, 0, 1, 0, 0.2f, 0.3f, 1}}), IsNull());
    EXPECT_THAT(wrong_with({.homography = {-1, 0, 0, 0, -1, 0, 0, 0, -1}}), IsNull()) << "the same as without signs";
}

}  // namespace
}  // namespace wall::geom
