// SPDX-License-Identifier: MIT
#include "tileserver/io/burst_watch.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

TEST(BurstWatch, TellsItsEndOnce) {
    BurstWatch watch;
    EXPECT_FALSE(watch.tick(64 * kMiB)) << "it is coming";
    EXPECT_FALSE(watch.tick(90 * kMiB));
    EXPECT_TRUE(watch.tick(90 * kMiB + 100));
    EXPECT_FALSE(watch.tick(90 * kMiB + 200)) << "since then nothing came that is worth it";
}

TEST(BurstWatch, CountsWhatComesSlowly) {
    BurstWatch watch;
    std::uint64_t bytes = 0;
    int ends = 0;
    for (int second = 0; second < 100; ++second) ends += watch.tick(bytes += kMiB / 4);
    EXPECT_EQ(ends, 3) << "of 25 MiB";
}

TEST(BurstWatch, AStreamThatDoesNotEndIsLeftAlone) {
    BurstWatch watch;
    std::uint64_t bytes = 0;
    for (int second = 0; second < 100; ++second) EXPECT_FALSE(watch.tick(bytes += 100 * kMiB));
}

}  // namespace
}  // namespace wall::tileserver
