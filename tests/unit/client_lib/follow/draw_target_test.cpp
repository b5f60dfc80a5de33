// SPDX-License-Identifier: MIT
// What a node is told of a target, with a node that nobody is connected to: only its batch counts.
#include "client_lib/follow/draw_target.h"

#include <gtest/gtest.h>

#include "client_lib/follow/hidden_part.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

using glapi::Op;

class ADrawTarget : public testing::Test {
protected:
    ADrawTarget() {
        surface.layout.width = surface.layout.height = 100;
        surface.layout.rect = {0, 0, 100, 100};
        surface.layout.version = 1;
        surface.layout.layers = {tile_layer(surface.layout, NodeIndex(0), 0, {0, 0, 50, 100}),
                                 tile_layer(surface.layout, NodeIndex(1), 2, {50, 0, 50, 100})};
    }
    /// What has been packed for the node since it was last asked.
    std::vector<Op> told() {
        std::vector<Op> ops;
        for (std::size_t i = 0; i < node.batch.commands(); ++i) ops.push_back(static_cast<Op>(node.batch.opcode_at(i)));
        node.batch.clear();
        return ops;
    }

    ClientSurface surface{SurfaceId(1), {}}, other{SurfaceId(2), {}};
    Node node;
    Mirror mirror;
};

TEST_F(ADrawTarget, MayBeNothing) { EXPECT_FALSE(DrawTarget()); }

TEST_F(ADrawTarget, HasTheLayersThatItsSurfaceHasNow) {
    const DrawTarget target(surface);
    EXPECT_EQ(target.layers().size(), 2u);
    surface.layout.layers.pop_back();
    EXPECT_EQ(target.layers().size(), 1u);
}

TEST_F(ADrawTarget, OfOneLayerHasThatAndNothingIsKeptOfIt) {
    surface.hidden = std::make_unique<HiddenPart>();
    const TargetLayer only = whole_window(100, 100, NodeIndex(1));
    const DrawTarget all(surface), one(surface, only);
    EXPECT_EQ(all.with_hidden_part(), &surface);
    EXPECT_EQ(one.with_hidden_part(), nullptr);
    ASSERT_EQ(one.layers().size(), 1u);
    EXPECT_EQ(one.layers().front().bit(), only.bit());
}

TEST_F(ADrawTarget, IsDescribedOnceAndPlacedAgainWithEachLayout) {
    const DrawTarget target(surface);
    target.describe_to(node);
    EXPECT_EQ(told(), (std::vector{Op::SurfaceCreate, Op::SurfacePlace}));
    target.describe_to(node);
    EXPECT_EQ(told(), std::vector<Op>{});
    ++surface.layout.version;
    target.describe_to(node);
    EXPECT_EQ(told(), std::vector{Op::SurfacePlace});
}

TEST_F(ADrawTarget, IsBoundWhenItOrTheReadTargetIsAnother) {
    const DrawTarget first(surface), second(other);
    bind_targets(node, mirror, first, first);
    EXPECT_EQ(told(), (std::vector{Op::SurfaceCreate, Op::SurfacePlace, Op::Bind}));
    bind_targets(node, mirror, first, first);
    EXPECT_EQ(told(), std::vector<Op>{});
    bind_targets(node, mirror, first, second);
    EXPECT_EQ(told(), (std::vector{Op::SurfaceCreate, Op::SurfacePlace, Op::Bind}));
    bind_targets(node, mirror, second, second);
    EXPECT_EQ(told(), std::vector{Op::Bind});
}

TEST_F(ADrawTarget, OfOneLayerIsBoundAsTheSurfaceThatItBelongsTo) {
    const TargetLayer only = whole_window(100, 100, NodeIndex(0));
    bind_targets(node, mirror, DrawTarget(surface), DrawTarget(surface));
    told();
    bind_targets(node, mirror, DrawTarget(surface, only), DrawTarget(surface));
    EXPECT_EQ(told(), std::vector<Op>{});
}

TEST_F(ADrawTarget, DoesNotGoToANodeThatIsNotThere) { EXPECT_FALSE(DrawTarget(surface).goes_to(node)); }

TEST_F(ADrawTarget, NotesWhatWasDrawnInItsSurface) {
    const DrawTarget target(surface);
    target.note_drawn();
    target.note_cleared();
    target.note_depth_image();
    EXPECT_TRUE(surface.drawn && surface.cleared && surface.depth_images);
}

}  // namespace
}  // namespace wall::client
