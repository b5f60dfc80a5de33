// SPDX-License-Identifier: MIT
// Blocks of uniforms on a node: values come from the session's own buffers, as far as those go, and from nowhere else.
#include <gtest/gtest.h>

#include <optional>

#include "common/glapi/program_format.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/objects/buffer.h"

namespace wall::tileserver {
namespace {

using test::Batch;
using test::Pixels;
using test::TestNode;
using test::TestSession;
namespace el = glstate::el;
namespace pack = glapi::pack;

constexpr ClientName kProgram(1), kBuffer(2), kOther(3);
constexpr glstate::Vec4 kGreen = {0, 1, 0, 1}, kBlue = {0, 0, 1, 1};

const glapi::ProgramDefinition kTinted{
    {{GL_VERTEX_SHADER, true, "#version 140\nin vec4 place; void main() { gl_Position = place; }"},
     {GL_FRAGMENT_SHADER, true,
      "#version 140\nlayout(std140) uniform Tint { vec4 unused; vec4 color; };\n"
      "out vec4 result; void main() { result = color + unused * 0.0; }"}},
    {{0, "place"}},
    {},
    {"Gone", "Tint"}};

class UniformBlocksTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{0, {0, 0, 8, 8}}};
        open(first_, 1);
        open(second_, 2);
    }
    void open(std::optional<TestSession>& session, std::uint32_t id) {
        session.emplace(*node_.node, SessionId(id));
        session->open_surface(8, 8, {0, 0, 8, 8});
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(0), kProgram, encode(kTinted));
        session->expect_run(batch);
    }
    static void fill(wire::PackBuffer& b, ClientName buffer, const glstate::Vec4& color, std::uint32_t bytes = 512) {
        pack::BufferData(b, buffer, bytes, GL_DYNAMIC_DRAW);
        for (std::uint32_t at = 0; at + 32 <= bytes; at += 256)
            pack::BufferSubData(b, buffer, at + 16, std::as_bytes(std::span(color)));
    }
    static void draw(Batch& batch) {
        batch.set<el::current_program>(kProgram.value);
        batch.block(1, [](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT);
            pack::Begin(b, GL_QUADS);
            for (const auto& v :
                 {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
                pack::Vertex2f(b, v[0], v[1]);
            pack::End(b);
        });
    }
    static Pixels pixel(TestSession& session) { return session.read(0, {3, 3, 1, 1}); }
    Pixels drawn(TestSession& session, const glstate::BufferRange& range) {
        Batch batch;
        batch.set<el::uniform_buffer>(range, 0);
        draw(batch);
        session.expect_run(batch);
        return pixel(session);
    }

    TestNode node_;
    std::optional<TestSession> first_, second_;
};

const Pixels kGreenPixel{0, 255, 0, 255}, kBluePixel{0, 0, 255, 255}, kNothing{0, 0, 0, 255};

TEST_F(UniformBlocksTest, ABlockReadsWhatIsBoundAtItsPlace) {
    Batch batch;
    fill(batch.buffer(), kBuffer, kGreen);
    fill(batch.buffer(), kOther, kBlue);
    batch.set<el::uniform_buffer>({kBuffer.value, 0, 0}, 0).set<el::uniform_buffer>({kOther.value, 256, 32}, 9);
    draw(batch);
    first_->expect_run(batch);
    EXPECT_EQ(pixel(*first_), kGreenPixel);
    Batch elsewhere;
    pack::UniformBlock(elsewhere.buffer(), kProgram, 1, 9);
    pack::UniformBlock(elsewhere.buffer(), kProgram, 0, 5);  // of a block that is not active here
    draw(elsewhere);
    first_->expect_run(elsewhere);
    EXPECT_EQ(pixel(*first_), kBluePixel);
}

TEST_F(UniformBlocksTest, ANewContentIsSeen) {
    Batch batch;
    fill(batch.buffer(), kBuffer, kGreen);
    first_->expect_run(batch);
    EXPECT_EQ(drawn(*first_, {kBuffer.value, 0, 0}), kGreenPixel);
    Batch again;
    fill(again.buffer(), kBuffer, kBlue, 1024);
    draw(again);
    first_->expect_run(again);
    EXPECT_EQ(pixel(*first_), kBluePixel);
}

