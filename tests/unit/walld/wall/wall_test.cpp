// SPDX-License-Identifier: MIT
#include "walld/wall/wall.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

class FakeOutbox : public Outbox {
public:
    void to_node(NodeIndex node, const proto::Envelope& message) override { nodes[node].push_back(message); }
    void to_client(SessionId session, const proto::Envelope& message) override { clients[session].push_back(message); }
    void to_member(SessionId session, Rank rank, const proto::Envelope& message) override {
        clients[session].push_back(message);
        members[{session, rank}].push_back(message);
    }
    void end_session(SessionId session, const std::string& reason) override { ended[session] = reason; }

    std::map<NodeIndex, std::vector<proto::Envelope>> nodes;
    std::map<SessionId, std::vector<proto::Envelope>> clients;
    std::map<std::pair<SessionId, Rank>, std::vector<proto::Envelope>> members;
    std::map<SessionId, std::string> ended;
};

class TheWall : public ::testing::Test {
protected:
    NodeIndex join(const std::string& name, std::uint32_t pid = 100, const std::string& key = "") {
        proto::NodeHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_name(name);
        hello.set_pid(pid);
        hello.set_address("unix:/tmp/" + name);
        hello.set_key(key);
        return *wall_.node_joins(hello, now_);
    }
    SessionId open(const proto::ClientHello& hello = {}) {
        return wall_.open_session(hello, {}, now_, [](SessionId) {});
    }
    geom::Rect open_surface(SessionId id, std::uint32_t surface, std::uint32_t width, std::uint32_t height) {
        proto::SurfaceOpen message;
        message.set_surface(surface);
        message.set_width(width);
        message.set_height(height);
        EXPECT_TRUE(wall_.open_surface(id, message, now_));
        return wall_.find({id, SurfaceId(surface)})->place.wanted();
    }
    /// The program takes the newest placement and draws with it from `frame` on.
    void adopt(SessionId id, std::uint32_t frame) {
        proto::SurfaceAdopted message;
        message.set_surface(1);
        message.set_layout_version(wall_.find({id, SurfaceId(1)})->place.version());
        message.set_frame(frame);
        wall_.adopt_placement(id, message, now_);
    }
    void rendered(NodeIndex node, SessionId id, std::uint32_t frame) {
        proto::Rendered report;
        report.set_session(id.value);
        report.set_surface(1);
        report.set_frame(frame);
        wall_.node_rendered(node, report, now_);
    }
    const proto::Envelope& last_to_node(NodeIndex node) { return out_.nodes[node].back(); }
    const proto::Envelope& last_to_client(SessionId id) { return out_.clients[id].back(); }

    FakeOutbox out_;
    Clock::time_point now_{};
    int tickets_ = 0;
    Wall wall_{*config::parse_config(kTwoNodes, "test"), out_,
               [this](std::size_t n) { return std::string(n, static_cast<char>('a' + tickets_++)); }};
};

TEST_F(TheWall, WelcomesANodeWithItsTiles) {
    EXPECT_EQ(join("right"), kRight);
    const auto& welcome = out_.nodes[kRight][0].node_welcome();
    EXPECT_EQ(welcome.node(), 1u);
    ASSERT_EQ(welcome.tiles_size(), 1);
    EXPECT_EQ(welcome.tiles(0).rect().x(), 640);
}

TEST_F(TheWall, RefusesNodesItDoesNotKnowOrHasAlready) {
    join("left");
    proto::NodeHello hello;
    hello.set_version(wire::kProtocolVersion);
    hello.set_name("left");
    EXPECT_FALSE(wall_.node_joins(hello, now_));
    hello.set_name("middle");
    EXPECT_FALSE(wall_.node_joins(hello, now_));
    hello.set_name("right");
    hello.set_version(wire::kProtocolVersion + 1);
    EXPECT_FALSE(wall_.node_joins(hello, now_));
}

TEST_F(TheWall, AProcessThatWasStartedLaterTakesTheNodesPlace) {
    const auto left = join("left", 1);
    const auto id = open();
    proto::NodeHello hello;
    hello.set_version(wire::kProtocolVersion);
    hello.set_name("left");
    hello.set_pid(2);
    hello.set_started_us(1000);
    ASSERT_TRUE(wall_.node_joins(hello, now_)) << "the link of the one before may be dead";
    EXPECT_EQ(last_to_client(id).node_up().incarnation(), 2u);
    EXPECT_EQ(wall_.node_joins(hello, now_), left) << "the same one on another link";
    EXPECT_EQ(last_to_client(id).node_up().incarnation(), 2u);
    hello.set_pid(3);
    hello.set_started_us(999);
    EXPECT_FALSE(wall_.node_joins(hello, now_));
    hello.set_pid(2);
    EXPECT_FALSE(wall_.node_joins(hello, now_)) << "the number of a process may be given again";
}

TEST_F(TheWall, ANodeThatComesBackHasTheSameIndexAndAHigherIncarnation) {
    const auto left = join("left", 1);
    const auto id = open();
    wall_.node_leaves(left, now_);
    EXPECT_EQ(last_to_client(id).node_down().node(), left.value);
    EXPECT_EQ(join("left", 2), left);
    EXPECT_EQ(last_to_client(id).node_up().incarnation(), 2u);
    EXPECT_NE(last_to_client(id).node_up().ticket(), out_.clients[id][0].client_welcome().nodes(0).ticket());
}

