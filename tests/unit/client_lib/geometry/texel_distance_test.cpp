// SPDX-License-Identifier: MIT
#include "client_lib/geometry/texel_distance.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace wall::client {
namespace {

constexpr std::int32_t kWidth = 300, kHeight = 200;

/// A rectangle at (x, y), of the image from (left, bottom) on; so many times as large.
std::array<LookingVertex, 4> rectangle(float x, float y, float left = 0, float bottom = 0, float scale = 1) {
    std::array<LookingVertex, 4> out;
    for (int i = 0; i < 4; ++i) {
        const float u = i % 2 == 0 ? left : kWidth, v = i < 2 ? bottom : kHeight;
        out[i] = {x + scale * (u - left), y + scale * (v - bottom), u, v};
    }
    return out;
}

TEST(TexelDistance, AsItIs) {
    EXPECT_EQ(texel_distance(rectangle(0, 0), kWidth, kHeight), (TexelDistance{0, 0}));
    EXPECT_EQ(texel_distance(rectangle(17, -9), kWidth, kHeight), (TexelDistance{17, -9}));
    EXPECT_EQ(texel_distance(rectangle(100, 50, 40, 30), kWidth, kHeight), (TexelDistance{60, 20})) << "a part of it";
    EXPECT_EQ(texel_distance(rectangle(3.2f, 7.8f), kWidth, kHeight), (TexelDistance{3, 8})) << "nearly";
}

TEST(TexelDistance, OtherwiseThanItIs) {
    EXPECT_FALSE(texel_distance(rectangle(0, 0, 0, 0, 0.5f), kWidth, kHeight)) << "scaled";
    EXPECT_FALSE(texel_distance(rectangle(0, 0, 0, 0, 1.002f), kWidth, kHeight)) << "a little";
    EXPECT_FALSE(texel_distance(rectangle(0.5f, 0), kWidth, kHeight)) << "between texels";
    auto turned = rectangle(0, 0);
    for (LookingVertex& v : turned) v.texel_y = kHeight - v.texel_y;
    EXPECT_FALSE(texel_distance(turned, kWidth, kHeight));
    auto sheared = rectangle(0, 0);
    sheared[3].x += 1;
    EXPECT_FALSE(texel_distance(sheared, kWidth, kHeight));
    EXPECT_FALSE(texel_distance({}, kWidth, kHeight));
}

TEST(TexelDistance, BesideTheImage) {
    EXPECT_FALSE(texel_distance(rectangle(0, 0, -1), kWidth, kHeight));
    EXPECT_FALSE(texel_distance(rectangle(0, 0), kWidth, kHeight - 1));
    EXPECT_FALSE(texel_distance(rectangle(2e6f, 0), kWidth, kHeight));
    auto none = rectangle(0, 0);
    none[2].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(texel_distance(none, kWidth, kHeight));
    none[0].x = none[2].x;
    EXPECT_FALSE(texel_distance(none, kWidth, kHeight));
}

}  // namespace
}  // namespace wall::client
