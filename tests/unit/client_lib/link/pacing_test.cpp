// SPDX-License-Identifier: MIT
// Which nodes get the next frame.
#include "client_lib/link/pacing.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

constexpr NodeProgress kLate{.done = false, .left_out = false, .queued_bytes = 1000};
constexpr NodeProgress kLateAndFull{.done = false, .left_out = false, .queued_bytes = kMaxLateBytes + 1};
constexpr NodeProgress kLeftOut{.done = false, .left_out = true, .queued_bytes = 0};
constexpr NodeProgress kBack{.done = true, .left_out = true, .queued_bytes = 0};

TEST(Pacing, OneThatIsInTimeGetsTheFrame) {
    EXPECT_FALSE(leave_out({.done = true}, true, true));
    EXPECT_FALSE(leave_out({.done = true, .queued_bytes = kMaxLateBytes + 1}, true, true))
        << "a long queue is no sin of one that draws";
}

TEST(Pacing, OneThatIsLateAloneMissesWholeFrames) {
    EXPECT_TRUE(leave_out(kLate, true, true));
    EXPECT_FALSE(leave_out(kLate, false, true)) << "all are late: held, or slow alike";
}

TEST(Pacing, FramesThatBuildOnEachOtherAreKeptWhileThereIsRoom) {
    EXPECT_FALSE(leave_out(kLate, true, false));
    EXPECT_TRUE(leave_out(kLateAndFull, true, false));
    EXPECT_TRUE(leave_out(kLateAndFull, false, false));
}

TEST(Pacing, OneLeftOutIsBackWhenItHasDrawnWhatItGot) {
    EXPECT_TRUE(leave_out(kLeftOut, true, false));
    EXPECT_TRUE(leave_out(kLeftOut, false, true));
    EXPECT_FALSE(leave_out(kBack, true, true));
}

}  // namespace
}  // namespace wall::client
