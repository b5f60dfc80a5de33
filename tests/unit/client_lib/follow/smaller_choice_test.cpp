// SPDX-License-Identifier: MIT
#include "client_lib/follow/smaller_choice.h"

#include <gtest/gtest.h>

#include <deque>

namespace wall::client {
namespace {

/// A program whose frames are sent some frames after they were packed.
class ASmallerChoice : public testing::Test {
protected:
    /// Returns in how many of the frames vertices were moved. `exact`, `moved`: packed bytes for each that is sent.
    int run(int frames, double exact, double moved, std::uint64_t frame_bytes = 200'000) {
        int count = 0;
        for (int i = 0; i < frames; ++i) {
            const bool moves = choice_.moves();
            count += moves;
            packed_ += frame_bytes;
            queue_.push_back(static_cast<std::uint64_t>(static_cast<double>(frame_bytes) / (moves ? moved : exact)));
            if (queue_.size() > 3) {
                sent_ += queue_.front();
                queue_.pop_front();
            }
            choice_.note_frame(packed_, sent_);
        }
        return count;
    }
    SmallerChoice choice_;
    std::deque<std::uint64_t> queue_;
    std::uint64_t packed_ = 0, sent_ = 0;
};

TEST_F(ASmallerChoice, MovesWhatBecomesSmaller) {
    run(300, 5.6, 7.1);
    EXPECT_GT(run(5000, 5.6, 7.1), 4600);
}

TEST_F(ASmallerChoice, LeavesWhatBecomesLarger) {
    run(300, 7.9, 7.5);
    EXPECT_LT(run(5000, 7.9, 7.5), 500);
}

TEST_F(ASmallerChoice, LeavesWhatStaysAsItIs) { EXPECT_LT(run(5000, 66, 66.5), 1000); }

TEST_F(ASmallerChoice, SeesItAlsoInLargeFrames) {
    run(60, 5.6, 7.1, 5'000'000);
    EXPECT_GT(run(1000, 5.6, 7.1, 5'000'000), 900);
}

TEST_F(ASmallerChoice, SeesThatTheProgramHasChanged) {
    run(300, 5.6, 7.1);
    run(3000, 7.9, 7.5);
    EXPECT_LT(run(2000, 7.9, 7.5), 300);
    run(3000, 5.6, 7.1);
    EXPECT_GT(run(2000, 5.6, 7.1), 1700);
}

}  // namespace
}  // namespace wall::client
