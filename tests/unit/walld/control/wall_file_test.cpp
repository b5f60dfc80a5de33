// SPDX-License-Identifier: MIT
#include "walld/control/wall_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/small_wall.h"
#include "tests/support/temporary_folder.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

constexpr const char* kThird = "[[node]]\nname = \"third\"\n[[node.tile]]\nname = \"t\"\nrect = [1280, 0, 640, 480]\n";

class AWallFile : public ::testing::Test {
protected:
    AWallFile() { write(kTwoNodes); }
    void write(const std::string& text) const { std::ofstream(folder_.file("wall.toml")) << text; }
    std::string why_not(const Outcome<Description>& outcome) const { return outcome ? "" : outcome.error().message; }

    test::TemporaryFolder folder_;
    WallFile file_{folder_.file("wall.toml"), folder_.file("state")};
};

TEST_F(AWallFile, HasTheNodesThatWereAdded) {
    ASSERT_EQ(file_.read()->config.nodes.size(), 2u);
    const auto added = file_.add(kThird);
    ASSERT_TRUE(added) << added.error().message;
    EXPECT_EQ(added->config.nodes.size(), 3u);
    const auto read = WallFile(folder_.file("wall.toml"), folder_.file("state")).read();
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->config.find_node("third")->tiles.at(0).rect.x, 1280);
    EXPECT_THAT(read->toml, HasSubstr(kThird)) << "as nodes get it";
}

TEST_F(AWallFile, AddsOneNodeThatGoesWithTheOthersOrNothing) {
    const auto left = "[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"t\"\nrect = [1280, 0, 640, 480]\n";
    EXPECT_THAT(why_not(file_.add(left)), HasSubstr("has a node 'left' already"));
    const auto tile = "[[node]]\nname = \"third\"\n[[node.tile]]\nname = \"l\"\nrect = [1280, 0, 640, 480]\n";
    EXPECT_THAT(why_not(file_.add(tile)), HasSubstr("tile 'l' appears twice"));
    EXPECT_THAT(why_not(file_.add(std::string("[wall]\nname = \"mine\"\n") + kThird)),
                HasSubstr("the node:1: unknown key 'wall'"));
    EXPECT_THAT(why_not(file_.add("[[node")), HasSubstr("the node:1: not TOML"));
    EXPECT_THAT(why_not(file_.add(kTwoNodes)), HasSubstr("expected one [[node]] table, not 2"));
    for (const char* name : {"../wall", ".hidden", "a b", "a/b"}) {
        const auto text =
            std::string("[[node]]\nname = \"") + name + "\"\n[[node.tile]]\nname = \"t\"\nrect = [1, 0, 1, 1]\n";
        EXPECT_THAT(why_not(file_.add(text)), HasSubstr("letters, digits")) << name;
    }
    EXPECT_EQ(file_.read()->config.nodes.size(), 2u);
    EXPECT_FALSE(std::filesystem::exists(folder_.file("state")));
}

TEST_F(AWallFile, RemovesOnlyWhatWasAdded) {
    ASSERT_TRUE(file_.add(kThird));
    EXPECT_THAT(why_not(file_.remove("left")), HasSubstr("take it out there, then `wallctl reload`"));
    EXPECT_THAT(why_not(file_.remove("nobody")), HasSubstr("there is no node 'nobody'"));
    const auto removed = file_.remove("third");
    ASSERT_TRUE(removed) << removed.error().message;
    EXPECT_EQ(removed->config.nodes.size(), 2u);
    EXPECT_EQ(file_.read()->config.nodes.size(), 2u);
}

TEST_F(AWallFile, SaysWhereWallTomlIsWrong) {
    ASSERT_TRUE(file_.add(kThird));
    write(std::string(kTwoNodes) + "[nonsense]\n");
    EXPECT_THAT(why_not(file_.read()), HasSubstr("wall.toml:12: unknown key 'nonsense'"));
    EXPECT_THAT(why_not(file_.remove("third")), HasSubstr("wall.toml:12:"));
    write(kTwoNodes);
    EXPECT_EQ(file_.read()->config.nodes.size(), 3u) << "nothing was lost";
    write(std::string(kTwoNodes) + kThird);
    EXPECT_THAT(why_not(file_.read()), HasSubstr("state/nodes")) << "named, because it stands there as well";
}

TEST_F(AWallFile, KnowsWhoIsDrained) {
    EXPECT_TRUE(file_.drained()->empty());
    ASSERT_TRUE(file_.set_drained({"left", "right"}));
    EXPECT_EQ(*file_.drained(), (std::set<std::string>{"left", "right"}));
    std::ofstream(folder_.file("state") + "/drained.json") << "[1]";
    EXPECT_THAT(file_.drained().error().message, HasSubstr("expected an array of nodes' names"));
}

TEST_F(AWallFile, WithoutAFolderKeepsNothing) {
    const WallFile bare(folder_.file("wall.toml"), {});
    EXPECT_EQ(bare.read()->config.nodes.size(), 2u);
    EXPECT_THAT(why_not(bare.add(kThird)), HasSubstr("no state directory"));
    EXPECT_TRUE(bare.set_drained({"left"})) << "for as long as walld runs";
}

}  // namespace
}  // namespace wall::walld
