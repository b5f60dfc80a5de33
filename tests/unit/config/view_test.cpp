// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/load_config.h"

namespace wall::config {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A wall of one tile with these keys, from line 6 on.
std::string wall_with(const std::string& keys, const std::string& wall = "") {
    return "[wall]\n" + wall + "\n[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"a\"\nrect = [0, 0, 640, 480]\n" +
           keys + "\n";
}

std::optional<geom::View> view_with(const std::string& keys, const std::string& wall = "") {
    const auto config = parse_config(wall_with(keys, wall), "wall.toml");
    EXPECT_TRUE(config) << config.error().message;
    return config ? config->nodes[0].tiles[0].view : std::nullopt;
}

std::string refusal_of(const std::string& keys) {
    const auto config = parse_config(wall_with(keys), "wall.toml");
    EXPECT_FALSE(config) << keys;
    return config ? "" : config.error().message;
}

TEST(ViewConfig, ATileLooksNowhereElseUnlessItIsSaid) { EXPECT_FALSE(view_with("").has_value()); }

TEST(ViewConfig, AnglesAreThoseOfTheTile) {
    EXPECT_EQ(view_with("yaw = 45\npitch = -5\nroll = 2.5\nfov = [60, 40]"), geom::view_of_angles(45, -5, 2.5, 60, 40));
    EXPECT_EQ(view_with("fov = 90"), geom::view_of_angles(0, 0, 0, 90, geom::angle_of_ratio(90, 0.75)))
        << "pixels are as high as they are wide";
}

TEST(ViewConfig, AScreenIsSeenFromTheEyeOfTheWall) {
    const std::string screen =
        "screen = { lower_left = [-1, 0, -2], lower_right = [1, 0, -2], upper_left = [-1, 1.5, -2] }";
    const auto from_origin = view_with(screen), from_eye = view_with(screen, "eye = [0, 0.75, -1]");
    ASSERT_TRUE(from_origin && from_eye);
    EXPECT_FLOAT_EQ(from_origin->bottom, 0);
    EXPECT_FLOAT_EQ(from_origin->top, 0.75f);
    EXPECT_FLOAT_EQ(from_eye->bottom, -0.75f);
    EXPECT_FLOAT_EQ(from_eye->right_edge, 1);
}

TEST(ViewConfig, SaysWhatIsWrong) {
    const struct {
        const char *keys, *says;
    } cases[] = {
        {"yaw = 45", "wall.toml:8: 'yaw': expected 'fov' beside it"},
        {"fov = 0", "wall.toml:8: 'fov': expected a number from"},
        {"fov = 180", "wall.toml:8: 'fov': expected a number from"},
        {"fov = [60]", "wall.toml:8: 'fov': expected an angle in degrees, or [width, height]"},
        {"fov = 60\npitch = \"up\"", "wall.toml:9: 'pitch': expected a number from"},
        {"fov = 60\nroll = 400", "wall.toml:9: 'roll': expected a number from"},
        {"screen = { lower_left = [0, 0, 0] }", "wall.toml:8: 'screen': 'lower_right' is missing: expected [x, y, z]"},
        {"screen = { lower_left = [0, 0], lower_right = [1, 0, 0], upper_left = [0, 1, 0] }",
         "wall.toml:8: 'lower_left': expected [x, y, z] in metres"},
        {"screen = { lower_left = [0, 0, -1], lower_right = [1, 0, -1], upper_left = [2, 0, -1] }",
         "wall.toml:8: 'screen': the three corners lie on one line: expected three corners of a rectangle"},
        {"screen = { lower_left = [0, 0, 0], lower_right = [1, 0, 0], upper_left = [0, 1, 0] }",
         "wall.toml:8: 'screen': the eye lies in the screen's plane: expected"},
        {"screen = { lower_left = [0, 0, -1], lower_right = [1, 0, -1], upper_left = [0, 1, -1] }\nfov = 60",
         "wall.toml:9: 'fov' beside 'screen': expected either"},
        {"screen = { lower_left = [0, 0, -1], lower_right = [1, 0, -1], upper_left = [0, 1, -1], eye = 1 }",
         "wall.toml:8: unknown key 'eye' in 'screen'"},
    };
    for (const auto& [keys, says] : cases) EXPECT_THAT(refusal_of(keys), StartsWith(says)) << keys;
}

/// Two tiles with these keys, at one place.
std::string pair_with(const std::string& first, const std::string& second) {
    return wall_with(first) + "[[node.tile]]\nname = \"b\"\nrect = [0, 0, 640, 480]\n" + second + "\n";
}

TEST(EyesConfig, ATileIsForBothEyesOrOne) {
    const auto config = parse_config(pair_with("eye = \"left\"", "eye = \"right\"\nyaw = 30\nfov = 60"), "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    const auto& tiles = config->nodes[0].tiles;
    ASSERT_EQ(tiles.size(), 2u);
    EXPECT_EQ(tiles[0].eye, geom::Eye::left);
    EXPECT_EQ(tiles[1].eye, geom::Eye::right);
    EXPECT_TRUE(tiles[1].view.has_value());
}

TEST(EyesConfig, AnOutputThatShowsBothHasACompanionForTheRightEye) {
    const auto config =
        parse_config(pair_with("stereo = \"rows\"\npixels = [320, 240]\nyaw = 30\nfov = 60", ""), "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    const auto& tiles = config->nodes[0].tiles;
    ASSERT_EQ(tiles.size(), 3u);
    EXPECT_EQ(tiles[0].eye, geom::Eye::left);
    EXPECT_EQ(tiles[0].output.stereo, geom::StereoLayout::rows);
    EXPECT_EQ(tiles[0].output.right_slot, 2u);
    EXPECT_EQ(tiles[1].eye, geom::Eye::both);
    EXPECT_EQ(tiles[2].name, "a/right");
    EXPECT_EQ(tiles[2].eye, geom::Eye::right);
    EXPECT_EQ(tiles[2].rect, tiles[0].rect);
    EXPECT_EQ(tiles[2].view, tiles[0].view);
    EXPECT_TRUE(geom::is_plain(tiles[2].output, tiles[2].rect));
}

/// Each GPU is a node, and a tile's companion is drawn by the tile's.
TEST(EyesConfig, CompanionsAreWithTheirTiles) {
    const auto config = parse_config(
        "[[node]]\nname = \"n\"\ngpus = 2\n"
        "[[node.tile]]\nname = \"a\"\nrect = [0, 0, 64, 48]\nstereo = \"anaglyph\"\n"
        "[[node.tile]]\nname = \"b\"\nrect = [64, 0, 64, 48]\nstereo = \"over-under\"\n",
        "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    ASSERT_EQ(config->nodes.size(), 2u);
    for (const auto& node : config->nodes) {
        ASSERT_EQ(node.tiles.size(), 2u) << node.name;
        EXPECT_EQ(node.tiles[1].name, node.tiles[0].name + "/right");
        EXPECT_EQ(node.tiles[0].output.right_slot, node.tiles[1].slot);
    }
}

TEST(EyesConfig, SaysWhatIsWrong) {
    const struct {
        const char *first, *second, *says;
    } cases[] = {
        {"eye = \"middle\"", "", "wall.toml:8: 'eye' is 'middle': expected \"left\" or \"right\""},
        {"eye = \"left\"", "", "wall.toml:8: tile 'a' is for one eye, and the other sees nothing there: expected"},
        {"eye = \"left\"", "eye = \"left\"", "wall.toml:8: tile 'a' is for one eye"},
        {"stereo = \"shutter\"", "", "wall.toml:8: 'stereo' is 'shutter': expected \"side-by-side\", \"over-under\""},
        {"stereo = \"rows\"\neye = \"left\"", "", "wall.toml:9: 'eye' beside 'stereo': expected one of them"},
        {"pixels = [639, 480]\nstereo = \"side-by-side\"", "",
         "wall.toml:9: 'stereo' is 'side-by-side' on an output of 639 columns: expected an even number"},
        {"pixels = [640, 479]\nstereo = \"rows\"", "", "'rows' on an output of 479 rows: expected an even number"},
    };
    for (const auto& [first, second, says] : cases) {
        const auto config = parse_config(pair_with(first, second), "wall.toml");
        ASSERT_FALSE(config) << first;
        EXPECT_THAT(config.error().message, HasSubstr(says)) << first;
    }
}

TEST(ViewConfig, NodesThatAreAddedStandInTheSameRoom) {
    const std::string node =
        "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"a\"\nrect = [0, 0, 8, 6]\n"
        "screen = { lower_left = [0, 0, 0], lower_right = [1, 0, 0], upper_left = [0, 1, 0] }\n";
    const auto at_origin = parse_nodes(node, "the node");
    ASSERT_FALSE(at_origin);
    EXPECT_THAT(at_origin.error().message, HasSubstr("the eye lies in the screen's plane"));
    const auto behind = parse_nodes(node, "the node", {0, 0, 1});
    ASSERT_TRUE(behind) << behind.error().message;
    EXPECT_TRUE((*behind)[0].tiles[0].view.has_value());
}

}  // namespace
}  // namespace wall::config
