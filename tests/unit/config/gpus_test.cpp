// SPDX-License-Identifier: MIT
#include "common/config/gpus.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "common/config/load_config.h"

namespace wall::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A [[node]] of tiles of 100x100 pixels in rows of `columns`, with these keys.
std::string node_of(std::size_t columns, const std::vector<std::string>& tiles, const std::string& keys = {}) {
    std::string out = "[[node]]\nname = \"n\"\n" + keys;
    for (std::size_t i = 0; i < tiles.size(); ++i)
        out += "[[node.tile]]\nname = \"" + std::to_string(i) + "\"\nrect = [" + std::to_string(i % columns * 100) +
               ", " + std::to_string(i / columns * 100) + ", 100, 100]\n" + tiles[i] + "\n";
    return out;
}

std::string refusal_of(const std::string& toml) {
    const auto config = parse_config(toml, "wall.toml");
    return config ? "nothing" : config.error().message;
}

/// What draws each tile, in the tiles' order.
std::vector<std::string> dealt(std::size_t columns, const std::vector<std::string>& tiles,
                               const std::string& keys = {}) {
    const auto config = parse_config(node_of(columns, tiles, keys), "wall.toml");
    EXPECT_TRUE(config) << config.error().message;
    std::vector<std::string> out(tiles.size());
    for (const auto& node : config->nodes)
        for (const auto& tile : node.tiles) out[std::stoul(tile.name)] = tile.gpu;
    return out;
}

std::vector<std::string> names(const WallConfig& config) {
    std::vector<std::string> out;
    for (const auto& node : config.nodes) out.push_back(node.name);
    return out;
}

TEST(TileGpu, IsAnyANumberOrAnAddress) {
    EXPECT_EQ(dealt(1, {""})[0], "auto");
    EXPECT_EQ(dealt(1, {"gpu = \"auto\""})[0], "auto");
    EXPECT_EQ(dealt(1, {"gpu = 3"})[0], "3");
    EXPECT_EQ(dealt(1, {"gpu = \"0000:65:00.0\""})[0], "0000:65:00.0");
    for (const auto* wrong : {"-1", "64", "1.5", "\"\"", "\"first\"", "\"3\"", "\"65:00.0; rm\"", "[1]"})
        EXPECT_THAT(refusal_of(node_of(1, {std::string("gpu = ") + wrong})), StartsWith("wall.toml:6: 'gpu'")) << wrong;
}

TEST(TileGpu, IsDealtOutLikeACheckerboard) {
    EXPECT_THAT(dealt(2, {"", "", "", ""}, "gpus = 2\n"), ElementsAre("0", "1", "1", "0"));
    EXPECT_THAT(dealt(4, {"", "", "", "", "", "", "", ""}, "gpus = 2\n"),
                ElementsAre("0", "1", "0", "1", "1", "0", "1", "0"));
    EXPECT_THAT(dealt(3, {"", "", ""}, "gpus = 3\n"), ElementsAre("0", "1", "2"));
    const auto of_four = dealt(2, {"", "", "", ""}, "gpus = 4\n");
    EXPECT_EQ(std::set(of_four.begin(), of_four.end()).size(), 4u);
}

TEST(TileGpu, IsForSomeTilesOnesOwnChoice) {
    EXPECT_THAT(dealt(4, {"gpu = 1", "", "", "gpu = 1"}, "gpus = 2\n"), ElementsAre("1", "0", "0", "1"));
    EXPECT_THAT(dealt(2, {"gpu = 4", "gpu = 7", "", ""}), ElementsAre("4", "7", "7", "4"))
        << "the rest goes to those that are named";
    EXPECT_THAT(dealt(2, {"", "gpu = 3"}), ElementsAre("3", "3"));
    EXPECT_THAT(dealt(2, {"", ""}), ElementsAre("auto", "auto")) << "one that the node finds";
}