TEST_F(TheWall, AProcessThatOnlyLostItsConnectionIsTheSameIncarnationWithTheSameTicket) {
    const auto left = join("left", 1);
    const auto id = open();
    wall_.node_leaves(left, now_);
    join("left", 1);
    EXPECT_EQ(last_to_client(id).node_up().incarnation(), 1u);
    EXPECT_EQ(last_to_client(id).node_up().ticket(), out_.clients[id][0].client_welcome().nodes(0).ticket());
}

TEST_F(TheWall, ATicketIsWithTheNodeAndTheClientAndDiffersByNode) {
    join("left");
    join("right");
    const auto id = open();
    const auto& welcome = out_.clients[id][0].client_welcome();
    EXPECT_EQ(welcome.canvas_width(), 1280u);
    ASSERT_EQ(welcome.nodes_size(), 2);
    EXPECT_EQ(welcome.nodes(0).ticket().size(), Wall::kTicketBytes);
    EXPECT_NE(welcome.nodes(0).ticket(), welcome.nodes(1).ticket());
    EXPECT_EQ(last_to_node(kLeft).ticket().ticket(), welcome.nodes(0).ticket());
    EXPECT_EQ(last_to_node(kRight).ticket().ticket(), welcome.nodes(1).ticket());
}

TEST_F(TheWall, TellsNodesOfASortLastProgramOfEachOther) {
    join("left");
    join("right");
    const auto usual = open();
    EXPECT_TRUE(std::ranges::none_of(out_.nodes[kLeft], &proto::Envelope::has_peers));
    proto::ClientHello hello;
    hello.set_version(wire::kProtocolVersion);
    hello.set_sort_last(true);
    const auto id = open(hello);
    EXPECT_NE(id, usual);
    const auto& welcome = out_.clients[id][0].client_welcome();
    const auto told = [&](NodeIndex node) {
        const auto& heard = out_.nodes[node];
        const auto last = std::find_if(heard.rbegin(), heard.rend(), [](const auto& m) { return m.has_peers(); });
        return last == heard.rend() ? proto::Peers() : last->peers();
    };
    for (const NodeIndex node : {kLeft, kRight}) {
        ASSERT_EQ(told(node).nodes_size(), 2);
        EXPECT_EQ(told(node).session(), id.value);
        for (int i = 0; i < 2; ++i) EXPECT_EQ(told(node).nodes(i).ticket(), welcome.nodes(i).ticket());
    }
    EXPECT_TRUE(welcome.nodes(0).renders());
    wall_.node_leaves(kRight, now_);
    ASSERT_EQ(told(kLeft).nodes_size(), 1) << "at once, so that nobody waits for what it draws";
    EXPECT_EQ(told(kLeft).nodes(0).node(), kLeft.value);
    join("right", 7);
    ASSERT_EQ(told(kLeft).nodes_size(), 2);
    EXPECT_NE(told(kLeft).nodes(1).ticket(), welcome.nodes(1).ticket()) << "it is another process";
}

TEST_F(TheWall, LetsNodesOfOtherMachinesHandOn) {
    join("left", 1, "a key");
    const auto id = open();
    EXPECT_FALSE(out_.clients[id][0].client_welcome().nodes(0).hands_on()) << "there is nobody else";
    join("right", 2, "another key");
    for (const NodeIndex node : {kLeft, kRight}) {
        const auto& heard = out_.clients[id];
        const auto told = std::find_if(heard.rbegin(), heard.rend(), [&](const auto& message) {
            return message.has_node_up() && message.node_up().node() == node.value;
        });
        ASSERT_NE(told, heard.rend());
        EXPECT_TRUE(told->node_up().hands_on());
        EXPECT_TRUE(std::ranges::any_of(out_.nodes[node], [](const auto& m) { return m.peers().nodes_size() == 2; }));
        EXPECT_TRUE(std::ranges::any_of(out_.nodes[node], [](const auto& m) {
            return m.ticket().peer_keys_size() == 2;
        })) << "each knows who may come to it";
    }
    proto::ClientHello parallel;
    parallel.set_version(wire::kProtocolVersion);
    parallel.mutable_group()->set_name("g");
    parallel.mutable_group()->set_members(2);
    const auto group = open(parallel);
    EXPECT_FALSE(out_.members[std::pair(group, Rank())][0].client_welcome().nodes(0).hands_on())
        << "its processes wait for each other on each node";
}

TEST_F(TheWall, PlacesWindowsSideBySideOnTopOfEachOther) {
    join("left");
    const auto id = open();
    EXPECT_EQ(open_surface(id, 1, 300, 300), (geom::Rect{0, 0, 300, 300}));
    EXPECT_EQ(open_surface(id, 2, 300, 300), (geom::Rect{300, 0, 300, 300}));
    const auto& stacking = last_to_node(kLeft).stacking();
    ASSERT_EQ(stacking.entries_size(), 2);
    EXPECT_EQ(stacking.entries(1).surface(), 2u);
}

