// SPDX-License-Identifier: MIT
#include "walld/http/logins.h"

#include <gtest/gtest.h>

namespace wall::walld {
namespace {

class TheLogins : public ::testing::Test {
protected:
    static SecretDigest token(const char* secret) { return SecretDigest::of(secret); }
    Logins::Clock::time_point now_{};
    int count_ = 0;
    Logins logins_{[this](std::size_t bytes) { return std::string(bytes - 4, 'x') + std::to_string(1000 + count_++); }};
};

TEST_F(TheLogins, KnowASecretUntilItIsOver) {
    const auto secret = logins_.open(token("kiosk"), now_);
    EXPECT_EQ(secret.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
              std::string::npos);
    EXPECT_EQ(logins_.find(secret, now_), token("kiosk"));
    EXPECT_EQ(logins_.find(secret, now_ + Logins::kLifetime - std::chrono::seconds(1)), token("kiosk"));
    EXPECT_FALSE(logins_.find(secret, now_ + Logins::kLifetime));
    EXPECT_EQ(logins_.size(), 0u);
    EXPECT_FALSE(logins_.find("", now_));
}

TEST_F(TheLogins, EndWhenTheyAreClosed) {
    const auto one = logins_.open(token("a"), now_), other = logins_.open(token("b"), now_);
    EXPECT_NE(one, other);
    logins_.close(one);
    logins_.close("unknown");
    EXPECT_FALSE(logins_.find(one, now_));
    EXPECT_EQ(logins_.find(other, now_), token("b"));
}

TEST_F(TheLogins, AreNotMoreThanThereMayBe) {
    const auto first = logins_.open(token("first"), now_);
    for (std::size_t i = 0; i < Logins::kMost; ++i) logins_.open(token("more"), now_ + std::chrono::seconds(1));
    EXPECT_EQ(logins_.size(), Logins::kMost);
    EXPECT_FALSE(logins_.find(first, now_)) << "the oldest has given way";
}

TEST(CookieValue, IsOneOfSeveral) {
    EXPECT_EQ(cookie_value("a=1; wallgl=x-_9; b=2", "wallgl"), "x-_9");
    EXPECT_EQ(cookie_value("__Host-wallgl=x;wallgl=y", "wallgl"), "y");
    for (const char* without : {"", "wallgl", "xwallgl=1", "a=wallgl=1", ";;; =", "wallgl =1"})
        EXPECT_EQ(cookie_value(without, "wallgl"), "") << without;
}

}  // namespace
}  // namespace wall::walld