TEST(NodeOfSeveralGpus, IsANodeForEach) {
    const auto config = parse_config(
        node_of(2, {"gpu = 1", "gpu = \"0000:65:00.0\"", "", "gpu = 1"}, "listen = \"unix:/run/n\"\n"), "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_THAT(names(*config), ElementsAre("n/gpu1", "n/0000:65:00.0"));
    EXPECT_EQ(config->nodes[0].tiles.size(), 2u);
    EXPECT_EQ(config->nodes[1].tiles.size(), 2u);
    for (const auto& node : config->nodes) {
        EXPECT_EQ(node.process, "n");
        EXPECT_EQ(node.gpu(), node.tiles.back().gpu);
    }
    EXPECT_EQ(config->nodes[0].listen.path, "/run/n");
    EXPECT_EQ(config->nodes[1].listen.path, "/run/n.1");
    EXPECT_EQ(config->nodes_of("n").size(), 2u);
    EXPECT_TRUE(config->nodes_of("n/gpu1").empty());
    EXPECT_EQ(config->find_node("n"), nullptr);
    EXPECT_THAT(names(*parse_config(node_of(1, {"gpu = 3", "gpu = 3"}), "wall.toml")), ElementsAre("n"))
        << "one is the node";
}

TEST(NodeOfSeveralGpus, ListensOnAPortForEach) {
    const auto ports = [](const std::string& listen) {
        const auto config = parse_config(node_of(3, {"", "", ""}, "gpus = 3\nlisten = \"" + listen + "\"\n"), "x");
        std::vector<int> out;
        for (const auto& node : config->nodes) out.push_back(node.listen.port);
        return out;
    };
    EXPECT_THAT(ports("10.0.0.5:7790"), ElementsAre(7790, 7791, 7792));
    EXPECT_THAT(ports("127.0.0.1:0"), ElementsAre(0, 0, 0)) << "any that are free";
    EXPECT_THAT(ports("127.0.0.1:65533"), ElementsAre(65533, 65534, 65535));
}

TEST(NodeOfSeveralGpus, SaysWhatIsWrongAndWhatWasExpected) {
    const std::vector<std::pair<std::string, std::string>> rows{
        {node_of(1, {""}, "gpus = 0\n"), "wall.toml:3: 'gpus': expected an integer from 1 to 64"},
        {node_of(1, {""}, "gpus = \"all\"\n"), "wall.toml:3: 'gpus': expected an integer"},
        {node_of(1, {"", "gpu = 2"}, "gpus = 2\n"),
         "wall.toml:11: tile '1' is drawn by GPU 2 of 2: expected a number from 0 to 1"},
        {node_of(1, {"gpu = \"65:00.0\""}, "gpus = 2\n"), "wall.toml:7: tile '0' names its GPU by its address"},
        {node_of(1, {""}, "backend = \"osmesa\"\ngpus = 2\n"), "wall.toml:4: 'gpus' of a node with backend"},
        {node_of(1, {"gpu = 0"}, "backend = \"osmesa\"\n"), "wall.toml:7: 'gpu' of a node with backend"},
        {node_of(1, {"output = \"window\""}, "gpus = 2\n"), "wall.toml:3: 'gpus' of a node with tiles in windows"},
        {node_of(1, {"output = \"window\"", "gpu = 2"}), "wall.toml:10: 'gpu' in a node with tiles in windows"},
        {node_of(1, {"gpu = 0", "gpu = 1"}, "listen = \"127.0.0.1:65535\"\n"),
         "wall.toml:1: node 'n' listens on a port for each of its 2 GPUs"},
        {node_of(1, {"gpu = 0", "gpu = 1"}) + "[[node]]\nname = \"n/gpu1\"\n[[node.tile]]\nname = \"x\"\n"
                                              "rect = [0, 0, 9, 9]\n",
         "wall.toml:1: two nodes are called 'n/gpu1'"},
    };
    for (const auto& [toml, expected] : rows) EXPECT_THAT(refusal_of(toml), StartsWith(expected)) << toml;
}

TEST(NodeOfSeveralGpus, GoesOnWithOtherTiles) {
    const auto two = parse_config(node_of(3, {"gpu = 0", "gpu = 1", "gpu = 0"}), "wall.toml");
    const auto swapped = parse_config(node_of(3, {"gpu = 0", "gpu = 1", "gpu = 1"}), "wall.toml");
    EXPECT_TRUE(draws_as(*two->find_node("n/gpu0"), *swapped->find_node("n/gpu0")));
    EXPECT_FALSE(same_tiles(*two->find_node("n/gpu0"), *swapped->find_node("n/gpu0")));
    EXPECT_TRUE(same_tiles(*two->find_node("n/gpu0"), *two->find_node("n/gpu0")));
    EXPECT_FALSE(draws_as(*two->find_node("n/gpu0"), *two->find_node("n/gpu1")));
}

TEST(NodeOfSeveralGpus, HasTilesWhoseSlotsAreTheirOwnAmongAll) {
    const auto config = parse_config(node_of(2, {"stereo = \"side-by-side\"", "", "", ""}, "gpus = 2\n"), "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    std::set<std::uint32_t> slots;
    std::size_t tiles = 0;
    for (const auto& node : config->nodes) {
        for (const auto& tile : node.tiles) slots.insert(tile.slot);
        tiles += node.tiles.size();
    }
    EXPECT_EQ(tiles, 5u) << "one for a right eye";
    EXPECT_EQ(slots, (std::set<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(config->nodes[0].tile(0)->output.right_slot, 4u);
    EXPECT_EQ(config->nodes[0].tile(1), nullptr) << "the other node's";
}

TEST(Gpus, OfTilesWithoutAWindowSystemAreTheCardsOfTheirMonitors) {
    const std::string one = "output = \"kms:DP-1\"\n", first = one + "gpu = \"0000:17:00.0\"",
                      second = one + "gpu = \"0000:65:00.0\"";
    EXPECT_THAT(dealt(2, {first, second}), ElementsAre("0000:17:00.0", "0000:65:00.0")) << "DP-1 of either";
    EXPECT_THAT(refusal_of(node_of(1, {one}, "gpus = 2\n")),
                StartsWith("wall.toml:3: 'gpus' of a node with tiles on monitors without a window system"));
    EXPECT_THAT(refusal_of(node_of(1, {one + "gpu = 1"})),
                StartsWith("wall.toml:7: tile '0' names its GPU by a number"));
    EXPECT_THAT(refusal_of(node_of(2, {first, "output = \"kms:DP-2\""})),
                StartsWith("wall.toml:8: tile '1' says no 'gpu', others of its node do"));
}

}  // namespace
}  // namespace wall::config
