// SPDX-License-Identifier: MIT
// What two nodes lack alike goes to one of them.
#include "client_lib/follow/hand_on.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <thread>
#include <utility>
#include <vector>

#include "client_lib/follow/surface.h"
#include "common/wire/parcel.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

constexpr NodeIndex kHead(0), kTail(1);
constexpr std::size_t kLarge = HandOn::kLeastParcel + 1000;

/// So many bytes of a buffer.
struct OneBuffer final : Object {
    explicit OneBuffer(std::size_t content_bytes) : Object(next_object_id()), bytes(content_bytes, std::byte{7}) {}
    std::uint64_t latest() const override { return stamp; }
    void pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const override {
        glapi::pack::BufferSubData(buffer, id, 0, bytes);
        packed();
    }
    std::vector<std::byte> bytes;
    std::uint64_t stamp = next_stamp();
};

struct OneObject final : UsedObjects {
    explicit OneObject(const Object& one) : object(one) {}
    void for_each_used(const std::function<void(const Object&)>& use) override { use(object); }
    const Object& object;
};

/// What a draw names; of the nodes that are known to have it.
struct OneNamed : NamesNone {
    OneNamed(const Object& one, std::vector<NodeIndex> known) : object(one), on(std::move(known)) {}
    bool are_on(const Node& node) const { return std::ranges::find(on, node.index) != on.end(); }
    template <class Use>
    void for_each(Use&& use) const {
        use(object);
    }
    const Object& object;
    std::vector<NodeIndex> on;
};

/// A window of 100x100 pixels on a tile of each of two nodes, which are reached over links.
class HandOnTest : public testing::Test {
protected:
    HandOnTest() {
        std::thread node_sides([this] {
            for (auto& fake : fakes) EXPECT_TRUE(fake.welcome([] {}, kPatience, std::string("\1\0\0\0", 4)));
        });
        std::vector<NodeInfo> infos;
        for (const NodeIndex index : {kHead, kTail}) {
            infos.push_back({index, fakes[index.value].listener.address(), "ticket"});
            infos.back().hands_on = true;
        }
        nodes.connect_and_wait(infos);
        node_sides.join();
        surface.layout.width = surface.layout.height = 100;
        surface.layout.rect = {0, 0, 100, 100};
        surface.layout.version = 1;
        surface.layout.layers = {tile_layer(surface.layout, kHead, 0, {0, 0, 50, 100}),
                                 tile_layer(surface.layout, kTail, 0, {50, 0, 50, 100})};
    }
    void bring(const Object& object, const NodeMasks& to) {
        OneObject objects(object);
        used.objects = object.latest();
        hand_on.bring_used(to, source(objects));
    }
    DrawSource source(UsedObjects& objects) {
        const DrawTarget target(surface);
        return {ContextId(1), state, target, target, used, objects, share};
    }
    /// Whether it is not told of any frame soon.
    bool is_quiet(NodeIndex node) { return !readable(fakes[node.value].stream.get(), 100ms); }
    FakeNode& fake(NodeIndex node) { return fakes[node.value]; }

    const NodeMasks both{{kHead, 1}, {kTail, 1}};
    std::array<FakeNode, 2> fakes{FakeNode("hand_on_head"), FakeNode("hand_on_tail")};
    Nodes nodes{{[](Node&) {}, [] {}, [] {}, [] {}}};
    HandOn hand_on{nodes};
    ClientSurface surface{SurfaceId(1), {}};
    glstate::State state;
    UseStamp used;
    std::shared_ptr<ShareGroup> share = std::make_shared<ShareGroup>();
};

TEST_F(HandOnTest, MuchGoesToOneNodeAndIsAwaitedByTheOther) {
    const OneBuffer buffer(kLarge);
    bring(buffer, both);
    const auto parcel = fake(kHead).receive();
    ASSERT_EQ(parcel.kind, FrameKind::parcel);
    const auto piece = wire::read_parcel_piece(parcel.payload);
    ASSERT_TRUE(piece);
    EXPECT_EQ(piece->lead.route, (std::vector{kHead, kTail}));
    EXPECT_EQ(piece->content.size(), piece->lead.bytes) << "it is one piece";
    const auto batch = wire::split_batch(piece->content);
    ASSERT_TRUE(batch);
    EXPECT_EQ(batch->context, ContextId(1));
    EXPECT_EQ(batch->opcodes.size(), 1u);
    const auto place = fake(kTail).receive();
    ASSERT_EQ(place.kind, FrameKind::awaited);
    const auto awaited = wire::read_awaited(place.payload);
    ASSERT_TRUE(awaited);
    EXPECT_EQ(awaited->number, piece->lead.number);
    EXPECT_EQ(awaited->from, kHead);
    bring(buffer, both);
    EXPECT_TRUE(is_quiet(kHead) && is_quiet(kTail)) << "they have it";
}

