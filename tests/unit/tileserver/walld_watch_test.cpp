// SPDX-License-Identifier: MIT
#include "tileserver/io/walld_watch.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
using Need = WalldWatch::Need;

TEST(WalldWatch, AsksWhenNothingComesAndThenIsSilentAfterTheLimit) {
    WalldWatch watch(250ms);
    EXPECT_EQ(watch.interval(), 125ms);
    EXPECT_EQ(watch.tick(), Need::ask);
    EXPECT_EQ(watch.tick(), Need::nothing);
    EXPECT_FALSE(watch.silent());
    EXPECT_EQ(watch.tick(), Need::show_frames) << "twice half the limit after it was asked";
    EXPECT_TRUE(watch.silent());
    EXPECT_EQ(watch.tick(), Need::nothing) << "that is said once";
    EXPECT_TRUE(watch.heard());
    EXPECT_FALSE(watch.heard());
    EXPECT_EQ(watch.tick(), Need::ask);
}

TEST(WalldWatch, IsQuietWhileMessagesCome) {
    WalldWatch watch(250ms);
    for (int i = 0; i < 100; ++i) {
        EXPECT_NE(watch.tick(), Need::show_frames);
        EXPECT_NE(watch.tick(), Need::show_frames);
        EXPECT_FALSE(watch.heard());
    }
}

TEST(WalldWatch, WantsANewLinkInTheEnd) {
    WalldWatch watch(1000ms);
    int ticks = 1;
    for (; watch.tick() != Need::new_link; ++ticks) ASSERT_LT(ticks, 1000);
    EXPECT_EQ(ticks * watch.interval(), WalldWatch::kLostLimit);
    watch.linked();
    EXPECT_FALSE(watch.silent());
    EXPECT_EQ(watch.tick(), Need::ask);
}

TEST(WalldWatch, IsAsPatientAsTheLimitSays) {
    for (const auto limit : {1ms, 20ms, 250ms, 2000ms, 10'000ms}) {
        WalldWatch watch(limit);
        int ticks = 1;
        for (; watch.tick() != Need::show_frames; ++ticks) ASSERT_LT(ticks, 1000);
        const auto since_asked = (ticks - 1) * watch.interval();
        EXPECT_GE(since_asked, limit);
        EXPECT_LE(since_asked, limit + 2 * watch.interval());
        EXPECT_LT(since_asked, WalldWatch::kLostLimit);
    }
}

}  // namespace
}  // namespace wall::tileserver