TEST_F(TheWall, TheWantedRectangleGoesToTheFirstWindowOnly) {
    join("left");
    proto::ClientHello hello;
    hello.set_fullscreen(true);
    const auto id = open(hello);
    EXPECT_EQ(open_surface(id, 1, 300, 300), (geom::Rect{0, 0, 1280, 480}));
    EXPECT_EQ(open_surface(id, 2, 300, 300).width, 300);
    wall_.close_surface(id, SurfaceId(1));
    EXPECT_EQ(open_surface(id, 3, 300, 300), (geom::Rect{0, 0, 1280, 480}))
        << "a probe window was closed; this is the real one";
}

TEST_F(TheWall, ARectangleMustBePossible) {
    proto::ClientHello hello;
    hello.set_version(wire::kProtocolVersion);
    EXPECT_TRUE(wall_.check(hello));
    hello.mutable_rect()->set_width(10);
    EXPECT_FALSE(wall_.check(hello)) << "no height";
    hello.mutable_rect()->set_height(10);
    EXPECT_TRUE(wall_.check(hello));
    hello.mutable_rect()->set_x(INT32_MAX);
    EXPECT_FALSE(wall_.check(hello));
    hello.mutable_rect()->set_x(1280);
    EXPECT_FALSE(wall_.check(hello)) << "beyond the canvas";
    hello.mutable_rect()->set_x(1279);
    EXPECT_TRUE(wall_.check(hello));
    hello.clear_rect();
    hello.set_version(wire::kProtocolVersion + 1);
    EXPECT_FALSE(wall_.check(hello));
}

TEST_F(TheWall, AllowsNoMoreLossThanItsDescriptionDoes) {
    proto::ClientHello hello;
    hello.set_version(wire::kProtocolVersion);
    hello.set_lossy_pixels(0);
    EXPECT_TRUE(wall_.check(hello));
    hello.set_lossy_pixels(0.25f);
    const auto refused = wall_.check(hello);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, RefusalKind::forbidden);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("up to 0.25 pixels off, and the wall allows 0;"));
    hello.mutable_resume()->set_session(4);
    EXPECT_TRUE(wall_.check(hello)) << "it was let in when more was allowed";
    for (const float wrong : {-1.0f, 17.0f, NAN}) {
        hello.set_lossy_pixels(wrong);
        EXPECT_EQ(wall_.check(hello).error().kind, RefusalKind::invalid) << wrong;
    }
}

TEST_F(TheWall, APlacementFollowsTheWindowUnlessItIsScaled) {
    join("left");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    proto::SurfaceResize resize;
    resize.set_surface(1);
    resize.set_width(400);
    resize.set_height(200);
    wall_.resize_surface(id, resize);
    EXPECT_EQ(last_to_client(id).placement().rect().width(), 400u);
    EXPECT_EQ(last_to_client(id).placement().layout_version(), 2u);
    ASSERT_TRUE(wall_.place_surface({id, {}}, {10, 20, 100, 50}));
    wall_.resize_surface(id, resize);
    EXPECT_EQ(last_to_client(id).placement().rect().width(), 100u);
    EXPECT_EQ(last_to_client(id).placement().layout_version(), 4u) << "a resize is always answered";
}

TEST_F(TheWall, ANodeShowsOnlyWhatLiesOnIt) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    EXPECT_EQ(last_to_node(kLeft).stacking().entries_size(), 1);
    EXPECT_EQ(last_to_node(kRight).stacking().entries_size(), 0);
    ASSERT_TRUE(wall_.place_surface({id, {}}, {700, 0, 300, 300}));
    adopt(id, 1);
    EXPECT_EQ(last_to_node(kLeft).stacking().entries_size(), 0) << "it has moved away";
    EXPECT_EQ(last_to_node(kRight).stacking().entries_size(), 1);
}

TEST_F(TheWall, AMovedWindowStaysInSightUntilItsFirstFrameAtTheNewPlaceIsPresented) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    rendered(kLeft, id, 1);
    ASSERT_TRUE(wall_.place_surface({id, {}}, {700, 0, 300, 300}));
    EXPECT_EQ(last_to_client(id).placement().rect().x(), 700);
    EXPECT_EQ(last_to_client(id).placement().layout_version(), 2u);
    const auto& place = wall_.find({id, SurfaceId(1)})->place;
    EXPECT_TRUE(place.moving());
    adopt(id, 3);
    EXPECT_EQ(last_to_client(id).adoption_noted().layout_version(), 2u);
    rendered(kLeft, id, 2);
    EXPECT_EQ(last_to_node(kLeft).present().frame(), 2u) << "a frame of the old layout is the old nodes' business";
    EXPECT_EQ(place.shown().x, 0);
    out_.nodes.clear();
    rendered(kRight, id, 3);
    ASSERT_EQ(out_.nodes[kLeft].size(), 1u);
    EXPECT_EQ(out_.nodes[kLeft][0].stacking().entries_size(), 0);
    ASSERT_EQ(out_.nodes[kRight].size(), 2u);
    EXPECT_EQ(out_.nodes[kRight][0].stacking().entries_size(), 1) << "stacked before it is shown";
    EXPECT_EQ(out_.nodes[kRight][1].present().frame(), 3u);
    EXPECT_FALSE(place.moving());
}

