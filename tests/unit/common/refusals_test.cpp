// SPDX-License-Identifier: MIT
#include "common/log/refusals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::log {
namespace {

using ::testing::EndsWith;

class TheRefusals : public ::testing::Test {
protected:
    /// How many lines as many refusals make.
    unsigned lines(unsigned refusals, const std::string& from = "10.0.0.7") {
        unsigned out = 0;
        for (unsigned i = 0; i < refusals; ++i) out += refusals_.line("data", from, "no", now_) ? 1 : 0;
        return out;
    }
    Refusals refusals_;
    Refusals::Clock::time_point now_{};
};

TEST_F(TheRefusals, AreALineEach) {
    EXPECT_EQ(refusals_.line("control", "10.0.0.7", "no \"key\"\n", now_),
              R"(refused at=control from="10.0.0.7" reason="no \"key\"\n")");
}

TEST_F(TheRefusals, OfAFloodAreAFewLinesThatSayHowManyThereWere) {
    EXPECT_EQ(lines(10'000), Refusals::kAtOnce);
    EXPECT_EQ(lines(3, "10.0.0.8"), 3u) << "somebody else's are said";
    now_ += Refusals::kThenEach;
    const auto next = refusals_.line("data", "10.0.0.7", "no", now_);
    ASSERT_TRUE(next);
    EXPECT_THAT(*next, EndsWith(" unsaid=" + std::to_string(10'000 - Refusals::kAtOnce)));
    EXPECT_EQ(lines(10), 0u);
    now_ += Refusals::kThenEach * 2;
    EXPECT_EQ(lines(10), 2u);
    now_ += std::chrono::hours(1);
    EXPECT_EQ(lines(10'000), Refusals::kAtOnce) << "in the end it is as at first";
}

TEST_F(TheRefusals, OfManyPeersTakeNoMoreRoomThanSoMuch) {
    unsigned said = 0;
    for (std::size_t i = 0; i < 10 * Refusals::kMostPeers; ++i) said += lines(1, "peer " + std::to_string(i));
    EXPECT_EQ(said, Refusals::kMostPeers + Refusals::kAtOnce) << "the others share what is said";
    EXPECT_EQ(lines(5, "peer 0"), 5u) << "those that were there are told apart still";
    now_ += Refusals::kThenEach * (Refusals::kAtOnce + 1);
    EXPECT_EQ(lines(5, "somebody new"), 5u);
}

}  // namespace
}  // namespace wall::log
