// SPDX-License-Identifier: MIT
// A target of objects of which two nodes draw what their tiles show.
#include "client_lib/follow/drawn_parts.h"

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <functional>
#include <thread>

#include "client_lib/objects/texture.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

using glapi::Op;
using ::testing::ElementsAre;

constexpr NodeIndex kLeft(0), kRight(1);
constexpr ContextId kContext(1);
constexpr std::int32_t kWidth = 8, kHeight = 2;  // pixels of a byte

/// An image that nodes have drawn.
struct DrawnImage final : Object {
    DrawnImage() : Object(next_object_id()) {}
    std::uint64_t latest() const override { return 1; }
    void pack_changes(std::uint64_t, wire::PackBuffer&, const std::function<void()>&) const override {}
    bool is_drawn() const override { return true; }
    void pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>&) const override {
        const auto pixels =
            ask([&](wire::PackBuffer& question,
                    RequestId request) { glapi::pack::BufferRead(question, request, id, 0, kWidth * kHeight); },
                {0, kHeight, kWidth});
        if (pixels) glapi::pack::BufferSubData(buffer, id, 0, *pixels);
    }
};

struct OneImage final : DrawnTarget {
    explicit OneImage(const Object& one) : image(one) {}
    ClientName target_id() const override { return ClientName(1000 + image.id.value); }
    std::uint32_t width() const override { return kWidth; }
    std::uint32_t height() const override { return kHeight; }
    void for_each_image(const std::function<void(const Object&)>& use) const override { use(image); }
    void note_drawn() override {}
    std::uint64_t defined() const override { return definition; }
    bool may_be_larger() const override { return larger; }
    const Object& image;
    std::uint64_t definition = 1;
    bool larger = true;
};

struct Sampled final : UsedObjects {
    void for_each_used(const std::function<void(const Object&)>& use) override {
        for (const Object* object : objects) use(*object);
    }
    std::vector<const Object*> objects;
};

/// A window of 8x2 pixels on the tiles of two nodes, half of it each.
class DrawnInParts : public testing::Test {
protected:
    DrawnInParts() {
        std::thread node_side([this] {
            for (FakeNode& fake : fakes) EXPECT_TRUE(fake.welcome([] {}));
        });
        nodes.connect_and_wait(std::array{NodeInfo{kLeft, fakes[0].listener.address(), "ticket", 1, true},
                                          NodeInfo{kRight, fakes[1].listener.address(), "ticket", 1, true}});
        node_side.join();
        surface.layout.width = kWidth, surface.layout.height = kHeight;
        surface.layout.rect = {0, 0, kWidth, kHeight};
        surface.layout.version = 1;
        surface.layout.layers = {tile_layer(surface.layout, kLeft, 0, {0, 0, 4, kHeight}),
                                 tile_layer(surface.layout, kRight, 0, {4, 0, 4, kHeight})};
        open[surface.id] = &surface;
        share->by_id[image->id] = image;
        for (const NodeIndex node : {kLeft, kRight})
            nodes[node].object_stamps = {{image->id, 1}, {target->target_id(), 1}};
    }
    DrawTarget of_target() { return {*target, nodes.everywhere()}; }
    DrawSource source(const DrawTarget& draw, const DrawTarget& read) {
        return {kContext, state, draw, read, used, objects, share};
    }
    /// All of the target is copied to the window, for the first time since that is a habit.
    void begin() { parts.begin(target, source(DrawTarget(surface), of_target()), 0, 0); }
    /// Draws with these objects to something else.
    void draw_with(const std::vector<const Object*>& with) {
        objects.objects = with;
        ++used.objects;
        parts.before_drawing(source(DrawTarget(surface), DrawTarget(surface)));
    }
    /// What has been packed for the node; behind it there is nothing.
    std::vector<Op> packed(NodeIndex node) {
        std::vector<Op> ops;
        wire::PackBuffer& batch = nodes[node].batch;
        for (std::uint32_t at = 0; at < batch.commands(); ++at) ops.push_back(static_cast<Op>(batch.opcode_at(at)));
        batch.clear();
        return ops;
    }
    /// The nodes answer a question each, in order, all pixels being such a letter.
    void answer(const std::array<char, 2>& letters) {
        for (std::uint32_t i = 0; i < 2; ++i) {
            while (!fakes[i].receives(Op::BufferRead)) {
            }
            const std::uint32_t number = i + 1;
            std::string text(sizeof number, '\0');
            std::memcpy(text.data(), &number, sizeof number);
            fakes[i].send(FrameKind::reply, text + std::string(kWidth * kHeight, letters[i]));
        }
    }

