// SPDX-License-Identifier: MIT
#include "tileserver/io/awaited_parcels.h"

#include <gtest/gtest.h>

#include "tileserver/render/batch_queue.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

RawBytes bytes(std::size_t count, int value) { return RawBytes(count, static_cast<std::byte>(value)); }

class AwaitedParcelsTest : public ::testing::Test {
protected:
    std::optional<RawBytes> await(std::uint32_t number, std::uint32_t from = 1) {
        return awaited_.await(number, NodeIndex(from), now_);
    }
    bool takes(std::uint32_t number) { return awaited_.take(number, bytes(10, 1), now_).has_value(); }
    bool has_room(std::uint32_t number, std::size_t waiting = 0, std::uint32_t from = 1) const {
        return awaited_.has_room(number, NodeIndex(from), waiting, kMost);
    }

    static constexpr std::size_t kMost = 1000;
    AwaitedParcels awaited_;
    AwaitedParcels::Clock::time_point now_{1h};
};

TEST_F(AwaitedParcelsTest, AParcelGoesToItsPlaceWhicheverIsThereFirst) {
    EXPECT_FALSE(await(1));
    EXPECT_TRUE(takes(1));
    EXPECT_FALSE(takes(2)) << "it has no place yet";
    EXPECT_TRUE(await(2));
    EXPECT_FALSE(takes(2)) << "it was there already";
}

TEST_F(AwaitedParcelsTest, WhatIsOfAStreamBeforeThisOneIsDropped) {
    EXPECT_FALSE(takes(1));
    EXPECT_FALSE(takes(2));
    EXPECT_FALSE(await(3));
    EXPECT_FALSE(takes(2));
    EXPECT_TRUE(takes(3));
    EXPECT_FALSE(await(1)) << "numbers grow; nothing is left of it";
}

TEST_F(AwaitedParcelsTest, TheFirstThatIsAwaitedAlwaysHasRoom) {
    await(1, 5), await(2, 6);
    EXPECT_TRUE(has_room(1, kMost, 5)) << "behind it nothing goes on";
    EXPECT_TRUE(has_room(9, kMost, 5)) << "it may come behind this one";
    EXPECT_FALSE(has_room(2, kMost, 6));
    EXPECT_TRUE(has_room(2, kMost - 1, 6));
}

TEST_F(AwaitedParcelsTest, OnlySoMuchMayComeBeforeItsPlace) {
    EXPECT_TRUE(has_room(1, kMost)) << "it is not among what waits to be drawn";
    awaited_.take(1, bytes(AwaitedParcels::kMostEarly, 1), now_);
    EXPECT_FALSE(has_room(2));
    EXPECT_TRUE(await(1));
    EXPECT_TRUE(has_room(2));
}

TEST_F(AwaitedParcelsTest, KnowsWhoseParcelsItWaitsFor) {
    await(1, 5);
    const auto gone = [](std::uint32_t node) { return [node](NodeIndex from) { return from == NodeIndex(node); }; };
    EXPECT_TRUE(awaited_.waits_for(gone(5)));
    EXPECT_FALSE(awaited_.waits_for(gone(4)));
    EXPECT_TRUE(takes(1));
    EXPECT_FALSE(awaited_.waits_for(gone(5)));
}

TEST_F(AwaitedParcelsTest, IsOverdueOnlyIfNothingComesForLong) {
    EXPECT_FALSE(awaited_.overdue(now_ + 100h)) << "nothing is awaited";
    await(1);
    EXPECT_FALSE(awaited_.overdue(now_ + AwaitedParcels::kLongestWait));
    EXPECT_TRUE(awaited_.overdue(now_ + AwaitedParcels::kLongestWait + 1ms));
    awaited_.note(now_ + 10s);
    EXPECT_FALSE(awaited_.overdue(now_ + AwaitedParcels::kLongestWait + 10s));
}

TEST_F(AwaitedParcelsTest, AStreamMayNotHavePlacesWithoutEnd) {
    for (std::uint32_t i = 1; i <= AwaitedParcels::kMostPlaces; ++i) await(i);
    EXPECT_FALSE(awaited_.too_many());
    await(AwaitedParcels::kMostPlaces + 1);
    EXPECT_TRUE(awaited_.too_many());
}

TEST(BatchQueue, NothingComesOutBehindAPlaceThatIsEmpty) {
    BatchQueue queue([] {});
    queue.push(bytes(1, 1));
    queue.push_place(7);
    queue.push(bytes(3, 3));
    EXPECT_EQ(queue.pop(), bytes(1, 1));
    EXPECT_EQ(queue.front(), nullptr);
    EXPECT_FALSE(queue.fill(6, bytes(2, 2)));
    EXPECT_EQ(queue.front(), nullptr);
    EXPECT_TRUE(queue.fill(7, bytes(2, 2)));
    EXPECT_EQ(queue.bytes(), 5u);
    ASSERT_NE(queue.front(), nullptr);
    EXPECT_EQ(queue.pop(), bytes(2, 2));
    EXPECT_EQ(queue.pop(), bytes(3, 3));
    EXPECT_EQ(queue.front(), nullptr);
}

}  // namespace
}  // namespace wall::tileserver
