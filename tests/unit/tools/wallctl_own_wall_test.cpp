// SPDX-License-Identifier: MIT
// The description of a wall that lies in a program's own windows is one that daemons take.
#include "tools/wallctl/own_wall.h"

#include <gtest/gtest.h>

#include "common/config/load_config.h"

namespace wall::wallctl {
namespace {

TEST(AnOwnWall, HasATileInEachOfTheProgramsWindows) {
    const std::vector<Covered> windows{{":7", 0x1400003, 400, 300}, {":7", 0x1400009, 120, 500}};
    const auto config = config::parse_config(own_wall_toml("/tmp/a \"folder\"", windows), "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    ASSERT_EQ(config->nodes.size(), 1u);
    EXPECT_EQ(config->nodes[0].listen.text(), "unix:/tmp/a \"folder\"/node");
    const auto& tiles = config->nodes[0].tiles;
    ASSERT_EQ(tiles.size(), 2u);
    EXPECT_EQ(tiles[0].rect, (geom::Rect{0, 0, 400, 300}));
    EXPECT_EQ(tiles[1].rect, (geom::Rect{400, 0, 120, 500}));
    EXPECT_EQ(tiles[0].window, (config::WindowConfig{.display = ":7", .monitor = "", .parent = 0x1400003}));
    EXPECT_EQ(tiles[1].window->parent, 0x1400009u);
    EXPECT_EQ(own_wall_left(windows, 1), 400);
}

TEST(AnOwnWall, TakesTheDisplayOfItsEnvironmentWhereNoneIsNamed) {
    const auto config = config::parse_config(own_wall_toml("/tmp/x", {{"", 5, 10, 10}}), "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->nodes[0].tiles[0].window->display, "");
}

}  // namespace
}  // namespace wall::wallctl
