// SPDX-License-Identifier: MIT
#include "client_lib/objects/changed_ranges.h"

#include <gtest/gtest.h>

#include <random>

namespace wall::client {
namespace {

std::vector<ByteRange> since(const ChangedRanges& ranges, std::uint64_t known) {
    std::vector<ByteRange> out;
    ranges.since(known, [&](ByteRange range) { out.push_back(range); });
    return out;
}
using Ranges = std::vector<ByteRange>;

TEST(ChangedRanges, TellWhatIsNewerThanWhatIsKnown) {
    ChangedRanges ranges;
    ranges.reset(1);
    EXPECT_TRUE(ranges.lacks_all(0));
    EXPECT_FALSE(ranges.lacks_all(1));
    ranges.add({0, 10}, 2);
    ranges.add({1000, 1010}, 3);
    EXPECT_EQ(since(ranges, 1), (Ranges{{0, 10}, {1000, 1010}}));
    EXPECT_EQ(since(ranges, 2), (Ranges{{1000, 1010}}));
    EXPECT_EQ(since(ranges, 3), Ranges{});
    ranges.reset(4);
    EXPECT_TRUE(ranges.lacks_all(3));
    EXPECT_EQ(since(ranges, 4), Ranges{});
}

TEST(ChangedRanges, NeighboursTravelTogether) {
    ChangedRanges ranges;
    ranges.reset(1);
    ranges.add({0, 10}, 2);
    ranges.add({20, 30}, 3);
    EXPECT_EQ(since(ranges, 1), (Ranges{{0, 30}}));
    EXPECT_EQ(since(ranges, 2), (Ranges{{0, 30}})) << "as new as the newer one";
    ranges.add({5, 5}, 4);
    EXPECT_EQ(since(ranges, 3), Ranges{}) << "nothing was written";
}

TEST(ChangedRanges, WhatIsLargeIsNotSentAgainForASmallChangeInIt) {
    ChangedRanges ranges;
    ranges.reset(1);
    ranges.add({0, 1000000}, 2);
    ranges.add({500, 600}, 3);
    EXPECT_EQ(since(ranges, 2), (Ranges{{500, 600}}));
    EXPECT_EQ(since(ranges, 1), (Ranges{{0, 1000000}}));
    ranges.add({0, 1000000}, 4);
    EXPECT_EQ(since(ranges, 3), (Ranges{{0, 1000000}}));
    for (std::size_t i = 0; i < 10 * ChangedRanges::kMost; ++i) ranges.add({i * 150, i * 150 + 10}, 5 + i);
    std::size_t told = 0;
    for (const ByteRange& range : since(ranges, 4)) told += range.size();
    EXPECT_LT(told, 100000u) << "however many they are";
}

// Whatever is written in whatever order, a follower that was told at some time is told at least what it lacks.
TEST(ChangedRanges, WhatIsSealedDoesNotBecomeNewerByANeighbour) {
    ChangedRanges ranges;
    ranges.reset(1);
    ranges.add({0, 100}, 2);
    ranges.add({500, 600}, 3);
    ranges.seal();
    ranges.add({0, 50}, 4);
    EXPECT_EQ(since(ranges, 3), (Ranges{{0, 50}}));
    EXPECT_EQ(since(ranges, 1), (Ranges{{0, 600}}));
    ranges.seal();
    EXPECT_EQ(since(ranges, 4), Ranges{});
    ranges.add({40, 60}, 5);
    EXPECT_EQ(since(ranges, 4), (Ranges{{40, 60}}));
    ranges.reset(6);
    EXPECT_EQ(since(ranges, 0), Ranges{});
}

TEST(ChangedRanges, NothingIsForgotten) {
    constexpr std::size_t kBytes = 100000;
    std::mt19937 random(7);
    ChangedRanges ranges;
    ranges.reset(1);
    std::vector<std::uint64_t> written(kBytes, 1);  // stamp of each byte
    for (std::uint64_t stamp = 2; stamp < 2000; ++stamp) {
        const std::size_t begin = random() % kBytes, end = std::min(kBytes, begin + random() % 300);
        ranges.add({begin, end}, stamp);
        std::fill(written.begin() + static_cast<std::ptrdiff_t>(begin),
                  written.begin() + static_cast<std::ptrdiff_t>(end), stamp);
        if (stamp % 97 != 0) continue;
        const std::uint64_t known = 1 + random() % stamp;
        std::vector<bool> told(kBytes);
        for (const ByteRange& range : since(ranges, known))
            std::fill(told.begin() + static_cast<std::ptrdiff_t>(range.begin),
                      told.begin() + static_cast<std::ptrdiff_t>(range.end), true);
        for (std::size_t i = 0; i < kBytes; ++i) ASSERT_TRUE(told[i] || written[i] <= known) << i << " at " << stamp;
    }
    EXPECT_LE(since(ranges, 1).size(), ChangedRanges::kMost);
}

}  // namespace
}  // namespace wall::client
