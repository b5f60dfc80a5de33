// SPDX-License-Identifier: MIT
#include "walld/stream_hub.h"

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
    std::shared_ptr<StreamHub::Viewer> viewer(std::vector<WatchRequest> requests) {
        auto added = hub_.add_viewer();
        EXPECT_TRUE(hub_.watch(*added, requests));
        return added;
    }
    static WatchRequest tile(const std::string& name) { return {.tile = name}; }
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
        ASSERT_TRUE(wall_.place_surface({id, {}}, {x, 0, 100, 100}, {}));
        proto::SurfaceAdopted adopted;
        adopted.set_surface(1);
        adopted.set_layout_version(version);
        adopted.set_frame(version);
        wall_.adopt_placement(id, adopted, {});
        proto::Rendered rendered;
        rendered.set_session(id.value);
        rendered.set_surface(1);
        rendered.set_frame(version);
        wall_.node_rendered(0, rendered, {});
        wall_.node_rendered(1, rendered, {});
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
    unsigned part_ = 0, sequence_ = 0;
};

TEST_F(StreamHubTest, AViewerGetsTheFormatAndThenFrames) {
    const auto one = viewer({tile("l")});
    const auto id = started(0);
    EXPECT_EQ(
        next(*one),
        R"({"background":"#000000","codec":"huffyuv","height":480,"layout":"rgba",)"
        R"("parts":[{"away":false,"rect":[0,0,640,480],"tile":"l"}],"shows":[0,0,640,480],"stream":0,"width":640})");
    EXPECT_EQ(next(*one), "");
    frame(0, id, true, "first");
    EXPECT_EQ(next(*one), R"({"header":"","part":0,"stream":0})");
    EXPECT_FALSE(asked(0, false)) << "nobody has taken the frame";
    EXPECT_EQ(next(*one), "first");
    EXPECT_TRUE(asked(0, false));
    frame(0, id, false, "second");
    EXPECT_EQ(next(*one), "second");
    EXPECT_EQ(sequence_, 2u);
}

TEST_F(StreamHubTest, ViewersOfTheSameShareAStream) {
    const auto one = viewer({tile("l")});
    const auto id = started(0);
    const auto two = viewer({tile("l")});
    EXPECT_EQ(hub_.node_streams(), 1u);
    EXPECT_TRUE(asked(0, true)) << "an unchanged picture would not come by itself";
    frame(0, id, true, "k");
    next(*one), next(*one), next(*two), next(*two);
    EXPECT_EQ(next(*one), "k");
    EXPECT_EQ(next(*two), "k");
    hub_.remove_viewer(*one);
    EXPECT_EQ(hub_.node_streams(), 1u);
    hub_.remove_viewer(*two);
    EXPECT_EQ(hub_.node_streams(), 0u);
    EXPECT_TRUE(said(0).back().has_stream_stop());
}

TEST_F(StreamHubTest, TheNewestWins) {
    const auto slow = viewer({tile("l")}), quick = viewer({tile("l")});
    const auto id = started(0);
    for (const std::string packet : {"1", "2", "3"}) {
        frame(0, id, true, packet);
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
    const auto id = started(0);
    frame(0, id, true, "key");
    next(*quick), next(*quick), next(*quick);
    said(0);
    frame(0, id, false, "difference");
    EXPECT_EQ(next(*quick), "difference");
    EXPECT_TRUE(asked(0, false)) << "no key frame before the slow one has room for it";
    next(*slow), next(*slow);
    EXPECT_EQ(next(*slow), "key");
    EXPECT_TRUE(asked(0, true));
    frame(0, id, false, "another");
    EXPECT_EQ(next(*slow), "");
    frame(0, id, true, "new key");
    EXPECT_EQ(next(*slow), "new key");
}

TEST_F(StreamHubTest, ANodeThatComesBackStartsAnew) {
    const auto one = viewer({tile("r"), tile("l")});
    const auto id = started(1);
    frame(1, id, true, "k");
    next(*one), next(*one), next(*one), next(*one);
    wall_.node_leaves(1, {});
    hub_.node_left(1);
    EXPECT_EQ(next(*one), R"({"ended":"node right is away","part":0,"stream":0})");
    said(1);
    join("right");
    EXPECT_EQ(started(1), id);
    frame(1, id, true, "again");
    EXPECT_THAT(next(*one), HasSubstr("header"));
    EXPECT_EQ(next(*one), "again");
}

TEST_F(StreamHubTest, ANewListKeepsWhatIsInBoth) {
    const auto one = viewer({tile("l"), tile("r")});
    started(0), started(1);
    ASSERT_TRUE(hub_.watch(*one, {tile("r")}));
    EXPECT_TRUE(said(0).back().has_stream_stop());
    for (const auto& message : said(1)) EXPECT_TRUE(message.has_stream_ready());
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
    const auto id = started(0);
    frame(1, id, true, "not its own");
    frame(0, id + 1, true, "not a stream");
    frame(0, id, false, "a difference to nothing");
    next(*one);
    EXPECT_EQ(next(*one), "");
}

TEST_F(StreamHubTest, AFrameOfAnotherSizeEndsItsPart) {
    const auto one = viewer({tile("l")});
    frame(0, started(0), true, "k", 64, 48);
    next(*one);
    EXPECT_THAT(next(*one), HasSubstr("64x48 pixels came, not 640x480"));
}

TEST_F(StreamHubTest, AWallIsAPartForEachTile) {
    const auto one = viewer({{.wall = true, .width = 320, .height = 120}});
    const auto left = said(0).at(0).stream_start();
    EXPECT_EQ(left.width(), 160u);
    EXPECT_EQ(left.crop().width(), 640u);
    const auto right = started(1);
    EXPECT_THAT(next(*one), HasSubstr(R"({"away":false,"rect":[160,0,160,120],"tile":"r"}],"shows":[0,0,1280,480])"));
    frame(1, right, true, "right", 160, 120);
    EXPECT_EQ(next(*one), R"({"header":"","part":1,"stream":0})");
    EXPECT_EQ(next(*one), "right");
    EXPECT_EQ(part_, 1u);
    frame(0, left.stream(), true, "left", 160, 120);
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
    EXPECT_EQ(said(0).at(0).stream_start().surface(), 1u);
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
    const auto late = hub_.add_viewer();
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

}  // namespace
}  // namespace wall::walld
