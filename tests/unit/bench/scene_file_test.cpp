// SPDX-License-Identifier: MIT
#include "bench/simulate/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace wall::simulate {
namespace {

constexpr const char* kHead =
    "session\trank\tnode\tsurface\tframe\tlink\tplain\tcommands\tblocks\tvertices\tin_pieces\n";

class SceneFile : public testing::Test {
protected:
    SceneFile() {
        std::filesystem::create_directories(folder_);
        // Frame 1 brings what later ones do not.
        write("trace.tsv", std::string(kHead) +
                               "1\t0\t0\t9\t1\t5000\t5000\t1\t1\t0\t0\n"
                               "1\t0\t0\t9\t2\t100\t400\t7\t2\t30\t20\n"
                               "1\t0\t1\t9\t2\t300\t600\t7\t2\t10\t0\n"
                               "1\t0\t1\t9\t3\t200\t600\t7\t2\t10\t0\n"
                               "1\t0\t1\t9\t4\t200\t600\t7\t2\t10\t0\n");
    }
    ~SceneFile() override { std::filesystem::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& content) {
        std::ofstream(folder_ / name) << content;
        return (folder_ / name).string();
    }
    std::string error_of(const std::string& scene) {
        const auto read = read_scene(write("scene.json", scene));
        if (read) return "";
        const std::string& said = read.error().message;
        return said.substr(said.find(folder_.string()) == 0 ? folder_.string().size() + 1 : 0);
    }

    const std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "wallgl-scene";
};

TEST_F(SceneFile, PutsCountsAndCostsTogether) {
    const auto scene = read_scene(write("scene.json", R"({
        "hosts": [{"processors": 2, "up": 1000}, {"count": 2, "down": 500}], "nodes": [1, 2, 2], "latency": 0.5,
        "frames": 20, "programs": [{"trace": "trace.tsv", "hosts": [0], "nodes": [2, 0], "last": 3, "ahead": 1,
            "pack": 0.25, "send": {"byte": 0.5, "message": 3}, "draw": {"byte": 2, "vertex": 1, "frame": 7,
            "piece_share": 0.25}, "link": {"byte": 1.5, "message": 40}}]})"));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->hosts.size(), 3u);
    EXPECT_EQ(scene->hosts[0].processors, 2);
    EXPECT_EQ(scene->hosts[0].up, 1000);
    EXPECT_EQ(scene->hosts[0].down, kUnlimited);
    EXPECT_EQ(scene->hosts[2].down, 500);
    EXPECT_EQ(std::vector(scene->nodes.begin(), scene->nodes.end()), (std::vector<std::uint32_t>{1, 2, 2}));
    EXPECT_EQ(scene->latency, 0.5);
    EXPECT_EQ(scene->frames, 20u);
    ASSERT_EQ(scene->programs.size(), 1u);
    EXPECT_EQ(scene->programs[0].ahead, 1u);
    const auto& frames = scene->programs[0].members.at(0).frames;
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[0].pack, 0.25);
    EXPECT_EQ(frames[0].send, 400 * 0.5 + 2 * 3);
    ASSERT_EQ(frames[0].messages.size(), 2u);
    EXPECT_EQ(frames[0].messages[0].node, NodeIndex(2));
    EXPECT_EQ(frames[0].messages[0].bytes, 190);
    EXPECT_EQ(frames[0].messages[0].draw, 200 + 10 + 5);
    EXPECT_EQ(frames[0].messages[0].finish, 7);
    EXPECT_EQ(frames[0].messages[1].node, NodeIndex(0));
    EXPECT_EQ(frames[1].messages.at(0).bytes, 340);
}

TEST_F(SceneFile, SaysWhatIsWrongWhere) {
    const std::string hosts = R"({"hosts": [{}], "nodes": [0, 0], "programs": [{"trace": ")";
    EXPECT_EQ(error_of(hosts + R"(none.tsv", "hosts": [0], "nodes": [0, 1]}]})"),
              "scene.json: " + (folder_ / "none.tsv").string() + ": cannot be read");
    EXPECT_EQ(error_of(hosts + R"(trace.tsv", "hosts": [0], "nodes": [0]}]})"),
              "scene.json: program 0: its trace has node 1, and it has 1 nodes");
    EXPECT_EQ(error_of(hosts + R"(trace.tsv", "hosts": [0, 0], "nodes": [0, 1]}]})"),
              "scene.json: program 0: its trace has no frames of rank 1");
    write("trace.tsv", std::string(kHead) + "1\t0\tx\n");
    EXPECT_EQ(error_of(hosts + R"(trace.tsv", "hosts": [0], "nodes": [0, 1]}]})"),
              "scene.json: " + (folder_ / "trace.tsv").string() + ":2: expected eleven numbers");
    EXPECT_THAT(error_of("{"), testing::StartsWith("scene.json: [json.exception.parse_error"));
    EXPECT_THAT(error_of("{}"), testing::HasSubstr("'hosts' not found"));
}

}  // namespace
}  // namespace wall::simulate
