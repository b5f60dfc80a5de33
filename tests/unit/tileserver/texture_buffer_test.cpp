// SPDX-License-Identifier: MIT
// Textures made of buffers on a node: the texels are those of the part that the client named, as the buffer is now.
#include <gtest/gtest.h>

#include <optional>

#include "common/glapi/program_format.h"
#include "gen/glstate/texture_elements.gen.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

using test::Batch;
using test::Pixels;
using test::TestNode;
using test::TestSession;
namespace el = glstate::el;
namespace pack = glapi::pack;

constexpr ClientName kProgram(1), kBuffer(2), kTexture(3);
constexpr std::array<glstate::Vec4, 2> kTexels = {{{0, 1, 0, 1}, {0, 0, 1, 1}}};
constexpr std::uint32_t kTexel = sizeof(glstate::Vec4);

/// Draws with the first texel.
const glapi::ProgramDefinition kShown{
    {{GL_VERTEX_SHADER, true, "#version 140\nin vec4 place; void main() { gl_Position = place; }"},
     {GL_FRAGMENT_SHADER, true,
      "#version 140\nuniform samplerBuffer texels;\n"
      "out vec4 result; void main() { result = texelFetch(texels, 0); }"}},
    {{0, "place"}},
    {}};

class TextureBufferTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{0, {0, 0, 8, 8}}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(8, 8, {0, 0, 8, 8});
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(0), kProgram, encode(kShown));
        fill(batch.buffer(), kTexels);
        session_->expect_run(batch);
    }
    static void fill(wire::PackBuffer& b, const std::array<glstate::Vec4, 2>& texels) {
        pack::BufferData(b, kBuffer, 2 * kTexel, GL_DYNAMIC_DRAW);
        pack::BufferSubData(b, kBuffer, 0, std::as_bytes(std::span(texels)));
    }
    static void draw(Batch& batch) {
        batch.set<el::current_program>(kProgram.value).set<el::texture_binding_buffer>(kTexture.value, 0);
        batch.block(1, [](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT);
            pack::Begin(b, GL_QUADS);
            for (const auto& v :
                 {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
                pack::Vertex2f(b, v[0], v[1]);
            pack::End(b);
        });
    }
    Pixels pixel() { return session_->read(0, {3, 3, 1, 1}); }
    Pixels drawn(ClientName buffer, std::uint32_t offset, std::uint32_t bytes) {
        Batch batch;
        pack::TexBuffer(batch.buffer(), kTexture, GL_RGBA32F, buffer, offset, bytes);
        draw(batch);
        session_->expect_run(batch);
        return pixel();
    }

    TestNode node_;
    std::optional<TestSession> session_;
};

const Pixels kGreenPixel{0, 255, 0, 255}, kBluePixel{0, 0, 255, 255};

TEST_F(TextureBufferTest, TexelsAreThoseOfThePart) {
    EXPECT_EQ(drawn(kBuffer, 0, 0), kGreenPixel);
    EXPECT_EQ(drawn(kBuffer, kTexel, kTexel), kBluePixel);
}

TEST_F(TextureBufferTest, ANewContentIsSeenAndWhatWasDrawnKeepsItsOwn) {
    EXPECT_EQ(drawn(kBuffer, 0, 0), kGreenPixel);
    Batch batch;
    fill(batch.buffer(), {kTexels[1], kTexels[0]});
    draw(batch);
    fill(batch.buffer(), kTexels);
    session_->expect_run(batch);
    EXPECT_EQ(pixel(), kBluePixel);
}

TEST_F(TextureBufferTest, WhatIsNotThereHasNoTexels) {
    EXPECT_EQ(drawn(kBuffer, 0, 0), kGreenPixel);
    EXPECT_NE(drawn(kBuffer, kTexel, 2 * kTexel), kGreenPixel) << "over the end";
    EXPECT_NE(drawn(ClientName(99), 0, 0), kGreenPixel) << "no such buffer";
    EXPECT_NE(drawn(ClientName(), 0, 0), kGreenPixel) << "none";
    EXPECT_EQ(drawn(kBuffer, 0, 0), kGreenPixel);
    Batch gone;
    pack::ObjectDelete(gone.buffer(), kBuffer);
    draw(gone);
    session_->expect_run(gone);
    EXPECT_NE(pixel(), kGreenPixel) << "its memory goes with it, whatever the driver keeps";
}

TEST_F(TextureBufferTest, AnotherKindIsRefused) {
    Batch program;
    pack::TexBuffer(program.buffer(), kTexture, GL_RGBA32F, kProgram, 0, 0);
    EXPECT_FALSE(session_->run(program));
}

}  // namespace
}  // namespace wall::tileserver