    std::array<FakeNode, 2> fakes{FakeNode("parts_left"), FakeNode("parts_right")};
    Nodes nodes{{[](Node&) {}, [] {}, [] {}, [] {}}};
    OpenSurfaces open;
    DrawnParts parts{nodes, open};
    ClientSurface surface{SurfaceId(1), {}};
    glstate::State state;
    UseStamp used;
    Sampled objects;
    std::shared_ptr<ShareGroup> share = std::make_shared<ShareGroup>();
    std::shared_ptr<DrawnImage> image = std::make_shared<DrawnImage>();
    std::shared_ptr<OneImage> target = std::make_shared<OneImage>(*image);
};

TEST_F(DrawnInParts, EachNodeIsToldItsPartAndGetsWhatTouchesIt) {
    begin();
    ASSERT_NE(target->parts(), nullptr);
    for (const NodeIndex node : {kLeft, kRight}) EXPECT_THAT(packed(node), ElementsAre(Op::TargetPart));
    const auto touched = nodes_touched(of_target().layers(), PixelRect{0, 0, 2, 2});
    ASSERT_EQ(touched.size(), 1u);
    EXPECT_EQ(touched[0].node, kLeft);
    EXPECT_EQ(nodes_touched(of_target().layers(), std::nullopt).size(), 2u);
    EXPECT_TRUE(parts.suffice(*target, DrawTarget(surface), 0, 0));
    EXPECT_FALSE(parts.suffice(*target, DrawTarget(surface), 1, 0)) << "it comes to other tiles";
}

TEST_F(DrawnInParts, OneNodeThatShowsAllDrawsAll) {
    surface.layout.layers = {tile_layer(surface.layout, kLeft, 0, {0, 0, kWidth, kHeight})};
    begin();
    EXPECT_EQ(target->parts(), nullptr);
}

TEST_F(DrawnInParts, NotWhereANodeLacksIt) {
    nodes[kRight].object_stamps.erase(image->id);
    begin();
    EXPECT_EQ(target->parts(), nullptr);
}

TEST_F(DrawnInParts, WhoSamplesItHasAllOfIt) {
    begin();
    for (const NodeIndex node : {kLeft, kRight}) packed(node);
    std::thread node_side([this] { answer({'l', 'r'}); });
    draw_with({image.get()});
    node_side.join();
    EXPECT_EQ(target->parts(), nullptr);
    EXPECT_TRUE(target->take_ended());
    for (FakeNode& fake : fakes) {
        const FakeNode::Frame frame = fake.receive();
        const auto batch = wire::split_batch(frame.payload);
        ASSERT_TRUE(batch);
        EXPECT_EQ(batch->opcodes.back(), static_cast<std::byte>(Op::BufferSubData));
        const auto* const text = reinterpret_cast<const char*>(batch->operands.data());
        const std::string operands(text, batch->operands.size());
        // The right node's part begins two pixels before its tile.
        EXPECT_NE(operands.find("llrrrrrrllrrrrrr"), std::string::npos) << operands;
    }
}

TEST_F(DrawnInParts, WhoDrawsWithOtherObjectsLeavesItSo) {
    begin();
    const DrawnImage other;
    draw_with({&other});
    EXPECT_NE(target->parts(), nullptr);
    objects.objects = {image.get()};
    ++used.objects;
    parts.before_drawing(source(of_target(), DrawTarget(surface)));
    EXPECT_NE(target->parts(), nullptr) << "it draws to it";
    parts.before_drawing(source(DrawTarget(surface), of_target()));
    EXPECT_NE(target->parts(), nullptr) << "it is bound to be read from";
}