TEST_F(UniformBlocksTest, WhatWasDrawnKeepsTheContentOfThen) {
    Batch batch;
    fill(batch.buffer(), kBuffer, kGreen);
    batch.set<el::current_program>(kProgram.value).set<el::uniform_buffer>({kBuffer.value, 0, 0}, 0);
    const auto half = [&](float left) {
        batch.block(1, [&](auto& b) {
            pack::Begin(b, GL_QUADS);
            for (const auto& v :
                 {std::array{left, -1.f}, std::array{left + 1, -1.f}, std::array{left + 1, 1.f}, std::array{left, 1.f}})
                pack::Vertex2f(b, v[0], v[1]);
            pack::End(b);
        });
    };
    half(-1);
    pack::BufferSubData(batch.buffer(), kBuffer, 16, std::as_bytes(std::span(kBlue)));
    half(0);
    first_->expect_run(batch);
    EXPECT_EQ(first_->read(0, {1, 3, 1, 1}), kGreenPixel);
    EXPECT_EQ(first_->read(0, {6, 3, 1, 1}), kBluePixel);
}

TEST_F(UniformBlocksTest, SessionsSeeTheirOwnBuffers) {
    Batch green, blue;
    fill(green.buffer(), kBuffer, kGreen);
    first_->expect_run(green);
    EXPECT_EQ(drawn(*first_, {kBuffer.value, 0, 0}), kGreenPixel);
    EXPECT_NE(drawn(*second_, {kBuffer.value, 0, 0}), kGreenPixel) << "it has no such buffer";
    fill(blue.buffer(), kBuffer, kBlue);
    second_->expect_run(blue);
    EXPECT_EQ(drawn(*second_, {kBuffer.value, 0, 0}), kBluePixel);
    EXPECT_EQ(drawn(*first_, {kBuffer.value, 0, 0}), kGreenPixel);
}

TEST_F(UniformBlocksTest, PartsThatNoBufferHasAreNothing) {
    Batch green, blue;
    fill(green.buffer(), kBuffer, kGreen);
    first_->expect_run(green);
    fill(blue.buffer(), kOther, kBlue, 64);
    second_->expect_run(blue);
    for (const glstate::BufferRange& range :
         {glstate::BufferRange{kOther.value, 64, 0}, glstate::BufferRange{kOther.value, 0xffffff00u, 0xffffffffu},
          glstate::BufferRange{kOther.value, 3, 32}, glstate::BufferRange{77, 0, 0},
          glstate::BufferRange{kProgram.value, 0, 0}}) {
        EXPECT_EQ(drawn(*first_, {kBuffer.value, 0, 0}), kGreenPixel);
        EXPECT_NE(drawn(*second_, range), kGreenPixel) << range.buffer << ' ' << range.offset;
    }
    EXPECT_EQ(drawn(*second_, {kOther.value, 0, 4096}), kBluePixel) << "cut to the buffer";
}

TEST_F(UniformBlocksTest, ABufferMayGo) {
    Batch batch;
    fill(batch.buffer(), kBuffer, kGreen);
    first_->expect_run(batch);
    EXPECT_EQ(drawn(*first_, {kBuffer.value, 0, 0}), kGreenPixel);
    Batch gone;
    pack::ObjectDelete(gone.buffer(), kBuffer);
    draw(gone);
    first_->expect_run(gone);
    EXPECT_NE(pixel(*first_), kGreenPixel);
}

TEST_F(UniformBlocksTest, WhatNoClientSendsIsRefused) {
    for (const auto& [block, binding] : {std::pair{2u, 0u}, std::pair{1u, unsigned{el::uniform_buffer::count}}}) {
        std::optional<TestSession> session;
        open(session, 3);
        Batch batch;
        pack::UniformBlock(batch.buffer(), kProgram, block, binding);
        EXPECT_FALSE(session->run(batch)) << block;
    }
}

}  // namespace
}  // namespace wall::tileserver
