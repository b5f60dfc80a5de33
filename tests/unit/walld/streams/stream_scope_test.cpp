// SPDX-License-Identifier: MIT
#include "walld/streams/stream_scope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/load_config.h"
#include "tests/support/small_wall.h"

namespace wall::walld {
namespace {

using ::testing::HasSubstr;

class StreamScopeTest : public ::testing::Test {
protected:
    static std::string config() {
        std::string out = "[[node]]\nname = \"n\"\n";
        for (const auto* tile :
             {"\"a\"\nrect = [0, 0, 101, 77]", "\"b\"\nrect = [101, 0, 99, 77]", "\"c\"\nrect = [0, 77, 101, 33]",
              "\"d\"\nrect = [101, 77, 99, 33]", "\"far\"\nrect = [220, 0, 50, 110]"})
            out += std::string("[[node.tile]]\nname = ") + tile + "\n";
        return out;
    }
    StreamScope scope(const WatchRequest& request) {
        const auto made = scope_of(wall_, request);
        EXPECT_TRUE(made) << made.error().message;
        return made.value_or(StreamScope{});
    }
    std::string error(const WatchRequest& request) {
        const auto made = scope_of(wall_, request);
        return made ? "" : made.error().message;
    }
    NoOutbox out_;
    Wall wall_{*config::parse_config(config(), "test"), out_, [](std::size_t n) { return std::string(n, 'x'); }};
};

TEST_F(StreamScopeTest, ATileIsOnePart) {
    const auto tile = scope({.tile = "b"});
    EXPECT_EQ(tile.rect, (geom::Rect{101, 0, 99, 77}));
    const auto parts = parts_of(wall_, tile);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].slot, 1u);
    EXPECT_EQ(parts[0].crop, (geom::Rect{0, 0, 99, 77}));
    EXPECT_EQ(parts[0].at, (geom::Rect{0, 0, 99, 77}));
}

TEST_F(StreamScopeTest, ARegionIsInTheTilesPixels) {
    const auto parts = parts_of(wall_, scope({.tile = "d", .region = geom::Rect{9, 3, 90, 30}, .width = 45}));
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].crop, (geom::Rect{9, 3, 90, 30}));
    EXPECT_EQ(parts[0].at, (geom::Rect{0, 0, 45, 30}));
    EXPECT_EQ(error({.tile = "d", .region = geom::Rect{10, 3, 90, 30}}), ".region: expected a part of 99x33 pixels");
    EXPECT_EQ(error({.tile = "x"}), ".tile: there is no tile 'x'");
}

TEST_F(StreamScopeTest, ARegionOfTheWallTakesTheTilesItTouches) {
    const auto parts = parts_of(wall_, scope({.wall = true, .region = geom::Rect{100, 70, 150, 7}}));
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].at, (geom::Rect{0, 0, 1, 7}));
    EXPECT_EQ(parts[1].at, (geom::Rect{1, 0, 99, 7}));
    EXPECT_EQ(parts[2].at, (geom::Rect{120, 0, 30, 7})) << "20 pixels of bezel";
    EXPECT_EQ(parts[2].crop, (geom::Rect{0, 70, 30, 7}));
}

TEST_F(StreamScopeTest, TilesThatTouchTouchInThePictureInEverySize) {
    for (std::uint32_t width = 1; width <= 270; ++width) {
        const auto whole = scope({.wall = true, .width = width, .height = width / 3 + 1});
        std::vector<int> covered(std::size_t{whole.width} * whole.height);
        for (const auto& part : parts_of(wall_, whole)) {
            EXPECT_LE(part.at.width, part.crop.width);
            EXPECT_LE(part.at.height, part.crop.height);
            for (auto y = part.at.y; y < part.at.bottom(); ++y)
                for (auto x = part.at.x; x < part.at.right(); ++x)
                    ++covered.at(static_cast<std::size_t>(y) * whole.width + static_cast<std::size_t>(x));
        }
        const auto left_four = static_cast<std::int32_t>(whole.width * 200 / 270);
        for (std::uint32_t y = 0; y < whole.height; ++y)
            for (std::int32_t x = 0; x < left_four; ++x)
                EXPECT_EQ(covered[y * whole.width + static_cast<std::uint32_t>(x)], 1)
                    << width << ": " << x << "," << y;
    }
}