TEST_F(TheWall, TheFirstFrameAtANewPlaceWaitsForAllItsNodes) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    rendered(kLeft, id, 1);
    ASSERT_TRUE(wall_.place_surface({id, {}}, {500, 0, 300, 300}));
    adopt(id, 2);
    out_.nodes.clear();
    rendered(kLeft, id, 2);
    EXPECT_TRUE(out_.nodes[kLeft].empty()) << "the other half is not there yet";
    rendered(kRight, id, 2);
    EXPECT_EQ(last_to_node(kLeft).present().frame(), 2u);
    EXPECT_EQ(last_to_node(kRight).present().frame(), 2u);
}

TEST_F(TheWall, AWindowThatMovesToWhereNoNodeIsDisappears) {
    join("left");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    rendered(kLeft, id, 1);
    ASSERT_TRUE(wall_.place_surface({id, {}}, {700, 0, 300, 300}));
    adopt(id, 2);
    EXPECT_EQ(last_to_node(kLeft).stacking().entries_size(), 0);
    EXPECT_FALSE(wall_.find({id, SurfaceId(1)})->place.moving());
    join("right");
    rendered(kRight, id, 5);
    EXPECT_EQ(last_to_node(kRight).present().frame(), 5u) << "and comes back with its node";
}

TEST_F(TheWall, ALayoutVersionThatWasNeverGivenIsNotAdopted) {
    join("left");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    proto::SurfaceAdopted message;
    message.set_surface(1);
    for (const std::uint32_t version : {0u, 1u, 2u, UINT32_MAX}) {
        message.set_layout_version(version);
        wall_.adopt_placement(id, message, now_);
    }
    message.set_surface(9);
    wall_.adopt_placement(id, message, now_);
    EXPECT_EQ(wall_.find({id, SurfaceId(1)})->place.shown(), (geom::Rect{0, 0, 300, 300}));
}

TEST_F(TheWall, APlacementThatCannotBeChangesNothing) {
    join("left");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    const auto messages = out_.clients[id].size();
    for (const geom::Rect rect : {geom::Rect{0, 0, 0, 10},
                                  {0, 0, 10, -1},
                                  {1280, 0, 10, 10},
                                  {0, -10, 10, 10},
                                  {-2000000000, 0, 10, 10},
                                  {0, 0, 2000000000, 10}}) {
        const auto placed = wall_.place_surface({id, {}}, rect);
        ASSERT_FALSE(placed);
        EXPECT_EQ(placed.error().kind, RefusalKind::invalid);
    }
    EXPECT_EQ(wall_.place_surface({SessionId(7), {}}, {0, 0, 10, 10}).error().kind, RefusalKind::not_found);
    EXPECT_EQ(wall_.place_surface({id, SurfaceId(2)}, {0, 0, 10, 10}).error().kind, RefusalKind::not_found);
    EXPECT_EQ(wall_.place_surface({open(), {}}, {0, 0, 10, 10}).error().kind, RefusalKind::conflict) << "no window yet";
    EXPECT_EQ(out_.clients[id].size(), messages);
    EXPECT_FALSE(wall_.find({id, SurfaceId(1)})->place.moving());
}

TEST_F(TheWall, TellsNodesASessionsWeightWithTheTicketThatTheyHave) {
    join("left");
    const auto id = open();
    const auto ticket = last_to_node(kLeft).ticket();
    EXPECT_EQ(ticket.weight(), wire::kUsualWeight);
    ASSERT_TRUE(wall_.set_weight({id, {}}, 30));
    EXPECT_EQ(last_to_node(kLeft).ticket().weight(), 30u);
    EXPECT_EQ(last_to_node(kLeft).ticket().ticket(), ticket.ticket());
    join("right");
    const auto& heard = out_.nodes[kRight];
    const auto told = std::ranges::find_if(heard, &proto::Envelope::has_ticket);
    ASSERT_NE(told, heard.end());
    EXPECT_EQ(told->ticket().weight(), 30u) << "who comes later as well";
    EXPECT_EQ(wall_.set_weight({SessionId(7), {}}, 30).error().kind, RefusalKind::not_found);
}

TEST_F(TheWall, TellsAProgramHowItsPicturesForTwoEyesAreApart) {
    join("left");
    const auto id = open();
    open_surface(id, 1, 100, 100);
    proto::Stereo stereo;
    stereo.set_separation(0.02f);
    stereo.set_screen(5);
    ASSERT_TRUE(wall_.set_stereo({id, {}}, stereo));
    const auto placement = last_to_client(id).placement();
    EXPECT_EQ(placement.stereo().separation(), 0.02f);
    EXPECT_EQ(placement.stereo().screen(), 5);
    const auto& place = wall_.find({id, SurfaceId(1)})->place;
    EXPECT_EQ(placement.layout_version(), place.version()) << "it is a placement like others";
    ASSERT_TRUE(wall_.set_stereo({id, {}}, std::nullopt));
    EXPECT_FALSE(last_to_client(id).placement().has_stereo());
    EXPECT_GT(place.version(), placement.layout_version());
    EXPECT_EQ(wall_.set_stereo({SessionId(7), {}}, stereo).error().kind, RefusalKind::not_found);
}

