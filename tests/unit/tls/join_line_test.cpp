// SPDX-License-Identifier: MIT
#include "common/tls/join_line.h"

#include <gtest/gtest.h>

namespace wall::tls {
namespace {

JoinLine line_for(const std::string& address) {
    return {*Address::parse(address), *Fingerprint::from_bytes(std::string(Fingerprint::kBytes, 'k')),
            std::string(JoinLine::kSecretBytes, 's')};
}

TEST(JoinLine, ComesBackFromItsText) {
    for (const char* address : {"10.77.0.1:7770", "wall.example.org:7770", "[2001:db8::1]:7770"}) {
        const auto line = line_for(address);
        const auto back = JoinLine::parse(line.text());
        ASSERT_TRUE(back) << line.text() << ": " << back.error().message;
        EXPECT_EQ(back->walld, line.walld);
        EXPECT_EQ(back->fingerprint, line.fingerprint);
        EXPECT_EQ(back->secret, line.secret);
    }
}

// People copy lines by hand, and terminals cut them.
TEST(JoinLine, ThatWasCutOrChangedIsRefused) {
    const auto whole = line_for("10.77.0.1:7770").text();
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(JoinLine::parse(whole.substr(0, length))) << length;
    EXPECT_FALSE(JoinLine::parse(whole + "A"));
    EXPECT_FALSE(JoinLine::parse(" " + whole));
    EXPECT_FALSE(JoinLine::parse("wallgl2" + whole.substr(7)));
    EXPECT_FALSE(JoinLine::parse(line_for("unix:/run/wallgl/walld.sock").text()));
}

TEST(JoinLine, HasAHostThatIsANameOrANumber) {
    const auto whole = line_for("10.77.0.1:7770").text();
    const auto rest = whole.substr(whole.find(":7770"));
    for (const char* host : {"[\034a.[b]", "[a b]", "[a/b]", "a\"b"})
        EXPECT_FALSE(JoinLine::parse("wallgl1." + std::string(host) + rest)) << host;
    EXPECT_TRUE(JoinLine::parse("wallgl1.wall-1.example" + rest));
}

TEST(JoinLine, SaysWhatWasExpected) {
    const auto wrong = JoinLine::parse("10.77.0.1:7770");
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("join-token"), std::string::npos) << wrong.error().message;
}

}  // namespace
}  // namespace wall::tls
