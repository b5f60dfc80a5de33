// SPDX-License-Identifier: MIT
#include "walld/control/machines.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace wall::walld {
namespace {

using Kind = Machine::Kind;
const std::string kSecret(16, 's'), kOther(16, 't');

tls::Fingerprint key(char c) { return *tls::Fingerprint::from_bytes(std::string(tls::Fingerprint::kBytes, c)); }

class JoiningMachines : public testing::Test {
protected:
    Machines open() {
        auto out = Machines::open(folder_.file(""));
        EXPECT_TRUE(out) << out.error().message;
        return std::move(*out);
    }
    /// The error's text; empty if it has joined.
    std::string join(Kind kind, const std::string& secret, char k, const std::string& host = "desk") {
        const auto joined = machines_.join(kind, secret, host, key(k), now_);
        return joined ? "" : joined.error().message;
    }
    test::TemporaryFolder folder_;
    Machines machines_ = open();
    Machines::Clock::time_point now_ = Machines::Clock::now();
};

TEST_F(JoiningMachines, AreKnownByTheirKeysAlsoToTheNextWalld) {
    ASSERT_TRUE(machines_.invite({Kind::node, "left"}, kSecret, now_));
    EXPECT_EQ(join(Kind::node, kSecret, 'a'), "");
    ASSERT_TRUE(machines_.find(key('a')));
    EXPECT_EQ(machines_.find(key('a'))->text(), "node left");
    EXPECT_FALSE(machines_.find(key('b')));
    const auto later = open();
    ASSERT_TRUE(later.find(key('a')));
    EXPECT_EQ(later.find(key('a'))->name, "left");
}

TEST_F(JoiningMachines, UseALineOnce) {
    ASSERT_TRUE(machines_.invite({Kind::node, "left"}, kSecret, now_));
    EXPECT_EQ(join(Kind::node, kSecret, 'a'), "");
    EXPECT_NE(join(Kind::node, kSecret, 'b').find("used up"), std::string::npos);
    EXPECT_FALSE(machines_.find(key('b')));
}

TEST_F(JoiningMachines, AreTooLateAfterItsTime) {
    ASSERT_TRUE(machines_.invite({Kind::node, "left"}, kSecret, now_));
    now_ += Machines::kJoinTime;
    EXPECT_NE(join(Kind::node, kSecret, 'a').find("older than 15 minutes"), std::string::npos);
}

TEST_F(JoiningMachines, JoinAsWhatTheLineIsForAndMayTryAgain) {
    ASSERT_TRUE(machines_.invite({Kind::client, "desk"}, kSecret, now_));
    EXPECT_NE(join(Kind::node, kSecret, 'a').find("client host desk"), std::string::npos);
    EXPECT_NE(join(Kind::client, kOther, 'a'), "");
    EXPECT_EQ(join(Kind::client, kSecret, 'a'), "");
}

TEST_F(JoiningMachines, TakeThePlaceOfOneOfTheirName) {
    for (const char k : {'a', 'b'}) {
        ASSERT_TRUE(machines_.invite({Kind::node, "left"}, kSecret, now_));
        EXPECT_EQ(join(Kind::node, kSecret, k), "");
    }
    EXPECT_FALSE(machines_.find(key('a')));
    EXPECT_EQ(machines_.all().size(), 1u);
}

TEST_F(JoiningMachines, WithoutANameHaveTheirOwnButNotAnothers) {
    ASSERT_TRUE(machines_.invite({Kind::client, ""}, kSecret, now_));
    EXPECT_EQ(join(Kind::client, kSecret, 'a'), "");
    EXPECT_EQ(machines_.find(key('a'))->name, "desk");
    ASSERT_TRUE(machines_.invite({Kind::client, ""}, kSecret, now_));
    EXPECT_NE(join(Kind::client, kSecret, 'b').find("another client host"), std::string::npos);
    EXPECT_NE(join(Kind::client, kSecret, 'b', "a b").find("printable"), std::string::npos);
    EXPECT_EQ(join(Kind::client, kSecret, 'b', "table"), "");
}

TEST_F(JoiningMachines, ThatAreRevokedAreNobodyAnyMore) {
    ASSERT_TRUE(machines_.invite({Kind::client, "desk"}, kSecret, now_));
    EXPECT_EQ(join(Kind::client, kSecret, 'a'), "");
    EXPECT_FALSE(machines_.revoke(Kind::node, "desk"));
    const auto gone = machines_.revoke(Kind::client, "desk");
    ASSERT_TRUE(gone);
    EXPECT_EQ(gone->key, key('a'));
    EXPECT_FALSE(machines_.find(key('a')));
    EXPECT_FALSE(open().find(key('a')));
}

TEST_F(JoiningMachines, HaveNamesThatPeopleCanRead) {
    for (const char* name : {"", "a b", "a@b", "a\"b", "\n"})
        EXPECT_FALSE(machines_.invite({Kind::node, name}, kSecret, now_)) << name;
}

TEST_F(JoiningMachines, AreNotAwaitedWithoutEnd) {
    for (std::size_t i = 0; i < Machines::kMaxInvitations; ++i)
        ASSERT_TRUE(machines_.invite({Kind::client, "desk"}, std::to_string(i), now_));
    EXPECT_FALSE(machines_.invite({Kind::client, "desk"}, kSecret, now_));
    EXPECT_TRUE(machines_.invite({Kind::client, "desk"}, kSecret, now_ + Machines::kJoinTime));
}

TEST(Machines, WithoutAFolderJoinNowhere) {
    auto machines = Machines::open({});
    ASSERT_TRUE(machines);
    const auto refused = machines->invite({Kind::node, "left"}, kSecret, Machines::Clock::now());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("state_directory"), std::string::npos);
}

TEST(Machines, OfAFileThatIsNoneAreAnErrorThatNamesIt) {
    const test::TemporaryFolder folder;
    for (const char* text : {"{}", "[1]", R"([{"kind":"node","name":"a","role":"user","key":"short"}])", "["}) {
        std::ofstream(folder.file("machines.json")) << text;
        const auto read = Machines::open(folder.file(""));
        ASSERT_FALSE(read) << text;
        EXPECT_NE(read.error().message.find("machines.json"), std::string::npos) << read.error().message;
    }
}

}  // namespace
}  // namespace wall::walld
