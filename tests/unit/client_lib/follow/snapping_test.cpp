// SPDX-License-Identifier: MIT
// Vertices of a window on one node, that are moved in its batch.
#include "client_lib/follow/snapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "client_lib/context/context.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {

void GLAPIENTRY gl_entry_Vertex3f(GLfloat x, GLfloat y, GLfloat z);

namespace {

constexpr NodeIndex kSnappingNode(0);
constexpr float kSnapBound = 0.25f;
constexpr std::array kAhead{1.2345678f, 2.3456789f, -60.123456f}, kBehind{0.1234567f, 0.2345678f, 5.123456f};

struct DrawsNothing final : UsedObjects {
    void for_each_used(const std::function<void(const Object&)>&) override {}
};

class SnappingTest : public testing::Test {
protected:
    SnappingTest() {
        std::thread node_side([this] { EXPECT_TRUE(fake_.welcome([] {})); });
        const std::vector<NodeInfo> infos{{kSnappingNode, fake_.listener.address(), "ticket", 1, true, false, true}};
        nodes_.connect_and_wait(infos);
        node_side.join();
        surface_.layout.width = surface_.layout.height = 100;
        surface_.layout.rect = {0, 0, 100, 100};
        camera_.clip_from_object = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2f, 0};
        camera_.viewport[2] = camera_.viewport[3] = 100;
        snapping_.allow(4);
        snapping_.begin_frame(surface_);
        tls_packer = &packer_;
    }
    ~SnappingTest() override { tls_packer = nullptr; }

    /// A line from one vertex to another, into the node's batch. Returns where its first vertex stands there.
    std::size_t draw(const std::array<float, 3>& from, const std::array<float, 3>& to) {
        packer_.begin(GL_LINES);
        gl_entry_Vertex3f(from[0], from[1], from[2]);
        gl_entry_Vertex3f(to[0], to[1], to[2]);
        packer_.end();
        const DrawTarget target(surface_);
        const DrawSource source{ContextId(1), state_, target, target, used_, objects_, share_};
        snapping_.before_block(source, packer_, camera_);
        Node& node = nodes_[kSnappingNode];
        wire::PackBuffer& batch = nodes_.batch(node, ContextId(1));
        const auto first = batch.mark();
        batch.append(packer_, {}, packer_.mark());
        if (auto* const packed = snapping_.packed())
            packed->push_back({kSnappingNode, node.batches, first, batch.mark()});
        packer_.reset();
        return first.operand_bytes + sizeof(std::uint32_t);  // behind Begin's mode
    }
    std::array<float, 3> vertex_at(std::size_t offset) {
        std::array<float, 3> out{};
        std::memcpy(out.data(), nodes_[kSnappingNode].batch.operand_at(offset), sizeof out);
        return out;
    }
    std::array<float, 3> snapped(const std::array<float, 3>& v, float reach) const {
        std::array<float, 4> out{};
        const auto grid = SnapGrid::make(camera_, {1, 1}, kSnapBound);
        _mm_storeu_ps(out.data(), grid->snapped(_mm_setr_ps(v[0], v[1], v[2], 1), reach));
        return {out[0], out[1], out[2]};
    }

    FakeNode fake_{"snapping"};
    Nodes nodes_{{[](Node&) {}, [] {}, [] {}, [] {}}};
    Snapping snapping_{nodes_, kSnapBound};
    ClientSurface surface_{SurfaceId(1), {}};
    glstate::Projection camera_;
    glstate::State state_;
    UseStamp used_;
    DrawsNothing objects_;
    std::shared_ptr<ShareGroup> share_ = std::make_shared<ShareGroup>();
    Packer packer_;
};

TEST_F(SnappingTest, WaitsForAllOfATransformation) {
    const auto first = draw(kAhead, kAhead);
    EXPECT_EQ(vertex_at(first), kAhead);
    const auto second = draw(kAhead, kBehind);
    snapping_.settle();
    EXPECT_EQ(vertex_at(first), snapped(kAhead, 61)) << "as the one that reaches behind the eye";
    EXPECT_EQ(vertex_at(second), vertex_at(first));
    EXPECT_NE(vertex_at(first), snapped(kAhead, 0));
    EXPECT_NE(vertex_at(first), kAhead);
}

TEST_F(SnappingTest, EachTransformationHasItsOwn) {
    const auto first = draw(kAhead, kAhead);
    camera_.clip_from_object[12] = 0.5f;
    draw(kAhead, kBehind);
    EXPECT_EQ(vertex_at(first), snapped(kAhead, 0));
}

TEST_F(SnappingTest, WhatMustGoGetsWhatIsRightInAnyCase) {
    draw(kAhead, kAhead);
    nodes_.send(nodes_[kSnappingNode]);
    const auto sent = fake_.receive();
    const auto batch = wire::split_batch(sent.payload);
    ASSERT_TRUE(batch);
    std::array<float, 3> first{};
    std::memcpy(first.data(), batch->operands.data() + sizeof(std::uint32_t), sizeof first);
    EXPECT_EQ(first, snapped(kAhead, INFINITY));
    EXPECT_EQ(vertex_at(draw(kAhead, kBehind)), first) << "and so does the rest";
}

TEST_F(SnappingTest, WhatComesAgainStays) {
    draw(kAhead, kBehind);
    snapping_.settle();
    snapping_.begin_frame(surface_);
    const auto again = draw(kAhead, kBehind);
    snapping_.settle();
    EXPECT_EQ(vertex_at(again), kAhead);
    const auto other = draw(kBehind, kAhead);
    snapping_.settle();
    EXPECT_EQ(vertex_at(other), kBehind) << "that is decided for a transformation";
}

TEST_F(SnappingTest, LeavesABatchAloneThatIsAnotherOne) {
    draw(kAhead, kAhead);
    nodes_.distrust();
    nodes_[kSnappingNode].batch.append(0, 64);
    const std::vector<std::byte> before(nodes_[kSnappingNode].batch.operands().begin(),
                                        nodes_[kSnappingNode].batch.operands().end());
    snapping_.settle();
    EXPECT_TRUE(std::ranges::equal(nodes_[kSnappingNode].batch.operands(), before));
}

TEST_F(SnappingTest, NothingMovesWhereTheWallAllowsNothing) {
    snapping_.allow(0);
    snapping_.begin_frame(surface_);
    const auto first = draw(kAhead, kBehind);
    snapping_.settle();
    EXPECT_EQ(vertex_at(first), kAhead);
}

}  // namespace
}  // namespace wall::client
