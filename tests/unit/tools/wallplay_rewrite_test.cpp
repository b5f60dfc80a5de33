// SPDX-License-Identifier: MIT
#include "tools/wallplay/rewrite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::wallplay {
namespace {

using glapi::Op;

constexpr SurfaceId kRecorded(3), kHere(8);

/// All commands of the buffer as a node gets them that shows the window on tiles 1 and 40.
wire::PackBuffer rewritten(const wire::PackBuffer& recorded, std::uint64_t slots = std::uint64_t{1} << 40 | 2) {
    wire::PackBuffer out;
    DrawnSurfaces drawn;
    const NodeView view{.surface = [](SurfaceId id) { return id == kRecorded ? kHere : SurfaceId(); },
                        .slots = [slots](SurfaceId id) { return id == kRecorded ? slots : 0; }};
    glstate::CommandWalk walk(recorded.opcodes(), recorded.operands());
    for (auto next = walk.next(); next && *next; next = walk.next()) {
        drawn.note(ContextId(1), **next);
        if (!is_of_windows((*next)->op)) rewrite(**next, drawn.of(ContextId(1)), view, out);
    }
    return out;
}

std::vector<glstate::Command> commands_of(const wire::PackBuffer& buffer) {
    std::vector<glstate::Command> out;
    glstate::CommandWalk walk(buffer.opcodes(), buffer.operands());
    for (auto next = walk.next(); next && *next; next = walk.next()) out.push_back(**next);
    return out;
}

TEST(Rewrite, BlocksAreDrawnOnTheTilesThatShowTheWindow) {
    wire::PackBuffer recorded;
    glapi::pack::Bind(recorded, kRecorded, kRecorded);
    glapi::pack::Block(recorded, 1, 0, 2, 12);
    glapi::pack::Vertex3f(recorded, 1, 2, 3);
    glapi::pack::End(recorded);
    const auto out = rewritten(recorded);
    const auto commands = commands_of(out);
    ASSERT_EQ(commands.size(), 2u);
    EXPECT_EQ(SurfaceId(commands[0].word(0)), kHere);
    EXPECT_EQ(commands[1].word(0), 2u);
    EXPECT_EQ(commands[1].word(1), 1u << 8);
    ASSERT_EQ(commands[1].block_opcodes.size(), 2u);
    EXPECT_EQ(commands[1].block_opcodes[1], static_cast<std::byte>(Op::Vertex3f)) << "last first";
    EXPECT_EQ(wire::load<float>(commands[1].block_operands.data() + 4), 2.0f);
}

TEST(Rewrite, ABlockIsExecutedWhereNoTileShowsTheWindow) {
    wire::PackBuffer recorded;
    glapi::pack::Bind(recorded, kRecorded, kRecorded);
    glapi::pack::Block(recorded, 1, 0, 0, 0);
    const auto out = rewritten(recorded, 0);
    EXPECT_NE(commands_of(out).back().word(0), 0u);
}

TEST(Rewrite, NobodyIsAskedAndWindowsAreNotTheRecordings) {
    wire::PackBuffer recorded;
    glapi::pack::SurfaceCreate(recorded, kRecorded, 1, 0, 24, 8, 0, 0, 0, 0);
    glapi::pack::SurfacePlace(recorded, kRecorded, 1, 64, 48, 0, 0, 64, 48, 0);
    glapi::pack::Sync(recorded, RequestId(5));
    glapi::pack::ShareTexture(recorded, RequestId(6), ClientName(1), 0, 0, {});
    glapi::pack::TexShared(recorded, ClientName(1));
    glapi::pack::ProgramLink(recorded, RequestId(7), ClientName(2), {});
    glapi::pack::ObjectDelete(recorded, ClientName(4));
    glapi::pack::Swap(recorded, kRecorded, 1);
    const auto out = rewritten(recorded);
    const auto commands = commands_of(out);
    ASSERT_EQ(commands.size(), 2u);
    EXPECT_EQ(commands[0].op, Op::ProgramLink);
    EXPECT_EQ(commands[0].word(0), 0u);
    EXPECT_EQ(commands[0].word(1), 2u);
    EXPECT_EQ(commands[1].op, Op::ObjectDelete);
}

TEST(DrawnSurfaces, FollowsEachContextUntilItEnds) {
    DrawnSurfaces drawn;
    wire::PackBuffer buffer;
    glapi::pack::Bind(buffer, kRecorded, kRecorded);
    glapi::pack::ContextDestroy(buffer, ContextId(2));
    glapi::pack::BeginAgain(buffer);
    const auto commands = commands_of(buffer);
    drawn.note(ContextId(1), commands[0]);
    drawn.note(ContextId(2), commands[0]);
    drawn.note(ContextId(1), commands[1]);
    EXPECT_EQ(drawn.of(ContextId(1)), kRecorded);
    EXPECT_EQ(drawn.of(ContextId(2)), SurfaceId());
    drawn.note(ContextId(2), commands[2]);
    EXPECT_EQ(drawn.of(ContextId(1)), SurfaceId());
}

}  // namespace
}  // namespace wall::wallplay
