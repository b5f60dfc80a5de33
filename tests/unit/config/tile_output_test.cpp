// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/config/load_config.h"
#include "common/config/read_warp.h"
#include "tests/support/temporary_folder.h"

namespace wall::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A wall of one tile with these keys, from line 5 on.
std::string wall_with(const std::string& keys, const std::string& rect = "[0, 0, 640, 480]") {
    return "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"a\"\nrect = " + rect + "\n" + keys + "\n";
}

TileConfig tile_with(const std::string& keys, const std::string& rect = "[0, 0, 640, 480]") {
    const auto config = parse_config(wall_with(keys, rect), "wall.toml");
    EXPECT_TRUE(config) << config.error().message;
    return config ? config->nodes[0].tiles[0] : TileConfig{};
}

std::string refusal_of(const std::string& text) {
    const auto config = parse_config(text, "wall.toml");
    EXPECT_FALSE(config) << text;
    return config ? "" : config.error().message;
}

TEST(TileOutputConfig, IsPlainUnlessItIsSaid) {
    const auto tile = tile_with("");
    EXPECT_TRUE(geom::is_plain(tile.output, tile.rect));
}

TEST(TileOutputConfig, OfAMonitorOnItsSideHasItsOwnPixels) {
    const auto upright = tile_with("rotation = 90", "[0, 0, 1080, 1920]");
    EXPECT_EQ(upright.output.rotation, 90u);
    EXPECT_EQ(upright.output.width, 1920);
    EXPECT_EQ(upright.output.height, 1080);
    const auto large = tile_with("rotation = 180\npixels = [3840, 2160]", "[0, 0, 1920, 1080]");
    EXPECT_EQ(large.output.width, 3840);
    EXPECT_EQ(large.output.height, 2160);
}

