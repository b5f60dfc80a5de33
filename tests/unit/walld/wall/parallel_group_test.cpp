// SPDX-License-Identifier: MIT
#include "walld/wall/parallel_group.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

proto::Group member(std::uint32_t rank, std::uint32_t members, const std::string& name = "g") {
    proto::Group out;
    out.set_name(name);
    out.set_rank(rank);
    out.set_members(members);
    return out;
}

proto::Placement version(std::uint32_t number, std::uint32_t from_frame) {
    proto::Placement out;
    out.set_layout_version(number);
    out.set_from_frame(from_frame);
    return out;
}

TEST(ParallelGroup, TakesEachRankOnce) {
    ParallelGroup group("g", 3);
    group.joins(1, 100);
    EXPECT_TRUE(group.admits(member(0, 3), false));
    EXPECT_THAT(group.admits(member(1, 3), false).error().message,
                HasSubstr("rank 1 (process 100) of parallel program 'g' is here already"));
    EXPECT_THAT(group.admits(member(0, 2), false).error().message, HasSubstr("has 3 processes, not 2"));
    EXPECT_TRUE(group.leaves(1));
    EXPECT_FALSE(group.leaves(1));
    EXPECT_THAT(group.admits(member(1, 3), false).error().message, HasSubstr("has ended already"));
    for (const auto& wrong :
         {member(0, 0), member(3, 3), member(0, 65), member(0, 1, ""), member(0, 1, std::string(300, 'x'))})
        EXPECT_FALSE(ParallelGroup::check(wrong));
}

TEST(ParallelGroup, EndsWhenAllHaveLeft) {
    ParallelGroup group("g", 2);
    group.joins(0, 1);
    group.leaves(0);
    EXPECT_FALSE(group.all_left()) << "one has not come yet";
    group.joins(1, 2);
    EXPECT_TRUE(group.all_came());
    group.leaves(1);
    EXPECT_TRUE(group.all_left());
}

class Agreed : public ::testing::Test {
protected:
    void SetUp() override {
        for (const Rank rank : {0u, 1u}) {
            group_.joins(rank, 100 + rank);
            placements_.opened(rank);
        }
        placements_.add(version(1, 0));
    }
    ParallelGroup group_{"g", 2};
    AgreedPlacements placements_;
};

TEST_F(Agreed, WhatAllKnowIsAgreed) {
    EXPECT_FALSE(placements_.settle(group_)) << "the first one holds from the start";
    placements_.propose(version(2, 15));
    placements_.noted(1, 2);
    EXPECT_FALSE(placements_.settle(group_));
    EXPECT_EQ(placements_.versions().size(), 1u);
    placements_.noted(0, 2);
    const auto agreed = placements_.settle(group_);
    ASSERT_TRUE(agreed);
    EXPECT_EQ(agreed->layout_version(), 2u);
    EXPECT_TRUE(placements_.versions().at(2).agreed());
    EXPECT_FALSE(placements_.settle(group_)) << "once";
}

TEST_F(Agreed, WhoHasLeftOrClosedTheWindowNeedNotKnow) {
    placements_.propose(version(2, 15));
    placements_.noted(0, 2);
    placements_.closed(1);
    EXPECT_TRUE(placements_.settle(group_));
    placements_.propose(version(3, 20));
    EXPECT_FALSE(placements_.settle(group_));
    group_.leaves(0);
    EXPECT_TRUE(placements_.settle(group_));
    placements_.propose(version(4, 25));
    placements_.opened(1);
    EXPECT_FALSE(placements_.settle(group_)) << "it has it again";
}

TEST_F(Agreed, WhatIsReceivedBeforeTheWindowIsOpenDoesNotCount) {
    AgreedPlacements late;
    late.opened(0);
    late.add(version(1, 0));
    late.propose(version(2, 5));
    late.noted(0, 2);
    late.noted(1, 2);
    EXPECT_FALSE(late.settle(group_));
    late.opened(1);
    late.noted(1, 2);
    EXPECT_TRUE(late.settle(group_));
}

TEST_F(Agreed, AProposalThatIsTooLateIsReplaced) {
    placements_.propose(version(2, 15));
    placements_.noted(0, 2);
    EXPECT_TRUE(placements_.too_late(2, 17));
    EXPECT_EQ(placements_.begun(), 17u);
    placements_.propose(version(3, 22));
    EXPECT_FALSE(placements_.too_late(2, 16)) << "that one is no more";
    EXPECT_EQ(placements_.begun(), 17u);
    placements_.noted(1, 2);
    EXPECT_FALSE(placements_.settle(group_));
    for (const Rank rank : {0u, 1u}) placements_.noted(rank, 3);
    EXPECT_EQ(placements_.settle(group_)->from_frame(), 22u);
}

TEST_F(Agreed, VersionsArePastWhenTheNextOneHolds) {
    placements_.add(version(2, 15));
    placements_.add(version(3, 16));
    placements_.presented(14);
    EXPECT_EQ(placements_.versions().size(), 3u);
    placements_.presented(15);
    EXPECT_EQ(placements_.versions().begin()->first, 2u);
    placements_.add(version(4, 16));
    EXPECT_FALSE(placements_.versions().contains(3)) << "it never holds";
    placements_.presented(16);
    ASSERT_EQ(placements_.versions().size(), 1u);
    EXPECT_EQ(placements_.versions().begin()->first, 4u);
}

TEST(ParallelGroup, HasReturnedWithAllWindowsOfAllProcesses) {
    ParallelGroup group("g", 3);
    group.had_left(2);
    group.joins(0, 1, 2);
    group.announced(0);
    group.joins(1, 2, 0);
    EXPECT_TRUE(group.all_came());
    EXPECT_FALSE(group.all_returned());
    group.announced(0);
    EXPECT_TRUE(group.all_returned());
    EXPECT_EQ(group.left(), std::set<Rank>{2});
}

}  // namespace
}  // namespace wall::walld
