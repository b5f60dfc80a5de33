// SPDX-License-Identifier: MIT
// Taking a mesh apart asks for no memory for its triangles. This program's operator new counts.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <span>
#include <thread>

#include "client_lib/context/current.h"
#include "client_lib/follow/block_sender.h"
#include "client_lib/objects/share_group.h"
#include "tests/unit/client_lib/fake_node.h"

namespace {

thread_local std::size_t allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
    ++allocations;
    void* memory = std::malloc(size ? size : 1);
    if (!memory) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace wall::client {

void GLAPIENTRY gl_entry_Vertex3f(GLfloat x, GLfloat y, GLfloat z);

namespace {

struct NoObjects final : UsedObjects {
    void for_each_used(const std::function<void(const Object&)>&) override {}
};

/// A window of 100x100 pixels, of which two nodes show a half each.
class AMeshOverTwoNodes : public testing::Test {
protected:
    AMeshOverTwoNodes() {
        std::thread node_side([this] {
            for (FakeNode& fake : fakes_) EXPECT_TRUE(fake.welcome([] {}));
        });
        std::vector<NodeInfo> infos;
        for (std::uint32_t i = 0; i < fakes_.size(); ++i)
            infos.push_back({NodeIndex(i), fakes_[i].listener.address(), "ticket", 1, true});
        nodes_.connect_and_wait(infos);
        node_side.join();
        SurfaceLayout& layout = surface_.layout;
        layout.width = layout.height = 100;
        layout.rect = {0, 0, 100, 100};
        layout.version = 1;
        layout.layers = {tile_layer(layout, NodeIndex(0), 0, {0, 0, 50, 100}),
                         tile_layer(layout, NodeIndex(1), 0, {50, 0, 50, 100})};
        open_[surface_.id] = &surface_;
        for (std::size_t i = 0; i < 4; ++i) projection_.clip_from_object[5 * i] = 1;
        projection_.viewport[2] = projection_.viewport[3] = 100;
    }
    /// One glBegin of so many triangles, of which every other lies on the right. How often memory is asked for while it
    /// is sent.
    std::size_t allocations_of(int triangles) {
        Packer packer;
        tls_packer = &packer;
        packer.begin(GL_TRIANGLES);
        for (int i = 0; i < triangles; ++i) {
            const float x = i % 2 ? 0.5f : -0.5f;
            for (const auto& [dx, y] : {std::pair{0.f, 0.f}, {0.1f, 0.f}, {0.f, 0.1f}}) {
                if (packer.next_operand() >= packer.limit) packer.make_room();
                gl_entry_Vertex3f(x + dx, y, 0);
            }
        }
        packer.end();
        tls_packer = nullptr;
        const DrawTarget target(surface_);
        const DrawSource source{ContextId(1), state_, target, target, used_, objects_, share_};
        const std::size_t before = allocations;
        BlockSender(followers_, source, packer, projection_, scratch_).run();
        const std::size_t asked = allocations - before;
        for (const auto& node : nodes_) {
            const auto opcodes = node->batch.opcodes();
            EXPECT_EQ(std::ranges::count(opcodes, static_cast<std::byte>(glapi::Op::Vertex3f)), 3 * triangles / 2);
            node->batch.clear();
        }
        return asked;
    }

private:
    std::array<FakeNode, 2> fakes_{FakeNode("divide_left"), FakeNode("divide_right")};
    Nodes nodes_{{[](Node&) {}, [] {}, [] {}, [] {}}};
    OpenSurfaces open_;
    NodeUpdater updater_{nodes_};
    HiddenParts hidden_{nodes_, open_};
    Sight sight_;
    Dealer dealer_{nodes_, updater_, false};
    WindowContents windows_{nodes_, dealer_};
    DrawnParts drawn_{nodes_, open_};
    Followers followers_{nodes_, updater_, hidden_, dealer_, windows_, drawn_, sight_};
    ClientSurface surface_{SurfaceId(1), {}};
    glstate::State state_;
    glstate::Projection projection_;
    UseStamp used_;
    NoObjects objects_;
    std::shared_ptr<ShareGroup> share_ = std::make_shared<ShareGroup>();
    SortScratch scratch_;
};

TEST_F(AMeshOverTwoNodes, AsksForNoMemoryForItsTriangles) {
    constexpr int kMany = 10'000;
    allocations_of(kMany);  // what is kept from block to block grows
    EXPECT_EQ(allocations_of(kMany), allocations_of(100));
}

}  // namespace
}  // namespace wall::client