TEST_F(StreamScopeTest, ABoxKeepsProportions) {
    const auto size = [&](std::uint32_t width, std::uint32_t height) {
        const auto made = scope({.wall = true, .width = width, .height = height, .fit = true});
        return std::pair(made.width, made.height);
    };
    EXPECT_EQ(size(135, 100), std::pair(135u, 55u));
    EXPECT_EQ(size(200, 55), std::pair(135u, 55u));
    EXPECT_EQ(size(0, 0), std::pair(270u, 110u));
    EXPECT_EQ(size(1000, 1000), std::pair(270u, 110u));
    EXPECT_EQ(size(1, 0), std::pair(1u, 1u));
}

TEST_F(StreamScopeTest, OfAWindowThatIsNotThere) {
    EXPECT_EQ(error({.session = SessionId(9)}), ".session: there is no session 9");
    EXPECT_EQ(scope({.wall = true, .session = SessionId(9)}).session, SessionId(9)) << "the wall with nothing on it";
}

TEST(WatchRequest, SaysWhatWasExpected) {
    const auto error = [](const std::string& entries) {
        const auto parsed = WatchRequest::parse("{\"watch\": [" + entries + "]}");
        return parsed ? std::string() : parsed.error().message;
    };
    EXPECT_EQ(error(R"({"tile": "l", "fps": 60, "width": 1, "session": 3, "surface": 1, "region": [0, 0, 1, 1]})"), "");
    EXPECT_EQ(error(R"({"wall": true, "fit": true}, {"session": 3})"), "");
    EXPECT_EQ(WatchRequest::parse("{").error().message, "expected {\"watch\": [...]}");
    EXPECT_FALSE(WatchRequest::parse("{\"watch\": " + std::string(30'000, '[') + std::string(30'000, ']') + "}"));
    EXPECT_EQ(error(R"({"tile": "l"}, 3)"), "watch[1]: expected an object");
    EXPECT_EQ(error("{}"), R"(watch[0]: expected "tile": NAME, "wall": true or "session": NUMBER)");
    EXPECT_EQ(error(R"({"wall": false})"), R"(watch[0]: expected "tile": NAME, "wall": true or "session": NUMBER)");
    EXPECT_EQ(error(R"({"tile": ""})"), "watch[0].tile: expected a text");
    EXPECT_EQ(error(R"({"wall": 1})"), "watch[0].wall: expected true or false");
    EXPECT_EQ(error(R"({"tile": "l", "wall": true})"), "watch[0]: expected a tile or the wall, not both");
    EXPECT_EQ(error(R"({"tile": "l", "surface": 1})"), "watch[0].surface: expected a session with it");
    EXPECT_EQ(error(R"({"session": 3, "region": [0, 0, 1, 1]})"),
              "watch[0].region: goes with a tile or the wall; a window is shown as a whole");
    for (const auto* region :
         {"[0, 0, 1]", "[0, 0, 1, 0]", "[-1, 0, 1, 1]", "[0, 0, 1, 99999]", "[0.5, 0, 1, 1]", "\"all\""})
        EXPECT_EQ(error(std::string(R"({"wall": true, "region": )") + region + "}"),
                  "watch[0].region: expected [x, y, width, height] in pixels");
    EXPECT_EQ(error(R"({"tile": "l", "fps": 61})"), "watch[0].fps: expected a whole number from 1 to 60");
    EXPECT_EQ(error(R"({"tile": "l", "width": -1})"), "watch[0].width: expected a whole number from 1 to 32768");
    EXPECT_THAT(error(R"({"tile": "l", "codec": "mp3"})"), HasSubstr("watch[0].codec: "));
    std::string many = "{}";
    for (std::size_t i = 0; i < WatchRequest::kMost; ++i) many += ",{}";
    EXPECT_THAT(error(many), HasSubstr("at most 256 streams"));
}

}  // namespace
}  // namespace wall::walld
