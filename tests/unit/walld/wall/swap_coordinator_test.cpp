// SPDX-License-Identifier: MIT
#include "walld/wall/swap_coordinator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::walld {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr NodeIndex kLeft(0), kRight(1), kThird(2), kStranger(9);

class Swap : public ::testing::Test {
protected:
    Clock::time_point at(int ms) const { return start_ + milliseconds(ms); }
    Clock::time_point start_ = Clock::time_point{} + std::chrono::hours(1);
    SwapCoordinator swap_{milliseconds(250), false};
};

TEST_F(Swap, PresentsWhenTheLastNodeHasRendered) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    EXPECT_THAT(swap_.rendered(kLeft, 1, at(1)), IsEmpty());
    EXPECT_FALSE(swap_.shown(1));
    EXPECT_THAT(swap_.rendered(kRight, 1, at(2)), ElementsAre(PresentTo{kLeft, 1}, PresentTo{kRight, 1}));
    EXPECT_TRUE(swap_.shown(1));
    EXPECT_FALSE(swap_.deadline());
}

TEST_F(Swap, APipelinedNodeWaitsForTheOthers) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.rendered(kLeft, 1, at(1));
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(2)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kRight, 1, at(3)), ElementsAre(PresentTo{kLeft, 1}, PresentTo{kRight, 1}));
    EXPECT_THAT(swap_.rendered(kRight, 2, at(4)), ElementsAre(PresentTo{kLeft, 2}, PresentTo{kRight, 2}));
}

TEST_F(Swap, ASlowNodeIsLeftOutAfterTheLimitAndNotWaitedForAgain) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.rendered(kLeft, 1, at(10));
    EXPECT_EQ(swap_.deadline(), at(260));
    EXPECT_THAT(swap_.tick(at(259)), IsEmpty());
    EXPECT_THAT(swap_.tick(at(260)), ElementsAre(PresentTo{kLeft, 1}));
    EXPECT_EQ(swap_.timeouts(), 1u);
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(270)), ElementsAre(PresentTo{kLeft, 2}));
    EXPECT_THAT(swap_.rendered(kRight, 1, at(280)), ElementsAre(PresentTo{kRight, 1})) << "it shows what it has";
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(290)), ElementsAre(PresentTo{kLeft, 3}));
}

TEST_F(Swap, ASlowNodeThatCaughtUpIsWaitedForAgain) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.rendered(kLeft, 1, at(0));
    swap_.tick(at(250));
    EXPECT_THAT(swap_.rendered(kRight, 1, at(260)), ElementsAre(PresentTo{kRight, 1}));
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(270)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kRight, 2, at(280)), ElementsAre(PresentTo{kLeft, 2}, PresentTo{kRight, 2}));
}

TEST_F(Swap, ADeadNodeDoesNotHoldTheOthers) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.rendered(kLeft, 1, at(1));
    EXPECT_THAT(swap_.set_nodes({kLeft}, at(2)), ElementsAre(PresentTo{kLeft, 1}));
}

TEST_F(Swap, ANewNodeJoinsWithItsFirstCurrentFrame) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.rendered(kLeft, 5, at(1));
    swap_.set_nodes({kLeft, kRight}, at(2));
    EXPECT_FALSE(swap_.shown(5)) << "it shows nothing yet";
    EXPECT_THAT(swap_.rendered(kLeft, 6, at(3)), ElementsAre(PresentTo{kLeft, 6}))
        << "not waited for before it has drawn";
    EXPECT_THAT(swap_.rendered(kRight, 6, at(4)), ElementsAre(PresentTo{kRight, 6}));
    EXPECT_THAT(swap_.rendered(kLeft, 7, at(5)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kRight, 7, at(6)), ElementsAre(PresentTo{kLeft, 7}, PresentTo{kRight, 7}));
}

TEST_F(Swap, IgnoresStrangersAndOldReports) {
    swap_.set_nodes({kLeft}, at(0));
    EXPECT_THAT(swap_.rendered(kStranger, 1, at(1)), IsEmpty());
    swap_.rendered(kLeft, 3, at(2));
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(3)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(3)), IsEmpty());
    EXPECT_EQ(swap_.presented(), 3u);
}

