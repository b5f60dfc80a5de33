// SPDX-License-Identifier: MIT
// Which nodes get the next frame.
#include "client_lib/link/pacing.h"

#include <gtest/gtest.h>

#include <array>

namespace wall::client {
namespace {

constexpr std::uint32_t kFrame = 70;
constexpr NodeProgress kLate{.frame = kFrame, .done = false, .left_out = false, .queued_bytes = 1000};
constexpr NodeProgress kLateAndFull{
    .frame = kFrame, .done = false, .left_out = false, .queued_bytes = kMaxLateBytes + 1};
constexpr NodeProgress kLeftOut{.frame = kFrame, .done = false, .left_out = true, .queued_bytes = 0};
constexpr NodeProgress kInTime{.frame = kFrame, .done = true};
constexpr NodeProgress kBack{.frame = kFrame - 50, .done = true, .left_out = true, .queued_bytes = 0};

bool left_out_beside(const NodeProgress& node, const NodeProgress& other, bool whole_frames) {
    return leave_out(node, newest_done(std::array{other, node}), whole_frames);
}

TEST(Pacing, OneThatIsInTimeGetsTheFrame) {
    EXPECT_FALSE(left_out_beside(kInTime, kInTime, true));
    EXPECT_FALSE(left_out_beside({.frame = kFrame, .done = true, .queued_bytes = kMaxLateBytes + 1}, kInTime, true))
        << "a long queue is no sin of one that draws";
}

TEST(Pacing, OneThatIsLateAloneMissesWholeFrames) {
    EXPECT_TRUE(left_out_beside(kLate, kInTime, true));
    EXPECT_FALSE(left_out_beside(kLate, kLate, true)) << "all are late: held, or slow alike";
}

// The wall is held, and a node that stood still has just drawn the old frame that it was left out with. If the others
// were left out for that, each would get frames that no other has, and wait for those in vain.
TEST(Pacing, OneThatComesBackDoesNotMakeTheOthersLate) {
    EXPECT_FALSE(left_out_beside(kLate, kBack, true));
    EXPECT_FALSE(left_out_beside(kBack, kLate, true)) << "it gets what the others get next";
}

TEST(Pacing, FramesThatBuildOnEachOtherAreKeptWhileThereIsRoom) {
    EXPECT_FALSE(left_out_beside(kLate, kInTime, false));
    EXPECT_TRUE(left_out_beside(kLateAndFull, kInTime, false));
    EXPECT_TRUE(left_out_beside(kLateAndFull, kLate, false));
}

TEST(Pacing, OneLeftOutIsBackWhenItHasDrawnWhatItGot) {
    EXPECT_TRUE(left_out_beside(kLeftOut, kInTime, false));
    EXPECT_TRUE(left_out_beside(kLeftOut, kLate, true));
    EXPECT_FALSE(left_out_beside(kBack, kInTime, true));
}

}  // namespace
}  // namespace wall::client
