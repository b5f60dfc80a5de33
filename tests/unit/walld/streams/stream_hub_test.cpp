// SPDX-License-Identifier: MIT
#include "walld/streams/stream_hub.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <cstring>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

class FakeOutbox : public Outbox {
public:
    void to_node(NodeIndex node, const proto::Envelope& message) override {
        if (message.has_stream_start() || message.has_stream_stop() || message.has_stream_ready())
            nodes[node].push_back(message);
    }
    void to_client(SessionId, const proto::Envelope&) override {}
    void to_member(SessionId, Rank, const proto::Envelope&) override {}
    void end_session(SessionId, const std::string&) override {}
    std::map<NodeIndex, std::vector<proto::Envelope>> nodes;
};

class StreamHubTest : public ::testing::Test {
protected:
    void join(const std::string& name) {
        proto::NodeHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_name(name);
        hello.set_address("unix:/tmp/" + name);
        hub_.node_joined(*wall_.node_joins(hello, {}));
    }
    void SetUp() override { join("left"), join("right"); }
    static Person person(const std::string& name) { return {Person::Kind::unix_user, name, 1, Role::viewer}; }
    /// Each of another person, unless somebody is named.
    std::shared_ptr<StreamHub::Viewer> viewer(std::vector<WatchRequest> requests, std::string who = {}) {
        auto added = *hub_.add_viewer(person(who.empty() ? "viewer " + std::to_string(++viewers_) : who));
        EXPECT_TRUE(hub_.watch(*added, requests));
        return added;
    }
    static WatchRequest tile(const std::string& name) { return {.tile = name}; }
    /// As many as a viewer may ask for, all different.
    static std::vector<WatchRequest> many(const std::string& name) {
        std::vector<WatchRequest> out;
        for (std::uint32_t width = 1; width <= WatchRequest::kMost; ++width)
            out.push_back({.tile = name, .width = width});
        return out;
    }
    static std::string small_tiles(int count) {
        std::string out = "[[node]]\nname = \"n\"\n";
        for (int i = 0; i < count; ++i)
            out += "[[node.tile]]\nname = \"" + std::to_string(i) + "\"\nrect = [" + std::to_string(64 * i) +
                   ", 0, 64, 48]\n";
        return out;
    }
    /// A program's window there, shown with its first frame.
    SessionId window(const geom::Rect& rect) {
        proto::ClientHello hello;
        hello.set_version(wire::kProtocolVersion);
        const auto id = wall_.open_session(hello, {}, {}, [](SessionId) {});
        proto::SurfaceOpen open;
        open.set_surface(1);
        open.set_width(static_cast<std::uint32_t>(rect.width));
        open.set_height(static_cast<std::uint32_t>(rect.height));
        EXPECT_TRUE(wall_.open_surface(id, open, {}));
        EXPECT_EQ(wall_.find(SurfaceKey{id, SurfaceId(1)})->place.shown().width, rect.width);
        return id;
    }
    /// Its next frame is there.
    void move_window(SessionId id, std::uint32_t version, std::int32_t x) {
        ASSERT_TRUE(wall_.place_surface({id, {}}, {x, 0, 100, 100}));
        proto::SurfaceAdopted adopted;
        adopted.set_surface(1);
        adopted.set_layout_version(version);
        adopted.set_frame(version);
        wall_.adopt_placement(id, adopted, {});
        proto::Rendered rendered;
        rendered.set_session(id.value);
        rendered.set_surface(1);
        rendered.set_frame(version);
        wall_.node_rendered(kLeft, rendered, {});
        wall_.node_rendered(kRight, rendered, {});
        ASSERT_EQ(wall_.find({id, SurfaceId(1)})->place.shown().x, x);
    }
    std::vector<proto::Envelope> said(NodeIndex node) { return std::exchange(out_.nodes[node], {}); }
    std::uint32_t started(NodeIndex node) {
        for (const auto& message : said(node))
            if (message.has_stream_start()) return message.stream_start().stream();
        ADD_FAILURE() << "no stream was started";
        return 0;
    }
    void frame(NodeIndex node, std::uint32_t stream, bool key, const std::string& packet, std::uint32_t width = 640,
               std::uint32_t height = 480) {
        proto::StreamFrame message;
        message.set_stream(stream);
        message.set_key(key);
        message.set_width(width);
        message.set_height(height);
        message.set_packet(packet);
        hub_.arrived(node, message);
    }
    /// "text" or the packet of the next message; empty: none.
    std::string next(StreamHub::Viewer& viewer) {
        const auto message = hub_.next(viewer);
        if (!message) return {};
        if (message->binary)
            part_ = static_cast<unsigned char>(message->head[4]),
            sequence_ = static_cast<unsigned char>(message->head[16]);
        return message->binary ? *message->packet : message->head;
    }
    bool asked(NodeIndex node, bool key) {
        const auto messages = said(node);
        return std::any_of(messages.begin(), messages.end(),
                           [key](const auto& m) { return m.has_stream_ready() && m.stream_ready().key() == key; });
    }

