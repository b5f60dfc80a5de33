// SPDX-License-Identifier: MIT
// The packed stream: packers and the bounds-checked decoder. Every proper prefix of a valid batch is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <vector>

#include "common/wire/batch.h"
#include "gen/glapi/null_handler.gen.h"

namespace wall {
namespace {

struct TestHandler : glapi::NullHandler {
    std::size_t commands = 0, tiles = 0, blocks = 0, block_bytes = 0;
    std::vector<float> vertex;
    std::uint32_t color = 0;
    std::vector<std::byte> image;
    SurfaceId swapped;

    std::uint32_t state_bytes(std::uint32_t id) { return id == 7 ? 4 : 0; }
    bool State(std::uint32_t, std::span<const std::byte> value) { return ++commands, value.size() == 4; }
    std::uint64_t begin_block(std::uint64_t mask, std::size_t bytes) { return block_bytes += bytes, ++blocks, mask; }
    void begin_tile(unsigned) { ++tiles; }
    bool another_pass() { return false; }
    void Begin(std::uint32_t mode) {
        ++commands;
        if (mode > 9) refuse("no such mode");
    }
    void End() { ++commands; }
    void Vertex3f(float x, float y, float z) { ++commands, vertex = {x, y, z}; }
    void Color4ub(std::uint32_t rgba) { ++commands, color = rgba; }
    template <class... A>
    void TexImage(A... a) {
        ++commands;
        const auto pixels = std::get<sizeof...(A) - 1>(std::tuple(a...));
        image.assign(pixels.begin(), pixels.end());
    }
    void Swap(SurfaceId surface, std::uint32_t) { ++commands, swapped = surface; }
};

constexpr std::byte kPixels[5] = {std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5}};

/// A batch of every shape of command: state, bytes, a block on two tiles.
void pack_sample(wire::PackBuffer& to) {
    const float width = 2;
    glapi::pack_state(to, 7, &width, sizeof width);
    glapi::pack::TexImage(to, ClientName(1), 2, 0, 4, 5, 1, 1, 0, 6, 7, kPixels);
    wire::PackBuffer body;
    glapi::pack::Begin(body, 4);
    glapi::pack::Color4ub(body, 0x01020304);
    glapi::pack::Vertex3f(body, 1, 2, 3);
    glapi::pack::End(body);
    glapi::pack::Block(to, 5, 0, static_cast<std::uint32_t>(body.commands()),
                       static_cast<std::uint32_t>(body.operand_bytes()));
    to.append(body, {}, body.mark());
    glapi::pack::Swap(to, SurfaceId(9), 2);
}

Result<void> decode(const wire::PackBuffer& batch, TestHandler& h) {
    return glapi::decode(batch.opcodes(), batch.operands(), h);
}

TEST(PackedStream, VertexCosts13Bytes) {
    wire::PackBuffer buffer;
    glapi::pack::Vertex3f(buffer, 1, 2, 3);
    EXPECT_EQ(buffer.bytes(), 13u);
}

/// A packer that takes these behind its buffer.
template <auto kPack, class... Operands>
constexpr bool takes = std::is_invocable_v<decltype(kPack), wire::PackBuffer&, Operands...>;

TEST(PackedStream, AnIdIsNoNumberAndNoOtherId) {
    using glapi::pack::Bind, glapi::pack::QueryResult, glapi::pack::Swap;
    static_assert(takes<&Swap, SurfaceId, std::uint32_t>);
    static_assert(!takes<&Swap, std::uint32_t, std::uint32_t>);
    static_assert(!takes<&Swap, ContextId, std::uint32_t>);
    static_assert(!takes<&Bind, SurfaceId, ContextId>);
    static_assert(takes<&QueryResult, RequestId, ClientName> && !takes<&QueryResult, ClientName, RequestId>);
    wire::PackBuffer buffer;
    Bind(buffer, SurfaceId(0x01020304), SurfaceId(5));
    const auto bytes = buffer.operands();
    EXPECT_EQ(std::vector(bytes.begin(), bytes.end()),
              (std::vector{std::byte{4}, std::byte{3}, std::byte{2}, std::byte{1}, std::byte{5}, std::byte{0},
                           std::byte{0}, std::byte{0}}))
        << "in the stream it is one, little endian";
}

TEST(PackedStream, DecodesWhatWasPacked) {
    wire::PackBuffer batch;
    pack_sample(batch);
    TestHandler h;
    ASSERT_TRUE(decode(batch, h));
    EXPECT_EQ(h.blocks, 1u);
    EXPECT_EQ(h.block_bytes, 17u + 5 + 5 + 13 + 1) << "Block, Begin, Color4ub, Vertex3f, End";
    EXPECT_EQ(h.tiles, 2u);
    EXPECT_EQ(h.commands, 3u + 2 * 4);
    EXPECT_EQ(h.vertex, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(h.color, 0x01020304u);
    EXPECT_EQ(h.swapped, SurfaceId(9));
    EXPECT_EQ(h.image, std::vector<std::byte>(std::begin(kPixels), std::end(kPixels)));
}

/// The commands of some groups apart; what it does not look at goes to the rest.
struct HandlerByGroup : glapi::Handler {
    static constexpr bool kByGroup = true;
    struct Geometry : glapi::NullHandler {
        std::vector<float> vertex;
        void Vertex3f(float x, float y, float z) { vertex = {x, y, z}; }
    } geometry;
    struct Stream : glapi::NullHandler {
        std::uint32_t last = 0;
        std::uint32_t state_bytes(std::uint32_t id) { return id == 7 ? 4 : 0; }
        bool State(std::uint32_t id, std::span<const std::byte>) { return last = id, true; }
    } stream;
    struct Surface : glapi::NullHandler {
        glapi::Refusal& refusal;
        explicit Surface(glapi::Refusal& all) : refusal(all) {}
        void Swap(SurfaceId, std::uint32_t) { refusal.refuse("not now"); }
    } surface{*this};
    glapi::NullHandler draw, array_draw, instanced_draw, captured_draw, texture_barrier, buffer, capture, capture_end,
        vertex_input, draw_pieces, renderbuffer, framebuffer, sampler, texture_buffer, texture_drawn, blit, read,
        object, texture, run, program, pipeline, subroutine, storage, dispatch, format, image_copy, texture_view,
        surface_view, assembly, begin_again, partial, piece_range, query, map, sync;

    std::uint64_t begin_block(std::uint64_t tiles, std::size_t) { return tiles; }
    void begin_tile(unsigned) {}
    bool another_pass() { return false; }
    void end_block() {}
};

TEST(PackedStream, EachGroupMayHaveAHandler) {
    wire::PackBuffer batch;
    pack_sample(batch);
    HandlerByGroup h;
    const auto done = glapi::decode(batch.opcodes(), batch.operands(), h);
    EXPECT_EQ(h.geometry.vertex, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(h.stream.last, 7u);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "Swap: not now") << "a group refuses for all";
}

/// Wants a pause whenever it is asked.
struct PausingHandler : TestHandler {
    glapi::Pause wanted = glapi::Pause::now;
    std::size_t all_told = 0;
    glapi::Pause should_pause(std::size_t told) {
        all_told += told;
        return wanted;
    }
};

TEST(PackedStream, APausedBatchGoesOnWhereItStood) {
    wire::PackBuffer batch, body;
    for (int i = 0; i < 3000; ++i) glapi::pack::Vertex3f(body, static_cast<float>(i), 0, 0);
    pack_sample(batch);
    glapi::pack::Block(batch, 5, 0, static_cast<std::uint32_t>(body.commands()),
                       static_cast<std::uint32_t>(body.operand_bytes()));
    batch.append(body, {}, body.mark());
    pack_sample(batch);
    TestHandler at_once;
    ASSERT_TRUE(decode(batch, at_once));

    PausingHandler paused;
    glapi::BatchRun run(batch.opcodes(), batch.operands());
    int slices = 1;
    std::size_t longest = 0;
    for (;; ++slices) {
        const std::size_t before = paused.commands;
        const auto done = run.run(paused);
        ASSERT_TRUE(done) << done.error().message;
        longest = std::max(longest, paused.commands - before);
        if (*done) break;
    }
    EXPECT_GT(slices, 10);
    EXPECT_LE(longest, 1200u);
    EXPECT_EQ(paused.commands, at_once.commands);
    EXPECT_EQ(paused.tiles, at_once.tiles);
    EXPECT_EQ(paused.blocks, at_once.blocks);
    EXPECT_EQ(paused.vertex, at_once.vertex);
    EXPECT_EQ(paused.all_told + run.untold(), paused.commands);

    PausingHandler later;
    later.wanted = glapi::Pause::soon;
    glapi::BatchRun uncut(batch.opcodes(), batch.operands());
    const auto done = uncut.run(later);
    EXPECT_TRUE(done && *done) << "it could not be cut";
}

TEST(PackedStream, EveryProperPrefixIsRefused) {
    wire::PackBuffer batch;
    pack_sample(batch);
    std::vector<std::byte> payload;
    wire::append_batch(payload, {ContextId(3), batch.opcodes(), batch.operands()});
    ASSERT_TRUE(wire::split_batch(payload));
    for (std::size_t n = 0; n < payload.size(); ++n) EXPECT_FALSE(wire::split_batch(std::span(payload).first(n))) << n;
    for (std::size_t n = 0; n < batch.operand_bytes(); ++n) {
        TestHandler h;
        EXPECT_FALSE(glapi::decode(batch.opcodes(), batch.operands().first(n), h)) << n;
    }
    for (std::size_t n = 0; n < batch.commands(); ++n) {  // the first n commands are at the end of memory
        TestHandler h;
        EXPECT_FALSE(glapi::decode(batch.opcodes().last(n), batch.operands(), h)) << n;
    }
}

TEST(PackedStream, RefusesMisplacedCommands) {
    const auto refused = [](auto&& pack) {
        wire::PackBuffer batch;
        pack(batch);
        TestHandler h;
        const auto done = decode(batch, h);
        return done ? std::string() : done.error().message;
    };
    EXPECT_EQ(refused([](auto& b) { glapi::pack::Begin(b, 4); }), "Begin: outside a block");
    EXPECT_EQ(refused([](auto& b) { glapi::pack::Block(b, 1, 0, 1, 8), glapi::pack::Swap(b, SurfaceId(1), 1); }),
              "a block may not hold Swap");
    EXPECT_EQ(refused([](auto& b) { glapi::pack::Block(b, 1, 0, 1, 16), glapi::pack::Block(b, 1, 0, 0, 0); }),
              "a block may not hold Block");
    EXPECT_EQ(refused([](auto& b) { glapi::pack::Block(b, 1, 0, 2, 0), glapi::pack::Swap(b, SurfaceId(1), 1); }),
              "Block: reaches over the batch's end");
    EXPECT_EQ(refused([](auto& b) { glapi::pack::Block(b, 1, 0, 1, 4), glapi::pack::Begin(b, 99); }),
              "Begin: no such mode");
    EXPECT_EQ(refused([](auto& b) { b.append(200, 0); }), "unknown opcode 200");
    EXPECT_EQ(refused([](auto& b) { glapi::pack_state(b, 8, &b, 4); }), "State: bad operands");
}

TEST(PackedStream, ARunMayNotCallARun) {
    wire::PackBuffer run;
    glapi::pack::Begin(run, 4);
    TestHandler h;
    EXPECT_TRUE(glapi::decode_run(run.opcodes(), run.operands(), h));
    glapi::pack::RunCall(run, ClientName(1));
    EXPECT_FALSE(glapi::decode_run(run.opcodes(), run.operands(), h));
}

}  // namespace
}  // namespace wall