TEST_F(Swap, NothingIsShownWithoutNodes) {
    EXPECT_FALSE(swap_.shown(1));
    EXPECT_THAT(swap_.set_nodes({}, at(0)), IsEmpty());
    EXPECT_FALSE(swap_.shown(1));
}

TEST_F(Swap, HeldFramesAreShownOneStepAtATime) {
    SwapCoordinator held(milliseconds(250), true);
    held.set_nodes({kLeft, kRight}, at(0));
    held.rendered(kLeft, 1, at(1));
    EXPECT_THAT(held.rendered(kRight, 1, at(2)), IsEmpty());
    EXPECT_FALSE(held.deadline()) << "no limit runs for a frame that may not be shown";
    EXPECT_THAT(held.step(1, at(1000)), ElementsAre(PresentTo{kLeft, 1}, PresentTo{kRight, 1}));
    held.rendered(kLeft, 2, at(1001));
    EXPECT_THAT(held.rendered(kRight, 2, at(1002)), IsEmpty());
    EXPECT_THAT(held.step(1, at(1003)), ElementsAre(PresentTo{kLeft, 2}, PresentTo{kRight, 2}));
}

TEST_F(Swap, AStepAheadOfTheFrameCounts) {
    SwapCoordinator held(milliseconds(250), true);
    held.set_nodes({kLeft}, at(0));
    EXPECT_THAT(held.step(2, at(0)), IsEmpty());
    EXPECT_THAT(held.rendered(kLeft, 1, at(1)), ElementsAre(PresentTo{kLeft, 1}));
    EXPECT_THAT(held.rendered(kLeft, 2, at(2)), ElementsAre(PresentTo{kLeft, 2}));
    EXPECT_THAT(held.rendered(kLeft, 3, at(3)), IsEmpty());
    EXPECT_THAT(held.release(at(4)), ElementsAre(PresentTo{kLeft, 3}));
}

TEST_F(Swap, HoldStopsWhereItIs) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.rendered(kLeft, 4, at(0));
    swap_.hold(at(1));
    EXPECT_THAT(swap_.rendered(kLeft, 5, at(2)), IsEmpty());
    EXPECT_THAT(swap_.step(1, at(3)), ElementsAre(PresentTo{kLeft, 5}));
}

/// It was late, and was not sent what came meanwhile.
TEST_F(Swap, ANodeDoesNotShowWhatItWasLeftOutOf) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.rendered(kLeft, 1, at(0));
    swap_.rendered(kRight, 1, at(1));
    swap_.rendered(kLeft, 2, at(2));
    EXPECT_THAT(swap_.rendered(kRight, 4, at(3)), ElementsAre(PresentTo{kLeft, 2})) << "it holds up nobody";
    EXPECT_FALSE(swap_.shown(2)) << "it shows the first one still";
    EXPECT_EQ(swap_.behind(kRight), 1u);
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(4)), ElementsAre(PresentTo{kLeft, 3}));
    EXPECT_THAT(swap_.rendered(kLeft, 4, at(5)), ElementsAre(PresentTo{kLeft, 4}, PresentTo{kRight, 4}));
    EXPECT_TRUE(swap_.shown(4));
}

TEST_F(Swap, AHeldGroupGoesOnToWhatAllCanShow) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.rendered(kLeft, 1, at(0));
    swap_.rendered(kRight, 1, at(1));
    swap_.rendered(kLeft, 2, at(2));
    swap_.tick(at(252));  // to show it without the right one
    swap_.hold(at(253));
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(254)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kRight, 4, at(255)), ElementsAre(PresentTo{kLeft, 3}));
    EXPECT_THAT(swap_.rendered(kLeft, 4, at(256)), ElementsAre(PresentTo{kLeft, 4}, PresentTo{kRight, 4}));
    swap_.rendered(kLeft, 5, at(257));
    EXPECT_THAT(swap_.rendered(kRight, 5, at(258)), IsEmpty()) << "and is held there";
    EXPECT_EQ(swap_.presented(), 4u);
}

