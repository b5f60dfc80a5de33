// SPDX-License-Identifier: MIT
// A command on its way to a node, up to the batch that is packed for it. The node is connected, and receives nothing
// yet.
#include "client_lib/follow/followers.h"

#include <gtest/gtest.h>

#include <thread>

#include "client_lib/follow/block_sender.h"
#include "client_lib/objects/texture.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

using glapi::Op;
using glstate::Category;

constexpr NodeIndex kNode(0);
constexpr ContextId kContext(1);
constexpr std::uint64_t kTile = 1;
const std::uint64_t kWholeWindow = whole_window(1, 1, kNode).bit();

/// A context that draws with one texture.
struct OneObject final : UsedObjects {
    void for_each_used(const std::function<void(const Object&)>& use) override { use(texture); }
    Texture texture{ClientName(7), 1, glapi::TextureTarget::t2d};
};

/// A window of 100x100 pixels, whose left half is on the node's only tile.
class AFollower : public testing::Test {
protected:
    AFollower() {
        std::thread node_side([this] { EXPECT_TRUE(fake.welcome([] {})); });
        nodes.connect_and_wait(std::array{NodeInfo{kNode, fake.listener.address(), "ticket", 1, true}});
        node_side.join();
        surface.layout.width = surface.layout.height = 100;
        surface.layout.rect = {0, 0, 100, 100};
        surface.layout.version = 1;
        open[surface.id] = &surface;
    }
    Node& node() { return nodes[kNode]; }
    DrawSource source() {
        const DrawTarget target(surface);
        return {kContext, state, target, target, used, objects, share};
    }
    void clear(const std::optional<PixelRect>& box = {}) {
        draw_on(followers, source(), box, Needs{}, NamesNone(),
                [](wire::PackBuffer& buffer) { glapi::pack::Clear(buffer, GL_COLOR_BUFFER_BIT); });
    }
    void show_left_half() {
        const std::vector<TileInfo> tiles{{kNode, 0, {0, 0, 50, 100}, {}}};
        surface.layout.layers = {tile_layer(surface.layout, kNode, 0, tiles[0].rect)};
        hidden.lay(surface, tiles);
    }
    /// What has been packed for the node since it was last asked, without state; of each Block its layers.
    struct Packed {
        std::vector<Op> ops;
        std::vector<std::uint64_t> blocks;
    };
    Packed packed() {
        Packed packed;
        wire::PackMark at;
        for (; at.commands < node().batch.commands(); ++at.commands) {
            const auto op = static_cast<Op>(node().batch.opcode_at(at.commands));
            std::uint32_t mask[2];
            if (op == Op::Block) {
                std::memcpy(mask, node().batch.operand_at(at.operand_bytes), sizeof mask);
                packed.blocks.push_back(mask[0] | std::uint64_t{mask[1]} << 32);
            }
            packed.ops.push_back(op);
            at.operand_bytes += glapi::kOpFixedBytes[static_cast<std::size_t>(op)];
        }
        node().batch.clear();
        return packed;
    }

    FakeNode fake{"followers_node"};
    Nodes nodes{{[](Node&) {}, [] {}, [] {}, [] {}}};
    OpenSurfaces open;
    NodeUpdater updater{nodes};
    HiddenParts hidden{nodes, open};
    Dealer dealer{nodes, updater, false};
    Sight sight;
    WindowContents windows{nodes, dealer};
    DrawnParts in_parts{nodes, open};
    Followers followers{nodes, updater, hidden, dealer, windows, in_parts, sight};
    ClientSurface surface{SurfaceId(1), {}};
    glstate::State state;
    UseStamp used;
    OneObject objects;
    std::shared_ptr<ShareGroup> share = std::make_shared<ShareGroup>();
};

TEST_F(AFollower, IsToldOfTheTargetOnceAndThenOnlyOfTheCommand) {
    surface.layout.layers = {tile_layer(surface.layout, kNode, 0, surface.layout.rect)};
    clear();
    EXPECT_EQ(packed().ops, (std::vector{Op::SurfaceCreate, Op::SurfacePlace, Op::Bind, Op::Block, Op::Clear}));
    EXPECT_TRUE(surface.drawn);
    clear();
    EXPECT_EQ(packed().ops, (std::vector{Op::Block, Op::Clear}));
}