    boost::asio::io_context io_;
    FakeOutbox out_;
    Wall wall_{*config::parse_config(kTwoNodes, "test"), out_, [](std::size_t n) { return std::string(n, 'x'); }};
    StreamHub hub_{io_.get_executor(), wall_, out_};
    unsigned part_ = 0, sequence_ = 0, viewers_ = 0;
};

TEST_F(StreamHubTest, AViewerGetsTheFormatAndThenFrames) {
    const auto one = viewer({tile("l")});
    const auto id = started(kLeft);
    EXPECT_EQ(
        next(*one),
        R"({"background":"#000000","codec":"huffyuv","height":480,"layout":"rgba",)"
        R"("parts":[{"away":false,"rect":[0,0,640,480],"tile":"l"}],"shows":[0,0,640,480],"stream":0,"width":640})");
    EXPECT_EQ(next(*one), "");
    frame(kLeft, id, true, "first");
    EXPECT_EQ(next(*one), R"({"header":"","part":0,"stream":0})");
    EXPECT_FALSE(asked(kLeft, false)) << "nobody has taken the frame";
    EXPECT_EQ(next(*one), "first");
    EXPECT_TRUE(asked(kLeft, false));
    frame(kLeft, id, false, "second");
    EXPECT_EQ(next(*one), "second");
    EXPECT_EQ(sequence_, 2u);
}

TEST_F(StreamHubTest, ViewersOfTheSameShareAStream) {
    const auto one = viewer({tile("l")});
    const auto id = started(kLeft);
    const auto two = viewer({tile("l")});
    EXPECT_EQ(hub_.node_streams(), 1u);
    EXPECT_TRUE(asked(kLeft, true)) << "an unchanged picture would not come by itself";
    frame(kLeft, id, true, "k");
    next(*one), next(*one), next(*two), next(*two);
    EXPECT_EQ(next(*one), "k");
    EXPECT_EQ(next(*two), "k");
    hub_.remove_viewer(*one);
    EXPECT_EQ(hub_.node_streams(), 1u);
    hub_.remove_viewer(*two);
    EXPECT_EQ(hub_.node_streams(), 0u);
    EXPECT_TRUE(said(kLeft).back().has_stream_stop());
}

TEST_F(StreamHubTest, TheNewestWins) {
    const auto slow = viewer({tile("l")}), quick = viewer({tile("l")});
    const auto id = started(kLeft);
    for (const std::string packet : {"1", "2", "3"}) {
        frame(kLeft, id, true, packet);
        while (!next(*quick).empty()) {
        }
    }
    next(*slow), next(*slow);
    EXPECT_EQ(next(*slow), "3");
    EXPECT_EQ(next(*slow), "");
    EXPECT_EQ(hub_.counters().dropped, 2u);
}

TEST_F(StreamHubTest, AfterADroppedDifferenceComesAKeyFrame) {
    const auto slow = viewer({tile("l")}), quick = viewer({tile("l")});
    const auto id = started(kLeft);
    frame(kLeft, id, true, "key");
    next(*quick), next(*quick), next(*quick);
    said(kLeft);
    frame(kLeft, id, false, "difference");
    EXPECT_EQ(next(*quick), "difference");
    EXPECT_TRUE(asked(kLeft, false)) << "no key frame before the slow one has room for it";
    next(*slow), next(*slow);
    EXPECT_EQ(next(*slow), "key");
    EXPECT_TRUE(asked(kLeft, true));
    frame(kLeft, id, false, "another");
    EXPECT_EQ(next(*slow), "");
    frame(kLeft, id, true, "new key");
    EXPECT_EQ(next(*slow), "new key");
}

TEST_F(StreamHubTest, ANodeThatComesBackStartsAnew) {
    const auto one = viewer({tile("r"), tile("l")});
    const auto id = started(kRight);
    frame(kRight, id, true, "k");
    next(*one), next(*one), next(*one), next(*one);
    wall_.node_leaves(kRight, {});
    hub_.node_left(kRight);
    EXPECT_EQ(next(*one), R"({"ended":"node right is away","part":0,"stream":0})");
    said(kRight);
    join("right");
    EXPECT_EQ(started(kRight), id);
    frame(kRight, id, true, "again");
    EXPECT_THAT(next(*one), HasSubstr("header"));
    EXPECT_EQ(next(*one), "again");
}

