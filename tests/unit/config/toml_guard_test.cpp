// SPDX-License-Identifier: MIT
#include "common/config/toml_guard.h"

#include <gtest/gtest.h>

namespace wall::config {
namespace {

TEST(TomlGuard, GoesThereAndBack) {
    const std::string text = "plain \u00e4\u0422\u4e2d\ufeff \U0001f9f1 end";
    const std::string guarded = to_private_use(text);
    EXPECT_EQ(guarded, "plain \U001000e4\U00100422\U00104e2d\U0010feff \U0001f9f1 end");
    EXPECT_EQ(from_private_use(guarded), text);
}

TEST(TomlGuard, LeavesIllFormedBytesAsTheyAre) {
    for (const std::string text :
         {"\xff", "\xc3", "\xc0\xaf", "\xe4\xb8", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\x80 a"}) {
        EXPECT_EQ(to_private_use(text), text);
        EXPECT_EQ(from_private_use(text), text);
    }
}

TEST(TomlGuard, FindsControlCharacters) {
    EXPECT_EQ(control_character_line("a\tb\r\n# \u00e4\n"), 0u);
    EXPECT_EQ(control_character_line(std::string_view("a = 1\n[\0]", 9)), 2u);
    EXPECT_EQ(control_character_line("# \x7f"), 1u);
}

}  // namespace
}  // namespace wall::config
