// SPDX-License-Identifier: MIT
#include "client_lib/follow/copy_habit.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

CopyHabit after(unsigned frames, unsigned copies, std::uint32_t first = 0) {
    CopyHabit habit;
    for (std::uint32_t frame = first; frame < first + frames; ++frame)
        for (unsigned i = 0; i < copies; ++i) habit.note(frame);
    return habit;
}

TEST(ACopyHabit, BeginsWithTheFourthFrame) {
    EXPECT_FALSE(CopyHabit().copies());
    EXPECT_FALSE(after(3, 1).copies());
    EXPECT_TRUE(after(4, 1).copies());
    EXPECT_TRUE(after(4, 1, 1000).copies());
}

TEST(ACopyHabit, IsOneOfManyWhereEachFrameHasMany) {
    EXPECT_FALSE(after(9, CopyHabit::kMany - 1).copies_much());
    EXPECT_FALSE(after(3, CopyHabit::kMany).copies_much());
    CopyHabit habit = after(3, CopyHabit::kMany);
    habit.note(3);
    EXPECT_TRUE(habit.copies_much()) << "with the first of the fourth";
    habit.note(4);
    EXPECT_FALSE(habit.copies_much()) << "the fourth had only one";
    EXPECT_TRUE(habit.copies());
}

TEST(ACopyHabit, EndsWithAFrameThatHasNone) {
    CopyHabit habit = after(9, CopyHabit::kMany);
    habit.note(10);
    EXPECT_FALSE(habit.copies() || habit.copies_much());
}

}  // namespace
}  // namespace wall::client
