// SPDX-License-Identifier: MIT
#include "tileserver/render/frame_limit.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

class AFrameLimit : public ::testing::Test {
protected:
    /// Frames of `windows` in turn for `time`, each as soon as the stream may go on and `takes` later. Gives how many.
    unsigned frames(FrameLimit::Clock::duration time, FrameLimit::Clock::duration takes, unsigned windows = 1) {
        unsigned out = 0;
        for (const auto end = now_ + time; now_ < end; ++out) {
            now_ = std::max(now_, limit_.pause_until()) + takes;
            limit_.frame(SurfaceId(1 + out % windows), now_);
        }
        return out;
    }
    FrameLimit limit_;
    FrameLimit::Clock::time_point now_{1h};
};

TEST_F(AFrameLimit, LetsAsManyThroughAsASecondMayHave) {
    limit_.set_interval(20ms);
    EXPECT_NEAR(frames(10s, 1ms), 500, 2);
}

TEST_F(AFrameLimit, IsOfEachWindow) {
    limit_.set_interval(20ms);
    EXPECT_NEAR(frames(10s, 1ms, 3), 3 * 500, 4);
}

TEST_F(AFrameLimit, HoldsNobodyWhoIsSlower) {
    limit_.set_interval(20ms);
    EXPECT_EQ(frames(10s, 50ms), 200u);
    EXPECT_LE(limit_.pause_until(), now_);
}

TEST_F(AFrameLimit, IsNoneWithoutAnInterval) { EXPECT_EQ(frames(1s, 1ms), 1000u); }

TEST_F(AFrameLimit, DoesNotMakeUpForAPause) {
    limit_.set_interval(20ms);
    frames(1s, 1ms);
    now_ += 1h;
    EXPECT_NEAR(frames(1s, 1ms), 50, 2);
}

TEST_F(AFrameLimit, IsGoneAtOnce) {
    limit_.set_interval(1h);
    for (int i = 0; i < 2; ++i) limit_.frame(SurfaceId(1), now_);
    EXPECT_GT(limit_.pause_until(), now_ + 30min);
    limit_.set_interval({});
    EXPECT_EQ(frames(1s, 1ms), 1000u);
}

TEST_F(AFrameLimit, KeepsNoMoreWindowsInMindThanItNeeds) {
    limit_.set_interval(1ms);
    for (std::uint32_t window = 1; window < 100'000; ++window) limit_.frame(SurfaceId(window), now_ += 1ms);
    EXPECT_NEAR(frames(1s, 100us), 1000, 10);
}

}  // namespace
}  // namespace wall::tileserver