TEST_F(StreamHubTest, ANewListKeepsWhatIsInBoth) {
    const auto one = viewer({tile("l"), tile("r")});
    started(kLeft), started(kRight);
    ASSERT_TRUE(hub_.watch(*one, {tile("r")}));
    EXPECT_TRUE(said(kLeft).back().has_stream_stop());
    for (const auto& message : said(kRight)) EXPECT_TRUE(message.has_stream_ready());
    EXPECT_EQ(hub_.node_streams(), 1u);
}

TEST_F(StreamHubTest, AWrongListChangesNothing) {
    const auto one = viewer({tile("l")});
    const auto wrong = hub_.watch(*one, {tile("l"), tile("x")});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().message, "watch[1].tile: there is no tile 'x'");
    EXPECT_EQ(hub_.node_streams(), 1u);
    one->tell_error(wrong.error().message);
    EXPECT_THAT(next(*one), HasSubstr("there is no tile"));
}

TEST_F(StreamHubTest, ForeignFramesAreIgnored) {
    const auto one = viewer({tile("l")});
    const auto id = started(kLeft);
    frame(kRight, id, true, "not its own");
    frame(kLeft, id + 1, true, "not a stream");
    frame(kLeft, id, false, "a difference to nothing");
    next(*one);
    EXPECT_EQ(next(*one), "");
}

TEST_F(StreamHubTest, AFrameOfAnotherSizeEndsItsPart) {
    const auto one = viewer({tile("l")});
    frame(kLeft, started(kLeft), true, "k", 64, 48);
    next(*one);
    EXPECT_THAT(next(*one), HasSubstr("64x48 pixels came, not 640x480"));
}

TEST_F(StreamHubTest, AWallIsAPartForEachTile) {
    const auto one = viewer({{.wall = true, .width = 320, .height = 120}});
    const auto left = said(kLeft).at(0).stream_start();
    EXPECT_EQ(left.width(), 160u);
    EXPECT_EQ(left.crop().width(), 640u);
    const auto right = started(kRight);
    EXPECT_THAT(next(*one), HasSubstr(R"({"away":false,"rect":[160,0,160,120],"tile":"r"}],"shows":[0,0,1280,480])"));
    frame(kRight, right, true, "right", 160, 120);
    EXPECT_EQ(next(*one), R"({"header":"","part":1,"stream":0})");
    EXPECT_EQ(next(*one), "right");
    EXPECT_EQ(part_, 1u);
    frame(kLeft, left.stream(), true, "left", 160, 120);
    next(*one);
    EXPECT_EQ(next(*one), "left");
    EXPECT_EQ(part_, 0u);
}

TEST_F(StreamHubTest, ViewersOfAWallAndOfATileShareTheTile) {
    const auto one = viewer({{.wall = true}}), two = viewer({tile("r")});
    EXPECT_EQ(hub_.node_streams(), 2u);
    ASSERT_TRUE(hub_.watch(*one, {tile("l")}));
    EXPECT_EQ(hub_.node_streams(), 2u);
    hub_.remove_viewer(*two);
    EXPECT_EQ(hub_.node_streams(), 1u);
}

TEST_F(StreamHubTest, AStreamFollowsItsWindowAtItsRate) {
    const auto id = window({0, 0, 100, 100});
    const auto one = viewer({{.session = id, .fps = 10}});
    EXPECT_EQ(said(kLeft).at(0).stream_start().surface(), 1u);
    next(*one);
    const auto move = [&](std::uint32_t version, std::int32_t x) { move_window(id, version, x); };
    const Clock::time_point now{std::chrono::hours(1)};
    move(2, 600);
    hub_.tick(now);
    EXPECT_THAT(next(*one), HasSubstr(R"("parts":[{"away":false,"rect":[0,0,40,100],"tile":"l"},)"
                                      R"({"away":false,"rect":[40,0,60,100],"tile":"r"}],"shows":[600,0,100,100])"));
    EXPECT_EQ(hub_.node_streams(), 2u);
    move(3, 650);
    hub_.tick(now + std::chrono::milliseconds(1));
    EXPECT_EQ(next(*one), "") << "it has just been told";
    ASSERT_EQ(hub_.next_deadline(), now + std::chrono::milliseconds(100));
    hub_.tick(*hub_.next_deadline());
    EXPECT_THAT(next(*one), HasSubstr(R"("parts":[{"away":false,"rect":[0,0,100,100],"tile":"r"}])"));
    EXPECT_FALSE(hub_.next_deadline());
    wall_.close_session(id);
    hub_.tick(now + std::chrono::seconds(1));
    EXPECT_THAT(next(*one), HasSubstr("\"ended\":\"there is no session"));
    EXPECT_EQ(hub_.node_streams(), 0u);
}