TEST_F(AFollower, GetsTheCurrentNormalWithTheBlockThatReadsIt) {
    surface.layout.layers = {tile_layer(surface.layout, kNode, 0, surface.layout.rect)};
    state.lighting.lighting_enabled = 1;
    clear();
    const auto triangle = [&](bool with_normal) {
        Packer packer;
        if (with_normal) {
            const float up[] = {0, 1, 0};
            std::memcpy(packer.append_attribute(Attribute::normal, Op::Normal3f, sizeof up), up, sizeof up);
        }
        packer.begin(GL_TRIANGLES);
        for (int i = 0; i < 3; ++i) glapi::pack::Vertex3f(packer, 0, 0, 0);
        packer.box.make_unbounded();
        packer.end();
        SortScratch scratch;
        BlockSender(followers, source(), packer, glstate::Projection(), scratch).run();
    };
    triangle(true);
    packed();
    const std::vector drawn{Op::Block, Op::Begin, Op::Vertex3f, Op::Vertex3f, Op::Vertex3f, Op::End};
    triangle(false);
    EXPECT_EQ(packed().ops, drawn) << "it has that normal";
    glstate::assign<glstate::el::normal>(state, 0, {1, 0, 0});
    triangle(false);
    EXPECT_EQ(packed().ops,
              (std::vector{Op::Block, Op::Normal3f, Op::Begin, Op::Vertex3f, Op::Vertex3f, Op::Vertex3f, Op::End}));
    triangle(false);
    EXPECT_EQ(packed().ops, drawn);
    triangle(true);
    EXPECT_EQ(packed().ops[1], Op::Normal3f) << "the block's own, and no other";
}

TEST_F(AFollower, GetsNothingOfWhatDoesNotTouchItsLayers) {
    surface.layout.layers = {tile_layer(surface.layout, kNode, 0, {0, 0, 50, 100})};
    clear(PixelRect{60, 0, 80, 100});
    EXPECT_TRUE(packed().ops.empty());
    clear(PixelRect{40, 0, 80, 100});
    EXPECT_EQ(packed().blocks, std::vector{kTile});
}

TEST_F(AFollower, GetsNothingWhileItIsLeftOut) {
    surface.layout.layers = {tile_layer(surface.layout, kNode, 0, surface.layout.rect)};
    node().left_out[surface.id] = 1;
    clear();
    EXPECT_TRUE(packed().ops.empty());
    node().left_out.clear();
    clear();
    EXPECT_EQ(packed().blocks, std::vector{kTile});
}

TEST_F(AFollower, LooksAtObjectsOnlyWhenTheStampIsAnother) {
    surface.layout.layers = {tile_layer(surface.layout, kNode, 0, surface.layout.rect)};
    used.shared = objects.texture.stamp = 5;
    clear();
    EXPECT_EQ(node().object_stamps[objects.texture.id], 5u);
    objects.texture.stamp = 6;
    clear();
    EXPECT_EQ(node().object_stamps[objects.texture.id], 5u) << "nobody said that anything has changed";
    used.shared = 6;
    clear();
    EXPECT_EQ(node().object_stamps[objects.texture.id], 6u);
}

TEST_F(AFollower, GetsTheHiddenPartOnlyWhenSomebodyLooksThere) {
    show_left_half();
    ASSERT_TRUE(surface.hidden);
    clear();
    EXPECT_EQ(packed().blocks, std::vector{kTile});
    EXPECT_FALSE(surface.hidden->now.empty());
    hidden.before_reading(DrawTarget(surface), {0, 0, 40, 100});
    EXPECT_TRUE(packed().blocks.empty()) << "that is on the tile";
    hidden.before_reading(DrawTarget(surface), {40, 0, 40, 100});
    EXPECT_EQ(packed().blocks, std::vector{kWholeWindow});
    clear();
    EXPECT_EQ(packed().blocks, std::vector{kTile | kWholeWindow}) << "drawn like the rest from then on";
}

TEST_F(AFollower, GetsNothingKeptOfWhatLiesOnTilesOnly) {
    show_left_half();
    clear(PixelRect{0, 0, 40, 100});
    EXPECT_TRUE(surface.hidden->now.empty());
}

TEST_F(AFollower, IsSentWhatIsKeptBeforeAnObjectOfItChanges) {
    show_left_half();
    used.shared = objects.texture.stamp = 5;
    share->by_id[objects.texture.id] = std::shared_ptr<Object>(std::shared_ptr<Object>(), &objects.texture);
    clear();
    packed();
    hidden.before_object_changes(ClientName(8));
    EXPECT_TRUE(packed().blocks.empty());
    hidden.before_object_changes(objects.texture.id);
    EXPECT_EQ(packed().blocks, std::vector{kWholeWindow});
}

}  // namespace
}  // namespace wall::client
