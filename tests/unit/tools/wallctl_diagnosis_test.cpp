// SPDX-License-Identifier: MIT
#include "tools/wallctl/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wall::wallctl {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;

auto is(Verdict verdict, const std::string& check, const std::string& detail) {
    return AllOf(Field(&Finding::verdict, verdict), Field(&Finding::check, check),
                 Field(&Finding::detail, HasSubstr(detail)));
}

json node(const char* name, const char* renderer = "NVIDIA", const char* version = "4.6") {
    return {{"name", name},     {"up", true},           {"silent", false},   {"drained", false},
            {"incarnation", 1}, {"renderer", renderer}, {"version", version}};
}

json with(json object, const char* name, json value) {
    object[name] = std::move(value);
    return object;
}

TEST(Diagnosis, AHealthyWallHasGoodNodesOnly) {
    const json status{{"nodes", {node("left"), node("right")}}, {"tiles", json::array()}, {"sessions", json::array()}};
    EXPECT_THAT(diagnose(status),
                ElementsAre(is(Verdict::good, "node left", "NVIDIA"), is(Verdict::good, "node right", "NVIDIA")));
}

TEST(Diagnosis, SaysWhatIsTheMatterWithANode) {
    const json nodes{with(node("a"), "up", false), with(with(node("b"), "up", false), "drained", true),
                     with(node("c"), "silent", true), with(node("d"), "incarnation", 3)};
    EXPECT_THAT(diagnose({{"nodes", nodes}}), ElementsAre(is(Verdict::wrong, "node a", "systemctl status tileserver@a"),
                                                          is(Verdict::note, "node b", "wallctl node undrain b"),
                                                          is(Verdict::wrong, "node c", "nothing has been heard"),
                                                          is(Verdict::note, "node d", "started 3 times")));
}

TEST(Diagnosis, SaysWhoseClockIsWrong) {
    const json nodes{with(node("a"), "clock_ahead_ms", 2500), with(node("b"), "clock_ahead_ms", -61'000),
                     with(node("c"), "clock_ahead_ms", 900), with(node("d"), "clock_ahead_ms", nullptr)};
    const auto found = diagnose({{"nodes", nodes}});
    ASSERT_EQ(found.size(), 6u);
    EXPECT_THAT(found[1], is(Verdict::note, "clock of node a", "is 2.5 s ahead of walld's"));
    EXPECT_THAT(found[3], is(Verdict::note, "clock of node b", "is 61.0 s behind walld's"));
    EXPECT_TRUE(clock_findings("this machine", -1999).empty());
}

TEST(Diagnosis, SaysHowFastANodeIsReached) {
    using namespace std::chrono_literals;
    const json status{{"tiles", {{{"name", "a0"}, {"node", "a"}}, {{"name", "b0"}, {"node", "b"}}}}};
    EXPECT_THAT(way_finding({"a0", 112.5e6, 420us, ""}, status),
                is(Verdict::good, "bandwidth to node a", "112.5 MB/s, 0.42 ms"));
    EXPECT_THAT(way_finding({"b0", 11.8e6, 9ms, ""}, status),
                is(Verdict::note, "bandwidth to node b", "a texture of 2048x2048 takes 1.4 s"));
    EXPECT_THAT(way_finding({"b0", 0, 0us, "no answer"}, status),
                is(Verdict::wrong, "bandwidth to node b", "no answer"));
    EXPECT_EQ(way_finding({"c0", 1e9, 1ms, ""}, json::object()).check, "bandwidth to tile c0");
}

TEST(Diagnosis, SaysWhereNodesDiffer) {
    const json nodes{node("a", "llvmpipe (LLVM 15)"), node("b"), node("c", "NVIDIA", "4.5")};
    const auto found = diagnose({{"nodes", nodes}});
    ASSERT_EQ(found.size(), 5u);
    EXPECT_THAT(found[3], is(Verdict::note, "GPUs", "a draw in software, beside GPUs in b, c"));
    EXPECT_THAT(found[4], is(Verdict::note, "drivers", "b: NVIDIA, 4.6"));
    EXPECT_THAT(diagnose({{"nodes", {node("a", "llvmpipe")}}}).back(),
                is(Verdict::note, "GPUs", "all draw in software"));
}

TEST(Diagnosis, SaysWhichTilesAndWindowsAreLate) {
    const json tiles{{{"name", "A"}, {"up", true}, {"lag_frames", 30}},
                     {{"name", "B"}, {"up", true}, {"lag_frames", 29}}};
    const json windows{{{"id", "3.1"}, {"frame", 1000}, {"swap_timeouts", 10}},
                       {{"id", "3.2"}, {"frame", 1000}, {"swap_timeouts", 9}},
                       {{"id", "3.3"}, {"frame", 99}, {"swap_timeouts", 50}}};
    const json sessions{{{"id", 3}, {"fault", ""}, {"silent", false}, {"held", false}, {"surfaces", windows}}};
    EXPECT_THAT(diagnose({{"tiles", tiles}, {"sessions", sessions}}),
                ElementsAre(is(Verdict::wrong, "tiles", "A (30 frames): their nodes"),
                            is(Verdict::note, "window 3.1", "10 of its 1000 frames")));
}

TEST(Diagnosis, SaysWhatIsTheMatterWithAProgram) {
    const json sessions{{{"id", 3}, {"fault", "left: bad"}, {"silent", true}, {"held", true}}};
    EXPECT_THAT(
        diagnose({{"wall", {{"max_sessions", 1}}}, {"sessions", sessions}}),
        ElementsAre(is(Verdict::wrong, "session 3", "left: bad"), is(Verdict::note, "session 3", "says nothing"),
                    is(Verdict::note, "session 3", "is held"), is(Verdict::note, "room", "1 of 1 programs")));
}

TEST(Diagnosis, OfAnotherWalldsStatusIsOnlyWhatIsUnderstood) {
    EXPECT_THAT(diagnose(json::array()), ElementsAre(is(Verdict::wrong, "walld's answer", "no status")));
    EXPECT_THAT(diagnose({{"nodes", 3}, {"tiles", {{{"name", 4}}}}, {"sessions", {{{"id", "x"}, {"surfaces", {1}}}}}}),
                ElementsAre());
}

}  // namespace
}  // namespace wall::wallctl
