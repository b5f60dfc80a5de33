// SPDX-License-Identifier: MIT
#include "tileserver/session/group_sync.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace wall::tileserver {
namespace {

using ::testing::HasSubstr;

class Group : public ::testing::Test {
protected:
    void join_all(GroupSync& group) {
        for (Rank rank = 0; rank < group.size(); ++rank) EXPECT_TRUE(group.left(rank) || group.join(rank));
    }
    std::set<Rank> waiting(const GroupSync& group) {
        std::set<Rank> out;
        for (Rank rank = 0; rank < group.size(); ++rank)
            if (group.waits(rank)) out.insert(rank);
        return out;
    }
    void SetUp() override {
        join_all(three_);
        join_all(two_);
    }
    static constexpr SurfaceId kWindow{1};
    using Ranks = std::set<Rank>;
    GroupSync three_{3}, two_{2};
};

TEST_F(Group, NobodyStartsBeforeAllHaveJoined) {
    GroupSync group(3);
    EXPECT_TRUE(group.join(2));
    EXPECT_TRUE(group.join(0));
    EXPECT_EQ(waiting(group), (Ranks{0, 2}));
    EXPECT_FALSE(group.deadlock()) << "the third may still come";
    EXPECT_TRUE(group.join(1));
    EXPECT_EQ(waiting(group), Ranks{});
    EXPECT_FALSE(group.join(1));
}

TEST_F(Group, MembersThatHadLeftAreNotWaitedFor) {
    GroupSync group(3, {1});
    EXPECT_TRUE(group.join(0));
    EXPECT_TRUE(group.join(2));
    EXPECT_EQ(waiting(group), Ranks{});
    EXPECT_TRUE(group.barrier_create(0, 1, 3));
    EXPECT_TRUE(group.barrier_exec(0, 1));
    EXPECT_TRUE(group.barrier_exec(2, 1));
    EXPECT_EQ(waiting(group), Ranks{});
}

TEST_F(Group, ABarrierHoldsUntilItsCountIsInside) {
    EXPECT_TRUE(three_.barrier_create(0, 7, 2));
    EXPECT_TRUE(three_.barrier_exec(1, 7));
    EXPECT_EQ(waiting(three_), (Ranks{1}));
    EXPECT_TRUE(three_.barrier_exec(2, 7));
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_TRUE(three_.barrier_exec(2, 7));  // the next round
    EXPECT_EQ(waiting(three_), (Ranks{2}));
    EXPECT_TRUE(three_.barrier_exec(0, 7));
    EXPECT_EQ(waiting(three_), Ranks{});
}

TEST_F(Group, ABarrierNeverWaitsForMoreThanCanCome) {
    EXPECT_TRUE(three_.barrier_create(0, 1, 3));
    EXPECT_TRUE(three_.barrier_exec(0, 1));
    EXPECT_TRUE(three_.barrier_exec(1, 1));
    EXPECT_TRUE(three_.leave(2));
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_TRUE(three_.barrier_exec(0, 1));
    EXPECT_EQ(waiting(three_), (Ranks{0}));
    EXPECT_TRUE(three_.barrier_destroy(1, 1));  // while it is waited on
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_FALSE(three_.barrier_exec(1, 1)) << "it has destroyed it";
    EXPECT_TRUE(three_.barrier_exec(0, 1));
    EXPECT_EQ(waiting(three_), Ranks{});
}

TEST_F(Group, BarriersAreCreatedByEachWithTheSameCount) {
    EXPECT_TRUE(two_.barrier_create(0, 1, 2));
    EXPECT_TRUE(two_.barrier_create(1, 1, 2));
    EXPECT_THAT(two_.barrier_create(1, 1, 1).error().message,
                HasSubstr("barrier 1 was created with count 2, by rank 1 with count 1"));
    for (const auto& [name, count] : {std::pair{0u, 1u}, {2u, 0u}, {2u, 3u}})
        EXPECT_FALSE(two_.barrier_create(0, name, count));
    EXPECT_FALSE(two_.barrier_exec(0, 9));
    EXPECT_FALSE(two_.barrier_destroy(0, 9));
    EXPECT_TRUE(two_.barrier_destroy(0, 1));
    EXPECT_TRUE(two_.barrier_destroy(1, 1));
    EXPECT_TRUE(two_.barrier_create(1, 1, 1)) << "a new one";
}

TEST_F(Group, ASemaphoreIsTakenInOrder) {
    EXPECT_TRUE(three_.semaphore_create(0, 1, 1, 0));
    EXPECT_TRUE(three_.semaphore_p(2, 1));
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_TRUE(three_.semaphore_p(1, 1));
    EXPECT_TRUE(three_.semaphore_p(0, 1));
    EXPECT_EQ(waiting(three_), (Ranks{0, 1}));
    EXPECT_TRUE(three_.semaphore_v(2, 1));
    EXPECT_EQ(waiting(three_), (Ranks{0}));
    EXPECT_TRUE(three_.semaphore_v(1, 1));
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_TRUE(three_.semaphore_v(1, 1));
    EXPECT_TRUE(three_.semaphore_p(0, 1));
    EXPECT_EQ(waiting(three_), Ranks{}) << "one was left";
}

TEST_F(Group, ASemaphoresValueIsWhatAllMembersHaveMoved) {
    GroupSync group(2);  // a node that came late
    EXPECT_TRUE(group.semaphore_create(0, 1, 1, -3));
    EXPECT_TRUE(group.join(0));
    EXPECT_TRUE(group.semaphore_create(1, 1, 1, +3));
    EXPECT_TRUE(group.join(1));
    EXPECT_TRUE(group.semaphore_p(0, 1));
    EXPECT_EQ(waiting(group), Ranks{});
    EXPECT_TRUE(group.semaphore_p(0, 1));
    EXPECT_EQ(waiting(group), (Ranks{0}));
    EXPECT_FALSE(group.semaphore_create(1, 1, 2, 0));
    EXPECT_FALSE(group.semaphore_create(1, 0, 2, 0));
    EXPECT_FALSE(group.semaphore_v(1, 5));
}

TEST_F(Group, AFrameIsFinishedWhenAllHaveEndedIt) {
    for (Rank rank : {0u, 1u, 2u}) three_.surface_open(rank, kWindow);
    EXPECT_TRUE(three_.swap(0, kWindow, 1));
    EXPECT_TRUE(three_.swap(2, kWindow, 1));
    EXPECT_EQ(waiting(three_), (Ranks{0, 2}));
    EXPECT_TRUE(three_.take_finished().empty());
    EXPECT_TRUE(three_.swap(1, kWindow, 1));
    EXPECT_EQ(three_.take_finished(), (std::vector<FinishedFrame>{{kWindow, 1}}));
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_FALSE(three_.swap(1, kWindow, 1)) << "the same frame again";
}

TEST_F(Group, AFrameDoesNotWaitForWhoHasLeftOrClosedTheWindow) {
    for (Rank rank : {0u, 1u, 2u}) three_.surface_open(rank, kWindow);
    EXPECT_TRUE(three_.swap(0, kWindow, 1));
    EXPECT_TRUE(three_.leave(1));
    EXPECT_EQ(waiting(three_), (Ranks{0}));
    EXPECT_FALSE(three_.surface_close(2, kWindow));
    EXPECT_EQ(three_.take_finished(), (std::vector<FinishedFrame>{{kWindow, 1}}));
    EXPECT_EQ(waiting(three_), Ranks{});
    EXPECT_FALSE(three_.swap(2, kWindow, 1));
    EXPECT_TRUE(three_.surface_close(0, kWindow));
}

TEST_F(Group, MembersMayComeToANodeAtDifferentFrames) {
    for (Rank rank : {0u, 1u}) two_.surface_open(rank, kWindow);
    EXPECT_TRUE(two_.swap(0, kWindow, 8));
    EXPECT_TRUE(two_.swap(1, kWindow, 7));
    EXPECT_EQ(two_.take_finished(), (std::vector<FinishedFrame>{{kWindow, 7}}));
    EXPECT_EQ(waiting(two_), (Ranks{0}));
    EXPECT_TRUE(two_.swap(1, kWindow, 8));
    EXPECT_EQ(waiting(two_), Ranks{});
}

TEST_F(Group, ADeadlockIsSaid) {
    EXPECT_TRUE(two_.barrier_create(0, 1, 2));
    EXPECT_TRUE(two_.semaphore_create(1, 2, 0, 0));
    EXPECT_TRUE(two_.barrier_exec(0, 1));
    EXPECT_FALSE(two_.deadlock());
    EXPECT_TRUE(two_.semaphore_p(1, 2));
    EXPECT_THAT(*two_.deadlock(), HasSubstr("rank 0 waits in barrier 1, rank 1 waits for semaphore 2"));
    EXPECT_FALSE(two_.semaphore_v(1, 2)) << "a stream that waits says nothing";
    EXPECT_FALSE(two_.leave(0));
}

// ---- any order ----

class Random {
public:
    explicit Random(std::uint32_t seed) : seed_(seed) {}
    std::uint32_t below(std::uint32_t limit) { return (seed_ = seed_ * 1664525u + 1013904223u) / 65536u % limit; }

private:
    std::uint32_t seed_;
};

/// Four members run the same program (barriers, turns by semaphores, swaps), each as far as it may, in a random order.
TEST_F(Group, ARightProgramEndsInEveryOrder) {
    constexpr std::uint32_t kMembers = 4, kSteps = 60;
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        GroupSync group(kMembers);
        std::array<std::uint32_t, kMembers> step{};
        std::vector<Rank> turns;
        const auto run = [&](Rank rank, std::uint32_t at) {
            if (at == 0) {
                EXPECT_TRUE(group.barrier_create(rank, 1, kMembers));
                for (Rank r = 0; r < kMembers; ++r) EXPECT_TRUE(group.semaphore_create(rank, 1 + r, r == 0, 0));
                group.surface_open(rank, kWindow);
                EXPECT_TRUE(group.join(rank));
            } else if (at % 4 == 1) {
                EXPECT_TRUE(group.barrier_exec(rank, 1));
            } else if (at % 4 == 2) {
                EXPECT_TRUE(group.semaphore_p(rank, 1 + rank));
            } else if (at % 4 == 3) {
                turns.push_back(rank);
                EXPECT_TRUE(group.semaphore_v(rank, 1 + (rank + 1) % kMembers));
            } else {
                EXPECT_TRUE(group.swap(rank, kWindow, at / 4));
            }
        };
        while (std::ranges::any_of(step, [](auto at) { return at < kSteps; })) {
            ASSERT_FALSE(group.deadlock()) << *group.deadlock();
            const Rank rank = random.below(kMembers);
            if (step[rank] < kSteps && !group.waits(rank)) run(rank, step[rank]++);
        }
        for (std::size_t i = 0; i < turns.size(); ++i) ASSERT_EQ(turns[i], i % kMembers) << "seed " << seed;
        for (Rank rank = 0; rank < kMembers; ++rank) EXPECT_TRUE(group.leave(rank));
    }
}

