// SPDX-License-Identifier: MIT
#include "tileserver/render/picture_budget.h"

#include <gtest/gtest.h>

#include <optional>

namespace wall::tileserver {
namespace {

TEST(PictureBudget, IsSpentUntilTheLastCopyOfAShareIsGone) {
    PictureBudget budget;
    const auto first = budget.hold(PictureBudget::kMost - 1);
    EXPECT_FALSE(budget.spent());
    {
        auto second = budget.hold(1);
        const auto copy = second;
        second.reset();
        EXPECT_TRUE(budget.spent());
    }
    EXPECT_FALSE(budget.spent());
}

TEST(PictureBudget, APictureLargerThanAllOfItPasses) {
    PictureBudget budget;
    ASSERT_FALSE(budget.spent());
    const auto huge = budget.hold(4 * PictureBudget::kMost);
    EXPECT_TRUE(budget.spent());
}

TEST(PictureBudget, AShareMayOutliveIt) {
    std::optional<PictureBudget> budget(std::in_place);
    auto share = budget->hold(1);
    budget.reset();
    share.reset();
}

}  // namespace
}  // namespace wall::tileserver
