// SPDX-License-Identifier: MIT
#include "walld/streams/still_may.h"

#include <gtest/gtest.h>

namespace wall::walld {
namespace {

TEST(WhetherTheyStillMay, IsAskedNowAndThen) {
    unsigned asked = 0;
    StillMay still([&] {
        ++asked;
        return Outcome<void>();
    });
    StillMay::Clock::time_point now(std::chrono::hours(1));
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(still.at(now));
    EXPECT_EQ(asked, 1u);
    now = still.next();
    EXPECT_TRUE(still.at(now));
    EXPECT_EQ(asked, 2u);
}

TEST(WhetherTheyStillMay, IsOverForGood) {
    bool may = false;
    StillMay still([&] { return may ? Outcome<void>() : refuse(RefusalKind::forbidden, "signed out"); });
    StillMay::Clock::time_point now(std::chrono::hours(1));
    EXPECT_EQ(still.at(now).error().message, "signed out");
    may = true;
    EXPECT_FALSE(still.at(now + std::chrono::hours(1)));
    EXPECT_EQ(still.last().error().message, "signed out");
}

}  // namespace
}  // namespace wall::walld
