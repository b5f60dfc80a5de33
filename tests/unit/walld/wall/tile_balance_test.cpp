// SPDX-License-Identifier: MIT
#include "walld/wall/tile_balance.h"

#include <gtest/gtest.h>

namespace wall::walld {
namespace {

constexpr NodeIndex kFirst(0), kSecond(1), kThird(2);
const std::vector kTwo{kFirst, kSecond};

TEST(TileBalance, MovesWhatMakesTheBusiestLeastBusy) {
    const auto better =
        better_place(kTwo, {{"a", kFirst, 0.6}, {"b", kFirst, 0.4}, {"c", kFirst, 0.05}, {"d", kSecond, 0.1}});
    ASSERT_TRUE(better);
    EXPECT_EQ(better->tile, "b") << "0.65 and 0.5; with a it would be 0.45 and 0.7";
    EXPECT_EQ(better->to, kSecond);
    EXPECT_NEAR(better->gain, 0.4, 1e-9);
}

TEST(TileBalance, ChoosesTheGpuWithTheMostTime) {
    const auto better = better_place({kFirst, kSecond, kThird},
                                     {{"a", kFirst, 0.4}, {"b", kFirst, 0.4}, {"c", kSecond, 0.3}, {"d", kThird, 0.1}});
    ASSERT_TRUE(better);
    EXPECT_EQ(better->to, kThird);
}

TEST(TileBalance, LeavesWhatGainsLittle) {
    EXPECT_FALSE(better_place(kTwo, {{"a", kFirst, 0.5}, {"b", kFirst, 0.05}, {"c", kSecond, 0.5}})) << "0.55 and 0.5";
    EXPECT_FALSE(better_place(kTwo, {{"a", kFirst, 0.1}, {"b", kFirst, 0.1}})) << "nothing waits for it";
    EXPECT_FALSE(better_place(kTwo, {{"a", kFirst, 0.9}, {"b", kSecond, 0.1}})) << "then the other would have it all";
    EXPECT_FALSE(better_place(kTwo, {{"a", kFirst, 0.5}, {"b", kSecond, 0.5}, {"c", kSecond, 0.01}}));
    EXPECT_FALSE(better_place({}, {}));
}

TEST(TileBalance, LeavesTilesThatStay) {
    EXPECT_FALSE(better_place(kTwo, {{"a", kFirst, 0.4, true}, {"b", kFirst, 0.4, true}}));
    const auto better = better_place(kTwo, {{"a", kFirst, 0.4, true}, {"b", kFirst, 0.2}});
    ASSERT_TRUE(better);
    EXPECT_EQ(better->tile, "b");
}

}  // namespace
}  // namespace wall::walld
