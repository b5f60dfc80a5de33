// SPDX-License-Identifier: MIT
// What is of single draw buffers (masks, blending, clears), samplers, and queries of primitives, on a node.
#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cstring>

#include "common/glstate/framebuffer.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

using ::testing::HasSubstr;

constexpr int kSize = 32;
constexpr geom::Rect kWindow{0, 0, kSize, kSize};
constexpr ClientName kFirst(21), kSecond(22), kFramebuffer(24), kSampler(25), kQuery(26);

using Pixel = std::array<std::uint8_t, 4>;

class DrawBuffersTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, {0, 0, kSize / 2, kSize}}, {1, {kSize / 2, 0, kSize / 2, kSize}}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kSize, kSize, kWindow);
    }
    static void define_texture(wire::PackBuffer& b, ClientName name) {
        pack::TexImage(b, name, GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, {});
        pack::TexParameter(b, name, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST, 0, 0, 0);
    }
    /// Two textures that are drawn to together.
    void draw_to_two(Batch& batch) {
        define_texture(batch.buffer(), kFirst);
        define_texture(batch.buffer(), kSecond);
        glstate::FramebufferDefinition definition;
        definition.attachments = {{GL_COLOR_ATTACHMENT0, kFirst, GL_TEXTURE_2D, 0, 0},
                                  {GL_COLOR_ATTACHMENT1, kSecond, GL_TEXTURE_2D, 0, 0}};
        definition.draw_buffers = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        pack::Framebuffer(batch.buffer(), kFramebuffer, encode(definition));
        pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
    }
    static void clear_color(wire::PackBuffer& b, std::int32_t drawbuffer, const glstate::Vec4& c) {
        const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
        pack::ClearBuffer(b, GL_COLOR, drawbuffer, GL_FLOAT, bits(c[0]), bits(c[1]), bits(c[2]), bits(c[3]));
    }
    Pixel texel(ClientName name) {
        Batch batch;
        pack::TexRead(batch.buffer(), RequestId(5), name, GL_TEXTURE_2D, 0, 0, 0, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        session_->expect_run(batch);
        Pixel out{};
        const auto& answer = session_->replies[RequestId(5)];
        if (answer.size() >= out.size()) std::memcpy(out.data(), answer.data(), out.size());
        return out;
    }
    Pixel window_pixel(std::uint32_t slot, int x) {
        const Pixels pixels = session_->read(slot, {x, 0, 1, 1});
        Pixel out{};
        if (pixels.size() >= out.size()) std::memcpy(out.data(), pixels.data(), out.size());
        return out;
    }
    std::string refusal(GLenum buffer, std::int32_t drawbuffer, GLenum type) {
        TestSession session(*node_.node, SessionId(2));
        Batch batch;
        batch.block(1, [&](auto& b) { pack::ClearBuffer(b, buffer, drawbuffer, type, 0, 0, 0, 0); });
        const auto done = session.run(batch);
        return done ? "" : done.error().message;
    }
    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(DrawBuffersTest, EachIsClearedAndMaskedByItself) {
    Batch batch;
    draw_to_two(batch);
    batch.block(1, [](auto& b) {
        clear_color(b, 0, {1, 0, 0, 1});
        clear_color(b, 1, {0, 1, 0, 1});
    });
    batch.set<el::color_mask>({0xff, 0xff, 0xfd, 0xff}).set<el::clear_color>({0, 0, 1, 1});
    batch.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
    session_->expect_run(batch);
    EXPECT_EQ(texel(kFirst), (Pixel{0, 0, 255, 255}));
    EXPECT_EQ(texel(kSecond), (Pixel{0, 0, 0, 255})) << "no blue there";
}

TEST_F(DrawBuffersTest, OneOfThemBlends) {
    Batch batch;
    draw_to_two(batch);
    batch.block(1, [](auto& b) {
        clear_color(b, 0, {0, 0, 1, 1});
        clear_color(b, 1, {0, 0, 1, 1});
    });
    batch.set<el::blend_enabled>(2).set<el::blend_func>({GL_ONE, GL_ONE, GL_ONE, GL_ONE}).set<el::color>({1, 0, 0, 1});
    batch.set<el::viewport>({0, 0, kSize, kSize});
    batch.block(1, [](auto& b) {
        pack::Begin(b, GL_QUADS);
        for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
            pack::Vertex2f(b, x, y);
        pack::End(b);
    });
    session_->expect_run(batch);
    EXPECT_EQ(texel(kFirst), (Pixel{255, 0, 0, 255}));
    EXPECT_EQ(texel(kSecond), (Pixel{255, 0, 255, 255}));
}

TEST_F(DrawBuffersTest, AWindowIsClearedOnAllItsTiles) {
    Batch batch;
    batch.block(3, [](auto& b) { clear_color(b, 0, {0, 1, 0, 1}); });
    batch.set<el::scissor>({0, 0, kSize / 2 + 2, kSize}).set<el::scissor_enabled>(1);
    batch.block(3, [](auto& b) { clear_color(b, 0, {1, 0, 0, 1}); });
    session_->expect_run(batch);
    EXPECT_EQ(window_pixel(0, 0), (Pixel{255, 0, 0, 255}));
    EXPECT_EQ(window_pixel(1, kSize / 2 + 1), (Pixel{255, 0, 0, 255}));
    EXPECT_EQ(window_pixel(1, kSize / 2 + 2), (Pixel{0, 255, 0, 255})) << "outside of the scissor box";
}

TEST_F(DrawBuffersTest, ClearsThatNoClientSendsAreRefused) {
    EXPECT_THAT(refusal(GL_FOG, 0, GL_FLOAT), HasSubstr("no such buffer"));
    EXPECT_THAT(refusal(GL_DEPTH, 0, GL_INT), HasSubstr("no such buffer"));
    EXPECT_THAT(refusal(GL_DEPTH, 1, GL_FLOAT), HasSubstr("no such draw buffer"));
    EXPECT_THAT(refusal(GL_COLOR, -1, GL_FLOAT), HasSubstr("no such draw buffer"));
    EXPECT_THAT(refusal(GL_COLOR, 8, GL_FLOAT), HasSubstr("no such draw buffer"));
    EXPECT_EQ(refusal(GL_DEPTH_STENCIL, 0, GL_FLOAT_32_UNSIGNED_INT_24_8_REV), "");
}

TEST_F(DrawBuffersTest, ASamplerSaysHowATextureIsLookedUp) {
    const std::array<std::uint8_t, 8> texels = {255, 0, 0, 255, 0, 255, 0, 255};
    Batch batch;
    auto& b = batch.buffer();
    pack::TexImage(b, kFirst, GL_TEXTURE_2D, 0, GL_RGBA8, 2, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   std::as_bytes(std::span(texels)));
    pack::TexParameter(b, kFirst, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST, 0, 0, 0);
    pack::TexParameter(b, kFirst, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST, 0, 0, 0);
    const auto number = [](GLenum v) { return std::bit_cast<std::uint32_t>(static_cast<float>(v)); };
    pack::SamplerParameter(b, kSampler, GL_TEXTURE_WRAP_S, GL_FLOAT, number(GL_CLAMP_TO_BORDER), 0, 0, 0);
    pack::SamplerParameter(b, kSampler, GL_TEXTURE_BORDER_COLOR, GL_FLOAT, 0, 0, number(1), number(1));
    pack::SamplerParameter(b, kSampler, GL_TEXTURE_MIN_FILTER, GL_FLOAT, number(GL_NEAREST), 0, 0, 0);
    batch.set<el::viewport>({0, 0, kSize, kSize}).set<el::texture_2d_enabled>(1);
    batch.set<el::texture_binding_2d>(kFirst.value).set<el::sampler_binding>(kSampler.value);
    const auto draw = [](auto& p) {
        pack::Begin(p, GL_QUADS);
        pack::TexCoord2f(p, 1.75f, 0.5f);  // outside, and repeated: green
        for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
            pack::Vertex2f(p, x, y);
        pack::End(p);
    };
    batch.block(3, draw);
    session_->expect_run(batch);
    EXPECT_EQ(window_pixel(0, 0), (Pixel{0, 0, 255, 255})) << "the sampler's border";
    Batch without;
    pack::ObjectDelete(without.buffer(), kSampler);
    without.block(3, draw);
    session_->expect_run(without);
    EXPECT_EQ(window_pixel(0, 0), (Pixel{0, 255, 0, 255})) << "as the texture says";
}

TEST_F(DrawBuffersTest, ASamplerOfAnotherSessionIsNotMet) {
    TestSession other(*node_.node, SessionId(2));
    Batch batch;
    pack::SamplerParameter(batch.buffer(), kSampler, GL_TEXTURE_WRAP_S, GL_UNSIGNED_INT, GL_REPEAT, 0, 0, 0);
    const auto done = other.run(batch);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("no value of that type"));
}

TEST_F(DrawBuffersTest, APrimitiveIsCountedOnceHoweverManyTiles) {
    Batch batch;
    batch.set<el::primitives_query>(kQuery.value).set<el::viewport>({0, 0, kSize, kSize});
    batch.block(3, [](auto& b) {
        pack::Begin(b, GL_TRIANGLE_STRIP);
        for (int i = 0; i < 5; ++i) pack::Vertex2f(b, i % 2 == 0 ? -1.0f : 1.0f, static_cast<float>(i) / 4 - 0.5f);
        pack::End(b);
    });
    batch.set<el::primitives_query>(0);
    pack::QueryResult(batch.buffer(), RequestId(6), kQuery);
    session_->expect_run(batch);
    std::uint64_t primitives = 99;
    const auto& answer = session_->replies[RequestId(6)];
    ASSERT_EQ(answer.size(), sizeof primitives);
    std::memcpy(&primitives, answer.data(), sizeof primitives);
    EXPECT_EQ(primitives, 3u);
    Batch as_samples;
    as_samples.set<el::occlusion_query>(kQuery.value);
    as_samples.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
    EXPECT_FALSE(session_->run(as_samples)) << "it counts something else";
}

}  // namespace
}  // namespace wall::tileserver::test
