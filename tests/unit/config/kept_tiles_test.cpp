// SPDX-License-Identifier: MIT
#include "common/config/kept_tiles.h"

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "common/config/load_config.h"

namespace wall::config {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

/// A tileserver with tiles of these names side by side, each with what its text says further.
WallConfig wall_of(const std::vector<std::pair<std::string, std::string>>& tiles, const std::string& keys = {}) {
    std::string toml = "[[node]]\nname = \"n\"\n" + keys;
    for (std::size_t i = 0; const auto& [name, more] : tiles)
        toml += "[[node.tile]]\nname = \"" + name + "\"\nrect = [" + std::to_string(100 * i++) + ", 0, 100, 100]\n" +
                more + "\n";
    const auto config = parse_config(toml, "wall.toml");
    EXPECT_TRUE(config) << config.error().message;
    return config.value_or(WallConfig{});
}

std::map<std::string, std::uint32_t> slots(const WallConfig& wall) {
    std::map<std::string, std::uint32_t> out;
    for (const auto& node : wall.nodes)
        for (const auto& tile : node.tiles) out[tile.name] = tile.slot;
    return out;
}

std::map<std::string, std::string> places(const WallConfig& wall) {
    std::map<std::string, std::string> out;
    for (const auto& node : wall.nodes)
        for (const auto& tile : node.tiles) out[tile.name] = node.name + " " + tile.gpu;
    return out;
}

TEST(KeptTiles, HaveTheirSlotsAmongOthers) {
    const auto now = wall_of({{"a", ""}, {"b", ""}, {"c", ""}});
    auto next = wall_of({{"x", ""}, {"c", ""}, {"b", ""}, {"y", ""}});
    keep_tiles(next, now);
    EXPECT_THAT(slots(next), ElementsAre(Pair("b", 1), Pair("c", 2), Pair("x", 0), Pair("y", 3)));
}

TEST(KeptTiles, HaveThoseOfTheirRightEyes) {
    const std::string both = "stereo = \"side-by-side\"";
    const auto now = wall_of({{"a", ""}, {"b", both}});
    auto next = wall_of({{"b", both}, {"a", ""}, {"c", both}});
    keep_tiles(next, now);
    EXPECT_THAT(slots(next),
                ElementsAre(Pair("a", 0), Pair("b", 1), Pair("b/right", 2), Pair("c", 3), Pair("c/right", 4)));
    EXPECT_EQ(next.nodes[0].tile(1)->output.right_slot, 2u);
    EXPECT_EQ(next.nodes[0].tile(3)->output.right_slot, 4u);
}

TEST(KeptTiles, StayWithTheGpuThatHasComeToDrawThem) {
    const std::string two = "gpus = 2\n";
    auto now = wall_of({{"a", ""}, {"b", ""}, {"c", ""}, {"d", ""}}, two);
    ASSERT_THAT(places(now), ElementsAre(Pair("a", "n/gpu0 0"), Pair("b", "n/gpu1 1"), Pair("c", "n/gpu0 0"),
                                         Pair("d", "n/gpu1 1")));
    auto& tiles = now.nodes[0].tiles;
    now.nodes[1].tiles.push_back(tiles.back());
    now.nodes[1].tiles.back().gpu = "1";
    tiles.pop_back();
    auto next = wall_of({{"a", ""}, {"b", ""}, {"c", ""}, {"d", ""}}, two);
    keep_tiles(next, now);
    EXPECT_THAT(places(next), ElementsAre(Pair("a", "n/gpu0 0"), Pair("b", "n/gpu1 1"), Pair("c", "n/gpu1 1"),
                                          Pair("d", "n/gpu1 1")));
    EXPECT_EQ(slots(next), slots(now));
    auto said = wall_of({{"a", ""}, {"b", ""}, {"c", "gpu = 0"}, {"d", ""}}, two);
    keep_tiles(said, now);
    EXPECT_EQ(places(said).at("c"), "n/gpu0 0") << "wall.toml says so";
}

TEST(KeptTiles, AreNoWindows) {
    const std::string window = "output = \"window\"";
    const auto now = wall_of({{"a", window}, {"b", window}});
    auto next = wall_of({{"b", window}, {"a", window}});
    keep_tiles(next, now);
    EXPECT_THAT(slots(next), ElementsAre(Pair("a", 1), Pair("b", 0))) << "as the process numbers what it opens";
}

TEST(KeptTiles, ASlotThatSomebodyHadIsNotGivenToTwo) {
    const auto now = wall_of({{"a", ""}, {"b", ""}});
    auto next = wall_of({{"c", ""}, {"b", ""}});
    keep_tiles(next, now);
    EXPECT_THAT(slots(next), ElementsAre(Pair("b", 1), Pair("c", 0)));
}

}  // namespace
}  // namespace wall::config