TEST_F(DrawnInParts, WhoLooksUpWhatLiesUnderItLeavesItSo) {
    begin();
    parts.allow(kContext, {image->id});
    draw_with({image.get()});
    EXPECT_NE(target->parts(), nullptr);
    for (const NodeIndex node : {kLeft, kRight}) nodes[node].slow = true, nodes[node].object_stamps.erase(image->id);
    parts.allow(kContext, {});
    parts.before_drawing(source(DrawTarget(surface), DrawTarget(surface)));
    EXPECT_EQ(target->parts(), nullptr) << "the same objects, and nobody says so of this draw";
}

TEST_F(DrawnInParts, WhoLooksUpMoreThanOnceHasAllOfIt) {
    begin();
    for (const NodeIndex node : {kLeft, kRight}) nodes[node].slow = true, nodes[node].object_stamps.erase(image->id);
    parts.allow(kContext, {image->id});
    draw_with({image.get(), image.get()});
    EXPECT_EQ(target->parts(), nullptr);
}

TEST_F(DrawnInParts, ItIsDrawnAtTheResolutionOfAWallThatShowsItLarger) {
    surface.layout.rect = {0, 0, 20, 5};  // two and a half times as large
    parts.begin(target, source(DrawTarget(surface), of_target()), 1, 1);
    ASSERT_NE(target->parts(), nullptr);
    EXPECT_EQ(target->parts()->images_width, 20u) << "from 2.5 to 22.5";
    EXPECT_EQ(target->parts()->images_height, 5u);
    for (const NodeIndex node : {kLeft, kRight}) nodes[node].object_stamps.erase(image->id);
    parts.end_all();
    for (const NodeIndex node : {kLeft, kRight}) nodes[node].object_stamps[image->id] = 1;
    target->larger = false;
    begin();
    ASSERT_NE(target->parts(), nullptr);
    EXPECT_EQ(target->parts()->images_width, 0u) << "of several samples a pixel";
}

TEST_F(DrawnInParts, ItIsNeverSmallerThanTheProgramKnowsIt) {
    surface.layout.rect = {0, 0, 4, 1};
    begin();
    ASSERT_NE(target->parts(), nullptr);
    EXPECT_EQ(target->parts()->images_width, 0u);
}

TEST_F(DrawnInParts, ItEndsWhenTheWindowOrTheNodesOrItselfChange) {
    const std::array<std::function<void()>, 4> changes{
        [this] { ++surface.layout.version; }, [this] { surface.whole = true; }, [this] { nodes.note_change(); },
        [this] { ++target->definition; }};
    for (const auto& change : changes) {
        surface.whole = false;
        begin();
        ASSERT_NE(target->parts(), nullptr);
        change();
        EXPECT_FALSE(parts.suffice(*target, DrawTarget(surface), 0, 0));
        for (const NodeIndex node : {kLeft, kRight})
            nodes[node].slow = true, nodes[node].object_stamps.erase(image->id);
        objects.objects = {image.get()};
        ++used.objects;
        parts.before_drawing(source(of_target(), of_target()));
        EXPECT_EQ(target->parts(), nullptr);
        for (const NodeIndex node : {kLeft, kRight}) nodes[node].object_stamps[image->id] = 1;
    }
}

TEST_F(DrawnInParts, WhatIsCopiedToOneInPartsIsDrawnInTheSame) {
    begin();
    const auto first = std::make_shared<DrawnImage>();
    const auto before = std::make_shared<OneImage>(*first);
    share->by_id[first->id] = first;
    for (const NodeIndex node : {kLeft, kRight})
        nodes[node].object_stamps[first->id] = nodes[node].object_stamps[before->target_id()] = 1;
    const DrawTarget read(*before, nodes.everywhere());
    parts.begin(before, source(of_target(), read), 0, 0);
    ASSERT_NE(before->parts(), nullptr);
    EXPECT_TRUE(parts.suffice(*before, of_target(), 0, 0));
    EXPECT_FALSE(parts.suffice(*before, DrawTarget(surface), 0, 0)) << "it was not copied there";
    for (const NodeIndex node : {kLeft, kRight}) nodes[node].object_stamps.clear();
    parts.end(*share);
    EXPECT_EQ(before->parts(), nullptr);
    EXPECT_EQ(target->parts(), nullptr);
}

}  // namespace
}  // namespace wall::client