TEST_F(TheWall, AsksAProgramToGoToAnotherWallAndKeepsItsAnswer) {
    join("left");
    const auto id = open();
    ASSERT_TRUE(wall_.ask_to_move({id, {}}, "unix:/b/walld.sock"));
    EXPECT_EQ(last_to_client(id).move_request().address(), "unix:/b/walld.sock");
    EXPECT_EQ(wall_.take_move_answer(id), std::nullopt) << "it has not said anything yet";
    proto::MoveAnswer answer;
    answer.set_refused("no way");
    wall_.move_answered(id, answer);
    EXPECT_EQ(wall_.take_move_answer(id), "no way");
    EXPECT_EQ(wall_.take_move_answer(id), std::nullopt) << "whoever asked has been told";
    wall_.move_answered(id, answer);
    ASSERT_TRUE(wall_.ask_to_move({id, {}}, "unix:/c/walld.sock"));
    EXPECT_EQ(wall_.take_move_answer(id), std::nullopt) << "an answer to an older question is none";
    EXPECT_EQ(wall_.ask_to_move({SessionId(7), {}}, "unix:/b").error().kind, RefusalKind::not_found);
}

TEST_F(TheWall, TakesStereoFromAProgramThatComesUnlessItCannotBe) {
    join("left");
    const auto stereo_of = [&](float separation, float screen) {
        proto::ClientHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.mutable_stereo()->set_separation(separation);
        hello.mutable_stereo()->set_screen(screen);
        return wall_.sessions().at(open(hello)).stereo.has_value();
    };
    EXPECT_TRUE(stereo_of(-0.02f, 0));
    EXPECT_FALSE(stereo_of(2, 1));
    EXPECT_FALSE(stereo_of(0.01f, std::numeric_limits<float>::quiet_NaN()));
    EXPECT_FALSE(stereo_of(std::numeric_limits<float>::quiet_NaN(), 1));
}

TEST_F(TheWall, TakesNoMoreSessionsThanItsLimit) {
    join("left");
    proto::ClientHello hello;
    hello.set_version(wire::kProtocolVersion);
    SessionId last;
    while (wall_.check(hello)) last = open(hello);
    EXPECT_EQ(wall_.sessions().size(), wall_.config().max_sessions);
    const auto full = wall_.check(hello);
    EXPECT_EQ(full.error().kind, RefusalKind::unavailable);
    EXPECT_NE(full.error().message.find("'max_sessions'"), std::string::npos);
    wall_.close_session(last);
    EXPECT_TRUE(wall_.check(hello));
}

TEST_F(TheWall, ALayoutBringsWindowsBackAndWaitsForThoseThatAreMissing) {
    join("left");
    const auto named = [](const char* program, const char* name) {
        proto::ClientHello hello;
        hello.set_program(program);
        hello.set_name(name);
        return hello;
    };
    const auto gears = open(named("glxgears", "")), map = open(named("viewer", "map"));
    open_surface(gears, 1, 100, 100);
    open_surface(map, 1, 100, 100);
    ASSERT_TRUE(wall_.place_surface({map, {}}, {600, 10, 200, 300}));
    ASSERT_TRUE(wall_.lower({map, {}}));
    const auto layout = wall_.current_layout();
    ASSERT_EQ(layout.windows.size(), 2u);

    ASSERT_TRUE(wall_.place_surface({map, {}}, {0, 0, 10, 10}));
    ASSERT_TRUE(wall_.place_surface({gears, {}}, {0, 0, 10, 10}));
    ASSERT_TRUE(wall_.raise({map, {}}));
    wall_.close_session(gears);
    EXPECT_EQ(wall_.load_layout(layout), 1u);
    EXPECT_EQ(wall_.find({map, SurfaceId(1)})->place.wanted(), (geom::Rect{600, 10, 200, 300}));
    const auto other = open(named("atlantis", ""));
    open_surface(other, 1, 50, 50);
    const auto again = open(named("glxgears", ""));
    EXPECT_EQ(open_surface(again, 1, 120, 90), (geom::Rect{0, 0, 120, 90})) << "as large as its window, as it was then";
    const auto position = [&](SessionId id) {
        return std::ranges::find(wall_.stacking(), SurfaceKey{id, SurfaceId(1)}) - wall_.stacking().begin();
    };
    EXPECT_LT(position(map), position(again));
    EXPECT_EQ(open_surface(open(named("glxgears", "")), 1, 120, 90).x, 120) << "that place is taken";
}

TEST_F(TheWall, RefusesSurfacesThatCannotBe) {
    join("left");
    const auto id = open();
    proto::SurfaceOpen message;
    EXPECT_FALSE(wall_.open_surface(id, message, now_));
    message.set_surface(1);
    EXPECT_FALSE(wall_.open_surface(id, message, now_)) << "no size";
    message.set_width(1u << 31);
    message.set_height(1);
    EXPECT_FALSE(wall_.open_surface(id, message, now_));
    open_surface(id, 1, 10, 10);
    message.set_width(10);
    EXPECT_FALSE(wall_.open_surface(id, message, now_)) << "the number is in use";
}

TEST_F(TheWall, PresentsWhatTheNodesUnderASurfaceHaveRendered) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 800, 300);
    rendered(kLeft, id, 1);
    EXPECT_FALSE(last_to_node(kLeft).has_present());
    rendered(kRight, id, 1);
    EXPECT_EQ(last_to_node(kLeft).present().frame(), 1u);
    EXPECT_EQ(last_to_node(kRight).present().frame(), 1u);
}

