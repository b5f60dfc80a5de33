// SPDX-License-Identifier: MIT
#include "common/join/membership.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/join/join.h"
#include "tests/support/temporary_folder.h"

namespace wall::join {
namespace {

const tls::Fingerprint kKey = *tls::Fingerprint::from_bytes(std::string(tls::Fingerprint::kBytes, 'w'));

TEST(Membership, IsWhatWasKept) {
    const test::TemporaryFolder folder;
    const Membership kept{MachineKind::node, "left", *Address::parse("10.77.0.1:7770"), kKey};
    ASSERT_TRUE(kept.save(folder.file("")));
    const auto read = Membership::load(folder.file(""));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->kind, MachineKind::node);
    EXPECT_EQ(read->name, "left");
    EXPECT_EQ(read->walld, kept.walld);
    EXPECT_EQ(read->walld_key, kKey);
}

TEST(Membership, OfAMachineThatHasNotJoinedSaysHowThatIsDone) {
    const test::TemporaryFolder folder;
    const auto none = Membership::load(folder.file(""));
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("join-token"), std::string::npos) << none.error().message;
}

TEST(Membership, OfAChangedFileIsAnErrorThatNamesFileAndMember) {
    const test::TemporaryFolder folder;
    const std::string good = R"("walld": "10.77.0.1:7770", "walld_key": ")" + kKey.text() + "\"}";
    const std::pair<const char*, std::string> wrong[] = {
        {"kind", R"({"kind": "king", "name": "left", )" + good},
        {"name", R"({"kind": "node", "name": "", )" + good},
        {"walld", R"({"kind": "node", "name": "left", "walld": "unix:/a"})"},
        {"walld_key", R"({"kind": "node", "name": "left", "walld": "10.77.0.1:7770", "walld_key": "short"})"},
        {"JSON", "{"},
        {"kind", "[]"},
    };
    for (const auto& [member, text] : wrong) {
        std::ofstream(folder.file("joined.json")) << text;
        const auto read = Membership::load(folder.file(""));
        ASSERT_FALSE(read) << text;
        EXPECT_NE(read.error().message.find("joined.json"), std::string::npos) << read.error().message;
        EXPECT_NE(read.error().message.find(member), std::string::npos) << read.error().message;
    }
}

// Nobody listens there: the key is kept for the next attempt, and nothing says that the machine had joined.
TEST(Joining, WhereNobodyIsFailsAndLeavesNoMembership) {
    const test::TemporaryFolder folder;
    const tls::JoinLine line{*Address::parse("127.0.0.1:1"), kKey, std::string(tls::JoinLine::kSecretBytes, 's')};
    const auto joined = join(line, MachineKind::client, folder.file("state"));
    ASSERT_FALSE(joined);
    EXPECT_NE(joined.error().message.find("127.0.0.1:1"), std::string::npos) << joined.error().message;
    EXPECT_TRUE(std::filesystem::exists(key_file(folder.file("state"))));
    EXPECT_FALSE(Membership::load(folder.file("state")));
}

}  // namespace
}  // namespace wall::join
