// SPDX-License-Identifier: MIT
#include "walld/wall/placement.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace wall::walld {
namespace {

using geom::Rect;
constexpr Rect kCanvas{0, 0, 1000, 600};

TEST(Placement, StartsAtTheTopLeft) { EXPECT_EQ(place(kCanvas, {}, 300, 200, 0), (Rect{0, 0, 300, 200})); }

TEST(Placement, GoesOnBesideThenBelow) {
    std::vector<Rect> taken;
    for (const auto& expected :
         {Rect{0, 0, 500, 300}, Rect{500, 0, 500, 300}, Rect{0, 300, 500, 300}, Rect{500, 300, 500, 300}}) {
        taken.push_back(place(kCanvas, taken, 500, 300, 0));
        EXPECT_EQ(taken.back(), expected);
    }
}

TEST(Placement, FindsAGapBetweenWindows) {
    const std::vector<Rect> taken{{0, 0, 300, 600}, {500, 0, 500, 600}};
    EXPECT_EQ(place(kCanvas, taken, 200, 100, 5), (Rect{300, 0, 200, 100}));
}

TEST(Placement, CascadesWhenThereIsNoRoom) {
    const std::vector<Rect> taken{kCanvas};
    EXPECT_EQ(place(kCanvas, taken, 300, 200, 1), (Rect{kCascadeStep, kCascadeStep, 300, 200}));
    EXPECT_EQ(place(kCanvas, taken, 300, 200, 2), (Rect{2 * kCascadeStep, 2 * kCascadeStep, 300, 200}));
}

TEST(Placement, AWindowLargerThanTheCanvasStartsInItsCorner) {
    EXPECT_EQ(place(kCanvas, {}, 2000, 200, 0), (Rect{0, 0, 2000, 200}));
}

TEST(Placement, NeverOverlapsWhileThereIsRoomAndStaysOnTheCanvas) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        std::vector<Rect> taken;
        for (std::uint32_t i = 0; i < 20; ++i) {
            const auto rect =
                place(kCanvas, taken, static_cast<int>(random() % 400 + 1), static_cast<int>(random() % 300 + 1), i);
            EXPECT_EQ(geom::intersect(rect, kCanvas), rect);
            taken.push_back(rect);
        }
        EXPECT_FALSE(geom::overlaps(taken[0], taken[1]));
    }
}

}  // namespace
}  // namespace wall::walld
