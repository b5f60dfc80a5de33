// SPDX-License-Identifier: MIT
// A tile goes to another GPU of its tileserver while programs draw.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"
#include "walld/streams/stream_scope.h"
#include "walld/wall/messages.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr NodeIndex kFirst(0), kSecond(1);
constexpr SurfaceId kWindow(1);
constexpr const char* kTwoGpus = R"(
[[node]]
name = "n"
gpus = 2
[[node.tile]]
name = "a"
rect = [0, 0, 100, 100]
[[node.tile]]
name = "b"
rect = [100, 0, 100, 100]
[[node.tile]]
name = "c"
rect = [0, 100, 100, 100]
[[node.tile]]
name = "d"
rect = [100, 100, 100, 100]
)";

class AWallOfTwoGpus : public ::testing::Test {
protected:
    AWallOfTwoGpus() {
        for (const auto* name : {"n/gpu0", "n/gpu1"}) {
            proto::NodeHello hello;
            hello.set_version(wire::kProtocolVersion);
            hello.set_name(name);
            hello.set_pid(100);
            EXPECT_TRUE(wall_.node_joins(hello, now_));
        }
        proto::ClientHello hello;
        hello.set_fullscreen(true);
        session_ = wall_.open_session(hello, {}, now_, [](SessionId) {});
        proto::SurfaceOpen window;
        window.set_surface(kWindow.value);
        window.set_width(200);
        window.set_height(200);
        EXPECT_TRUE(wall_.open_surface(session_, window, now_));
        adopt(1, 1);
        out_.nodes.clear();
        out_.client.clear();
    }
    void adopt(std::uint32_t version, std::uint32_t frame) {
        proto::SurfaceAdopted message;
        message.set_surface(kWindow.value);
        message.set_layout_version(version);
        message.set_frame(frame);
        wall_.adopt_placement(session_, message, now_);
    }
    void rendered(NodeIndex node, std::uint32_t frame) {
        proto::Rendered message;
        message.set_session(session_.value);
        message.set_surface(kWindow.value);
        message.set_frame(frame);
        wall_.node_rendered(node, message, now_);
    }
    /// Both have been drawing for 5 s more, and each tile has taken that share of its GPU.
    void drawing_takes(const std::map<std::string, double>& shares) {
        if (time_us_ == 0) report({});
        report(shares);
    }
    void report(const std::map<std::string, double>& shares) {
        constexpr std::uint64_t kWindowUs = 5'000'000;
        now_ += std::chrono::microseconds(kWindowUs);
        time_us_ += kWindowUs;
        for (const NodeIndex node : {kFirst, kSecond}) {
            proto::NodeStats stats;
            stats.set_time_us(time_us_);
            for (const auto& tile : wall_.nodes()[node].config->tiles) {
                const auto share = shares.find(tile.name);
                auto& ns = ns_[{node, tile.slot}];
                if (share != shares.end()) ns += static_cast<std::uint64_t>(share->second * kWindowUs * 1000);
                auto& row = *stats.add_tile_times();
                row.set_slot(tile.slot);
                row.set_ns(ns);
            }
            wall_.node_reports(node, stats, {}, now_);
        }
    }
    void took(NodeIndex node) { wall_.node_took_tiles(node, wall_.nodes()[node].tiles_version); }
    std::vector<std::string> names(NodeIndex node) const {
        std::vector<std::string> out;
        for (const auto& tile : wall_.nodes()[node].config->tiles)
            out.push_back(tile.name + (tile.arriving ? "?" : ""));
        return out;
    }
    /// How often programs draw it.
    std::ptrdiff_t drawn(const std::string& tile) const {
        const auto& told = out_.client.front().tiles_changed().tiles();
        return std::ranges::count(told, tile, [](const auto& t) { return t.name(); });
    }
    std::uint32_t placement() const { return out_.client.back().placement().layout_version(); }
    std::string node_in_status(const std::string& tile) const {
        std::string out;
        for (const auto& row : tiles_json(wall_, now_))
            if (row.at("name") == tile) out += row.at("node").get<std::string>() + ";";
        return out;
    }

    Clock::time_point now_{std::chrono::hours(1)};
    std::uint64_t time_us_ = 0;
    std::map<std::pair<NodeIndex, std::uint32_t>, std::uint64_t> ns_;
    HearingOutbox out_;
    char secret_ = 'a';
    Wall wall_{*config::parse_config(kTwoGpus, "test"), out_,
               [this](std::size_t bytes) { return std::string(bytes, secret_++); }};
    SessionId session_;
};

