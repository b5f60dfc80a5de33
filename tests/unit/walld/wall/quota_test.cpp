// SPDX-License-Identifier: MIT
#include "walld/wall/quota.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

constexpr QuotaLimits kLimits{"chairs", 2, 3};

TEST(Quota, OnePeerCannotTakeWhatOthersNeed) {
    Quota quota(kLimits);
    const auto first = quota.take("alice"), second = quota.take("alice");
    ASSERT_TRUE(first && second);
    const auto third = quota.take("alice");
    ASSERT_FALSE(third);
    EXPECT_EQ(third.error().kind, RefusalKind::busy);
    EXPECT_THAT(third.error().message, HasSubstr("alice has 2 chairs"));
    EXPECT_TRUE(quota.take("bob"));
}

TEST(Quota, WhatIsAllowedOfOneMayBeLess) {
    Quota quota(kLimits);
    const auto first = quota.take("alice", {1, "person_chairs"});
    ASSERT_TRUE(first);
    EXPECT_THAT(quota.take("alice", {1, "person_chairs"}).error().message,
                HasSubstr("alice has 1 chairs, as many as a person may have ('person_chairs' in [quota]"));
    EXPECT_TRUE(quota.take("bob", {1, "person_chairs"}));
    const auto second = quota.take("alice", {7, "person_chairs"});
    EXPECT_TRUE(second) << "the wall was described anew";
    EXPECT_FALSE(quota.take("alice", {7, "person_chairs"})) << "there are no more";
}

TEST(Quota, AllTogetherHaveALimit) {
    Quota quota(kLimits);
    std::vector<Quota::Place> places;
    for (const char* who : {"a", "b", "c"}) places.push_back(std::move(*quota.take(who)));
    EXPECT_THAT(quota.take("d").error().message, HasSubstr("there are 3 chairs"));
    places.pop_back();
    EXPECT_TRUE(quota.take("d"));
}

TEST(Quota, APlaceIsGivenBackOnce) {
    Quota quota(kLimits);
    {
        auto place = std::move(*quota.take("alice"));
        auto moved = std::move(place);
        EXPECT_EQ(quota.in_all(), 1u);
        place.leave();
        EXPECT_EQ(quota.in_all(), 1u) << "it was moved from";
        moved.leave();
        moved.leave();
        EXPECT_EQ(quota.in_all(), 0u);
        moved = std::move(*quota.take("bob"));
        EXPECT_EQ(quota.in_all(), 1u);
    }
    EXPECT_EQ(quota.in_all(), 0u);
    EXPECT_FALSE(quota.take("alice") && !quota.take("alice")) << "nothing is left of those who went";
}

TEST(Quota, APlaceMayOutliveIt) {
    std::optional<Quota> quota(kLimits);
    auto place = std::move(*quota->take("alice"));
    quota.reset();
    place.leave();
}

}  // namespace
}  // namespace wall::walld