TEST_F(StreamHubTest, WhatIsWatchedIsFoundAmongOtherTiles) {
    const auto whole = viewer({{.wall = true}}), right = viewer({tile("r")});
    next(*whole), next(*right);
    const std::string left = "[[node]]\nname = \"left\"\n[[node.tile]]\nname = \"l\"\nrect = [0, 0, 640, 480]\n";
    wall_.node_leaves(kRight, {});
    hub_.node_left(kRight);
    wall_.describe(*config::parse_config(left, "test"));
    hub_.wall_changed({});
    EXPECT_THAT(next(*whole), HasSubstr(R"("shows":[0,0,640,480])"));
    EXPECT_EQ(next(*right), R"({"ended":"there is no tile 'r'","stream":0})");
    EXPECT_EQ(next(*right), "");
    EXPECT_EQ(hub_.views().size(), 1u) << "of the tile that is left";
    wall_.describe(*config::parse_config(kTwoNodes, "test"));
    hub_.wall_changed({});
    EXPECT_THAT(next(*whole), HasSubstr(R"("shows":[0,0,1280,480])"));
    EXPECT_THAT(next(*right), HasSubstr(R"("tile":"r")")) << "it is there again";
}

TEST_F(StreamHubTest, ThereAreOnlySoManyStreams) {
    const auto id = window({0, 0, 100, 100});
    const auto follower = viewer({{.session = id}});
    next(*follower);
    std::vector<std::shared_ptr<StreamHub::Viewer>> others;
    for (std::uint32_t height = 1; hub_.node_streams() < StreamHub::kMaxNodeStreams; ++height) {
        std::vector<WatchRequest> requests;
        for (std::uint32_t width = 1;
             width <= WatchRequest::kMost && hub_.node_streams() + requests.size() < StreamHub::kMaxNodeStreams;
             ++width)
            requests.push_back({.tile = "l", .width = width, .height = height});
        others.push_back(viewer(requests));
    }
    const auto late = *hub_.add_viewer(person("late"));
    EXPECT_EQ(hub_.watch(*late, {tile("r")}).error().message, "watch: the wall's streams are all in use");
    ASSERT_TRUE(hub_.watch(*late, {{.tile = "l", .width = 1, .height = 1}})) << "one that there is";
    move_window(id, 2, 600);
    Clock::time_point now{std::chrono::hours(1)};
    hub_.tick(now);
    EXPECT_EQ(next(*follower), R"({"ended":"the wall's streams are all in use","stream":0})");
    hub_.tick(now += std::chrono::seconds(1));
    EXPECT_EQ(next(*follower), "") << "it was said";
    hub_.remove_viewer(*others.back());
    hub_.tick(now += std::chrono::seconds(1));
    EXPECT_THAT(next(*follower), HasSubstr("\"parts\""));
}

TEST_F(StreamHubTest, OnePersonCannotTakeAllStreams) {
    for (const char* name : {"l", "r"}) viewer(many(name), "greedy");
    const auto third = *hub_.add_viewer(person("greedy"));
    EXPECT_EQ(hub_.watch(*third, {tile("r")}).error().message,
              "watch: greedy may watch 512 different parts of tiles, and these would be 513");
    EXPECT_TRUE(hub_.watch(*third, many("r"))) << "those cost nobody anything";
    viewer({tile("r")}, "modest");
}

TEST_F(StreamHubTest, AViewerWatchesOnlySoManyParts) {
    const auto one = *hub_.add_viewer(person("one"));
    const std::vector<WatchRequest> walls(WatchRequest::kMost, {.wall = true});
    EXPECT_TRUE(hub_.watch(*one, walls)) << "512 parts, two of them different";
    Wall wide(*config::parse_config(small_tiles(5), "test"), out_, [](std::size_t n) { return std::string(n, 'x'); });
    StreamHub hub(io_.get_executor(), wide, out_);
    const auto two = *hub.add_viewer(person("two"));
    EXPECT_EQ(hub.watch(*two, walls).error().message, "watch: 1280 parts of tiles are more than the 1024 of a viewer");
}

TEST_F(StreamHubTest, WhatIsWatchedInsteadDoesNotCount) {
    const auto one = viewer(many("l"), "same"), two = viewer(many("r"), "same");
    EXPECT_TRUE(hub_.watch(*one, many("l"))) << "all 512 are taken, and these are among them";
    EXPECT_TRUE(hub_.watch(*one, {tile("l")}));
    EXPECT_TRUE(hub_.watch(*two, many("l")));
}

TEST_F(StreamHubTest, OnePersonHasOnlySoManyViewersAndAllTogetherToo) {
    std::vector<std::shared_ptr<StreamHub::Viewer>> viewers;
    for (std::size_t i = 0; i < kViewers.of_one; ++i) viewers.push_back(*hub_.add_viewer(person("greedy")));
    const auto more = hub_.add_viewer(person("greedy"));
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().kind, RefusalKind::busy);
    EXPECT_THAT(more.error().message, HasSubstr("greedy has 256 live views of this wall"));
    for (std::size_t i = hub_.viewers(); i < kViewers.in_all; ++i)
        viewers.push_back(*hub_.add_viewer(person(std::to_string(i))));
    EXPECT_THAT(hub_.add_viewer(person("late")).error().message, HasSubstr("there are 768 live views"));
    hub_.remove_viewer(*viewers.front());
    viewers.erase(viewers.begin());
    EXPECT_TRUE(hub_.add_viewer(person("greedy")));
}