/// Whatever members say: either one can go on, or the group says why none can.
TEST_F(Group, NobodyHangsWithoutAWord) {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        GroupSync group(3);
        for (Rank rank = 0; rank < 3; ++rank) group.surface_open(rank, kWindow);
        join_all(group);
        std::uint32_t frame = 0;
        for (int i = 0; i < 200; ++i) {
            const Rank rank = random.below(3);
            const std::uint32_t name = 1 + random.below(2);
            if (group.waits(rank) || group.left(rank)) continue;
            switch (random.below(9)) {
                case 0: (void)group.barrier_create(rank, name, 1 + random.below(3)); break;
                case 1: (void)group.barrier_destroy(rank, name); break;
                case 2: (void)group.barrier_exec(rank, name); break;
                case 3: (void)group.semaphore_create(rank, name, random.below(2), 0); break;
                case 4: (void)group.semaphore_destroy(rank, name); break;
                case 5: (void)group.semaphore_p(rank, name); break;
                case 6: (void)group.semaphore_v(rank, name); break;
                case 7: (void)group.swap(rank, kWindow, ++frame); break;
                default:
                    if (random.below(20) == 0) (void)group.leave(rank);
            }
            const bool somebody = [&] {
                for (Rank r = 0; r < 3; ++r)
                    if (!group.waits(r) && !group.left(r)) return true;
                return false;
            }();
            const bool all_left = group.left(0) && group.left(1) && group.left(2);
            ASSERT_EQ(group.deadlock().has_value(), !somebody && !all_left) << "seed " << seed;
            if (!somebody) break;
        }
    }
}

}  // namespace
}  // namespace wall::tileserver
