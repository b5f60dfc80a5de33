// SPDX-License-Identifier: MIT
#include "client_lib/geometry/target_layers.h"

#include <gtest/gtest.h>

#include "common/wire/limits.h"

namespace wall::client {
namespace {

/// A window of 200x100 pixels, twice as large on the canvas.
SurfaceLayout doubled() {
    SurfaceLayout layout;
    layout.width = 200;
    layout.height = 100;
    layout.rect = {1000, 500, 400, 200};
    return layout;
}

TEST(Layers, ATilesShowsItsPartOfTheWindowUpsideDown) {
    const TargetLayer layer = tile_layer(doubled(), NodeIndex(3), 7, {1000, 500, 101, 50});
    EXPECT_EQ(layer.node, NodeIndex(3));
    EXPECT_EQ(layer.bit(), std::uint64_t{1} << 7);
    EXPECT_FALSE(layer.is_whole_window());
    EXPECT_EQ(layer.area.x0, 0);
    EXPECT_EQ(layer.area.x1, 50.5f);
    EXPECT_EQ(layer.area.y0, 75) << "the canvas has its origin at the top, windows at the bottom";
    EXPECT_EQ(layer.area.y1, 100);
    EXPECT_EQ(layer.pixels, (geom::Rect{0, 75, 51, 25})) << "rounded outwards";
}

TEST(Layers, TheWholeWindowsLiesApartFromTilesWhateverIsSeenOfIt) {
    const TargetLayer all = whole_window(200, 100, NodeIndex(1));
    const TargetLayer strip = whole_window(doubled(), NodeIndex(1), {1000, 660, 400, 40});
    for (const TargetLayer& layer : {all, strip}) {
        EXPECT_TRUE(layer.is_whole_window());
        EXPECT_EQ(layer.bit(), std::uint64_t{1} << wire::kOffscreenSlot);
    }
    EXPECT_EQ(all.pixels, (geom::Rect{0, 0, 200, 100}));
    EXPECT_EQ(strip.pixels, (geom::Rect{0, 0, 200, 20}));
}

TEST(Layers, ATargetMayHaveAnyNumberOfThem) {
    std::vector<TargetLayer> layers;
    constexpr std::uint32_t kNodes = 90, kTiles = 30;
    for (std::uint32_t tile = 0; tile < kTiles; ++tile)
        for (std::uint32_t node = 0; node < kNodes; ++node)
            layers.push_back({NodeIndex(node), tile, {float(node), float(tile), float(node) + 1, float(tile) + 1}, {}});
    const NodeMasks all = nodes_touched(layers, std::nullopt);
    ASSERT_EQ(all.size(), kNodes);
    for (const auto& [node, slots] : all) EXPECT_EQ(slots, (std::uint64_t{1} << kTiles) - 1);
    const NodeMasks last = nodes_touched(layers, PixelRect{88.5f, 28.5f, 90, 30});
    ASSERT_EQ(last.size(), 2u);
    for (const auto& [node, slots] : last) EXPECT_EQ(slots, std::uint64_t{3} << 28);
    EXPECT_EQ(count_nodes(layers), kNodes);
}

TEST(Layers, TheirNodesComeInAnyOrder) {
    std::vector<TargetLayer> layers;
    for (const std::uint32_t node : {5u, 3u, 5u, 7u, 3u, 200u, 7u})
        layers.push_back({NodeIndex(node), static_cast<std::uint32_t>(layers.size()), {0, 0, 1, 1}, {}});
    const NodeMasks masks = nodes_touched(layers, std::nullopt);
    ASSERT_EQ(masks.size(), 4u);
    std::uint64_t all = 0;
    for (const auto& [node, slots] : masks) {
        EXPECT_EQ(all & slots, 0u);
        all |= slots;
        for (const TargetLayer& layer : layers) EXPECT_EQ((slots & layer.bit()) != 0, layer.node == node);
    }
    EXPECT_EQ(all, 0x7fu);
    EXPECT_EQ(count_nodes(layers), 4u);
    EXPECT_EQ(count_nodes({}), 0u);
}

}  // namespace
}  // namespace wall::client
