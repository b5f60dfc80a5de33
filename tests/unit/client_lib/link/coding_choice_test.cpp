// SPDX-License-Identifier: MIT
#include "client_lib/link/coding_choice.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

using namespace std::chrono_literals;

constexpr double kRatio = 8;  // of what is packed to what is coded

/// A program that packs as much as goes out, over a link or to a node that takes so much a second.
class Coded : public ::testing::Test {
protected:
    /// Megabytes a second: of the link, of what the node draws, of the coder.
    struct Rates {
        double link = 1e6, node = 1e6, coder = 500;
    };
    /// Returns the megabytes that the node has got.
    double run(std::chrono::milliseconds time, const Rates& rates) {
        double got = 0;
        for (const auto end = now_ + time; now_ < end; now_ += kStep) {
            const bool coded = choice_.codes();
            const double through = coded ? std::min(rates.link * kRatio, rates.coder) : rates.link;
            const double rate = std::min({through, rates.node, packed_});
            if (rate < packed_) waited_ += kStep;
            const double seconds = std::chrono::duration<double>(kStep).count();
            if (coded)
                choice_.coding_took(std::chrono::duration_cast<CodingChoice::Clock::duration>(
                    std::chrono::duration<double>(rate / rates.coder * seconds)));
            choice_.delivered(static_cast<std::size_t>(rate * seconds * 1e6), coded, now_, waited_);
            got += rate * seconds;
        }
        return got;
    }
    static constexpr auto kStep = 10ms;
    double packed_ = 2000;  // by the program, at most
    CodingChoice::Time now_{1h};
    CodingChoice::Clock::duration waited_{};
    CodingChoice choice_{Coding::measured};
};

TEST_F(Coded, WhatASlowLinkHoldsUp) {
    run(3s, {.link = 12});
    EXPECT_TRUE(choice_.codes());
    EXPECT_GT(run(60s, {.link = 12}), 0.95 * 60 * 12 * kRatio) << "and it stays so";
}

TEST_F(Coded, NotWhatAProgramSendsAnyway) {
    packed_ = 5;
    run(60s, {.link = 12});
    EXPECT_FALSE(choice_.codes());
}

/// It looks as if the link was slow, until coding does not help.
TEST_F(Coded, NotWhatTheNodeHoldsUp) {
    unsigned coded = 0;
    for (int i = 0; i < 6000; ++i) {
        run(100ms, {.node = 50});
        coded += choice_.codes();
    }
    EXPECT_FALSE(choice_.codes());
    EXPECT_GT(coded, 0u) << "it was tried";
    EXPECT_LT(coded, 60u) << "and ever more rarely: one in a hundred in ten minutes";
}

TEST_F(Coded, UntilTheLinkIsFasterThanTheCoder) {
    run(3s, {.link = 12});
    ASSERT_TRUE(choice_.codes());
    run(30s, {.link = 1000, .coder = 300});
    EXPECT_FALSE(choice_.codes());
    run(600s, {.link = 1000, .coder = 300});
    EXPECT_FALSE(choice_.codes());
}

TEST_F(Coded, AgainWhenTheLinkHasBecomeSlow) {
    run(60s, {.link = 1e6});
    EXPECT_FALSE(choice_.codes());
    run(3s, {.link = 12});
    EXPECT_TRUE(choice_.codes());
}

TEST_F(Coded, AtOnceWhereItDidNotPayBefore) {
    run(2s, {.node = 50});
    ASSERT_FALSE(choice_.codes()) << "the node is what is slow";
    run(1500ms, {.link = 12, .node = 50});
    EXPECT_TRUE(choice_.codes());
}

/// What was on its way when coding began came as it was sent before.
TEST_F(Coded, IsJudgedByWhatWasCoded) {
    run(600ms, {.link = 12});
    ASSERT_TRUE(choice_.codes());
    for (int i = 0; i < 300; ++i) choice_.delivered(10, false, now_ += kStep, waited_);
    EXPECT_TRUE(choice_.codes());
}

TEST_F(Coded, AlwaysOrNever) {
    CodingChoice never(Coding::never), always(Coding::always);
    EXPECT_FALSE(never.codes());
    EXPECT_TRUE(always.codes());
    always.delivered(1, true, now_, 0s);
    always.delivered(1, true, now_ + 1h, 1h);
    EXPECT_TRUE(always.codes());
}

}  // namespace
}  // namespace wall::client
