// SPDX-License-Identifier: MIT
// What drawing takes for tiles: a tile for which ten times as much is drawn takes longer, and nothing is measured where
// nobody asks.
#include "tileserver/driver/tile_times.h"

#include <gtest/gtest.h>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

constexpr std::int32_t kSize = 256;

class TileTimesTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{3, {0, 0, kSize, kSize}}, {7, {kSize, 0, kSize, kSize}}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(2 * kSize, kSize, {0, 0, 2 * kSize, kSize});
    }
    /// The whole window, so many times, on the tiles of the mask.
    void fill(std::uint64_t tiles, int times) {
        Batch batch;
        batch.block(tiles, [&](auto& b) {
            for (int i = 0; i < times; ++i) {
                pack::Begin(b, GL_QUADS);
                for (const auto& [x, y] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
                    pack::Vertex2f(b, x, y);
                pack::End(b);
            }
        });
        session_->expect_run(batch);
    }
    TileTimes& times() { return node_.node->tile_times; }
    /// All that was drawn is done, and what it has taken is known.
    void take(TileTimes::Clock::time_point now) {
        node_.node->driver.gl().Finish();
        times().tick(now + TileTimes::kLook);
        node_.node->driver.gl().Finish();
        times().tick(now + TileTimes::kLook);
    }

    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(TileTimesTest, SayWhichTileTakesHowMuch) {
    const TileTimes::Clock::time_point now{std::chrono::hours(1)};
    fill(1u << 3 | 1u << 7, 1);
    times().switch_on(true);
    times().tick(now);
    for (int i = 0; i < 4; ++i) {
        fill(1u << 3 | 1u << 7, 20);
        fill(1u << 7, 400);
    }
    take(now);
    const auto& all = times().all();
    ASSERT_TRUE(all.contains(3) && all.contains(7));
    EXPECT_GT(all.at(3).count(), 0);
    EXPECT_GT(all.at(7), 4 * all.at(3)) << "21 times as much is drawn for it";
    EXPECT_EQ(all.size(), 2u);
}

TEST_F(TileTimesTest, LookAtATenthOfTheTime) {
    const TileTimes::Clock::time_point now{std::chrono::hours(1)};
    times().switch_on(true);
    times().tick(now);
    fill(1u << 3, 20);
    take(now);
    const auto first = times().all().at(3);
    fill(1u << 3, 2000);
    times().tick(now + TileTimes::kEvery / 2);
    fill(1u << 3, 2000);
    take(now + TileTimes::kEvery / 2);
    EXPECT_EQ(times().all().at(3), first) << "nobody looks";
    times().tick(now + TileTimes::kEvery);
    fill(1u << 3, 20);
    take(now + TileTimes::kEvery);
    EXPECT_GT(times().all().at(3), first);
}

TEST_F(TileTimesTest, AreNotTakenUnlessSomebodyAsks) {
    const TileTimes::Clock::time_point now{std::chrono::hours(1)};
    times().tick(now);
    fill(1u << 3, 20);
    take(now);
    EXPECT_TRUE(times().all().empty());
}

TEST_F(TileTimesTest, LeaveNoQueriesBehind) {
    const auto before = node_.node->driver.gl().objects->queries;
    {
        TileTimes alone(node_.node->driver.gl());
        const TileTimes::Clock::time_point now{std::chrono::hours(1)};
        alone.switch_on(true);
        alone.tick(now);
        for (std::uint32_t i = 0; i < 2 * TileTimes::kMostMarks; ++i) alone.mark(i % 2);
        alone.tick(now);
        EXPECT_LE(node_.node->driver.gl().objects->queries - before, std::int64_t{TileTimes::kMostMarks} + 2);
    }
    EXPECT_EQ(node_.node->driver.gl().objects->queries, before);
}

}  // namespace
}  // namespace wall::tileserver::test