TEST_F(HandOnTest, PiecesAreSmallEnoughToBeHandedOnWhileOthersCome) {
    const OneBuffer buffer(5 * wire::kParcelPiece / 2);
    bring(buffer, both);
    wire::ParcelReader reader;
    Result<std::optional<RawBytes>> whole;
    int pieces = 0;
    for (; pieces < 10 && whole && !*whole; ++pieces) {
        const auto frame = fake(kHead).receive();
        ASSERT_EQ(frame.kind, FrameKind::parcel);
        EXPECT_LE(frame.payload.size(), wire::kParcelPiece + 100);
        whole = reader.take(*wire::read_parcel_piece(frame.payload));
    }
    EXPECT_EQ(pieces, 3);
    ASSERT_TRUE(whole && *whole);
    EXPECT_GT((*whole)->size(), buffer.bytes.size());
}

TEST_F(HandOnTest, LittleGoesToEach) {
    const OneBuffer buffer(1000);
    bring(buffer, both);
    for (const NodeIndex node : {kHead, kTail}) {
        nodes.send(nodes[node]);
        EXPECT_TRUE(fake(node).receives(glapi::Op::BufferSubData));
    }
}

TEST_F(HandOnTest, OnlyWhatIsLackedAlikeIsHandedOn) {
    OneBuffer buffer(kLarge);
    bring(buffer, {{kHead, 1}});
    bring(buffer, {{kTail, 1}});
    EXPECT_TRUE(is_quiet(kHead) && is_quiet(kTail)) << "one node alone gets it with the draw";
    nodes[kTail].object_stamps[buffer.id] = buffer.stamp;
    buffer.stamp = next_stamp();
    bring(buffer, both);
    EXPECT_TRUE(is_quiet(kHead) && is_quiet(kTail)) << "they lack it since different times";
    nodes[kHead].object_stamps[buffer.id] = nodes[kTail].object_stamps[buffer.id];
    bring(buffer, both);
    EXPECT_EQ(fake(kHead).receive().kind, FrameKind::parcel);
}

TEST_F(HandOnTest, WhatADrawNamesTooUnlessTheyAreKnownToHaveIt) {
    const OneBuffer buffer(kLarge), used_one(1);
    OneObject objects(used_one);
    hand_on.bring_named(both, source(objects), OneNamed(buffer, {kTail}));
    EXPECT_TRUE(is_quiet(kHead) && is_quiet(kTail)) << "one node alone gets it with the draw";
    const OneNamed named(buffer, {});
    hand_on.bring_named(both, source(objects), named);
    EXPECT_EQ(fake(kHead).receive().kind, FrameKind::parcel);
    EXPECT_EQ(fake(kTail).receive().kind, FrameKind::awaited);
    for (const NodeIndex node : {kHead, kTail}) {
        bring_named(nodes, nodes[node], source(objects), named, nodes.batch(nodes[node], ContextId(1)));
        EXPECT_EQ(nodes[node].batch.bytes(), 0u) << "it has it";
    }
}

TEST_F(HandOnTest, OnlyNodesThatMayHandOn) {
    const OneBuffer buffer(kLarge);
    nodes[kTail].info.hands_on = false;
    bring(buffer, both);
    nodes[kTail].info.hands_on = true;
    nodes[kTail].slow = true;
    bring(buffer, both);
    EXPECT_TRUE(is_quiet(kHead) && is_quiet(kTail));
}

TEST_F(HandOnTest, ANodeThatWasNotReachedBeginsAnewAndAllGetItFromHere) {
    const OneBuffer buffer(kLarge);
    bring(buffer, both);
    fake(kHead).send(FrameKind::not_handed_on, std::string("\1\0\0\0", 4));
    for (const auto end = Clock::now() + kPatience; nodes[kTail].alive() && Clock::now() < end;)
        std::this_thread::sleep_for(5ms);
    EXPECT_FALSE(nodes[kTail].alive());
    EXPECT_TRUE(nodes[kHead].alive());
    EXPECT_FALSE(nodes.hand_on()) << "not for a while";
}

TEST_F(HandOnTest, WhatAllHaveGotKeepsNobodyFromGoingOn) {
    const OneBuffer buffer(kLarge);
    bring(buffer, both);
    const std::uint32_t number = wire::read_parcel_piece(fake(kHead).receive().payload)->lead.number;
    fake(kTail).send(FrameKind::handed_on, std::string(1, static_cast<char>(number)) + std::string(3, '\0'));
    std::this_thread::sleep_for(100ms);
    nodes.connect({.node = kHead, .address = {}, .ticket = {}, .up = false});
    EXPECT_TRUE(nodes[kTail].alive());
}

TEST_F(HandOnTest, WithTheFirstNodeGoesWhatWasOnItsWay) {
    const OneBuffer buffer(kLarge);
    bring(buffer, both);
    nodes.connect({.node = kHead, .address = {}, .ticket = {}, .up = false});
    EXPECT_FALSE(nodes[kTail].alive()) << "it would wait for ever";
}

}  // namespace
}  // namespace wall::client
