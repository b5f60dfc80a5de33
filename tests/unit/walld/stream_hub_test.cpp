// SPDX-License-Identifier: MIT
#include "walld/stream_hub.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <cstring>

#include "common/wire/limits.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

constexpr const char* kConfig = R"(
[[node]]
name = "left"
[[node.tile]]
name = "l"
rect = [0, 0, 640, 480]
[[node]]
name = "right"
[[node.tile]]
name = "r"
rect = [640, 0, 640, 480]
)";

class FakeOutbox : public Outbox {
public:
    void to_node(NodeIndex node, const proto::Envelope& message) override {
        if (message.has_stream_start() || message.has_stream_stop() || message.has_stream_ready()) nodes[node].push_back(message);
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
    WatchRequest tile(const std::string& name) {
        WatchRequest out;
        out.tile = name;
        return out;
    }
    std::vector<proto::Envelope> said(NodeIndex node) { return std::exchange(out_.nodes[node], {}); }
    std::uint32_t started(NodeIndex node) {
        for (const auto& message : said(node))
            if (message.has_stream_start()) return message.stream_start().stream();
        ADD_FAILURE() << "no stream was started";
        return 0;
    }
    void frame(NodeIndex node, std::uint32_t stream, bool key, const std::string& packet) {
        proto::StreamFrame message;
        message.set_stream(stream);
        message.set_key(key);
        message.set_width(640);
        message.set_height(480);
        message.set_packet(packet);
        hub_.arrived(node, message);
    }
    /// "text" or the packet of the next message; empty: none.
    std::string next(StreamHub::Viewer& viewer) {
        const auto message = hub_.next(viewer);
        if (!message) return {};
        if (message->binary) sequence_ = static_cast<unsigned char>(message->head[4]);
        return message->binary ? *message->packet : message->head;
    }
    bool asked(NodeIndex node, bool key) {
        const auto messages = said(node);
        return std::any_of(messages.begin(), messages.end(), [key](const auto& m) { return m.has_stream_ready() && m.stream_ready().key() == key; });
    }

    boost::asio::io_context io_;
    FakeOutbox out_;
    Wall wall_{*config::parse_config(kConfig, "test"), out_, [](std::size_t n) { return std::string(n, 'x'); }};
    StreamHub hub_{io_.get_executor(), wall_, out_};
    unsigned sequence_ = 0;
};

TEST_F(StreamHubTest, AViewerGetsTheFormatAndThenFrames) {
    const auto one = viewer({tile("l")});
    const auto id = started(0);
    EXPECT_EQ(next(*one), "");
    frame(0, id, true, "first");
    EXPECT_THAT(next(*one), HasSubstr("\"width\":640"));
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
    next(*one), next(*two);
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
    EXPECT_THAT(next(*slow), HasSubstr("codec"));
    EXPECT_EQ(next(*slow), "3");
    EXPECT_EQ(next(*slow), "");
    EXPECT_EQ(hub_.counters().dropped, 2u);
}

TEST_F(StreamHubTest, AfterADroppedDifferenceComesAKeyFrame) {
    const auto slow = viewer({tile("l")}), quick = viewer({tile("l")});
    const auto id = started(0);
    frame(0, id, true, "key");
    next(*quick), next(*quick);
    said(0);
    frame(0, id, false, "difference");
    EXPECT_EQ(next(*quick), "difference");
    EXPECT_TRUE(asked(0, false)) << "no key frame before the slow one has room for it";
    next(*slow);
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
    next(*one), next(*one);
    wall_.node_leaves(1, {});
    hub_.node_left(1);
    EXPECT_THAT(next(*one), HasSubstr("node right is away"));
    said(1);
    join("right");
    EXPECT_EQ(started(1), id);
    frame(1, id, true, "again");
    EXPECT_THAT(next(*one), HasSubstr("codec"));
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
    EXPECT_EQ(next(*one), "");
}

TEST(WatchRequest, SaysWhatWasExpected) {
    const auto error = [](const char* text) {
        const auto parsed = WatchRequest::parse(text);
        return parsed ? std::string() : parsed.error().message;
    };
    EXPECT_EQ(error(R"({"watch": [{"tile": "l", "fps": 60, "width": 1, "session": 3}]})"), "");
    EXPECT_EQ(error("{"), "expected {\"watch\": [...]}");
    EXPECT_EQ(error(R"({"watch": [{"tile": "l"}, 3]})"), "watch[1]: expected an object");
    EXPECT_EQ(error(R"({"watch": [{}]})"), "watch[0].tile: expected a text");
    EXPECT_EQ(error(R"({"watch": [{"tile": "l", "fps": 61}]})"), "watch[0].fps: expected a whole number from 1 to 60");
    EXPECT_EQ(error(R"({"watch": [{"tile": "l", "width": -1}]})"), "watch[0].width: expected a whole number from 1 to 32768");
    EXPECT_THAT(error(R"({"watch": [{"tile": "l", "codec": "mp3"}]})"), HasSubstr("watch[0].codec: "));
    std::string many = "{\"watch\": [";
    for (std::size_t i = 0; i <= StreamHub::kMaxWatches; ++i) many += i ? ",{}" : "{}";
    EXPECT_THAT(error((many + "]}").c_str()), HasSubstr("at most 256 streams"));
}

}  // namespace
}  // namespace wall::walld
