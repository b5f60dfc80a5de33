// SPDX-License-Identifier: MIT
#include "client_lib/objects/churn.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

constexpr std::uint64_t kBytes = 1000;

TEST(Churn, WhatIsDrawnAgainAndAgainIsKept) {
    Churn churn;
    churn.expect(GL_STATIC_DRAW);
    churn.changed(kBytes);
    for (int i = 0; i < 100; ++i) {
        churn.drawn(kBytes, 4);
        EXPECT_TRUE(churn.keep());
    }
}

TEST(Churn, WhatIsWrittenAnewForEveryDrawComesAlong) {
    Churn churn;
    churn.expect(GL_STATIC_DRAW);
    for (int frame = 0; frame < 3; ++frame) {
        churn.changed(kBytes);
        churn.drawn(kBytes, 4);  // four nodes would get all of it, sorted it is sent about once
    }
    EXPECT_FALSE(churn.keep());
    for (int frame = 0; frame < 3; ++frame) churn.changed(kBytes), churn.drawn(kBytes, 4);
    EXPECT_FALSE(churn.keep());
}

TEST(Churn, OneNodeKeepsWhatIsAboutEqual) {
    Churn churn;
    churn.expect(GL_STATIC_DRAW);
    for (int frame = 0; frame < 5; ++frame) churn.changed(kBytes), churn.drawn(kBytes, 1);
    EXPECT_TRUE(churn.keep());
}

TEST(Churn, ASmallChangeOfMuchIsWorthKeeping) {
    Churn churn;
    churn.expect(GL_DYNAMIC_DRAW);
    churn.changed(kBytes);
    for (int frame = 0; frame < 5; ++frame) churn.changed(kBytes / 100), churn.drawn(kBytes, 4);
    EXPECT_TRUE(churn.keep());
}

TEST(Churn, AStreamIsNotKeptUntilItProvesToBeNone) {
    Churn churn;
    churn.expect(GL_STREAM_DRAW);
    churn.changed(kBytes);
    EXPECT_FALSE(churn.keep());
    int draws = 0;
    while (!churn.keep() && draws < 100) churn.drawn(kBytes, 4), ++draws;
    EXPECT_EQ(draws, 9) << "it has cost twice what all four nodes would have";
    for (int frame = 0; frame < 3; ++frame) churn.changed(kBytes), churn.drawn(kBytes, 4);
    EXPECT_FALSE(churn.keep());
}

}  // namespace
}  // namespace wall::client
