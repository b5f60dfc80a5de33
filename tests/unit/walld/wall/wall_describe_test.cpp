// SPDX-License-Identifier: MIT
// Another description while nodes and programs are there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"
#include "walld/wall/messages.h"

namespace wall::walld {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr NodeIndex kNext(2);  // of a node that is added to kTwoNodes

std::string node_text(const std::string& name, const std::string& rect) {
    return "[[node]]\nname = \"" + name + "\"\n[[node.tile]]\nname = \"tile of " + name + "\"\nrect = [" + rect + "]\n";
}

class AWallThatIsDescribedAnew : public ::testing::Test {
protected:
    AWallThatIsDescribedAnew() {
        join("left");
        join("right");
        proto::ClientHello hello;
        hello.set_fullscreen(true);
        session_ = wall_.open_session(hello, {}, now_, [](SessionId) {});
        open_surface(1);
        open_surface(2);
        out_.nodes.clear();
        out_.client.clear();
    }
    NodeIndex join(const std::string& name) {
        proto::NodeHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_name(name);
        hello.set_pid(100);
        for (const auto& [node, messages] : out_.nodes) {
            if (wall_.nodes()[node].config->name != name) continue;
            for (const auto& message : messages)
                if (message.has_ticket()) *hello.add_sessions() = message.ticket();
        }
        return *wall_.node_joins(hello, now_);
    }
    void open_surface(std::uint32_t number) {
        proto::SurfaceOpen message;
        message.set_surface(number);
        message.set_width(100);
        message.set_height(100);
        ASSERT_TRUE(wall_.open_surface(session_, message, now_));
    }
    geom::Rect wanted(std::uint32_t surface) const {
        return wall_.find(SurfaceKey{session_, SurfaceId(surface)})->place.wanted();
    }
    /// What walld's shell does: who is described otherwise leaves before.
    void describe(const std::string& toml) {
        auto next = config::parse_config(toml, "test");
        ASSERT_TRUE(next) << next.error().message;
        for (const NodeIndex node : wall_.described_otherwise(*next)) wall_.node_leaves(node, now_);
        wall_.describe(std::move(*next));
    }
    std::string ticket_of(NodeIndex node) const { return wall_.sessions().at(session_).tickets.at(node); }

