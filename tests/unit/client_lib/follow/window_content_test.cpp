// SPDX-License-Identifier: MIT
// What a window holds, on its way to nodes that have seen none of its frames. One node shows the window, another one
// records; the test plays both.
#include "client_lib/follow/window_content.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>

#include "client_lib/follow/followers.h"
#include "tests/unit/client_lib/fake_node.h"

namespace wall::client {
namespace {

using glapi::Op;

constexpr NodeIndex kShowing(0), kRecording(1);
constexpr std::uint32_t kWindowSide = 10;
constexpr std::size_t kPlaneBytes = std::size_t{4} * kWindowSide * kWindowSide;

class WindowContent : public testing::Test {
protected:
    WindowContent() {
        std::thread node_side([this] {
            for (FakeNode* fake : {&shows, &records}) EXPECT_TRUE(fake->welcome([] {}));
        });
        NodeInfo recorder{kRecording, records.listener.address(), "ticket", 1, true};
        recorder.records = true;
        nodes.connect_and_wait(std::array{NodeInfo{kShowing, shows.listener.address(), "ticket", 1, true}, recorder});
        node_side.join();
        surface.layout.width = surface.layout.height = kWindowSide;
        surface.layout.rect = {0, 0, kWindowSide, kWindowSide};
        surface.layout.version = 1;
        for (const NodeIndex node : {kShowing, kRecording})
            surface.layout.layers.push_back(tile_layer(surface.layout, node, 0, surface.layout.rect));
        surface.frame = 3;
        surface.content_wanted = true;
        nodes[kShowing].surfaces[surface.id] = surface.layout.version;
    }
    /// The node is asked for colours and for depths, as the session's next two questions.
    void answer(FakeNode& node) {
        for (const std::uint32_t number : {asked_ + 1, asked_ + 2}) {
            EXPECT_TRUE(node.receives(Op::ReadPixels));
            std::string text(sizeof number, '\0');
            std::memcpy(text.data(), &number, sizeof number);
            node.send(FrameKind::reply, text + std::string(kPlaneBytes, number % 2 == 1 ? 'c' : 'd'));
        }
        asked_ += 2;
    }
    /// Whether an image was drawn from these bytes.
    static bool draws(const FakeNode::Frame& frame, char of) {
        const std::vector<std::byte> pixels(kPlaneBytes, static_cast<std::byte>(of));
        return frame.kind == FrameKind::batch && !std::ranges::search(frame.payload, pixels).empty();
    }
    template <class Call>
    void while_it_answers(Call&& call) {
        std::thread node_side([this] { answer(shows); });
        call();
        node_side.join();
    }

    std::uint32_t asked_ = 0;
    FakeNode shows{"shows_a_window"}, records{"records_a_window"};
    Nodes nodes{{[](Node&) {}, [] {}, [] {}, [] {}}};
    NodeUpdater updater{nodes};
    Dealer dealer{nodes, updater, false};
    WindowContents windows{nodes, dealer};
    ClientSurface surface{SurfaceId(1), {}};
    const DrawTarget target{surface};
};

TEST_F(WindowContent, GoesToWhoRecordsBeforeItIsDrawnOver) {
    while_it_answers([&] { windows.bring(target); });
    const auto frame = records.receive();
    EXPECT_TRUE(draws(frame, 'c'));
    EXPECT_TRUE(draws(frame, 'd'));
    EXPECT_FALSE(surface.content_wanted);
    EXPECT_TRUE(nodes[kRecording].surfaces.contains(surface.id));
    EXPECT_TRUE(nodes[kShowing].batch.commands() <= 1) << "but for the end of the context that has read it";
}

TEST_F(WindowContent, IsReadAndDrawnByOneContextHoweverOftenItIsWanted) {
    while_it_answers([&] { windows.bring(target); });
    const ContextId context = nodes[kShowing].batch_context;
    nodes[kShowing].batch.clear();
    nodes[kRecording].surfaces.clear();
    surface.content_wanted = true;
    while_it_answers([&] { windows.bring(target); });
    EXPECT_EQ(nodes[kShowing].batch_context, context) << "nodes have room for so many";
    EXPECT_EQ(nodes[kRecording].batch_context, context);
}

TEST_F(WindowContent, IsNotAskedForBeforeAClearOfAll) {
    windows.before_wiping(target);
    EXPECT_FALSE(surface.content_wanted);
    EXPECT_TRUE(nodes[kRecording].surfaces.contains(surface.id));
    windows.bring(target);
    EXPECT_FALSE(readable(shows.stream.get(), 50ms)) << "nobody was asked";
}

TEST_F(WindowContent, IsWantedUntilTheWindowLiesOnWhoRecords) {
    surface.layout.layers.pop_back();
    windows.bring(target);
    EXPECT_TRUE(surface.content_wanted);
    surface.layout.layers.push_back(tile_layer(surface.layout, kRecording, 0, surface.layout.rect));
    while_it_answers([&] { windows.bring(target); });
    EXPECT_FALSE(surface.content_wanted);
    EXPECT_TRUE(draws(records.receive(), 'c'));
}

TEST_F(WindowContent, OfAWindowThatHasNoFrameIsNothing) {
    surface.frame = 0;
    windows.bring(target);
    EXPECT_FALSE(surface.content_wanted);
    EXPECT_FALSE(readable(shows.stream.get(), 50ms));
}

TEST_F(WindowContent, WithoutDepthsIsColours) {
    ClientSurface flat(SurfaceId(2), {.format = {.depth_bits = 0, .stencil_bits = 0}});
    flat.layout = surface.layout;
    flat.frame = 1;
    flat.content_wanted = true;
    nodes[kShowing].surfaces[flat.id] = flat.layout.version;
    std::thread node_side([this] {
        EXPECT_TRUE(shows.receives(Op::ReadPixels));
        shows.send(FrameKind::reply, std::string("\1\0\0\0", 4) + std::string(kPlaneBytes, 'c'));
    });
    windows.bring(DrawTarget(flat));
    node_side.join();
    EXPECT_TRUE(draws(records.receive(), 'c'));
}

TEST_F(WindowContent, IsKeptForTheNodesOfAnotherWallUntilAFrameHasEndedThere) {
    while_it_answers([&] { windows.keep(surface); });
    nodes[kShowing].surfaces.clear();
    windows.bring(target);
    bool drawn = false;
    for (int i = 0; i < 2 && !drawn; ++i) drawn = draws(shows.receive(), 'c');
    EXPECT_TRUE(drawn) << "as they were read";
    windows.forget(surface.id);
    nodes[kShowing].surfaces.clear();
    surface.content_wanted = true;
    windows.bring(target);
    EXPECT_FALSE(readable(shows.stream.get(), 50ms)) << "nobody has it";
}

}  // namespace
}  // namespace wall::client