/// A node that was started anew has nothing of a held window until the program draws its next frame.
TEST_F(Swap, AHeldGroupGoesOnToTheFirstFrameOfANewNode) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    for (std::uint32_t frame = 1; frame <= 5; ++frame) {
        swap_.rendered(kLeft, frame, at(0));
        swap_.rendered(kRight, frame, at(1));
    }
    swap_.hold(at(2));
    swap_.lose(kRight, at(3));
    swap_.rendered(kLeft, 6, at(4));
    swap_.set_nodes({kLeft, kRight}, at(5));
    EXPECT_EQ(swap_.presented(), 5u);
    EXPECT_THAT(swap_.rendered(kRight, 7, at(6)), ElementsAre(PresentTo{kLeft, 6}));
    EXPECT_THAT(swap_.rendered(kLeft, 7, at(7)), ElementsAre(PresentTo{kLeft, 7}, PresentTo{kRight, 7}));
}

TEST_F(Swap, AMoveChangesTheGroupAtAFrame) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.rendered(kLeft, 1, at(1));
    EXPECT_THAT(swap_.move({kRight}, 3, at(2)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kRight, 3, at(3)), IsEmpty()) << "frame 2 comes first";
    EXPECT_FALSE(swap_.shown(2));
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(4)), ElementsAre(PresentTo{kLeft, 2}, PresentTo{kRight, 3}));
    EXPECT_EQ(swap_.presented(), 3u);
    EXPECT_TRUE(swap_.shown(3));
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(5)), IsEmpty()) << "no longer one of them";
}

TEST_F(Swap, ANodeThatIsLeftShowsItsLastFrameHoweverLate) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.rendered(kLeft, 1, at(1));
    swap_.move({kRight}, 3, at(2));
    swap_.rendered(kRight, 3, at(3));
    EXPECT_EQ(swap_.deadline(), at(253));
    EXPECT_THAT(swap_.tick(at(253)), ElementsAre(PresentTo{kRight, 3}));
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(300)), ElementsAre(PresentTo{kLeft, 2})) << "it waits for that to go on";
}

TEST_F(Swap, ADeadNewPlaceDoesNotHoldTheOthers) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.rendered(kLeft, 1, at(1));
    swap_.move({kLeft, kRight}, 2, at(2));
    EXPECT_THAT(swap_.rendered(kLeft, 2, at(3)), IsEmpty());
    EXPECT_THAT(swap_.lose(kRight, at(4)), ElementsAre(PresentTo{kLeft, 2}));
}

TEST_F(Swap, ThereAndBackAgain) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.rendered(kLeft, 1, at(1));
    swap_.move({kRight}, 2, at(2));
    swap_.move({kLeft}, 3, at(2));
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(3)), IsEmpty());
    EXPECT_THAT(swap_.rendered(kRight, 2, at(4)), ElementsAre(PresentTo{kLeft, 3}, PresentTo{kRight, 2}));
    EXPECT_TRUE(swap_.shown(3));
}

TEST_F(Swap, ANodeThatComesBackIsWaitedForOnBothStays) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    swap_.move({kRight}, 2, at(1));
    swap_.move({kLeft, kRight}, 3, at(1));
    for (std::uint32_t frame = 1; frame <= 3; ++frame) swap_.rendered(kRight, frame, at(2));
    EXPECT_EQ(swap_.presented(), 0u);
    EXPECT_THAT(swap_.rendered(kLeft, 1, at(3)), ElementsAre(PresentTo{kLeft, 1}, PresentTo{kRight, 2}))
        << "frame 2 is not its business";
    EXPECT_THAT(swap_.rendered(kLeft, 3, at(4)), ElementsAre(PresentTo{kLeft, 3}, PresentTo{kRight, 3}));
}

TEST_F(Swap, TwoMovesBeforeOneFrameLeaveNothingBehind) {
    swap_.set_nodes({kLeft}, at(0));
    swap_.move({kRight}, 2, at(1));
    swap_.move({kThird}, 2, at(1));
    swap_.rendered(kLeft, 1, at(2));
    EXPECT_THAT(swap_.rendered(kThird, 2, at(3)), ElementsAre(PresentTo{kThird, 2}));
}

