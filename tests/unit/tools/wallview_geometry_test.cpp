// SPDX-License-Identifier: MIT
#include "tools/wallview/geometry.h"

#include <gtest/gtest.h>

namespace wall::wallview {
namespace {

TEST(Letterbox, KeepsProportionsInTheMiddle) {
    EXPECT_EQ(letterbox(200, 100, 400, 400), (geom::Rect{0, 100, 400, 200}));
    EXPECT_EQ(letterbox(100, 200, 400, 400), (geom::Rect{100, 0, 200, 400}));
    EXPECT_EQ(letterbox(640, 480, 320, 240), (geom::Rect{0, 0, 320, 240}));
    EXPECT_EQ(letterbox(32768, 1, 32768, 32768), (geom::Rect{0, 16383, 32768, 1}));
    EXPECT_TRUE(letterbox(0, 0, 320, 240).empty());
}

}  // namespace
}  // namespace wall::wallview