TEST_F(TheWall, ASurfaceOnOneTileWaitsForThatOneOnly) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    rendered(kLeft, id, 1);
    EXPECT_EQ(last_to_node(kLeft).present().frame(), 1u);
    EXPECT_FALSE(last_to_node(kRight).has_present());
}

TEST_F(TheWall, ADeadlinePassesTheFrameOn) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 800, 300);
    rendered(kLeft, id, 1);
    ASSERT_EQ(wall_.next_deadline(), now_ + wall_.config().swap_timeout);
    wall_.tick(now_ + wall_.config().swap_timeout);
    EXPECT_EQ(last_to_node(kLeft).present().frame(), 1u);
    EXPECT_FALSE(wall_.next_deadline());
}

TEST_F(TheWall, AnEndedSessionIsTakenFromTheNodes) {
    join("left");
    const auto id = open();
    open_surface(id, 1, 300, 300);
    wall_.close_session(id);
    auto& sent = out_.nodes[kLeft];
    EXPECT_EQ(sent[sent.size() - 2].session_end().session(), id.value);
    EXPECT_EQ(sent.back().stacking().entries_size(), 0);
    EXPECT_TRUE(wall_.sessions().empty());
}

TEST_F(TheWall, RaiseLowerAndHoldNeedARealSession) {
    join("left");
    const auto a = open(), b = open();
    open_surface(a, 1, 10, 10);
    open_surface(b, 1, 10, 10);
    ASSERT_TRUE(wall_.raise({a, {}}));
    EXPECT_EQ(last_to_node(kLeft).stacking().entries(1).session(), a.value);
    ASSERT_TRUE(wall_.lower({a, {}}));
    EXPECT_EQ(last_to_node(kLeft).stacking().entries(0).session(), a.value);
    const Target nobody{SessionId(99), {}}, no_window{a, SurfaceId(9)};
    for (const auto& wrong : {nobody, no_window}) {
        EXPECT_FALSE(wall_.raise(wrong));
        EXPECT_FALSE(wall_.lower(wrong));
        EXPECT_FALSE(wall_.hold(wrong, true, now_));
        EXPECT_FALSE(wall_.step(wrong, 1, now_));
        EXPECT_FALSE(wall_.place_surface(wrong, {0, 0, 1, 1}));
    }
}

TEST_F(TheWall, AHeldSessionStartsHeld) {
    join("left");
    proto::ClientHello hello;
    hello.set_hold(true);
    const auto id = open(hello);
    open_surface(id, 1, 10, 10);
    rendered(kLeft, id, 1);
    EXPECT_FALSE(last_to_node(kLeft).has_present());
    ASSERT_TRUE(wall_.step({id, {}}, 1, now_));
    EXPECT_EQ(last_to_node(kLeft).present().frame(), 1u);
}

TEST_F(TheWall, SaysWhatThereIs) {
    join("left");
    proto::ClientHello hello;
    hello.set_program("gears");
    hello.set_name("\xff not UTF-8");
    const auto id = open(hello);
    open_surface(id, 1, 300, 300);
    proto::NodeStats stats;
    stats.add_transports()->set_name("ring");
    stats.mutable_transports(0)->set_streams(2);
    wall_.node_reports(kLeft, stats);
    const auto status = status_json(wall_, now_);
    EXPECT_NE(dump(status).find("not UTF-8"), std::string::npos);
    EXPECT_EQ(status["wall"]["width"], 1280);
    EXPECT_EQ(status["nodes"].size(), 2u);
    EXPECT_EQ(status["nodes"][0]["transports"]["ring"], 2);
    EXPECT_EQ(status["tiles"][1]["up"], false);
    EXPECT_EQ(status["tiles"][0]["age_ms"], nullptr);
    EXPECT_EQ(status["sessions"][0]["surfaces"][0]["id"], "1.1");
    EXPECT_EQ(status["sessions"][0]["traffic"]["frame_bytes"], 0);
}

TEST_F(TheWall, ANewProcessOfANodeBeginsWithoutTheOldFigures) {
    const auto left = join("left", 1);
    proto::NodeStats stats;
    stats.set_frames(5);
    wall_.node_reports(left, stats);
    wall_.node_leaves(left, now_);
    join("left", 1);
    EXPECT_EQ(wall_.nodes()[left].stats.frames(), 5u) << "the same process";
    wall_.node_leaves(left, now_);
    join("left", 2);
    EXPECT_EQ(wall_.nodes()[left].stats.frames(), 0u);
}

TEST_F(TheWall, KnowsWhatEachTileShows) {
    join("left");
    join("right");
    const auto id = open();
    open_surface(id, 1, 1280, 480);
    EXPECT_FALSE(wall_.nodes()[kLeft].shown_in(0).last);
    rendered(kLeft, id, 1);
    rendered(kRight, id, 1);
    EXPECT_EQ(wall_.nodes()[kRight].shown_in(0).last, now_);
    rendered(kLeft, id, 2);
    now_ += std::chrono::seconds(1);
    wall_.tick(now_);
    EXPECT_EQ(wall_.nodes()[kLeft].shown_in(0).frames, 2u);
    EXPECT_EQ(wall_.nodes()[kLeft].shown_in(0).last, now_);
    EXPECT_EQ(wall_.nodes()[kRight].shown_in(0).frames, 1u) << "its node is late";
    EXPECT_EQ(wall_.tile_lag(kLeft, wall_.nodes()[kLeft].config->tiles[0]), 0u);
    EXPECT_EQ(wall_.tile_lag(kRight, wall_.nodes()[kRight].config->tiles[0]), 1u);
    rendered(kRight, id, 2);
    EXPECT_EQ(wall_.tile_lag(kRight, wall_.nodes()[kRight].config->tiles[0]), 0u);
}