TEST_F(Swap, MeasuresHowFarTheNodesAreApart) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    for (std::uint32_t frame = 1; frame <= 3; ++frame) {
        swap_.rendered(kLeft, frame, at(int(100 * frame)));
        swap_.rendered(kRight, frame, at(int(100 * frame + 10 * frame)));
    }
    EXPECT_EQ(swap_.rendered_spread().frames(), 3u);
    EXPECT_DOUBLE_EQ(swap_.rendered_spread().last().count(), 30);
    EXPECT_DOUBLE_EQ(swap_.rendered_spread().mean().count(), 20);
    EXPECT_DOUBLE_EQ(swap_.rendered_spread().most().count(), 30);
    EXPECT_DOUBLE_EQ(swap_.presented_spread().most().count(), 0) << "told together";
    EXPECT_NEAR(swap_.frame_interval().count(), 110, 1);
    swap_.rendered(kLeft, 4, at(1000));
    swap_.tick(at(1250));
    swap_.rendered(kRight, 4, at(1300));
    EXPECT_DOUBLE_EQ(swap_.rendered_spread().last().count(), 300);
    EXPECT_DOUBLE_EQ(swap_.presented_spread().last().count(), 50) << "the late one";
}

/// Whatever comes in whatever order: a node is never told a frame that it has not rendered, nor an older one.
TEST_F(Swap, NeverPresentsWhatANodeDoesNotHave) {
    std::uint32_t seed = 1;
    const auto random = [&](std::uint32_t below) { return (seed = seed * 1664525u + 1013904223u) / 65536u % below; };
    std::map<NodeIndex, std::uint32_t> rendered, told;
    std::set<NodeIndex> present;
    for (int i = 0; i < 20000; ++i) {
        Presents out;
        const NodeIndex node(random(4));
        switch (random(8)) {
            case 0:
                if (present.erase(node)) rendered.erase(node), told.erase(node);
                else present.insert(node);
                out = swap_.set_nodes(present, at(i));
                break;
            case 1: out = swap_.tick(at(i)); break;
            case 2: out = random(2) ? swap_.hold(at(i)) : swap_.release(at(i)); break;
            case 3: out = swap_.step(1, at(i)); break;
            default:
                if (present.contains(node)) out = swap_.rendered(node, ++rendered[node], at(i));
        }
        for (const auto& [to, frame] : out) {
            ASSERT_LE(frame, rendered[to]);
            ASSERT_GT(frame, std::exchange(told[to], frame));
        }
    }
}

/// Most reports do not look at the other nodes. One that looks at all of them after each event comes to the same.
TEST_F(Swap, AReportLeavesNothingUndone) {
    std::uint32_t seed = 7;
    const auto random = [&](std::uint32_t below) { return (seed = seed * 1664525u + 1013904223u) / 65536u % below; };
    SwapCoordinator quick(milliseconds(20), false), thorough(milliseconds(20), false);
    std::map<NodeIndex, std::uint32_t> rendered;
    std::set<NodeIndex> present;
    std::uint32_t newest = 0;
    bool held = false;
    for (int i = 0; i < 50000; ++i) {
        const NodeIndex node(random(6));
        const auto both = [&](auto&& event) {
            const Presents out = event(quick);
            ASSERT_EQ(out, event(thorough));
            if (held) return;
            ASSERT_THAT(thorough.release(at(i)), IsEmpty());
        };
        switch (random(24)) {
            case 0:
                if (!present.erase(node)) present.insert(node);
                both([&](SwapCoordinator& s) { return s.set_nodes(present, at(i)); });
                break;
            case 1: both([&](SwapCoordinator& s) { return s.tick(at(i)); }); break;
            case 2:
                held = random(4) == 0;
                both([&](SwapCoordinator& s) { return held ? s.hold(at(i)) : s.release(at(i)); });
                break;
            case 3: both([&](SwapCoordinator& s) { return s.step(1, at(i)); }); break;
            case 4:
                if (!present.erase(node)) present.insert(node);
                both([&, from = newest + random(3)](SwapCoordinator& s) { return s.move(present, from, at(i)); });
                break;
            case 5:
                present.erase(node);
                both([&](SwapCoordinator& s) { return s.lose(node, at(i)); });
                break;
            default: {
                std::uint32_t& its = rendered[node];
                its += random(10) == 0 ? 1 + random(3) : 1;
                its = std::max(its, newest > 4 ? newest - 4 : 0);
                newest = std::max(newest, its);
                both([&](SwapCoordinator& s) { return s.rendered(node, its, at(i)); });
            }
        }
        ASSERT_EQ(quick.presented(), thorough.presented()) << "event " << i;
        ASSERT_EQ(quick.deadline(), thorough.deadline()) << "event " << i;
        ASSERT_EQ(quick.rendered_spread().frames(), thorough.rendered_spread().frames()) << "event " << i;
    }
    EXPECT_GT(quick.presented(), 1000u);
    EXPECT_GT(quick.timeouts(), 20u);
}