    Clock::time_point now_{std::chrono::hours(1)};
    HearingOutbox out_;
    char secret_ = 'a';
    Wall wall_{*config::parse_config(kTwoNodes, "test"), out_,
               [this](std::size_t bytes) { return std::string(bytes, secret_++); }};
    SessionId session_;
};

TEST_F(AWallThatIsDescribedAnew, TellsProgramsTheTilesBeforeThePlacements) {
    describe(kTwoNodes + node_text("next", "1280, 0, 640, 480"));
    ASSERT_EQ(out_.client.size(), 3u);
    ASSERT_EQ(out_.client[0].tiles_changed().tiles_size(), 3);
    EXPECT_EQ(out_.client[0].tiles_changed().tiles(2).node(), kNext.value);
    EXPECT_EQ(out_.client[0].tiles_changed().tiles(2).rect().x(), 1280);
    EXPECT_EQ(from_proto(out_.client[1].placement().rect()), (geom::Rect{0, 0, 1920, 480})) << "it fills the wall";
    EXPECT_EQ(from_proto(out_.client[2].placement().rect()), wanted(2));
    EXPECT_EQ(join("next"), kNext);
    EXPECT_TRUE(wall_.nodes()[kNext].up);
}

TEST_F(AWallThatIsDescribedAnew, LeavesAloneWhoIsDescribedAsBefore) {
    const auto ticket = ticket_of(kLeft);
    describe(kTwoNodes + node_text("next", "1280, 0, 640, 480"));
    EXPECT_TRUE(wall_.nodes()[kLeft].up);
    EXPECT_EQ(wall_.nodes()[kLeft].incarnation, 1u);
    EXPECT_EQ(ticket_of(kLeft), ticket);
    EXPECT_THAT(out_.nodes[kLeft], IsEmpty());
}

TEST_F(AWallThatIsDescribedAnew, OnlyTellsANodeThatItsOutputsShowThemselvesOtherwise) {
    const auto ticket = ticket_of(kLeft);
    describe(std::string(kTwoNodes) + "rotation = 180\n");  // of the last tile
    EXPECT_TRUE(wall_.nodes()[kRight].up);
    EXPECT_EQ(wall_.nodes()[kRight].incarnation, 1u);
    EXPECT_EQ(ticket_of(kLeft), ticket);
    EXPECT_THAT(out_.nodes[kLeft], IsEmpty());
    EXPECT_THAT(out_.client, IsEmpty()) << "nothing of programs' concern";
    ASSERT_EQ(out_.nodes[kRight].size(), 1u);
    const auto& tile = out_.nodes[kRight][0].node_welcome().tiles(0);
    EXPECT_EQ(tile.output().rotation(), 180u);
    EXPECT_EQ(tile.output().width(), 640u);
    describe(kTwoNodes);
    ASSERT_EQ(out_.nodes[kRight].size(), 2u);
    EXPECT_FALSE(out_.nodes[kRight][1].node_welcome().tiles(0).has_output()) << "as it is";
    describe(kTwoNodes);
    EXPECT_EQ(out_.nodes[kRight].size(), 2u) << "nothing has changed";
}

TEST_F(AWallThatIsDescribedAnew, TellsTestPicturesAgainToNodesThatAreWelcomed) {
    proto::TilePattern pattern;
    pattern.set_kind(proto::TilePattern::GRID);
    EXPECT_FALSE(wall_.set_pattern("nowhere", pattern));
    ASSERT_TRUE(wall_.set_pattern("r", pattern));
    ASSERT_EQ(out_.nodes[kRight].size(), 1u);
    EXPECT_EQ(out_.nodes[kRight][0].tile_pattern().kind(), proto::TilePattern::GRID);
    EXPECT_THAT(out_.nodes[kLeft], IsEmpty());
    describe(std::string(kTwoNodes) + "rotation = 180\n");
    ASSERT_EQ(out_.nodes[kRight].size(), 3u);
    EXPECT_TRUE(out_.nodes[kRight][1].has_node_welcome());
    EXPECT_EQ(out_.nodes[kRight][2].tile_pattern().kind(), proto::TilePattern::GRID);
    describe(node_text("left", "0, 0, 640, 480"));
    EXPECT_THAT(wall_.patterns(), IsEmpty()) << "of a tile that is gone";
}

TEST_F(AWallThatIsDescribedAnew, TellsThatATestPictureIsOver) {
    proto::TilePattern pattern;
    pattern.set_kind(proto::TilePattern::GRID);
    ASSERT_TRUE(wall_.set_pattern("r", pattern));
    ASSERT_TRUE(wall_.set_pattern("r", {}));
    EXPECT_EQ(out_.nodes[kRight][1].tile_pattern().kind(), proto::TilePattern::NONE);
    EXPECT_THAT(wall_.patterns(), IsEmpty());
}

TEST_F(AWallThatIsDescribedAnew, TellsProgramsOfOtherTilesWhenTheNodesDrawForThem) {
    const auto ticket = ticket_of(kRight);
    describe("[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"l\"\nrect = [0, 0, 640, 480]\n" +
             node_text("right", "640, 0, 320, 240"));
    EXPECT_TRUE(wall_.nodes()[kRight].up);
    EXPECT_THAT(out_.client, IsEmpty());
    ASSERT_EQ(out_.nodes[kRight].size(), 1u);
    const auto& welcome = out_.nodes[kRight][0].node_welcome();
    EXPECT_EQ(welcome.tiles(0).rect().width(), 320u);
    wall_.node_took_tiles(kRight, welcome.tiles_version() - 1);
    EXPECT_THAT(out_.client, IsEmpty()) << "of earlier ones";
    wall_.node_took_tiles(kRight, welcome.tiles_version());
    EXPECT_EQ(out_.client.at(0).tiles_changed().tiles_size(), 2);
    EXPECT_TRUE(out_.nodes[kRight].back().has_stacking()) << "of the windows there";
    EXPECT_EQ(ticket_of(kRight), ticket);
    EXPECT_EQ(wall_.nodes()[kRight].incarnation, 1u);
    wall_.node_took_tiles(kRight, welcome.tiles_version());
    EXPECT_EQ(out_.client.size(), 3u) << "once";
}

TEST_F(AWallThatIsDescribedAnew, DoesNotWaitForANodeThatLeaves) {
    describe("[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"l\"\nrect = [0, 0, 640, 480]\n" +
             node_text("right", "640, 0, 320, 240"));
    wall_.node_leaves(kRight, now_);
    EXPECT_TRUE(out_.client.at(0).has_tiles_changed());
}

TEST_F(AWallThatIsDescribedAnew, TakesANodeThatWasAwayForOneThatKnowsNothing) {
    wall_.node_leaves(kRight, now_, true);
    describe("[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"l\"\nrect = [0, 0, 640, 480]\n" +
             node_text("right", "640, 0, 320, 240"));
    EXPECT_TRUE(out_.client.at(0).has_tiles_changed());
    join("right");
    EXPECT_EQ(wall_.nodes()[kRight].incarnation, 2u) << "it may have been told to draw for tiles that it did not have";
}

TEST_F(AWallThatIsDescribedAnew, TakesANodeWithAnotherDriverForOneThatKnowsNothing) {
    const auto ticket = ticket_of(kRight);
    describe(
        "[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"l\"\nrect = [0, 0, 640, 480]\n"
        "[[node]]\nname = \"right\"\nbackend = \"osmesa\"\n[[node.tile]]\nname = \"r\"\n"
        "rect = [640, 0, 640, 480]\n");
    EXPECT_FALSE(wall_.nodes()[kRight].up) << "until it comes again";
    EXPECT_EQ(join("right"), kRight) << "even as the same process";
    EXPECT_EQ(wall_.nodes()[kRight].incarnation, 2u);
    EXPECT_NE(ticket_of(kRight), ticket) << "so that what it has of the program is dropped";
    EXPECT_EQ(wall_.nodes()[kLeft].incarnation, 1u);
}

TEST_F(AWallThatIsDescribedAnew, KeepsTheNumbersOfNodes) {
    describe(node_text("next", "0, 0, 640, 480") +
             "[[node]]\nname = \"right\"\n[[node.tile]]\nname = \"r\"\nrect = [640, 0, 640, 480]\n");
    EXPECT_EQ(wall_.nodes()[kLeft].duty, Duty::gone);
    EXPECT_EQ(join("right"), kRight);
    EXPECT_EQ(join("next"), kNext);
    proto::NodeHello hello;
    hello.set_version(wire::kProtocolVersion);
    hello.set_name("left");
    EXPECT_EQ(wall_.check_node(hello).error().message, "node 'left' is not in wall.toml");
    describe(kTwoNodes);
    EXPECT_EQ(join("left"), kLeft) << "its own again";
    EXPECT_EQ(wall_.nodes()[kNext].duty, Duty::gone);
}

TEST_F(AWallThatIsDescribedAnew, GivesAWindowWhosePlaceIsGoneAnotherOne) {
    ASSERT_TRUE(wall_.place_surface({session_, SurfaceId(2)}, {900, 100, 100, 100}));
    describe("[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"l\"\nrect = [0, 0, 640, 480]\n");
    EXPECT_EQ(wanted(1), (geom::Rect{0, 0, 640, 480}));
    EXPECT_LE(wanted(2).right(), 640);
    EXPECT_EQ(wanted(2).width, 100);
}

TEST_F(AWallThatIsDescribedAnew, TellsNodesAnotherBackgroundAndProgramsNothing) {
    describe(std::string("[wall]\nbackground = \"#102030\"\n") + kTwoNodes);
    EXPECT_EQ(out_.nodes[kLeft].at(0).node_welcome().background(), 0x102030u);
    EXPECT_EQ(out_.nodes[kRight].at(0).node_welcome().background(), 0x102030u);
    EXPECT_THAT(out_.client, IsEmpty());
}

TEST_F(AWallThatIsDescribedAnew, LeavesADrainedNodeAlone) {
    const auto ticket = ticket_of(kRight);
    wall_.node_leaves(kRight, now_);
    wall_.set_duty(kRight, Duty::drained);
    out_.client.clear();
    EXPECT_EQ(join("right"), kRight);
    EXPECT_FALSE(wall_.nodes()[kRight].up);
    EXPECT_THAT(out_.client, IsEmpty()) << "programs are not told of it";
    wall_.set_duty(kRight, Duty::serves);
    join("right");
    EXPECT_TRUE(wall_.nodes()[kRight].up);
    EXPECT_NE(ticket_of(kRight), ticket);
    EXPECT_EQ(out_.client.back().node_up().node(), kRight.value);
}

}  // namespace
}  // namespace wall::walld
