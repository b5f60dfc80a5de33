// SPDX-License-Identifier: MIT
#include "tileserver/render/tile_watches.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

class TileWatchesTest : public ::testing::Test {
protected:
    std::size_t due(std::uint64_t damage) { return watches_.due(damage, now_).size(); }
    TileWatches watches_;
    TileWatches::Clock::time_point now_{};
};

TEST_F(TileWatchesTest, TheFirstPictureComesAtOnceAndTheNextAfterReady) {
    watches_.add({7, true}, 100ms);
    const auto first = watches_.due(1, now_);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].id, 7u);
    now_ += 1s;
    EXPECT_EQ(due(2), 0u) << "the first is still on its way";
    watches_.ready(7, false);
    EXPECT_EQ(due(2), 1u);
}

TEST_F(TileWatchesTest, AnUnchangedTileIsNotReadUnlessAskedFor) {
    watches_.add({7, true}, 100ms);
    due(1);
    now_ += 1s;
    watches_.ready(7, false);
    EXPECT_EQ(due(1), 0u);
    EXPECT_EQ(watches_.next_due(1, now_), TileWatches::Clock::duration::max());
    watches_.ready(7, true);
    EXPECT_EQ(due(1), 1u);
}

TEST_F(TileWatchesTest, NotMoreOftenThanTheInterval) {
    watches_.add({7, true}, 100ms);
    due(1);
    watches_.ready(7, false);
    now_ += 99ms;
    EXPECT_EQ(due(2), 0u);
    EXPECT_EQ(watches_.next_due(2, now_), 1ms);
    now_ += 1ms;
    EXPECT_EQ(due(2), 1u);
}

TEST_F(TileWatchesTest, ARemovedStreamIsForgotten) {
    watches_.add({7, true}, 100ms);
    watches_.remove(7);
    watches_.ready(7, true);
    EXPECT_EQ(due(1), 0u);
}

}  // namespace
}  // namespace wall::tileserver
