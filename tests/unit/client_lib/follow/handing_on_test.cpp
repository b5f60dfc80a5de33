// SPDX-License-Identifier: MIT
#include "client_lib/follow/handing_on.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

using namespace std::chrono_literals;

struct FakeStream {
    bool over = false;
    bool failed() const { return over; }
};
using Handing = HandingOn<FakeStream>;

class HandingOnTest : public ::testing::Test {
protected:
    std::uint32_t begin(std::initializer_list<std::uint32_t> nodes) {
        std::vector<Handing::Stop> route;
        for (const std::uint32_t node : nodes) route.push_back({NodeIndex(node), streams_.at(node)});
        return handing_.begin(std::move(route));
    }
    Handing::Streams of(std::initializer_list<std::uint32_t> nodes) const {
        Handing::Streams out;
        for (const std::uint32_t node : nodes) out.push_back(streams_.at(node));
        return out;
    }

    Handing handing_{true};
    Handing::Clock::time_point now_{1h};
    std::vector<std::shared_ptr<FakeStream>> streams_{std::make_shared<FakeStream>(), std::make_shared<FakeStream>(),
                                                      std::make_shared<FakeStream>(), std::make_shared<FakeStream>()};
};

TEST_F(HandingOnTest, NobodyHandsOnWhereItIsNotWanted) {
    EXPECT_TRUE(handing_.open(now_));
    EXPECT_FALSE(Handing(false).open(now_));
}

TEST_F(HandingOnTest, ThoseBehindALostOneDoNotGetWhatWasOnItsWay) {
    const auto first = begin({0, 1, 2, 3});
    const auto second = begin({1, 3});
    EXPECT_NE(first, second);
    EXPECT_EQ(handing_.lost(streams_[1]), of({2, 3}));
    EXPECT_EQ(handing_.lost(streams_[1]), of({})) << "these were the only ones";
    EXPECT_TRUE(handing_.open(now_)) << "that says nothing of links between nodes";
}

TEST_F(HandingOnTest, WhatAllHaveGotIsNotLost) {
    const auto number = begin({0, 1, 2});
    begin({0, 3});
    handing_.handed_on(number);
    EXPECT_EQ(handing_.lost(streams_[0]), of({3}));
}

TEST_F(HandingOnTest, TheLastOneLosesForNobodyElse) {
    begin({0, 1});
    EXPECT_EQ(handing_.lost(streams_[1]), of({}));
}

TEST_F(HandingOnTest, ANodeThatCannotBeReachedIsTriedAgainLaterAndLater) {
    for (auto pause = Handing::kPause; pause < 2 * Handing::kLongestPause; pause *= 2) {
        begin({0, 1, 2});
        EXPECT_EQ(handing_.not_handed_on(NodeIndex(0), NodeIndex(1), now_), of({1, 2}));
        EXPECT_EQ(handing_.not_handed_on(NodeIndex(0), NodeIndex(1), now_), of({})) << "once";
        const auto again = std::min(pause, Handing::kLongestPause);
        EXPECT_FALSE(handing_.open(now_ + again - 1ms));
        now_ += again;
        EXPECT_TRUE(handing_.open(now_));
    }
}

TEST_F(HandingOnTest, StreamsThatAreOverAreLeftAlone) {
    begin({0, 1, 2, 3});
    streams_[1]->over = true;
    streams_[2].reset();
    EXPECT_EQ(handing_.not_handed_on(NodeIndex(0), NodeIndex(1), now_), of({3}));
}

TEST_F(HandingOnTest, OnlyWhatWentThatWayWasNotHandedOn) {
    begin({0, 1, 2}), begin({0, 3}), begin({1, 3}), begin({0, 1});
    EXPECT_EQ(handing_.not_handed_on(NodeIndex(1), NodeIndex(0), now_), of({})) << "nothing goes there";
    EXPECT_EQ(handing_.not_handed_on(NodeIndex(0), NodeIndex(2), now_), of({})) << "it gets that from another one";
    EXPECT_TRUE(handing_.open(now_));
    EXPECT_EQ(handing_.not_handed_on(NodeIndex(0), NodeIndex(1), now_), of({1, 2}));
    EXPECT_EQ(handing_.lost(streams_[1]), of({3})) << "that went another way";
}

TEST_F(HandingOnTest, RemembersSoManyParcels) {
    begin({0, 1});
    for (std::size_t i = 0; i < Handing::kMostRemembered; ++i) begin({2, 3});
    EXPECT_EQ(handing_.not_handed_on(NodeIndex(0), NodeIndex(1), now_), of({}));
}

}  // namespace
}  // namespace wall::client