TEST_F(Swap, AFrameIsMeasuredOnceHoweverLateANodeIs) {
    swap_.set_nodes({kLeft, kRight}, at(0));
    for (std::uint32_t frame = 1; frame <= 20; ++frame) swap_.rendered(kLeft, frame, at(int(frame)));
    for (std::uint32_t frame = 1; frame <= 20; ++frame) swap_.rendered(kRight, frame, at(int(100 + frame)));
    EXPECT_EQ(swap_.rendered_spread().frames(), 20u);
}

TEST(Resume, BeginsWhereTheNodesAre) {
    const Clock::time_point now{};
    SwapCoordinator swap(std::chrono::milliseconds(250), false);
    swap.set_nodes({kLeft, kRight}, now);
    EXPECT_TRUE(swap.resume(kLeft, 7, 7, now).empty());
    EXPECT_EQ(swap.presented(), 7u);
    EXPECT_TRUE(swap.resume(kRight, 8, 7, now).empty());
    EXPECT_EQ(swap.rendered(kLeft, 8, now), (Presents{{kLeft, 8}, {kRight, 8}}));
}

TEST(Resume, KeepsAHeldFrame) {
    const Clock::time_point now{};
    SwapCoordinator swap(std::chrono::milliseconds(250), true);
    swap.set_nodes({kLeft}, now);
    EXPECT_TRUE(swap.resume(kLeft, 8, 7, now).empty());
    EXPECT_EQ(swap.presented(), 7u);
    EXPECT_FALSE(swap.deadline());
    EXPECT_EQ(swap.step(1, now), (Presents{{kLeft, 8}}));
}

/// Its report is all that is heard of that frame; the group goes nowhere while it is held.
TEST(Resume, TellsANodeThatIsBehindToShowWhatItHasDrawn) {
    const Clock::time_point now{};
    SwapCoordinator swap(std::chrono::milliseconds(250), false);
    swap.set_nodes({kLeft, kRight}, now);
    swap.resume(kLeft, 9, 9, now);
    swap.hold(now);
    EXPECT_EQ(swap.resume(kRight, 5, 4, now), (Presents{{kRight, 5}}));
    EXPECT_TRUE(swap.rendered(kRight, 5, now).empty()) << "once";
    EXPECT_EQ(swap.rendered(kRight, 6, now), (Presents{{kRight, 6}})) << "and so on until it shows what all show";
    EXPECT_FALSE(swap.shown(9));
    for (std::uint32_t frame = 7; frame <= 9; ++frame) swap.rendered(kRight, frame, now);
    EXPECT_TRUE(swap.shown(9));
    EXPECT_TRUE(swap.rendered(kRight, 10, now).empty()) << "and no more";
}

TEST(Resume, TakesInWhatANodeHasShownByItself) {
    Clock::time_point now{};
    SwapCoordinator swap(std::chrono::milliseconds(250), false);
    swap.set_nodes({kLeft, kRight}, now);
    swap.rendered(kLeft, 1, now);
    swap.rendered(kRight, 1, now);
    swap.resume(kLeft, 100, 99, now);
    swap.resume(kRight, 102, 101, now);
    EXPECT_EQ(swap.presented(), 101u);
    EXPECT_EQ(swap.rendered(kLeft, 102, now), (Presents{{kLeft, 102}, {kRight, 102}})) << "both are in step again";
}

}  // namespace
}  // namespace wall::walld
