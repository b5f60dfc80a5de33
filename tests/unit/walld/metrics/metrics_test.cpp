// SPDX-License-Identifier: MIT
// What /metrics says of a wall, as families and as text.
#include "walld/metrics/metrics.h"

#include <gmock/gmock.h>
#include <prometheus/text_serializer.h>

#include <set>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kConfig = std::string("[wall]\nname = \"lab\"\n") + kTwoNodes;

class Metrics : public ::testing::Test {
protected:
    NodeIndex join(const std::string& name, std::uint32_t pid = 1) {
        proto::NodeHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_name(name);
        hello.set_pid(pid);
        hello.mutable_caps()->set_renderer("llvm\"pipe");
        return *wall_.node_joins(hello, now_);
    }
    SessionId open(const std::string& program = "gears") {
        proto::ClientHello hello;
        hello.set_version(wire::kProtocolVersion);
        hello.set_program(program);
        const auto id = wall_.open_session(hello, {}, {}, [](SessionId) {});
        proto::SurfaceOpen surface;
        surface.set_surface(1);
        surface.set_width(1280);
        surface.set_height(480);
        EXPECT_TRUE(wall_.open_surface(id, surface, now_));
        return id;
    }
    void rendered(NodeIndex node, SessionId id, std::uint32_t frame) {
        proto::Rendered report;
        report.set_session(id.value);
        report.set_surface(1);
        report.set_frame(frame);
        wall_.node_rendered(node, report, now_);
    }
    /// A node that has drawn for these sessions.
    void node_tells(NodeIndex node, std::initializer_list<SessionId> sessions) {
        proto::NodeStats stats;
        stats.set_frames(7);
        stats.set_decode_ns(1'500'000'000);
        stats.mutable_objects()->set_lists(3);
        for (const auto id : sessions) {
            auto& row = *stats.add_session_stats();
            row.set_session(id.value);
            row.set_geometry_bytes(1000);
            row.set_queued_bytes(64);
        }
        auto& stream = *stats.add_streams();
        stream.set_stream(5);
        stream.set_raw_bytes(4000);
        wall_.node_reports(node, stats);
    }
    Families families() {
        return metric_families({wall_, streams_, hub_, 1, ProcessFigures{2, 3 << 20, 9}, 1000.5, "1.2", now_});
    }
    std::string text() { return prometheus::TextSerializer().Serialize(families()); }

    NoOutbox out_;
    Clock::time_point now_ = Clock::time_point{} + std::chrono::hours(1);
    Wall wall_{*config::parse_config(kConfig, "test"), out_, [](std::size_t n) { return std::string(n, 'x'); }};
    std::vector<StreamView> streams_;
    StreamHub::Counters hub_;
};

TEST_F(Metrics, SayWhatTheWallIs) {
    join("left");
    EXPECT_THAT(text(), HasSubstr("wallgl_build_info{version=\"1.2\"} 1\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_wall_info{wall=\"lab\",width=\"1280\",height=\"480\"} 1\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_nodes{state=\"up\"} 1\nwallgl_nodes{state=\"away\"} 1\n"));
    EXPECT_THAT(text(), HasSubstr("# TYPE wallgl_sessions gauge\nwallgl_sessions 0\n"));
    EXPECT_THAT(text(), HasSubstr("process_start_time_seconds 1000.5\n"));
}

TEST_F(Metrics, ASessionHasSeriesUntilItEnds) {
    const auto left = join("left");
    join("right");
    const auto id = open();
    proto::ClientStats told;
    told.set_frames(2);
    auto& row = *told.add_nodes();
    row.set_node(1);
    row.set_object_bytes(500);
    wall_.client_reports(id, 0, told, now_);
    node_tells(left, {id});
    EXPECT_THAT(text(), HasSubstr("wallgl_session_info{session=\"1\",program=\"gears\",name=\"\",owner=\"\"} 1\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_session_frames_total{session=\"1\"} 2\n"));
    EXPECT_THAT(text(),
                HasSubstr("wallgl_session_sent_bytes_total{session=\"1\",node=\"right\",kind=\"object\"} 500\n"));
    EXPECT_THAT(text(),
                HasSubstr("wallgl_session_received_bytes_total{session=\"1\",node=\"left\",kind=\"geometry\"} 1000\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_session_queue_bytes{session=\"1\",node=\"left\"} 64\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_node_queue_bytes{node=\"left\"} 64\n"));
    wall_.close_session(id);
    EXPECT_THAT(text(), Not(HasSubstr("session=\"1\""))) << "though its node has not yet said so";
}

TEST_F(Metrics, ANodeThatIsAwaySaysNothing) {
    const auto left = join("left");
    const auto id = open();
    node_tells(left, {id});
    EXPECT_THAT(text(), HasSubstr("wallgl_node_decode_seconds_total{node=\"left\"} 1.5\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_node_objects{node=\"left\",kind=\"list\"} 3\n"));
    EXPECT_THAT(text(), HasSubstr("renderer=\"llvm\\\"pipe\""));
    wall_.node_leaves(left, now_);
    EXPECT_THAT(text(), HasSubstr("wallgl_node_up{node=\"left\"} 0\n"));
    for (const char* gone : {"wallgl_node_frames_total{", "wallgl_node_objects{", "wallgl_node_info{",
                             "wallgl_session_received_bytes_total{"})
        EXPECT_THAT(text(), Not(HasSubstr(gone)));
}

TEST_F(Metrics, TilesHaveAnAgeOnceTheyHaveShownSomething) {
    join("left");
    join("right");
    const auto id = open();
    EXPECT_THAT(text(), Not(HasSubstr("wallgl_tile_frame_age_seconds{")));
    rendered(kLeft, id, 1);
    rendered(kRight, id, 1);
    now_ += std::chrono::milliseconds(2500);
    EXPECT_THAT(text(), HasSubstr("wallgl_tile_frame_age_seconds{node=\"left\",tile=\"l\"} 2.5\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_surface_frame_age_seconds{session=\"1\",surface=\"1.1\"} 2.5\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_tile_frames_total{node=\"right\",tile=\"r\"} 1\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_tile_lag_frames{node=\"right\",tile=\"r\"} 0\n"));
}

TEST_F(Metrics, SkewIsAHistogram) {
    join("left");
    join("right");
    const auto id = open();
    rendered(kLeft, id, 1);
    now_ += std::chrono::milliseconds(3);
    rendered(kRight, id, 1);
    const std::string name = "wallgl_surface_rendered_skew_seconds", labels = "{session=\"1\",surface=\"1.1\"";
    EXPECT_THAT(text(), HasSubstr("# TYPE " + name + " histogram\n"));
    EXPECT_THAT(text(), HasSubstr(name + "_count" + labels + "} 1\n"));
    EXPECT_THAT(text(), HasSubstr(name + "_sum" + labels + "} 0.003\n"));
    EXPECT_THAT(text(), HasSubstr(name + "_bucket" + labels + ",le=\"0.002\"} 0\n"));
    EXPECT_THAT(text(), HasSubstr(name + "_bucket" + labels + ",le=\"0.004\"} 1\n"));
    EXPECT_THAT(text(), HasSubstr(name + "_bucket" + labels + ",le=\"+Inf\"} 1\n"));
}

TEST_F(Metrics, AStreamIsWhatWalldAndItsNodeKnowOfIt) {
    node_tells(join("left"), {});
    streams_ = {{.id = PictureId(5),
                 .node = kLeft,
                 .tile = "l",
                 .codec = "huffyuv",
                 .width = 64,
                 .height = 48,
                 .fps = 10,
                 .viewers = 2,
                 .frames = 3,
                 .dropped = 1}};
    const std::string labels =
        "{node=\"left\",tile=\"l\",codec=\"huffyuv\",size=\"64x48\",fps=\"10\",session=\"\",region=\"\",output=\"\"} ";
    EXPECT_THAT(text(), HasSubstr("wallgl_stream_viewers" + labels + "2\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_stream_dropped_frames_total" + labels + "1\n"));
    EXPECT_THAT(text(), HasSubstr("wallgl_stream_raw_bytes_total" + labels + "4000\n"));
    streams_.clear();
    EXPECT_THAT(text(), Not(HasSubstr("wallgl_stream_viewers{")));
}

TEST_F(Metrics, NamesOfProgramsAreUtf8) {
    join("left");
    open("\xff\"\n");
    EXPECT_THAT(text(), HasSubstr("program=\"\uFFFD\\\"\\n\""));
}

/// https://prometheus.io/docs/practices/naming/
TEST_F(Metrics, AreNamedAsIsUsual) {
    std::set<std::string> names;
    for (const auto& family : families()) {
        EXPECT_TRUE(names.insert(family.name).second) << family.name << " is there twice";
        EXPECT_TRUE(family.name.starts_with("wallgl_") || family.name.starts_with("process_")) << family.name;
        EXPECT_EQ(family.name.ends_with("_total"), family.type == prometheus::MetricType::Counter) << family.name;
        EXPECT_THAT(family.help, ::testing::EndsWith(".")) << family.name;
    }
}

/// Two equal series would make Prometheus refuse all of the answer.
TEST_F(Metrics, NoSeriesIsThereTwice) {
    const auto left = join("left");
    const auto id = open();
    node_tells(left, {id, id});
    for (const auto& family : families()) {
        std::set<std::vector<prometheus::ClientMetric::Label>> seen;
        for (const auto& series : family.metric) EXPECT_TRUE(seen.insert(series.label).second) << family.name;
    }
}

}  // namespace
}  // namespace wall::walld
