// SPDX-License-Identifier: MIT
// What only nodes have of an object, on its way to one that comes late. Two others are connected, and the test plays
// them.
#include "client_lib/follow/object_sender.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>

#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

using glapi::Op;

constexpr NodeIndex kLate(0), kFirst(1), kSecond(2);
const std::string kContent = "drawn";

/// One that somebody drew in.
struct DrawnObject final : Object {
    DrawnObject() : Object(ClientName(7)) {}
    std::uint64_t latest() const override { return 1; }
    void pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>&) const override {
        glapi::pack::BufferData(buffer, id, static_cast<std::uint32_t>(kContent.size()), GL_STATIC_DRAW);
    }
    bool is_drawn() const override { return true; }
    void pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>&) const override {
        const auto answer = ask(
            [&](wire::PackBuffer& question, RequestId request) {
                glapi::pack::BufferRead(question, request, id, 0, static_cast<std::uint32_t>(kContent.size()));
            },
            {});
        if (answer) glapi::pack::BufferSubData(buffer, id, 0, *answer);
    }
};

class DrawnContent : public testing::Test {
protected:
    DrawnContent() {
        std::thread node_side([this] {
            for (FakeNode* fake : {&late, &first, &second}) EXPECT_TRUE(fake->welcome([] {}));
        });
        nodes.connect_and_wait(std::array{NodeInfo{kLate, late.listener.address(), "ticket", 1, true},
                                          NodeInfo{kFirst, first.listener.address(), "ticket", 1, true},
                                          NodeInfo{kSecond, second.listener.address(), "ticket", 1, true}});
        node_side.join();
    }
    /// The late node gets the object. Whether it has what was drawn in it, now.
    bool send() {
        wire::PackBuffer& batch = nodes.batch(nodes[kLate], ContextId(1));
        ObjectSender(nodes, nodes[kLate], batch).send(object);
        bool has = false;
        for (std::uint32_t at = 0; at < batch.commands(); ++at)
            has = has || static_cast<Op>(batch.opcode_at(at)) == Op::BufferSubData;
        batch.clear();
        return has;
    }
    void has_it(NodeIndex node) { nodes[node].object_stamps[object.id] = object.latest(); }
    /// The node is asked, as the `number`th of all.
    static void answer(FakeNode& node, std::uint32_t number) {
        EXPECT_TRUE(node.receives(Op::BufferRead));
        std::string text(sizeof number, '\0');
        std::memcpy(text.data(), &number, sizeof number);
        node.send(FrameKind::reply, text + kContent);
    }

    FakeNode late{"late_node"}, first{"first_holder"}, second{"second_holder"};
    Nodes nodes{{[](Node&) {}, [] {}, [] {}, [] {}}};
    const DrawnObject object;
};

TEST_F(DrawnContent, ComesFromAnotherOneWhenOneGoesAwayInsteadOfAnswering) {
    has_it(kFirst);
    has_it(kSecond);
    std::thread node_side([this] {
        EXPECT_TRUE(first.receives(Op::BufferRead));
        first.stream.reset();
        answer(second, 2);
    });
    EXPECT_TRUE(send());
    node_side.join();
    EXPECT_TRUE(nodes[kLate].holds(object.id));
}

TEST_F(DrawnContent, ComesWithALaterDrawWhenNobodyAnswersNow) {
    has_it(kSecond);
    nodes[kSecond].left_out[SurfaceId(1)] = 3;
    EXPECT_FALSE(send());
    EXPECT_FALSE(nodes[kLate].holds(object.id)) << "it is not asked for it";
    nodes[kSecond].left_out.clear();
    std::thread node_side([this] { answer(second, 1); });
    EXPECT_TRUE(send());
    node_side.join();
    EXPECT_TRUE(nodes[kLate].holds(object.id));
}

TEST_F(DrawnContent, ComesFromASlowOneButIsNotAskedForThereAgainAndAgain) {
    has_it(kSecond);
    nodes[kSecond].slow = true;
    std::thread node_side([this] { answer(second, 1); });
    EXPECT_TRUE(send());
    node_side.join();
    nodes[kLate].hollow.insert(object.id);  // as if it had not answered
    EXPECT_FALSE(send());
    EXPECT_FALSE(nodes[kLate].holds(object.id)) << "until it answers to a frame";
}

TEST_F(DrawnContent, IsNotWaitedForWhenNobodyHasIt) {
    has_it(kFirst);
    nodes[kFirst].hollow.insert(object.id);
    EXPECT_FALSE(send());
    EXPECT_TRUE(nodes[kLate].holds(object.id)) << "as good as anybody's";
}

}  // namespace
}  // namespace wall::client