TEST(StreamHubPixels, AllStreamsTogetherHaveALimit) {
    constexpr const char* kHuge = R"(
[[node]]
name = "left"
[[node.tile]]
name = "huge"
rect = [0, 0, 16384, 16384]
)";
    NoOutbox out;
    const Wall wall(*config::parse_config(kHuge, "test"), out, [](std::size_t n) { return std::string(n, 'x'); });
    boost::asio::io_context io;
    StreamHub hub(io.get_executor(), wall, out);
    const auto viewer = *hub.add_viewer({});
    EXPECT_TRUE(hub.watch(*viewer, {{.tile = "huge"}}));
    EXPECT_FALSE(hub.watch(*viewer, {{.tile = "huge"}, {.tile = "huge", .width = 1, .height = 1}}));
}

TEST_F(StreamHubTest, AFrameComesInParts) {
    const auto one = viewer({tile("l")});
    const auto id = started(kLeft);
    next(*one);
    proto::StreamFrame first;
    first.set_stream(id);
    first.set_key(true);
    first.set_width(640);
    first.set_height(480);
    first.set_header("header");
    first.set_packet_bytes(10);
    first.set_packet("abcd");
    hub_.arrived(kLeft, first);
    EXPECT_EQ(next(*one), "") << "it is not whole";
    EXPECT_EQ(hub_.counters().frames, 0u);
    for (const auto& [offset, bytes] : {std::pair{4, "efgh"}, std::pair{8, "ij"}}) {
        proto::StreamFrame more;
        more.set_stream(id);
        more.set_packet_bytes(10);
        more.set_offset(static_cast<std::uint64_t>(offset));
        more.set_packet(bytes);
        hub_.arrived(kLeft, more);
    }
    EXPECT_THAT(next(*one), HasSubstr("\"header\""));
    EXPECT_THAT(next(*one), ::testing::EndsWith("abcdefghij"));
    EXPECT_EQ(hub_.counters().frames, 1u);
}

TEST_F(StreamHubTest, PartsThatDoNotFitEndTheStreamAndNothingElse) {
    const auto one = viewer({tile("l")});
    const auto id = started(kLeft);
    next(*one);
    const auto part = [&](std::uint64_t all, std::uint64_t offset, std::size_t bytes) {
        proto::StreamFrame frame;
        frame.set_stream(id);
        frame.set_key(true);
        frame.set_width(640);
        frame.set_height(480);
        frame.set_packet_bytes(all);
        frame.set_offset(offset);
        frame.set_packet(std::string(bytes, 'x'));
        hub_.arrived(kLeft, frame);
    };
    const std::vector<std::vector<std::array<std::uint64_t, 3>>> wrong{
        {{10, 4, 4}},                      // without a beginning
        {{10, 0, 4}, {10, 5, 4}},          // a gap
        {{10, 0, 4}, {12, 4, 4}},          // of another frame
        {{10, 0, 4}, {10, 4, 7}},          // longer than it said
        {{std::uint64_t{1} << 60, 0, 4}},  // larger than any
        {{10, UINT64_MAX, 4}},             // whose end wraps
    };
    for (const auto& parts : wrong) {
        for (const auto& [all, offset, bytes] : parts) part(all, offset, bytes);
        EXPECT_THAT(next(*one), HasSubstr("do not fit together")) << parts.front()[1];
    }
    part(4, 0, 4);
    EXPECT_THAT(next(*one), HasSubstr("\"header\"")) << "the next whole frame is good again";
}

}  // namespace
}  // namespace wall::walld
