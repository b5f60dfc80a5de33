// SPDX-License-Identifier: MIT
#include "bench/simulate/traffic_count.h"

#include <gtest/gtest.h>

#include "common/wire/batch.h"
#include "common/wire/pack_buffer.h"
#include "gen/glapi/wire.gen.h"

namespace wall::simulate {
namespace {

namespace pack = glapi::pack;

std::vector<std::byte> payload_of(const wire::PackBuffer& buffer) {
    std::vector<std::byte> out;
    wire::append_batch(out, {ContextId(1), buffer.opcodes(), buffer.operands()});
    return out;
}

void three_vertices(wire::PackBuffer& buffer) {
    pack::Begin(buffer, 4);
    for (int i = 0; i < 3; ++i) pack::Vertex3f(buffer, 0, 0, 0);
    pack::End(buffer);
}

/// As the client does: what is in the block stands behind its head.
void block(wire::PackBuffer& buffer, const wire::PackBuffer& inside) {
    pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(inside.opcodes().size()),
                static_cast<std::uint32_t>(inside.operands().size()));
    buffer.append(inside, {}, inside.mark());
}

TEST(TrafficCount, CountsWhatAFrameDraws) {
    wire::PackBuffer inside, buffer;
    three_vertices(inside);
    block(buffer, inside);
    pack::DrawArrays(buffer, ClientName(1), ClientName(), 4, 0, 300);
    pack::DrawElements(buffer, ClientName(1), ClientName(9), 4, 60, 0x1403, 0, 0);
    pack::DrawElementsInstanced(buffer, ClientName(1), 4, 30, 0x1403, 0, 0, 5, 0, 0);
    pack::Swap(buffer, SurfaceId(7), 3);
    TrafficCount count;
    const auto payload = payload_of(buffer);
    const auto seen = count.look(payload);
    ASSERT_TRUE(seen) << seen.error().message;
    EXPECT_EQ(seen->traffic.plain_bytes, payload.size());
    EXPECT_EQ(seen->traffic.blocks, 1u);
    EXPECT_EQ(seen->traffic.vertices, 3u + 300 + 60 + 150);
    EXPECT_EQ(seen->traffic.in_pieces, 60u);
    EXPECT_EQ(seen->traffic.commands, 5u + 5);
    ASSERT_EQ(seen->swaps.size(), 1u);
    EXPECT_EQ(seen->swaps[0].surface, SurfaceId(7));
    EXPECT_EQ(seen->swaps[0].frame, 3u);
    EXPECT_TRUE(seen->questions.empty());
}

TEST(TrafficCount, AListCountsWhereItIsCalled) {
    wire::PackBuffer list, define, inside, call;
    three_vertices(list);
    std::vector<std::byte> content(wire::padded4(list.opcodes().size()) - list.opcodes().size());
    content.insert(content.end(), list.opcodes().begin(), list.opcodes().end());
    content.insert(content.end(), list.operands().begin(), list.operands().end());
    pack::RunDefine(define, ClientName(5), static_cast<std::uint32_t>(list.opcodes().size()),
                    static_cast<std::uint32_t>(list.operands().size()), content);
    for (int i = 0; i < 2; ++i) pack::RunCall(inside, ClientName(5));
    block(call, inside);
    TrafficCount count;
    const auto defined = count.look(payload_of(define)), called = count.look(payload_of(call));
    ASSERT_TRUE(defined && called);
    EXPECT_EQ(defined->traffic.vertices, 0u);
    EXPECT_EQ(called->traffic.vertices, 6u);
}

TEST(TrafficCount, SeesWhoWaitsForAnAnswer) {
    wire::PackBuffer buffer;
    pack::Sync(buffer, RequestId(4));
    pack::ProgramLink(buffer, RequestId(), ClientName(2), {});  // asks nothing
    TrafficCount count;
    const auto seen = count.look(payload_of(buffer));
    ASSERT_TRUE(seen) << seen.error().message;
    ASSERT_EQ(seen->questions.size(), 1u);
    EXPECT_EQ(seen->questions[0].request, RequestId(4));
    EXPECT_EQ(seen->questions[0].name, "Sync");
}

TEST(TrafficCount, RefusesWhatIsNoBatch) {
    wire::PackBuffer buffer;
    pack::Swap(buffer, SurfaceId(7), 3);
    auto payload = payload_of(buffer);
    payload.pop_back();
    EXPECT_FALSE(TrafficCount().look(payload));
}

}  // namespace
}  // namespace wall::simulate
