// SPDX-License-Identifier: MIT
#include "tools/wallctl/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace wall::wallctl {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Tables, AlignColumnsAndLeaveOutTrailingBlanks) {
    const json tiles{{{"name", "a"},
                      {"node", "left"},
                      {"rect", {0, 0, 640, 480}},
                      {"output", "headless"},
                      {"pixels", {480, 640}},
                      {"rotation", 90},
                      {"shown", {"warp", "blend"}},
                      {"up", true}},
                     {{"name", "bottom"},
                      {"node", "r"},
                      {"rect", {0, 480, 64, 48}},
                      {"output", "window"},
                      {"pixels", {64, 48}},
                      {"rotation", 0},
                      {"shown", json::array()},
                      {"up", false}}};
    EXPECT_EQ(tiles_table(tiles),
              "TILE    NODE  PLACE        OUTPUT    PIXELS   SHOWN                   STATE\n"
              "a       left  640x480+0+0  headless  480x640  turned 90, warp, blend  up\n"
              "bottom  r     64x48+0+480  window    64x48    as it is                away\n");
}

TEST(Tables, ATokenIsGoodOrRevoked) {
    const json tokens{{{"name", "kiosk"}, {"role", "user"}, {"revoked", true}, {"programs", 0}},
                      {{"name", "control room"}, {"role", "operator"}, {"revoked", false}, {"programs", 2}}};
    EXPECT_EQ(tokens_table(tokens),
              "NAME          ROLE      STATE    PROGRAMS\n"
              "kiosk         user      revoked  0\n"
              "control room  operator  good     2\n");
    EXPECT_EQ(revoked_text({{"ended", 1}}), "revoked; 1 program ended\n");
    EXPECT_EQ(revoked_text({{"ended", 0}}), "revoked; 0 programs ended\n");
}

TEST(Tables, ASessionHasALineForEachWindow) {
    const json surface{{"id", "3.1"}, {"width", 300}, {"height", 200}, {"rect", {0, 0, 300, 200}}, {"frame", 7}};
    const json traffic{{"frames", 7},
                       {"state_bytes_per_second", 500},
                       {"object_bytes_per_second", 0},
                       {"geometry_bytes_per_second", 12000}};
    const json sessions{{{"id", 3},
                         {"program", "gears"},
                         {"name", ""},
                         {"pid", 42},
                         {"owner", {{"kind", "user"}, {"name", "alice"}}},
                         {"held", true},
                         {"fault", ""},
                         {"memory_bytes", 7'340'032},
                         {"traffic", traffic},
                         {"surfaces", {surface}}},
                        {{"id", 4},
                         {"program", "new"},
                         {"name", "x"},
                         {"pid", 43},
                         {"owner", {{"kind", "token"}, {"name", "kiosk"}}},
                         {"held", false},
                         {"fault", "bad stream"},
                         {"stereo", nullptr},
                         {"surfaces", json::array()}}};
    EXPECT_EQ(sessions_table(sessions),
              "ID   PROGRAM  NAME  OWNER        PID  WINDOW   PLACE        FRAME  SENT       MEMORY  NOTE\n"
              "3.1  gears          alice        42   300x200  300x200+0+0  7      12.5 kB/s  7.3 MB  held\n"
              "4    new      x     token kiosk  43                                           0.0 MB  bad stream\n");
    auto coded = sessions[0];
    coded["traffic"]["link_bytes_per_second"] = 1600;
    EXPECT_THAT(sessions_table(json::array({coded})), ::testing::HasSubstr("12.5 kB/s as 1.6 kB/s"));
}

TEST(Tables, ANodeIsUpAwayOrDrained) {
    const auto with = [](bool up, bool drained) {
        return nodes_table({{{"name", "left"}, {"up", up}, {"drained", drained}}});
    };
    EXPECT_THAT(with(true, false), HasSubstr("left  up "));
    EXPECT_THAT(with(false, false), HasSubstr("left  away "));
    EXPECT_THAT(with(false, true), HasSubstr("left  drained "));
    EXPECT_THAT(nodes_table({{{"name", "left"}, {"up", true}, {"transports", {{"ring", 3}, {"tls", 1}}}}}),
                HasSubstr("3 ring, 1 tls"));
}

TEST(Tables, SaysWhatReadingWallTomlAgainHasDone) {
    EXPECT_EQ(reloaded_text({{"tiles", 6}, {"nodes", {"a", "b"}}}),
              "the wall has 6 tiles; nodes that are new, gone or described otherwise: a b\n");
    EXPECT_EQ(reloaded_text({{"tiles", 6}, {"nodes", json::array()}}),
              "the wall has 6 tiles; nodes that are new, gone or described otherwise: none\n");
}

TEST(Tables, ASessionInStereoSaysHowFarApartTheEyesAre) {
    const auto of = [](const json& stereo, bool held) {
        return sessions_table({{{"id", 1}, {"held", held}, {"stereo", stereo}, {"surfaces", json::array()}}});
    };
    EXPECT_THAT(of({{"separation", 1.5}, {"distance", 0.0}}, false), HasSubstr("stereo 1.5 %\n"));
    EXPECT_THAT(of({{"separation", 3.0}, {"distance", 40.0}}, true), HasSubstr("held, stereo 3 % at 40\n"));
    EXPECT_THAT(of(nullptr, false), Not(HasSubstr("stereo")));
}

TEST(Tables, AParallelProgramSaysHowManyProcessesAreThere) {
    const json members{{{"rank", 0}, {"left", false}}, {{"rank", 1}, {"left", true}}, {{"rank", 3}, {"left", false}}};
    const json sessions{{{"id", 1},
                         {"program", "march"},
                         {"pid", 7},
                         {"group", {{"name", "g"}, {"size", 4}, {"members", members}}},
                         {"surfaces", json::array()}}};
    EXPECT_NE(sessions_table(sessions).find("march x2/4"), std::string::npos);
}

}  // namespace
}  // namespace wall::wallctl
