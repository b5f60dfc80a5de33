// SPDX-License-Identifier: MIT
#include "walld/control/tokens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;
using wall::test::TemporaryFolder;

const auto kKiosk = SecretDigest::of("0123456789abcdef"), kStage = SecretDigest::of("fedcba9876543210");

class TheTokens : public ::testing::Test {
protected:
    TheTokens() {
        write("kiosk", "0123456789abcdef");
        write("stage", "fedcba9876543210");
    }
    void write(const std::string& name, const std::string& secret) {
        std::ofstream(folder_.file(name)) << secret << '\n';
        ::chmod(folder_.file(name).c_str(), 0600);
    }
    Tokens open(const std::filesystem::path& state) const {
        return *Tokens::open(
            {{"kiosk", folder_.file("kiosk"), Role::user}, {"stage", folder_.file("stage"), Role::user}}, state);
    }
    Tokens open() const { return open(folder_.file("")); }
    TemporaryFolder folder_;
};

TEST_F(TheTokens, StandForSomebodyUntilTheyAreRevoked) {
    auto tokens = open();
    EXPECT_EQ(tokens.find(kKiosk)->text(), "token kiosk");
    EXPECT_EQ(tokens.revoke("kiosk")->name, "kiosk");
    EXPECT_THAT(tokens.find(kKiosk).error().message, HasSubstr("token kiosk was revoked"));
    EXPECT_TRUE(tokens.find(kStage));
    EXPECT_TRUE(tokens.revoke("kiosk")) << "again is no error";
    EXPECT_EQ(tokens.revoke("nobody").error().kind, RefusalKind::not_found);
}

TEST_F(TheTokens, AreRevokedForTheNextWalldToo) {
    open().revoke("kiosk").value();
    open().revoke("stage").value();
    EXPECT_FALSE(open().find(kKiosk));
    EXPECT_FALSE(open().find(kStage));
}

TEST_F(TheTokens, AreGoodAgainWithAnotherSecretAndNotWithTheOldOne) {
    open().revoke("kiosk").value();
    write("kiosk", "another secret of some length");
    EXPECT_EQ(open().find(SecretDigest::of("another secret of some length"))->name, "kiosk");
    EXPECT_FALSE(open().find(kKiosk));
    open().revoke("stage").value();
    write("kiosk", "0123456789abcdef");
    EXPECT_FALSE(open().find(kKiosk)) << "though others were revoked meanwhile";
}

TEST_F(TheTokens, WithoutAPlaceToWriteItDownAreNotRevoked) {
    auto tokens = open("");
    EXPECT_THAT(tokens.revoke("kiosk").error().message, HasSubstr("take the [[people.token]] out of wall.toml"));
    EXPECT_TRUE(tokens.find(kKiosk));
}

TEST_F(TheTokens, ABrokenListIsAnErrorAndNotAnEmptyOne) {
    for (const char* broken : {"{}", "[1]", "[\"x\"]", "[", ""}) {
        std::ofstream(folder_.file("revoked_tokens.json")) << broken;
        const auto tokens = Tokens::open({}, folder_.file(""));
        ASSERT_FALSE(tokens) << broken;
        EXPECT_THAT(tokens.error().message, HasSubstr("revoked_tokens.json: "));
    }
}

}  // namespace
}  // namespace wall::walld
