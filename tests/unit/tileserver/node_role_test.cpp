// SPDX-License-Identifier: MIT
#include "tileserver/node_role.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/join/membership.h"
#include "tests/support/small_wall.h"
#include "tests/support/temporary_folder.h"

namespace wall::tileserver {
namespace {

using ::testing::HasSubstr;

const std::string kOneTile = walld::kTwoNodes;
const std::string kTwoTiles = kOneTile + "[[node.tile]]\nname = \"r2\"\nrect = [640, 480, 640, 480]\n";
/// Which no process can become that draws with another driver.
const std::string kOtherDriver =
    "[[node]]\nname = \"right\"\nbackend = \"osmesa\"\n[[node.tile]]\nname = \"r\"\nrect = [640, 0, 640, 480]\n";
const std::string kAnotherNode =
    kOneTile + "[[node]]\nname = \"x\"\n[[node.tile]]\nname = \"x\"\nrect = [0, 480, 9, 9]\n";

class ARole : public ::testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.file(name)) << text; }
    test::TemporaryFolder folder_;
};

TEST_F(ARole, OfAFileIsAnotherOneWhenTheFileAndWalldSaySo) {
    write("wall.toml", kOneTile);
    const auto role = NodeRole::find({folder_.file("wall.toml"), "right", {}});
    ASSERT_TRUE(role) << role.error().message;
    EXPECT_EQ(role->nodes().at(0).tiles.size(), 1u);
    EXPECT_FALSE(role->described(kOneTile));
    EXPECT_FALSE(role->described(kOtherDriver)) << "by a file that is not the one here";
    write("wall.toml", kOtherDriver);
    EXPECT_FALSE(role->described(kOneTile)) << "which walld has not read yet";
    EXPECT_TRUE(role->described(kOtherDriver));
    write("wall.toml", kTwoTiles);
    EXPECT_FALSE(role->described(kTwoTiles)) << "which it takes while it draws";
    write("wall.toml", kAnotherNode);
    EXPECT_FALSE(role->described(kAnotherNode)) << "that is about others";
    EXPECT_FALSE(role->described("[[node]")) << "nonsense";
    EXPECT_FALSE(role->described("[[node]]\nname = \"x\"\n[[node.tile]]\nname = \"x\"\nrect = [0, 0, 9, 9]\n"))
        << "that has no such node";
}

TEST_F(ARole, OfSeveralGpusIsAnotherOneWhenTheirTilesAreOthers) {
    const auto with = [](const std::string& gpu, const std::string& other) {
        return kOneTile + "gpu = " + gpu +
               "\n[[node.tile]]\nname = \"r2\"\nrect = [640, 480, 640, 480]\ngpu = " + other + "\n";
    };
    write("wall.toml", with("0", "1"));
    const auto role = NodeRole::find({folder_.file("wall.toml"), "right", {}});
    ASSERT_TRUE(role) << role.error().message;
    ASSERT_EQ(role->nodes().size(), 2u);
    EXPECT_EQ(role->nodes()[1].name, "right/gpu1");
    EXPECT_FALSE(role->described(with("0", "1")));
    for (const auto& other : {with("1", "0"), with("0", "0"), with("0", "2"), kOneTile}) {
        write("wall.toml", other);
        EXPECT_TRUE(role->described(other)) << other;
    }
    EXPECT_EQ(role->node(), nullptr) << "which its children are";
    EXPECT_FALSE(NodeRole::find({folder_.file("wall.toml"), "right/gpu0", {}})) << "which is no process";
    write("wall.toml", with("0", "1"));
    const auto child = NodeRole::find({folder_.file("wall.toml"), "right", {}, "right/gpu1"});
    ASSERT_TRUE(child) << child.error().message;
    ASSERT_NE(child->node(), nullptr);
    EXPECT_EQ(child->node()->tiles.at(0).name, "r2");
    const auto none = NodeRole::find({folder_.file("wall.toml"), "right", {}, "right/gpu5"});
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message, HasSubstr("wall.toml: node \"right\" has no GPU \"right/gpu5\""));
}

TEST_F(ARole, OfAMachineThatHasJoinedIsKeptAsWalldSaysIt) {
    const join::Membership membership{join::MachineKind::node, "right", *Address::parse("192.0.2.1:7770"), {}};
    ASSERT_TRUE(membership.save(folder_.file("")));
    write("wall.toml", kOneTile);
    const auto role = NodeRole::find({{}, {}, folder_.file("")});
    ASSERT_TRUE(role) << role.error().message;
    const auto kept = [&] {
        std::ostringstream text;
        text << std::ifstream(folder_.file("wall.toml")).rdbuf();
        return text.str();
    };
    EXPECT_FALSE(role->described(kAnotherNode));
    EXPECT_EQ(kept(), kAnotherNode) << "what is about others as well";
    EXPECT_TRUE(role->described(kOtherDriver));
    EXPECT_FALSE(role->described(kTwoTiles)) << "which it takes while it draws";
    EXPECT_EQ(kept(), kTwoTiles);
    EXPECT_EQ(NodeRole::find({{}, {}, folder_.file("")})->nodes().at(0).tiles.size(), 2u);
    EXPECT_FALSE(role->described("[[node]"));
    EXPECT_EQ(kept(), kTwoTiles);
}

TEST_F(ARole, IsNoneThatTheWallDoesNotHave) {
    write("wall.toml", kOneTile);
    const auto role = NodeRole::find({folder_.file("wall.toml"), "middle", {}});
    ASSERT_FALSE(role);
    EXPECT_THAT(role.error().message, HasSubstr("wall.toml: no [[node]] has the name \"middle\""));
}

}  // namespace
}  // namespace wall::tileserver