// ---- parallel programs ----

class AParallelProgram : public TheWall {
protected:
    static proto::ClientHello member(std::uint32_t rank, std::uint32_t members = 2) {
        proto::ClientHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_pid(1000 + rank);
        hello.mutable_group()->set_name("march-1");
        hello.mutable_group()->set_rank(rank);
        hello.mutable_group()->set_members(members);
        return hello;
    }
    /// Both members come and open window 1.
    SessionId start() {
        const auto id = open(member(0));
        EXPECT_EQ(open(member(1)), id);
        for (const Rank rank : {0u, 1u}) open_window(id, rank, 300, 200);
        note_all(id);
        return id;
    }
    void open_window(SessionId id, Rank rank, std::uint32_t width, std::uint32_t height) {
        proto::SurfaceOpen message;
        message.set_surface(1);
        message.set_width(width);
        message.set_height(height);
        EXPECT_TRUE(wall_.open_surface(id, message, now_, rank));
    }
    void note(SessionId id, Rank rank, std::uint32_t version) {
        proto::PlacementNoted message;
        message.set_surface(1);
        message.set_layout_version(version);
        wall_.placement_noted(id, rank, message);
    }
    void note_all(SessionId id) {
        for (const Rank rank : {0u, 1u}) note(id, rank, wall_.find({id, SurfaceId(1)})->place.version());
    }
    std::uint32_t presented(SessionId id) { return wall_.find({id, SurfaceId(1)})->swap.presented(); }
    const Person alice_{Person::Kind::unix_user, "alice", 1000, Role::user};
    const Person bob_{Person::Kind::unix_user, "bob", 1001, Role::user};
};

TEST_F(AParallelProgram, IsOneSessionWithOneWindow) {
    join("left");
    const auto id = start();
    EXPECT_EQ(wall_.sessions().size(), 1u);
    EXPECT_EQ(wall_.stacking().size(), 1u);
    for (const Rank rank : {0u, 1u}) {
        const auto& sent = out_.members[{id, rank}];
        ASSERT_EQ(sent.size(), rank == 0 ? 2u : 3u) << "a welcome and the placement, and the note that others have";
        EXPECT_TRUE(rank == 0 || sent[2].has_surface_note());
        EXPECT_EQ(sent[0].client_welcome().session(), id.value);
        EXPECT_EQ(sent[1].placement().width(), 300u);
        EXPECT_EQ(sent[1].placement().from_frame(), 0u);
        EXPECT_EQ(sent[1].placement().nodes_size(), 1);
    }
    EXPECT_EQ(sessions_json(wall_)[0]["group"]["members"][1]["pid"], 1001);
}

TEST_F(AParallelProgram, BelongsToItsFirstMembersOwner) {
    join("left");
    wall_.open_session(member(0), alice_, now_, [](SessionId) {});
    EXPECT_TRUE(wall_.check_member(member(1), alice_));
    EXPECT_EQ(wall_.check_member(member(1), bob_).error().kind, RefusalKind::forbidden);
    EXPECT_EQ(wall_.check_member(member(0), alice_).error().kind, RefusalKind::conflict);
    EXPECT_EQ(wall_.check_member(member(1, 3), alice_).error().kind, RefusalKind::conflict);
    EXPECT_TRUE(wall_.check_member({}, bob_));
}

TEST_F(AParallelProgram, MovesAtAFrameThatNoMemberHasBegun) {
    join("left");
    join("right", 101);
    const auto id = start();
    const auto render = [&](std::uint32_t frame) {
        for (const NodeIndex node : {kLeft, kRight}) rendered(node, id, frame);
    };
    for (std::uint32_t frame = 1; frame <= 10; ++frame) render(frame);
    EXPECT_EQ(presented(id), 10u) << "of both nodes, though the window lies on one";
    ASSERT_TRUE(wall_.place_surface({id, {}}, {700, 0, 300, 200}));
    EXPECT_EQ(out_.clients[id].back().placement().from_frame(), 15u);
    EXPECT_FALSE(out_.clients[id].back().placement().agreed());
    const auto version = out_.clients[id].back().placement().layout_version();
    note(id, 1, version);
    EXPECT_FALSE(out_.clients[id].back().has_placement_agreed());
    note(id, 0, version);
    EXPECT_EQ(out_.clients[id].back().placement_agreed().layout_version(), version);
    for (std::uint32_t frame = 11; frame <= 14; ++frame) render(frame);
    EXPECT_EQ(wall_.find({id, SurfaceId(1)})->place.shown().x, 0);
    render(15);
    EXPECT_EQ(wall_.find({id, SurfaceId(1)})->place.shown().x, 700);
}