TEST(TileOutputConfig, ReadsBlendAndColour) {
    const auto config = parse_config(
        "[[node]]\nname = \"n\"\n"
        "[[node.tile]]\nname = \"a\"\nrect = [0, 0, 640, 480]\nblend = { right = 40, gamma = 2.4, black = 0.01 }\n"
        "color = { matrix = [1, 0, 0, 0, 0.9, 0, 0, 0, 0.8], gamma = 2.1, curve = [[0, 1], [0, 0.4, 0.9], [0.1, 1]] }\n"
        "[[node.tile]]\nname = \"b\"\nrect = [600, 0, 640, 480]\nblend = { left = 40 }\ncolor = { curve = [0, 0.9] }\n",
        "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    const auto &a = config->nodes[0].tiles[0].output, &b = config->nodes[0].tiles[1].output;
    EXPECT_THAT(a.blend->ramps, ElementsAre(0, 40, 0, 0));
    EXPECT_FLOAT_EQ(a.blend->gamma, 2.4f);
    EXPECT_FLOAT_EQ(a.blend->black, 0.01f);
    EXPECT_FLOAT_EQ(a.color->matrix[4], 0.9f);
    EXPECT_FLOAT_EQ(a.color->gamma, 2.1f);
    EXPECT_THAT(a.color->curves[1], ElementsAre(0, 0.4f, 0.9f));
    EXPECT_THAT(b.blend->ramps, ElementsAre(40, 0, 0, 0));
    for (const auto& curve : b.color->curves) EXPECT_THAT(curve, ElementsAre(0, 0.9f));
}

TEST(TileOutputConfig, SaysWhatIsWrongAndWhatWasExpected) {
    const std::vector<std::pair<std::string, std::string>> rows{
        {"rotation = 45", "wall.toml:6: 'rotation': expected the degrees"},
        {"rotation = \"90\"", "wall.toml:6: 'rotation'"},
        {"pixels = [0, 5]", "wall.toml:6: 'pixels': expected a number from 1 to 16384"},
        {"pixels = [20.5, 5]", "wall.toml:6: 'pixels': expected whole numbers"},
        {"pixels = 5", "wall.toml:6: 'pixels': expected [width, height]"},
        {"blend = { up = 3 }", "wall.toml:6: unknown key 'up' in 'blend'"},
        {"blend = { left = -1 }", "wall.toml:6: 'left': expected an integer"},
        {"blend = { gamma = 0 }", "wall.toml:6: 'gamma': expected a number from 0.1 to 10"},
        {"blend = { left = 40 }", "wall.toml:6: 'left' of 'blend': no other tile shows any of these 40 pixels"},
        {"blend = 3", "wall.toml:6: 'blend': expected a [blend] table"},
        {"color = { matrix = [1, 2] }", "wall.toml:6: 'matrix': expected 9 numbers"},
        {"color = { curve = [1] }", "wall.toml:6: 'curve': expected 2 to 256 numbers"},
        {"color = { curve = [0, 2] }", "wall.toml:6: 'curve': expected a number from 0 to 1"},
        {"color = { curve = [0, nan] }", "wall.toml:6: 'curve': expected a number from 0 to 1"},
        {"bezel_mm = 5", "wall.toml:6: 'bezel_mm': expected 'size_mm' beside it"},
        {"size_mm = [0, 1]", "wall.toml:6: 'size_mm': expected a number from 1"},
        {"size_mm = [5, 5]\nbezel_mm = [1, 2]", "wall.toml:7: 'bezel_mm': expected millimetres, or"},
        {"warp = \"\"", "wall.toml:6: 'warp' is empty"},
    };
    for (const auto& [keys, expected] : rows) EXPECT_THAT(refusal_of(wall_with(keys)), StartsWith(expected)) << keys;
}

TEST(TileOutputConfig, WantsRoomForBothRamps) {
    const std::string two =
        "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"a\"\nrect = [0, 0, 100, 50]\nblend = { left = 60, right = 60 "
        "}\n"
        "[[node.tile]]\nname = \"b\"\nrect = [0, 0, 100, 50]\n";
    EXPECT_THAT(refusal_of(two), StartsWith("wall.toml:6: tile 'a' is 100 pixels from edge to edge"));
}

/// Three monitors in a row and two below, 10 pixels a millimetre.
TEST(TileOutputConfig, PutsWhatBezelsHideOnTheCanvas) {
    const auto tile = [](const std::string& name, const std::string& rect, const std::string& bezel) {
        return "[[node.tile]]\nname = \"" + name + "\"\nrect = " + rect + "\n" +
               (bezel.empty() ? "" : "size_mm = [10, 5]\nbezel_mm = " + bezel + "\n");
    };
    const auto config =
        parse_config("[[node]]\nname = \"n\"\n" + tile("a", "[0, 0, 100, 50]", "1") +
                         tile("b", "[100, 0, 100, 50]", "[2, 3, 1, 1]") + tile("c", "[200, 0, 100, 50]", "0.5") +
                         tile("d", "[0, 50, 100, 50]", "1") + tile("e", "[100, 50, 100, 50]", ""),
                     "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    const auto& tiles = config->nodes[0].tiles;
    EXPECT_EQ(tiles[0].rect, (geom::Rect{0, 0, 100, 50})) << "the outermost bezels hide nothing";
    EXPECT_EQ(tiles[1].rect, (geom::Rect{130, 0, 100, 50})) << "1 mm and 2 mm";
    EXPECT_EQ(tiles[2].rect, (geom::Rect{265, 0, 100, 50})) << "3 mm and half a one more";
    EXPECT_EQ(tiles[3].rect, (geom::Rect{0, 70, 100, 50}));
    EXPECT_EQ(tiles[4].rect, (geom::Rect{110, 60, 100, 50})) << "no bezels of its own, those of its neighbours";
    EXPECT_THAT(refusal_of("[[node]]\nname = \"n\"\n" + tile("a", "[0, 0, 100, 50]", "1") +
                           tile("b", "[32600, 0, 168, 50]", "[99, 0, 0, 0]")),
                HasSubstr("tile 'b' lies beyond 32768 pixels"));
}

TEST(TileOutputConfig, IsOtherButTheNodeDrawsTheSame) {
    const auto draws = [](const std::string& a, const std::string& b) {
        return draws_as(parse_config(wall_with(a), "wall.toml")->nodes[0],
                        parse_config(wall_with(b), "wall.toml")->nodes[0]);
    };
    EXPECT_TRUE(draws("", "rotation = 180\ncolor = { gamma = 2 }\nwarp = \"x\"\npixels = [5, 5]"));
    EXPECT_FALSE(draws("output = \"window\"", "output = \"window\"\npixels = [5, 5]")) << "a window of another size";
    EXPECT_FALSE(draws("", "output = \"window\""));
    EXPECT_FALSE(draws("", "gpu = 1"));
}

TEST(WarpFile, IsAHomographyOrAMesh) {
    const auto homography = parse_warp("homography = [1, 0, 0.1, 0, 1, 0, 0, 0, 1]", "a.toml");
    ASSERT_TRUE(homography) << homography.error().message;
    EXPECT_FLOAT_EQ(homography->homography[2], 0.1f);
    const auto mesh =
        parse_warp("[mesh]\ncolumns = 2\nrows = 2\npoints = [[0, 0], [1, 0.0], [0, 1], [1.1, 1]]", "a.toml");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->columns, 2u);
    EXPECT_EQ(mesh->points[3], (geom::Point{1.1f, 1}));
    const auto holed = parse_warp("[mesh]\ncolumns = 2\nrows = 2\npoints = [[0, 0], [1, 0.0], [], [1, 1]]", "a.toml");
    ASSERT_TRUE(holed) << holed.error().message;
    EXPECT_TRUE(std::isnan(holed->points[2].x) && std::isnan(holed->points[2].y));
    EXPECT_EQ(holed->points[3], (geom::Point{1, 1}));
}

TEST(WarpFile, SaysWhatIsWrongAndWhatWasExpected) {
    const std::vector<std::pair<std::string, std::string>> rows{
        {"", "a.toml:1: expected 'homography' or [mesh], one of them"},
        {"homography = [1]", "a.toml:1: 'homography': expected 9 numbers"},
        {"\nhomography = [1, 0, 0, 0, 0, 0, 0, 0, 1]", "a.toml:2: this warp makes a line"},
        {"[mesh]\ncolumns = 2\nrows = 2\npoints = [[0, 0]]", "a.toml:4: [mesh]: expected 'columns', 'rows' and"},
        {"[mesh]\ncolumns = 99999999\nrows = 2\npoints = []", "a.toml:2: 'columns': expected an integer from 2"},
        {"[mesh]\ncolumns = 2\nrows = 2\npoints = [[0, 0], [1, 0], [0, 1], [inf, 1]]",
         "a.toml:4: 'points': expected a"},
        {"[mesh]\ncolumns = 2\nrows = 2\npoints = [[1, 0], [0, 0], [0, 1], [1, 1]]", "a.toml:1: this warp is folded"},
        {"[mesh]\ncolumns = 2\nrows = 2\npoints = [[0, 0], [1, 0], [0, 1], [1]]",
         "a.toml:4: 'points': expected [x, y], or [] for black"},
        {"mesh = 3", "a.toml:1: 'mesh': expected a [mesh] table"},
        {"what = 1", "a.toml:1: unknown key 'what'"},
    };
    for (const auto& [text, expected] : rows) {
        const auto warp = parse_warp(text, "a.toml");
        ASSERT_FALSE(warp) << text;
        EXPECT_THAT(warp.error().message, StartsWith(expected)) << text;
    }
}

TEST(WarpFile, LiesBesideWallToml) {
    const test::TemporaryFolder folder;
    auto config = parse_config(wall_with("warp = \"a.warp\""), "wall.toml");
    ASSERT_TRUE(config);
    const auto folder_path = std::filesystem::path(folder.file("wall.toml")).parent_path();
    const auto missing = load_warps(*config, folder_path);
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("a.warp: cannot be read: expected the warp of tile 'a'"));
    EXPECT_FALSE(config->nodes[0].tiles[0].output.warp);
    std::ofstream(folder.file("a.warp")) << "homography = [1, 0, 0, 0, 1, 0, 0, 0, 2]";
    ASSERT_TRUE(load_warps(*config, folder_path));
    EXPECT_FLOAT_EQ(config->nodes[0].tiles[0].output.warp->homography[8], 2);
}

}  // namespace
}  // namespace wall::config
