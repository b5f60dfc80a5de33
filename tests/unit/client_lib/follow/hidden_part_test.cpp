// SPDX-License-Identifier: MIT
#include "client_lib/follow/hidden_part.h"

#include <gtest/gtest.h>

#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

using geom::Rect;

TEST(UncoveredPart, IsNothingWhereTilesTouch) {
    EXPECT_TRUE(uncovered({10, 10, 300, 200}, {{0, 0, 160, 240}, {160, 0, 160, 240}}).empty());
}

TEST(UncoveredPart, IsTheStripBeyondAnEdge) {
    const std::vector<Rect> wall{{0, 0, 320, 240}};
    EXPECT_EQ(uncovered({0, 100, 320, 150}, wall), (Rect{0, 240, 320, 10}));
    EXPECT_EQ(uncovered({-20, 0, 100, 100}, wall), (Rect{-20, 0, 20, 100}));
}

TEST(UncoveredPart, IsTheWholeWindowBesideTheWallAndAroundIt) {
    const std::vector<Rect> wall{{0, 0, 320, 240}};
    EXPECT_EQ(uncovered({1000, 0, 100, 100}, wall), (Rect{1000, 0, 100, 100}));
    EXPECT_EQ(uncovered({-10, -10, 340, 260}, wall), (Rect{-10, -10, 340, 260}));
    EXPECT_EQ(uncovered({0, 0, 10, 10}, {}), (Rect{0, 0, 10, 10}));
}

TEST(UncoveredPart, IsWhatABezelHides) {
    EXPECT_EQ(uncovered({10, 10, 300, 100}, {{0, 0, 150, 240}, {170, 0, 150, 240}}), (Rect{150, 10, 20, 100}));
}

TEST(UncoveredPart, MayBeCoveredTwice) {
    EXPECT_TRUE(uncovered({0, 0, 100, 100}, {{0, 0, 60, 100}, {40, 0, 60, 100}}).empty());
}

TEST(AKeptFrame, HasAStretchForEachTurnOfAContext) {
    constexpr ContextId kFirst(1), kOther(2);
    KeptFrame frame;
    EXPECT_TRUE(frame.empty());
    for (const ContextId context : {kFirst, kFirst, kOther, kFirst}) {
        frame.turn_to(context);
        glapi::pack::Vertex2f(frame.follower.batch, 1, 2);
    }
    EXPECT_EQ(frame.bytes(), 4 * 9u);
    frame.seal();
    ASSERT_EQ(frame.stretches.size(), 3u);
    EXPECT_EQ(frame.stretches[0].commands.commands(), 2u);
    EXPECT_EQ(frame.stretches[1].context, kOther);
    EXPECT_EQ(frame.stretches[2].context, kFirst);
    EXPECT_EQ(frame.bytes(), 4 * 9u);
}

}  // namespace
}  // namespace wall::client