TEST_F(AParallelProgram, IsAskedAgainWhereAMemberHasBegunThatFrame) {
    join("left");
    const auto id = start();
    ASSERT_TRUE(wall_.place_surface({id, {}}, {100, 0, 300, 200}));
    const auto first = out_.clients[id].back().placement();
    note(id, 0, first.layout_version());
    proto::PlacementNoted late;
    late.set_surface(1);
    late.set_layout_version(first.layout_version());
    late.set_begun(40);  // nodes have presented by themselves meanwhile
    wall_.placement_noted(id, 1, late);
    const auto second = out_.clients[id].back().placement();
    EXPECT_EQ(second.from_frame(), 45u);
    EXPECT_GT(second.layout_version(), first.layout_version());
    EXPECT_EQ(second.rect().x(), 100);
    note(id, 1, first.layout_version());
    EXPECT_FALSE(out_.clients[id].back().has_placement_agreed());
    note_all(id);
    EXPECT_EQ(out_.clients[id].back().placement_agreed().layout_version(), second.layout_version());
}

TEST_F(AParallelProgram, ComesToANewNodeAtTheSameFrame) {
    join("left");
    const auto id = start();
    rendered(kLeft, id, 1);
    join("right", 101);
    const auto& placement = out_.clients[id].back().placement();
    EXPECT_EQ(placement.from_frame(), 6u);
    EXPECT_EQ(placement.nodes_size(), 2);
    EXPECT_EQ(out_.nodes[kRight][1].ticket().members(), 2u);
}

TEST_F(AParallelProgram, HasTheSizeOfRank0sWindow) {
    join("left");
    const auto id = open(member(0));
    open(member(1));
    open_window(id, 1, 100, 100);
    open_window(id, 0, 300, 200);
    EXPECT_EQ(wall_.find({id, SurfaceId(1)})->width, 300u);
    proto::SurfaceResize resize;
    resize.set_surface(1);
    resize.set_width(50);
    resize.set_height(60);
    wall_.resize_surface(id, resize, 1);
    EXPECT_EQ(wall_.find({id, SurfaceId(1)})->width, 300u);
    wall_.resize_surface(id, resize, 0);
    EXPECT_EQ(wall_.find({id, SurfaceId(1)})->width, 50u);
}

TEST_F(AParallelProgram, EndsAsAWholeWhenAMemberIsGone) {
    join("left");
    const auto id = start();
    EXPECT_NE(wall_.member_gone(id, 1).find("rank 1 (process 1001)"), std::string::npos);
    EXPECT_NE(out_.ended[id].find("ended without leaving"), std::string::npos);
    EXPECT_TRUE(wall_.sessions().empty());
    wall_.member_gone(id, 0);
}

TEST_F(AParallelProgram, GoesOnWithoutAMemberThatLeaves) {
    join("left");
    const auto id = start();
    wall_.close_surface(id, SurfaceId(1), 1);
    EXPECT_EQ(wall_.stacking().size(), 1u) << "rank 0 still has it";
    wall_.member_leaves(id, 1);
    wall_.member_gone(id, 1);
    EXPECT_EQ(wall_.sessions().size(), 1u);
    join("right", 101);
    EXPECT_EQ(out_.nodes[kRight][1].ticket().left(0), 1u);
    wall_.close_surface(id, SurfaceId(1), 0);
    EXPECT_TRUE(wall_.stacking().empty());
    wall_.member_leaves(id, 0);
    wall_.member_gone(id, 0);
    EXPECT_TRUE(wall_.sessions().empty());
    EXPECT_TRUE(out_.ended.empty());
}

TEST_F(AParallelProgram, EndsWhenNotAllMembersCome) {
    join("left");
    const auto id = open(member(0));
    EXPECT_EQ(wall_.next_deadline(), now_ + Wall::kMembersLimit);
    wall_.tick(now_ + Wall::kMembersLimit);
    EXPECT_NE(out_.ended[id].find("only 1 of 2 processes"), std::string::npos);
    EXPECT_TRUE(wall_.sessions().empty());
}

TEST_F(AParallelProgram, EndsWithANodesFault) {
    join("left");
    const auto id = start();
    proto::SessionFault fault;
    fault.set_session(id.value);
    fault.set_reason("Bad: bad");
    wall_.node_faults(kLeft, fault);
    EXPECT_EQ(out_.ended[id], "left: Bad: bad");
}

TEST_F(TheWall, EndsAProgramThatKeptANodeForItself) {
    const auto node = join("left");
    const auto id = open();
    proto::SessionFault fault;
    fault.set_session(id.value);
    fault.set_reason("bad");
    wall_.node_faults(node, fault);
    EXPECT_TRUE(out_.ended.empty()) << "one stream is over, the program goes on";
    fault.set_ends(true);
    wall_.node_faults(node, fault);
    EXPECT_EQ(out_.ended[id], "left: bad");
    EXPECT_TRUE(wall_.sessions().empty());
}

TEST(Target, IsASessionOrOneOfItsSurfaces) {
    EXPECT_EQ(Target::parse("3")->session, SessionId(3));
    EXPECT_EQ(Target::parse("3.4")->surface, SurfaceId(4));
    for (const char* wrong : {"", "x", "3.", ".4", "3.x", "-1", "99999999999"})
        EXPECT_FALSE(Target::parse(wrong)) << wrong;
}

}  // namespace
}  // namespace wall::walld
