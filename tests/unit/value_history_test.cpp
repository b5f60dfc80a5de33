// SPDX-License-Identifier: MIT
#include "common/glstate/value_history.h"

#include <gtest/gtest.h>

#include <random>

namespace wall::glstate {
namespace {

using Matrix = std::array<float, 16>;
static_assert(sizeof(Matrix) == ValueHistory::kValueBytes);

Matrix numbered(int number) {
    Matrix m{};
    m[3] = static_cast<float>(number);
    return m;
}

TEST(ValueHistory, ForgetsTheOldest) {
    ValueHistory history;
    for (int i = 0; i <= static_cast<int>(ValueHistory::kDepth); ++i) history.add(7, numbered(i).data());
    EXPECT_FALSE(history.find(7, numbered(0).data()));
    EXPECT_EQ(history.find(7, numbered(1).data()), ValueHistory::kDepth - 1);
    EXPECT_EQ(history.find(7, numbered(8).data()), 0u);
    EXPECT_FALSE(history.find(8, numbered(8).data())) << "elements have their own";
}

TEST(ValueHistory, WhatIsRecalledBecomesTheLatest) {
    ValueHistory history;
    for (int i = 0; i < 4; ++i) history.add(1, numbered(i).data());
    const auto value = history.recall(1, 3);
    EXPECT_EQ(std::memcmp(value.data(), numbered(0).data(), sizeof(Matrix)), 0);
    EXPECT_EQ(history.find(1, numbered(0).data()), 0u);
    EXPECT_EQ(history.find(1, numbered(3).data()), 1u);
    EXPECT_TRUE(history.recall(1, 4).empty());
    EXPECT_TRUE(history.recall(2, 0).empty());
}

// The two ends of a stream: one decides what to send, the other follows.
TEST(ValueHistory, BothEndsStayAlike) {
    ValueHistory sender, receiver;
    std::mt19937 random(5);
    for (int i = 0; i < 5000; ++i) {
        const auto element = static_cast<std::uint32_t>(random() % 3);
        const Matrix value = numbered(static_cast<int>(random() % 12));
        if (const auto place = sender.find(element, value.data())) {
            sender.recall(element, *place);
            const auto received = receiver.recall(element, *place);
            ASSERT_EQ(received.size(), sizeof value);
            ASSERT_EQ(std::memcmp(received.data(), value.data(), sizeof value), 0);
        } else {
            sender.add(element, value.data());
            receiver.add(element, value.data());
        }
    }
}

}  // namespace
}  // namespace wall::glstate
