// SPDX-License-Identifier: MIT
#include "client_lib/link/member_placements.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

Placement version(std::uint32_t number, std::uint32_t from_frame) {
    Placement out;
    out.layout_version = number;
    out.from_frame = from_frame;
    return out;
}

TEST(MemberPlacements, AFrameIsNotBegunBeforeItsPlaceIsAgreed) {
    MemberPlacements placements;
    EXPECT_TRUE(placements.add(version(1, 0)));
    EXPECT_TRUE(placements.known(1));
    EXPECT_EQ(placements.propose(version(2, 15)), 0u);
    EXPECT_TRUE(placements.known(14));
    EXPECT_FALSE(placements.known(15));
    const auto agreed = placements.agree(2);
    ASSERT_TRUE(agreed);
    EXPECT_EQ(agreed->from_frame, 15u);
    EXPECT_TRUE(placements.known(15));
    EXPECT_FALSE(placements.agree(2)) << "once";
}

TEST(MemberPlacements, WhatComesTooLateIsSaid) {
    MemberPlacements placements;
    placements.add(version(1, 0));
    placements.begin(15);
    EXPECT_EQ(placements.propose(version(2, 15)), 15u);
    EXPECT_TRUE(placements.known(16));
    EXPECT_FALSE(placements.agree(2));
    EXPECT_EQ(placements.propose(version(3, 16)), 0u);
}

TEST(MemberPlacements, AProposalTakesThePlaceOfTheOneBefore) {
    MemberPlacements placements;
    placements.add(version(1, 0));
    placements.propose(version(2, 15));
    placements.propose(version(3, 20));
    EXPECT_TRUE(placements.known(19));
    EXPECT_FALSE(placements.agree(2));
    EXPECT_TRUE(placements.agree(3));
}

TEST(MemberPlacements, AnotherWalldSaysWhatIsAgreed) {
    MemberPlacements placements;
    placements.add(version(1, 0));
    placements.propose(version(2, 15));  // another member was told that it holds
    EXPECT_FALSE(placements.add(version(1, 0))) << "it is known";
    EXPECT_FALSE(placements.known(15));
    EXPECT_TRUE(placements.add(version(2, 15)));
    EXPECT_TRUE(placements.known(15));
}

TEST(MemberPlacements, KeepsWhatHoldsAndWhatWill) {
    MemberPlacements placements;
    for (const auto& each : {version(1, 0), version(2, 10), version(3, 20), version(4, 20)}) placements.add(each);
    ASSERT_EQ(placements.agreed().size(), 3u) << "the third never holds";
    placements.begin(9);
    EXPECT_EQ(placements.agreed().front().layout_version, 1u);
    placements.begin(20);
    ASSERT_EQ(placements.agreed().size(), 1u);
    EXPECT_EQ(placements.agreed().front().layout_version, 4u);
}

}  // namespace
}  // namespace wall::client