TEST_F(AWallOfTwoGpus, MovesATileWithoutAFrameThatNobodyShows) {
    ASSERT_THAT(names(kFirst), ElementsAre("a", "d"));
    drawing_takes({{"a", 0.4}, {"d", 0.4}, {"b", 0.05}, {"c", 0.05}});
    ASSERT_THAT(names(kSecond), ElementsAre("b", "c", "a?")) << "the first of those that gain the most";
    EXPECT_EQ(wall_.nodes()[kSecond].config->tiles.back().gpu, "1");
    EXPECT_EQ(node_in_status("a"), "n/gpu0;") << "which shows it still";
    EXPECT_THAT(out_.client, IsEmpty()) << "until the other draws for it";
    EXPECT_THAT(out_.nodes[kFirst], IsEmpty());
    took(kSecond);
    ASSERT_EQ(out_.client.size(), 2u);
    EXPECT_EQ(drawn("a"), 2) << "by both";

    adopt(placement(), 7);
    rendered(kFirst, 7);
    EXPECT_EQ(node_in_status("a"), "n/gpu0;");
    out_.client.clear();
    rendered(kSecond, 7);  // the frame is shown
    EXPECT_THAT(names(kFirst), ElementsAre("d"));
    EXPECT_THAT(names(kSecond), ElementsAre("b", "c", "a"));
    EXPECT_EQ(node_in_status("a"), "n/gpu1;");
    EXPECT_EQ(wall_.tiles_moved(), 1u);
    EXPECT_THAT(out_.client, IsEmpty());
    took(kFirst);
    EXPECT_EQ(drawn("a"), 1);
    EXPECT_EQ(wall_.nodes()[kFirst].incarnation, 1u) << "nobody begins anew";
    EXPECT_EQ(wall_.nodes()[kSecond].incarnation, 1u);
}

TEST_F(AWallOfTwoGpus, LeavesAMovedTileForAWhile) {
    drawing_takes({{"a", 0.4}, {"d", 0.4}});
    took(kSecond);
    adopt(placement(), 7);
    rendered(kFirst, 7);
    rendered(kSecond, 7);
    took(kFirst);
    report({});
    drawing_takes({{"a", 0.4}, {"b", 0.1}, {"c", 0.1}});
    EXPECT_THAT(names(kFirst), ElementsAre("d", "b?")) << "not back";
}

TEST_F(AWallOfTwoGpus, AsksItsNodesToMeasureAndNoOthers) {
    drawing_takes({{"a", 0.4}, {"d", 0.4}});
    EXPECT_TRUE(out_.nodes[kSecond].front().node_welcome().measure_tiles());
    HearingOutbox out;
    Wall two(*config::parse_config(kTwoNodes, "test"), out, [](std::size_t bytes) { return std::string(bytes, 'a'); });
    proto::NodeHello hello;
    hello.set_version(wire::kProtocolVersion);
    hello.set_name("left");
    ASSERT_TRUE(two.node_joins(hello, now_));
    EXPECT_FALSE(out.nodes[kLeft].front().node_welcome().measure_tiles());
}

TEST_F(AWallOfTwoGpus, GivesUpWhereAWindowDoesNotDrawForBoth) {
    drawing_takes({{"a", 0.4}, {"d", 0.4}});
    took(kSecond);
    ASSERT_TRUE(wall_.next_deadline());
    out_.client.clear();
    now_ = *wall_.next_deadline();
    wall_.tick(now_);
    EXPECT_THAT(names(kFirst), ElementsAre("a", "d"));
    EXPECT_THAT(names(kSecond), ElementsAre("b", "c"));
    took(kSecond);
    EXPECT_EQ(drawn("a"), 1);
    EXPECT_EQ(wall_.tiles_moved(), 0u);
    EXPECT_EQ(node_in_status("a"), "n/gpu0;");
    report({});
    drawing_takes({{"a", 0.4}, {"d", 0.4}});
    EXPECT_THAT(names(kSecond), ElementsAre("b", "c", "d?")) << "another one";
}

TEST_F(AWallOfTwoGpus, GivesUpWhenANodeGoes) {
    for (const NodeIndex node : {kSecond, kFirst}) {
        drawing_takes({{"a", 0.4}, {"d", 0.4}});
        if (names(kSecond).size() == 3) took(kSecond);
        wall_.node_leaves(node, now_);
        EXPECT_THAT(names(kFirst), ElementsAre("a", "d"));
        EXPECT_THAT(names(kSecond), ElementsAre("b", "c"));
    }
}

TEST_F(AWallOfTwoGpus, GivesUpWhenItIsDescribedAnew) {
    drawing_takes({{"a", 0.4}, {"d", 0.4}});
    ASSERT_THAT(names(kSecond), ElementsAre("b", "c", "a?"));
    wall_.describe(*config::parse_config(kTwoGpus, "test"));
    EXPECT_THAT(names(kSecond), ElementsAre("b", "c"));
    took(kSecond);
    EXPECT_EQ(wall_.tiles_moved(), 0u);
}

TEST_F(AWallOfTwoGpus, TellsWhatDrawingTakes) {
    drawing_takes({{"a", 0.2}, {"d", 0.1}});
    for (const auto& row : tiles_json(wall_, now_)) {
        const auto name = row.at("name").get<std::string>();
        EXPECT_DOUBLE_EQ(row.at("load").get<double>(), name == "a" ? 0.2 : name == "d" ? 0.1 : 0.0) << name;
    }
}

TEST_F(AWallOfTwoGpus, LeavesThingsAloneThatAreInBalance) {
    drawing_takes({{"a", 0.2}, {"b", 0.2}, {"c", 0.2}, {"d", 0.2}});
    report({{"a", 0.25}, {"b", 0.2}, {"c", 0.2}, {"d", 0.2}});
    EXPECT_THAT(names(kFirst), ElementsAre("a", "d"));
    EXPECT_THAT(names(kSecond), ElementsAre("b", "c"));
}

TEST_F(AWallOfTwoGpus, TakesANodeThatStartsItsClockAnew) {
    drawing_takes({{"a", 0.4}, {"d", 0.4}});
    proto::NodeStats stats;
    stats.set_time_us(1);
    wall_.node_reports(kFirst, stats, {}, now_);
    SUCCEED();
}

}  // namespace
}  // namespace wall::walld
