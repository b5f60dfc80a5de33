// SPDX-License-Identifier: MIT
#include "tools/wallctl/watch_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/wallctl/columns.h"

namespace wall::wallctl {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Screen kEndless{kAnyWidth, kAnyWidth};

json surface(int frame, double skew) {
    return {{"id", "3.1"},
            {"rect", {0, 0, 100, 100}},
            {"shown_rect", {0, 0, 100, 100}},
            {"frame", frame},
            {"skew", {{"presented", {{"frames", frame}, {"last_ms", skew}}}}}};
}

json status(int frames) {
    return {{"wall", {{"name", "lab"}, {"width", 200}, {"height", 100}}},
            {"nodes", {{{"name", "left"}, {"up", true}}, {{"name", "right"}, {"up", false}}}},
            {"tiles",
             {{{"name", "l"},
               {"node", "left"},
               {"rect", {0, 0, 100, 100}},
               {"up", true},
               {"frames", frames},
               {"age_ms", 20},
               {"lag_frames", 0}},
              {{"name", "r"},
               {"node", "right"},
               {"rect", {100, 0, 100, 100}},
               {"up", false},
               {"frames", 0},
               {"age_ms", nullptr},
               {"lag_frames", 0}}}},
            {"sessions",
             {{{"id", 3},
               {"program", "gears"},
               {"name", ""},
               {"pid", 42},
               {"owner", {{"kind", "user"}, {"name", "alice"}}},
               {"held", false},
               {"fault", ""},
               {"traffic",
                {{"frames", 7},
                 {"state_bytes_per_second", 0},
                 {"object_bytes_per_second", 0},
                 {"geometry_bytes_per_second", 12000}}},
               {"surfaces", {surface(frames, 1.5)}}}}},
            {"streams",
             {{{"tile", "l"},
               {"node", "left"},
               {"region", nullptr},
               {"session", nullptr},
               {"codec", "huffyuv"},
               {"width", 50},
               {"height", 50},
               {"fps", 10},
               {"viewers", 2},
               {"frames", frames / 2},
               {"bytes", 1000 * frames},
               {"dropped", 1}}}}};
}

TEST(WatchText, ShowsRatesBetweenTwoStatuses) {
    EXPECT_EQ(watch_text(with_rates(status(100), status(160), 2), "12:00:00", kEndless),
              "wall lab: 200x100, 1 of 2 nodes up, 1 programs  12:00:00\n"
              "\n"
              "TILE  STATE  FPS   AGE    SKEW    NODE   PLACE\n"
              "l     up     30.0  0.0 s  1.5 ms  left   100x100+0+0\n"
              "r     away   0.0                  right  100x100+100+0\n"
              "\n"
              "ID   PROGRAM  OWNER  FPS   SENT       PLACE        NOTE\n"
              "3.1  gears    alice  30.0  12.0 kB/s  100x100+0+0\n"
              "\n"
              "WATCHED  SIZE   FPS   SENT       DROPPED  VIEWERS  CODEC    REGION  ONLY\n"
              "l        50x50  15.0  30.0 kB/s  1        2        huffyuv\n");
}

TEST(WatchText, HasNoRatesInTheBeginningAndAfterARestart) {
    EXPECT_FALSE(with_rates(json(), status(5), 0)["tiles"][0].contains("frames_per_second"));
    EXPECT_FALSE(with_rates(status(50), status(5), 1)["tiles"][0].contains("frames_per_second"));
    EXPECT_EQ(with_rates(status(1), status(5), 2)["sessions"][0]["surfaces"][0]["frames_per_second"], 2.0);
}

TEST(WatchText, ATileThatLacksFramesIsLate) {
    auto late = status(5);
    late["tiles"][0]["lag_frames"] = 3;
    EXPECT_THAT(watch_text(late, "", kEndless), HasSubstr("late 3"));
}

TEST(WatchText, FitsEveryScreen) {
    const auto rated = with_rates(status(100), status(160), 2);
    for (std::size_t columns = 1; columns < 90; ++columns) {
        for (std::size_t rows = 1; rows < 14; ++rows) {
            std::istringstream lines(watch_text(rated, "12:00:00", {columns, rows}));
            std::size_t count = 0;
            for (std::string line; std::getline(lines, line); ++count) {
                if (!line.ends_with("more lines")) {
                    EXPECT_LE(std::ranges::count_if(line, [](char c) { return (c & 0xc0) != 0x80; }),
                              static_cast<std::ptrdiff_t>(columns))
                        << line;
                }
            }
            EXPECT_LE(count, rows);
        }
    }
}

TEST(WatchText, ANarrowScreenKeepsWhatMattersMost) {
    const auto narrow = watch_text(with_rates(status(100), status(160), 2), "", {30, kAnyWidth});
    EXPECT_THAT(narrow, HasSubstr("TILE  STATE  FPS   AGE\n"));
    EXPECT_THAT(narrow, HasSubstr("ID   PROGRAM  FPS   SENT\n"));
    EXPECT_THAT(narrow, Not(HasSubstr("NODE")));
}

TEST(Columns, AreCutByCharacters) {
    EXPECT_EQ(cut("größer", 6), "größer");
    EXPECT_EQ(cut("größer", 4), "grö…");
    EXPECT_EQ(cut("größer", 0), "");
    EXPECT_EQ(table({{"A", "B"}, {"ö", "x"}}), "A  B\nö  x\n");
    EXPECT_EQ(printable("a\x1b[2Jb\n"), "a?[2Jb?");
}

}  // namespace
}  // namespace wall::wallctl
