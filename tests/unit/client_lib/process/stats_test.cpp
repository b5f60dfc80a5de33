// SPDX-License-Identifier: MIT
#include "client_lib/process/stats.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace wall::client {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Stats, CountsFramesOfEachNode) {
    Stats stats;
    stats.add_node(NodeIndex(0), NodeCounter::state_bytes, 3000);
    stats.add_node(NodeIndex(0), NodeCounter::geometry_bytes, 10);
    stats.end_frame();
    stats.add_node(NodeIndex(0), NodeCounter::state_bytes, 40);
    stats.end_frame();
    stats.add_node(NodeIndex(0), NodeCounter::state_bytes, 30);
    stats.end_frame();
    EXPECT_EQ(stats.of_node(NodeIndex(0), NodeCounter::state_bytes), 3070u);
    const auto json = stats.json();
    EXPECT_THAT(json, HasSubstr("\"frames\": 3"));
    EXPECT_THAT(json, HasSubstr("\"total\": {\"state_bytes\": 3070,"));
    EXPECT_THAT(json, HasSubstr("\"first_frame\": {\"state_bytes\": 3000,"));
    EXPECT_THAT(json, HasSubstr("\"last_frame\": {\"state_bytes\": 30,"));
    EXPECT_THAT(json, HasSubstr("\"largest_frame\": {\"state_bytes\": 3000,"));
}

TEST(Stats, NamesWhatWasUnsupportedAndWaitedFor) {
    Stats stats;
    EXPECT_TRUE(stats.count_unsupported("glNoSuchThing"));
    EXPECT_FALSE(stats.count_unsupported("glNoSuchThing"));
    stats.count_round_trip("glReadPixels");
    stats.add("ideal_geometry_bytes", 5);
    stats.add("ideal_geometry_bytes", 6);
    EXPECT_EQ(stats.get("ideal_geometry_bytes"), 11u);
    EXPECT_THAT(stats.json(), HasSubstr("\"unsupported\": {\"glNoSuchThing\": 2}"));
    EXPECT_THAT(stats.json(), HasSubstr("\"round_trips\": 1"));
    EXPECT_THAT(stats.json(), HasSubstr("\"round_trips_by_function\": {\"glReadPixels\": 1}"));
    EXPECT_THAT(stats.json(), HasSubstr("\"counters\": {\"ideal_geometry_bytes\": 11}"));
}

TEST(Stats, TrafficIsByNode) {
    Stats stats;
    EXPECT_TRUE(stats.traffic().nodes.empty());
    stats.add_node(NodeIndex(2), NodeCounter::state_bytes, 10);
    stats.add_node(NodeIndex(2), NodeCounter::geometry_bytes, 30);
    stats.add_diff_time(std::chrono::microseconds(5));
    stats.count_round_trip("glReadPixels");
    stats.count_round_trip("glFinish");
    stats.end_frame();
    const Traffic traffic = stats.traffic();
    ASSERT_EQ(traffic.nodes.size(), 1u);
    EXPECT_EQ(traffic.nodes[0].node, NodeIndex(2));
    EXPECT_EQ(traffic.nodes[0].state_bytes, 10u);
    EXPECT_EQ(traffic.nodes[0].object_bytes, 0u);
    EXPECT_EQ(traffic.nodes[0].geometry_bytes, 30u);
    EXPECT_EQ(traffic.frames, 1u);
    EXPECT_EQ(traffic.round_trips, 2u);
    EXPECT_EQ(traffic.diff_time, std::chrono::microseconds(5));
}

TEST(Stats, ThreadsLoseNothing) {
    Stats stats;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 10000; ++i) stats.add_node(NodeIndex(5), NodeCounter::blocks, 1);
        });
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(stats.of_node(NodeIndex(5), NodeCounter::blocks), 40000u);
    stats.add_node(NodeIndex(100000), NodeCounter::blocks, 2);
    EXPECT_EQ(stats.of_node(NodeIndex(Stats::kMaxNodes - 1), NodeCounter::blocks), 2u);
}

TEST(Stats, WritesTheFileOnlyWhenAsked) {
    const auto path = std::filesystem::temp_directory_path() / ("wallgl_stats_" + std::to_string(getpid()));
    Stats silent;
    silent.write();
    EXPECT_FALSE(std::filesystem::exists(path));
    setenv("WALLGL_STATS", path.c_str(), 1);
    Stats stats;
    unsetenv("WALLGL_STATS");
    stats.add("blocks", 1);
    stats.write();
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    EXPECT_THAT(text.str(), HasSubstr("\"blocks\": 1"));
    std::filesystem::remove(path);
    stats.write();  // nothing changed
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace wall::client
