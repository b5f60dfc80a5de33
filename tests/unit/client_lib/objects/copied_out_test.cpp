// SPDX-License-Identifier: MIT
#include "client_lib/objects/copied_out.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

constexpr CopiedOut::Place kWindow{{}, SurfaceId(7), 0, 0};

/// Drawn anew and copied in each of these frames.
bool copy(CopiedOut& copied, std::uint32_t first, unsigned frames, const CopiedOut::Place& to = kWindow) {
    bool habit = false;
    for (std::uint32_t frame = first; frame < first + frames; ++frame) {
        copied.note_redrawn();
        habit = copied.note(frame, to);
    }
    return habit;
}

TEST(ThatAllIsCopiedOut, IsAHabitAfterEightFramesInARow) {
    CopiedOut copied;
    EXPECT_FALSE(copy(copied, 5, CopiedOut::kFrames - 1));
    EXPECT_TRUE(copy(copied, 5 + CopiedOut::kFrames - 1, 1));
    EXPECT_TRUE(copied.note(5 + CopiedOut::kFrames - 1, kWindow)) << "once more in the frame";
}

TEST(ThatAllIsCopiedOut, IsNoneWhereAFrameIsLeftOutOrGoesElsewhereOrIsNotDrawnAnew) {
    CopiedOut skips, moves, stays;
    copy(skips, 0, 7);
    EXPECT_FALSE(copy(skips, 8, 1));
    copy(moves, 0, 7);
    EXPECT_FALSE(copy(moves, 7, 1, {{}, SurfaceId(7), 1, 0}));
    copy(stays, 0, 7);
    EXPECT_FALSE(stays.note(7, kWindow));
    EXPECT_FALSE(copy(stays, 8, 7));
    EXPECT_TRUE(copy(stays, 15, 1));
}

TEST(ThatAllIsCopiedOut, GoesOnWhereItWouldBeNoted) {
    CopiedOut copied;
    copy(copied, 0, 8);
    EXPECT_TRUE(copied.goes_on(7, kWindow));
    EXPECT_FALSE(copied.goes_on(8, kWindow)) << "it was not drawn anew";
    copied.note_redrawn();
    EXPECT_TRUE(copied.goes_on(8, kWindow));
    EXPECT_FALSE(copied.goes_on(8, {ClientName(7), {}, 0, 0}));
    EXPECT_FALSE(copied.goes_on(9, kWindow));
}

TEST(ThatAllIsCopiedOut, TakesLongerEachTimeItWasBroken) {
    CopiedOut copied;
    EXPECT_TRUE(copy(copied, 0, 8));
    copied.note_broken();
    EXPECT_FALSE(copy(copied, 8, 63));
    EXPECT_TRUE(copy(copied, 71, 1));
    for (int i = 0; i < 10; ++i) copied.note_broken();
    EXPECT_FALSE(copy(copied, 72, CopiedOut::kMostFrames - 1));
    EXPECT_TRUE(copy(copied, 71 + CopiedOut::kMostFrames, 1)) << "but never is given up";
}

}  // namespace
}  // namespace wall::client
