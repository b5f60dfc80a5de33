// SPDX-License-Identifier: MIT
#include "tileserver/render/tile_watches.h"

#include <gtest/gtest.h>

#include <map>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

constexpr PictureId kStream(7);

class TileWatchesTest : public ::testing::Test {
protected:
    std::size_t due(std::uint64_t damage) { return watches_.due(damage, now_, 1000).size(); }
    TileWatches watches_;
    TileWatches::Clock::time_point now_{};
};

TEST_F(TileWatchesTest, TheFirstPictureComesAtOnceAndTheNextAfterReady) {
    watches_.add({kStream, true}, 100ms);
    const auto first = watches_.due(1, now_, 1000);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].id, kStream);
    now_ += 1s;
    EXPECT_EQ(due(2), 0u) << "the first is still on its way";
    watches_.ready(kStream, false);
    EXPECT_EQ(due(2), 1u);
}

TEST_F(TileWatchesTest, AnUnchangedTileIsNotReadUnlessAskedFor) {
    watches_.add({kStream, true}, 100ms);
    due(1);
    now_ += 1s;
    watches_.ready(kStream, false);
    EXPECT_EQ(due(1), 0u);
    EXPECT_EQ(watches_.next_due(1, now_), TileWatches::Clock::duration::max());
    watches_.ready(kStream, true);
    EXPECT_EQ(due(1), 1u);
}

TEST_F(TileWatchesTest, NotMoreOftenThanTheInterval) {
    watches_.add({kStream, true}, 100ms);
    due(1);
    watches_.ready(kStream, false);
    now_ += 99ms;
    EXPECT_EQ(due(2), 0u);
    EXPECT_EQ(watches_.next_due(2, now_), 1ms);
    now_ += 1ms;
    EXPECT_EQ(due(2), 1u);
}

TEST_F(TileWatchesTest, ARemovedStreamIsForgotten) {
    watches_.add({kStream, true}, 100ms);
    watches_.remove(kStream);
    watches_.ready(kStream, true);
    EXPECT_EQ(due(1), 0u);
}

TEST_F(TileWatchesTest, ManyTakeTurnsAFewAtATime) {
    for (std::uint32_t stream = 0; stream < 1024; ++stream) watches_.add({PictureId(stream), true}, 100ms);
    std::map<PictureId, int> taken;
    for (int round = 0; round < 1024; ++round, now_ += 1ms) {
        const auto due = watches_.due(static_cast<std::uint64_t>(round), now_, 4);
        EXPECT_LE(due.size(), 4u);
        EXPECT_EQ(watches_.next_due(static_cast<std::uint64_t>(round), now_), TileWatches::Clock::duration{})
            << "more could be taken at once";
        for (const auto& request : due) {
            ++taken[request.id];
            watches_.ready(request.id, false);
        }
    }
    EXPECT_EQ(taken.size(), 1024u);
    for (const auto& [stream, count] : taken) EXPECT_EQ(count, 4) << "none comes before its turn: " << stream.value;
}

}  // namespace
}  // namespace wall::tileserver
