// SPDX-License-Identifier: MIT
#include "common/tls/fingerprint.h"

#include <gtest/gtest.h>

namespace wall::tls {
namespace {

// RFC 4648, 10, and what distinguishes base64url.
TEST(Base64url, IsAsTheStandardHasItWithoutPadding) {
    EXPECT_EQ(to_base64url(""), "");
    EXPECT_EQ(to_base64url("f"), "Zg");
    EXPECT_EQ(to_base64url("fo"), "Zm8");
    EXPECT_EQ(to_base64url("foo"), "Zm9v");
    EXPECT_EQ(to_base64url("foobar"), "Zm9vYmFy");
    EXPECT_EQ(to_base64url("\xfb\xff\xfe"), "-__-");
}

TEST(Base64url, ComesBackWhateverTheBytes) {
    std::string bytes;
    for (int i = 0; i < 256; ++i) {
        const auto back = from_base64url(to_base64url(bytes));
        ASSERT_TRUE(back) << i;
        EXPECT_EQ(*back, bytes);
        bytes += static_cast<char>(i * 7);
    }
}

TEST(Base64url, TakesNothingElse) {
    for (const char* text : {"Zg==", "Z", "Zh", "Zm9+", "Zm9/", "Zm 9", "Zm9v\n"})
        EXPECT_FALSE(from_base64url(text)) << text;
}

TEST(Fingerprint, IsOneTextAndOneRowOfBytes) {
    const std::string bytes(Fingerprint::kBytes, '\x5a');
    const auto made = Fingerprint::from_bytes(bytes);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->bytes(), bytes);
    EXPECT_EQ(made->text().size(), Fingerprint::kCharacters);
    const auto parsed = Fingerprint::parse(made->text());
    ASSERT_TRUE(parsed);
    EXPECT_EQ(*parsed, *made);
    EXPECT_NE(*parsed, Fingerprint());
}

TEST(Fingerprint, OfAnotherLengthIsNone) {
    const auto text = Fingerprint().text();
    EXPECT_FALSE(Fingerprint::from_bytes(std::string(31, 'a')));
    EXPECT_FALSE(Fingerprint::parse(text.substr(1)));
    EXPECT_FALSE(Fingerprint::parse(text + "A"));
    EXPECT_FALSE(Fingerprint::parse("!" + text.substr(1)));
}

}  // namespace
}  // namespace wall::tls
