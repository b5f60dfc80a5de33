// SPDX-License-Identifier: MIT
#include "common/tls/secret.h"

#include <gtest/gtest.h>

namespace wall::tls {
namespace {

TEST(Secret, IsTheSameInAllItsBytesOrNot) {
    EXPECT_TRUE(same_secret("0123456789abcdef", "0123456789abcdef"));
    EXPECT_FALSE(same_secret("0123456789abcdef", "0123456789abcdeF"));
    EXPECT_FALSE(same_secret("0123456789abcdef", "x123456789abcdef"));
    EXPECT_FALSE(same_secret({"a\0b", 3}, {"a\0c", 3})) << "no text that ends at a zero";
}

TEST(Secret, IsNotTheSameAsItsBeginning) {
    EXPECT_FALSE(same_secret("0123", "012"));
    EXPECT_FALSE(same_secret("", "0"));
    EXPECT_TRUE(same_secret("", "")) << "whoever has none must be refused by others";
}

}  // namespace
}  // namespace wall::tls
