// SPDX-License-Identifier: MIT
// What is particular to the choice itself; coding_choice_test and dealer_test have it in use.
#include "client_lib/process/measured_choice.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

using namespace std::chrono_literals;

class MeasuredChoiceTest : public testing::Test {
protected:
    /// So many frames a second, by the usual way and by the other one. Returns for how long the other one was used.
    std::chrono::milliseconds run(std::chrono::milliseconds time, double usual, double other) {
        std::chrono::milliseconds by_other{};
        for (const auto end = now_ + time; now_ < end;) {
            const bool way = choice_.other();
            const auto frame = std::chrono::milliseconds(static_cast<int>(1000 / (way ? other : usual)));
            now_ += frame;
            if (way) by_other += frame;
            choice_.done(
                1, way, now_, [&](double) { return seen_; }, [&] { ++whiles_; });
        }
        return by_other;
    }
    MeasuredChoice choice_{{.better = 1.1, .least = 8}};
    MeasuredChoice::Time now_{1h};
    MeasuredChoice::Seen seen_{.usual_in_doubt = true, .other_in_doubt = true};
    int whiles_ = 0;
};

TEST_F(MeasuredChoiceTest, TakesTheBetterWayAndKeepsIt) {
    run(10s, 20, 40);
    EXPECT_TRUE(choice_.other());
    EXPECT_GT(run(300s, 20, 40), 285s) << "looks now and then whether it still is";
    EXPECT_TRUE(choice_.other());
}

TEST_F(MeasuredChoiceTest, TriesWhatDoesNotPayEverMoreRarely) {
    EXPECT_LT(run(600s, 20, 20), 10s);
    EXPECT_LT(run(3000s, 20, 20), 12s);
}

TEST_F(MeasuredChoiceTest, WithoutADoubtNothingIsTried) {
    seen_ = {};
    EXPECT_EQ(run(60s, 20, 40), 0s);
}

TEST_F(MeasuredChoiceTest, JudgesByNoFewFrames) {
    EXPECT_EQ(run(2s, 2, 40), 0s) << "four frames";
    EXPECT_GT(run(20s, 2, 40), 10s);
}

TEST_F(MeasuredChoiceTest, LeavesWhatNoLongerPays) {
    run(10s, 20, 40);
    ASSERT_TRUE(choice_.other());
    run(60s, 40, 20);
    EXPECT_FALSE(choice_.other());
    EXPECT_LT(run(300s, 40, 20), 10s);
}

TEST_F(MeasuredChoiceTest, SaysWhereEachWhileBegins) {
    seen_ = {};
    run(10s, 20, 40);
    EXPECT_GE(whiles_, 18);
    EXPECT_LE(whiles_, 21);
}

}  // namespace
}  // namespace wall::client
