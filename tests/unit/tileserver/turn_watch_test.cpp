// SPDX-License-Identifier: MIT
#include "tileserver/render/turn_watch.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

class TurnWatchTest : public ::testing::Test {
protected:
    /// Looks as often as it wants to, for `time`; how often the turn was found to take too long.
    int look_for(TurnWatch::Clock::duration time) {
        int found = 0;
        for (const auto end = now_ + time; now_ < end;) {
            now_ += watch_.interval();
            found += watch_.overdue(turn_, now_) ? 1 : 0;
        }
        return found;
    }
    void begin(std::uint32_t stream) { turn_ = RunningTurn{StreamId(stream), SessionId(1), now_}; }

    TurnWatch watch_{10s};
    TurnWatch::Clock::time_point now_{1h};
    std::optional<RunningTurn> turn_;
};

TEST_F(TurnWatchTest, ATurnThatTakesTooLongIsFoundOnce) {
    begin(1);
    EXPECT_EQ(look_for(9s), 0);
    EXPECT_EQ(look_for(2s), 1);
    EXPECT_EQ(look_for(60s), 0);
}

TEST_F(TurnWatchTest, ManyShortTurnsAreNotOne) {
    for (int i = 0; i < 30; ++i) {
        begin(1);
        EXPECT_EQ(look_for(5s), 0);
    }
    turn_.reset();
    EXPECT_EQ(look_for(60s), 0);
}

TEST_F(TurnWatchTest, AProcessThatWasStoppedHasNotKeptTheDriver) {
    begin(1);
    EXPECT_EQ(look_for(2s), 0);
    now_ += 60s;  // nobody looks, and nothing runs
    EXPECT_EQ(look_for(2s), 0);
    EXPECT_EQ(look_for(8s), 1) << "what keeps it afterwards is found";
}

}  // namespace
}  // namespace wall::tileserver
