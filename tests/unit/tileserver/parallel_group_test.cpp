// SPDX-License-Identifier: MIT
// Two members of a parallel program on one node, without threads: what they share and what not.
#include "tileserver/session/parallel_group.h"

#include <gmock/gmock.h>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

using ::testing::HasSubstr;

constexpr geom::Rect kTile{0, 0, 32, 32};

class TwoMembers : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL driver";
        node_.node->tiles = {{0, kTile}};
        group_.emplace(*node_.driver, Membership{2, {}});
        for (const Rank rank : {0u, 1u}) members_[rank].emplace(*node_.node, SessionId(1), &*group_, rank);
        for (auto& member : members_) member->expect_run(just([](auto& b) { pack::Join(b); }));
    }
    template <class Pack>
    static Batch just(Pack&& pack) {
        Batch batch;
        pack(batch.buffer());
        return batch;
    }
    static Batch clear_to(const glstate::Vec4& color) {
        Batch batch;
        batch.set<el::clear_color>(color).block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        return batch;
    }
    static Batch swap(std::uint32_t frame) {
        return just([=](auto& b) { pack::Swap(b, SurfaceId(1), frame); });
    }
    std::string refusal(Rank rank, const Batch& batch) {
        const auto done = members_[rank]->run(batch);
        return done ? "" : done.error().message;
    }
    void open_both() {
        for (auto& member : members_) member->open_surface(32, 32, kTile);
    }
    std::array<int, 3> pixel(Rank rank) {
        const auto pixels = members_[rank]->read(0, {0, 0, 1, 1});
        return {pixels[0], pixels[1], pixels[2]};
    }

    TestNode node_;
    std::optional<ParallelGroup> group_;
    std::array<std::optional<TestSession>, 2> members_;
};

TEST_F(TwoMembers, ShareTheirWindowAndNothingElse) {
    open_both();
    members_[0]->expect_run(clear_to({1, 0, 0, 1}));
    EXPECT_EQ(pixel(1), (std::array{255, 0, 0}));
    members_[1]->expect_run(Batch().block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); }));
    EXPECT_EQ(pixel(0), (std::array{0, 0, 0})) << "with its own clear colour";
}

TEST_F(TwoMembers, EndAFrameTogether) {
    open_both();
    members_[0]->expect_run(swap(1));
    EXPECT_TRUE(group_->sync.waits(0));
    EXPECT_TRUE(group_->finish_frames(*node_.node, members_[1]->session.work).empty());
    EXPECT_FALSE(members_[0]->session.surface(SurfaceId(1))->waiting_frame());
    members_[1]->expect_run(swap(1));
    EXPECT_EQ(group_->finish_frames(*node_.node, members_[1]->session.work),
              (std::vector<FinishedFrame>{{SurfaceId(1), 1}}));
    EXPECT_FALSE(group_->sync.waits(0));
    EXPECT_TRUE(members_[0]->frames.empty()) << "said once, by the group";
}

TEST_F(TwoMembers, MustMeanTheSameWindow) {
    members_[0]->open_surface(32, 32, kTile);
    EXPECT_THAT(refusal(1, just([](auto& b) { pack::SurfaceCreate(b, SurfaceId(1), 0, 0, 24, 8, 16, 0, 1, 0); })),
                HasSubstr("different formats"));
}

TEST_F(TwoMembers, MustMeanTheSamePlace) {
    open_both();
    EXPECT_THAT(refusal(1, just([](auto& b) { pack::SurfacePlace(b, SurfaceId(1), 1, 32, 32, 5, 5, 32, 32, 0); })),
                HasSubstr("different places"));
}

TEST_F(TwoMembers, AMemberMayCloseTheWindow) {
    open_both();
    const auto close = just([](auto& b) { pack::SurfaceDestroy(b, SurfaceId(1)); });
    members_[0]->expect_run(close);
    ASSERT_NE(group_->surface(SurfaceId(1)), nullptr);
    members_[1]->expect_run(swap(1));
    EXPECT_FALSE(group_->sync.waits(1));
    members_[1]->expect_run(close);
    EXPECT_EQ(group_->surface(SurfaceId(1)), nullptr);
}

TEST_F(TwoMembers, NothingStandsBehindWhatMayHold) {
    open_both();
    for (const auto& hold : std::vector<std::function<void(wire::PackBuffer&)>>{
             [](auto& b) { pack::BarrierExec(b, 1); }, [](auto& b) { pack::SemaphoreP(b, 1); },
             [](auto& b) { pack::Swap(b, SurfaceId(1), 1); }, [](auto& b) { pack::Leave(b); }}) {
        Batch batch;
        hold(batch.buffer());
        pack::SemaphoreV(batch.buffer(), 1);
        EXPECT_THAT(refusal(0, batch), HasSubstr("not the last one"));
    }
}

TEST_F(TwoMembers, OthersHaveNoBarriers) {
    TestSession alone(*node_.node, SessionId(2));
    const auto done = alone.run(just([](auto& b) { pack::BarrierCreate(b, 1, 1); }));
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("not of a parallel program"));
}

}  // namespace
}  // namespace wall::tileserver::test
