// SPDX-License-Identifier: MIT
// Framebuffer objects on a node: what is drawn to them, sampled, copied and read back, and what is refused.
#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <limits>

#include "common/glstate/framebuffer.h"
#include "common/wire/whole_window.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

using ::testing::HasSubstr;

constexpr int kSize = 32;
constexpr geom::Rect kWindow{0, 0, kSize, kSize};
constexpr ClientName kTexture(21), kColor(22), kFramebuffer(24), kOther(25);

using Pixel = std::array<std::uint8_t, 4>;
constexpr Pixel kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255};

class FramebufferTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kWindow}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kSize, kSize, kWindow);
    }
    static void define_texture(wire::PackBuffer& b, ClientName name, int size = kSize) {
        pack::TexImage(b, name, GL_TEXTURE_2D, 0, GL_RGBA8, size, size, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, {});
        pack::TexParameter(b, name, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST, 0, 0, 0);
    }
    static void define_framebuffer(wire::PackBuffer& b, ClientName name, ClientName color,
                                   GLenum target = GL_TEXTURE_2D) {
        glstate::FramebufferDefinition definition;
        definition.attachments = {{GL_COLOR_ATTACHMENT0, color, target, 0, 0}};
        pack::Framebuffer(b, name, encode(definition));
    }
    /// Clears to a colour what is bound.
    static void clear(Batch& batch, const glstate::Vec4& color) {
        batch.set<el::clear_color>(color);
        batch.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
    }
    /// From the bottom left to `end`, in both directions; 1 is the whole target.
    static void draw_square(Batch& batch, float end) {
        batch.block(1, [end](auto& b) {
            pack::Begin(b, GL_QUADS);
            for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {end, -1.0f}, {end, end}, {-1.0f, end}})
                pack::Vertex2f(b, x, y);
            pack::End(b);
        });
    }
    /// A texture that was drawn red.
    void draw_texture() {
        Batch batch;
        define_texture(batch.buffer(), kTexture);
        define_framebuffer(batch.buffer(), kFramebuffer, kTexture);
        pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
        clear(batch, {1, 0, 0, 1});
        session_->expect_run(batch);
    }
    Pixel at(int x, int y) {
        const Pixels pixels = session_->read(0, {x, y, 1, 1});
        Pixel out{};
        std::memcpy(out.data(), pixels.data(), out.size());
        return out;
    }
    /// Why a stream is refused that has these commands.
    std::string refusal(const std::function<void(wire::PackBuffer&)>& commands) {
        TestSession session(*node_.node, SessionId(2));
        Batch batch;
        commands(batch.buffer());
        const auto done = session.run(batch);
        return done ? "" : done.error().message;
    }
    std::size_t texels(ClientName name, GLenum format = GL_RGBA) {
        Batch batch;
        pack::TexRead(batch.buffer(), RequestId(5), name, GL_TEXTURE_2D, 0, 0, 0, kSize, format, GL_UNSIGNED_BYTE);
        session_->expect_run(batch);
        return session_->replies[RequestId(5)].size();
    }

    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(FramebufferTest, WhatIsDrawnIsReadAndSampled) {
    draw_texture();
    EXPECT_EQ(at(3, 3), kRed);
    Batch batch;
    pack::BindTargets(batch.buffer(), {}, {}, 1);
    clear(batch, {0, 1, 0, 1});
    batch.set<el::texture_binding_2d>(kTexture.value).set<el::texture_2d_enabled>(1);
    draw_square(batch, 0);
    session_->expect_run(batch);
    EXPECT_EQ(at(3, 3), kRed) << "the window, where the texture was drawn";
    EXPECT_EQ(at(kSize - 3, 3), kGreen);
}

TEST_F(FramebufferTest, NothingNeedBeAttached) {
    Batch batch;
    glstate::FramebufferDefinition definition;
    definition.defaults = {8, 8, 0, 0, 0};
    pack::Framebuffer(batch.buffer(), kFramebuffer, encode(definition));
    pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
    batch.block(1, [](auto& b) {
        pack::Begin(b, GL_POINTS);
        pack::Vertex2f(b, 0, 0);
        pack::End(b);
        pack::TextureBarrier(b);
    });
    session_->expect_run(batch);
    EXPECT_THAT(refusal([](wire::PackBuffer& b) {
                    glstate::FramebufferDefinition absurd;
                    absurd.defaults.width = ~std::uint32_t{0};
                    pack::Framebuffer(b, kFramebuffer, encode(absurd));
                }),
                ::testing::Not(::testing::IsEmpty()));
}

TEST_F(FramebufferTest, ClipSpaceMayEndAtTheWindowsUpperEdge) {
    Batch batch;
    clear(batch, {0, 1, 0, 1});
    batch.set<el::clip_control>({GL_UPPER_LEFT, GL_ZERO_TO_ONE}).set<el::color>({1, 0, 0, 1});
    draw_square(batch, 0);
    session_->expect_run(batch);
    EXPECT_EQ(at(3, kSize - 3), kRed);
    EXPECT_EQ(at(3, 3), kGreen);
}

TEST_F(FramebufferTest, OnlyThePartThatIsNeededIsDrawn) {
    draw_texture();
    Batch batch;
    pack::TargetPart(batch.buffer(), kFramebuffer, 8, 8, 16, 16, 0, 0);
    clear(batch, {0, 1, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(at(7, 8), kRed);
    EXPECT_EQ(at(8, 8), kGreen);
    EXPECT_EQ(at(23, 23), kGreen);
    EXPECT_EQ(at(24, 23), kRed);
    Batch scissored;
    scissored.set<el::scissor>({0, 0, 12, kSize}).set<el::scissor_enabled>(1);
    clear(scissored, {1, 0, 0, 1});
    scissored.set<el::scissor_enabled>(0);
    pack::TargetWhole(scissored.buffer(), kFramebuffer);
    session_->expect_run(scissored);
    EXPECT_EQ(at(11, 8), kRed);
    EXPECT_EQ(at(12, 8), kGreen) << "beyond the scissor";
    Batch whole;
    clear(whole, {0, 1, 0, 1});
    pack::TargetPart(whole.buffer(), kOther, 0, 0, 1, 1, 0, 0);  // which is not there
    session_->expect_run(whole);
    EXPECT_EQ(at(0, 0), kGreen);
    for (const std::int32_t x : {-1, std::numeric_limits<std::int32_t>::max()})
        EXPECT_THAT(refusal([x](wire::PackBuffer& b) { pack::TargetPart(b, kFramebuffer, x, 0, 1, 1, 0, 0); }),
                    HasSubstr("outside of it"));
    EXPECT_THAT(refusal([](wire::PackBuffer& b) { pack::TargetPart(b, kFramebuffer, 0, 0, ~0u, 1, 0, 0); }),
                HasSubstr("larger than any image"));
}

TEST_F(FramebufferTest, ImagesMayBeLargerForAWhile) {
    draw_texture();
    constexpr float kEnd = -1 + 2 * 1.4f / kSize;  // a pixel, and a little less than half of the next
    const auto part = [&](wire::PackBuffer& b) {
        pack::TargetPart(b, kFramebuffer, 0, 0, kSize, kSize, 2 * kSize, 2 * kSize);
    };
    Batch batch;
    batch.set<el::color>({0, 1, 0, 1});
    part(batch.buffer());
    draw_square(batch, kEnd);
    pack::TargetWhole(batch.buffer(), kFramebuffer);
    session_->expect_run(batch);
    EXPECT_EQ(at(0, 0), kGreen);
    EXPECT_EQ(at(3, 3), kRed) << "as it was before";
    const Pixel border = at(1, 0);
    EXPECT_GT(border[0], 0) << "half of it";
    EXPECT_GT(border[1], 0);
    EXPECT_EQ(texels(kTexture), std::size_t{4} * kSize * kSize) << "of the size that it was defined with";

    // A blit of it, and a window that looks it up, take it for what it was.
    Batch shown;
    part(shown.buffer());
    clear(shown, {0, 1, 0, 1});
    pack::BindTargets(shown.buffer(), {}, kFramebuffer, 1);
    shown.block(
        1, [](auto& b) { pack::Blit(b, 0, 0, kSize, kSize, 0, 0, kSize, kSize, GL_COLOR_BUFFER_BIT, GL_NEAREST); });
    session_->expect_run(shown);
    EXPECT_EQ(at(0, 0), kGreen);
    EXPECT_EQ(at(kSize - 1, kSize - 1), kGreen);
    Batch sampled;
    pack::BindTargets(sampled.buffer(), {}, {}, 1);
    clear(sampled, {0, 0, 0, 1});
    sampled.set<el::color>({1, 1, 1, 1}).set<el::texture_binding_2d>(kTexture.value).set<el::texture_2d_enabled>(1);
    draw_square(sampled, 1);
    session_->expect_run(sampled);
    EXPECT_EQ(at(kSize - 1, kSize - 1), kGreen);
}

TEST_F(FramebufferTest, ImagesThatCannotBeLargerStayAsTheyAre) {
    Batch batch;
    pack::Renderbuffer(batch.buffer(), kColor, 4, GL_RGBA8, kSize, kSize);
    define_texture(batch.buffer(), kTexture);
    glstate::FramebufferDefinition definition;
    definition.attachments = {{GL_COLOR_ATTACHMENT0, kColor, GL_RENDERBUFFER, 0, 0}};
    pack::Framebuffer(batch.buffer(), kFramebuffer, encode(definition));
    define_framebuffer(batch.buffer(), kOther, kTexture);
    for (const std::uint32_t side : {2u * kSize, ~0u}) {
        pack::TargetPart(batch.buffer(), kFramebuffer, 0, 0, kSize, kSize, side, side);  // of four samples a pixel
        pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
        clear(batch, {1, 0, 0, 1});
        pack::BindTargets(batch.buffer(), kOther, kFramebuffer, 1);
        batch.block(
            1, [](auto& b) { pack::Blit(b, 0, 0, kSize, kSize, 0, 0, kSize, kSize, GL_COLOR_BUFFER_BIT, GL_NEAREST); });
        pack::TargetWhole(batch.buffer(), kFramebuffer);
    }
    pack::BindTargets(batch.buffer(), kOther, kOther, 1);
    session_->expect_run(batch);
    EXPECT_EQ(at(kSize - 1, kSize - 1), kRed);
}

TEST_F(FramebufferTest, TheWindowIsLeftAlone) {
    Batch window;
    clear(window, {0, 1, 0, 1});
    session_->expect_run(window);
    draw_texture();
    Batch back;
    pack::BindTargets(back.buffer(), {}, {}, 1);
    session_->expect_run(back);
    EXPECT_EQ(at(3, 3), kGreen);
}

TEST_F(FramebufferTest, ScissorAndViewportAreItsOwnPixels) {
    draw_texture();
    Batch batch;
    batch.set<el::scissor>({4, 5, 2, 3}).set<el::scissor_enabled>(1);
    clear(batch, {0, 1, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(at(3, 5), kRed);
    EXPECT_EQ(at(4, 5), kGreen);
    EXPECT_EQ(at(5, 7), kGreen);
    EXPECT_EQ(at(5, 8), kRed);
}

TEST_F(FramebufferTest, AnImageThatIsDefinedAnewIsDrawnToAsItIsNow) {
    draw_texture();
    Batch batch;
    define_texture(batch.buffer(), kTexture, 2 * kSize);
    clear(batch, {0, 1, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(at(2 * kSize - 1, 2 * kSize - 1), kGreen);
}

TEST_F(FramebufferTest, WithoutAnImageNothingIsDrawn) {
    draw_texture();
    Batch batch;
    pack::ObjectDelete(batch.buffer(), kTexture);
    clear(batch, {0, 1, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(at(3, 3), Pixel{}) << "an answer without pixels";
}

TEST_F(FramebufferTest, ItMayBeDeletedWhileItIsBound) {
    draw_texture();
    Batch batch;
    pack::ObjectDelete(batch.buffer(), kFramebuffer);
    clear(batch, {0, 1, 0, 1});
    pack::BindTargets(batch.buffer(), {}, {}, 1);
    clear(batch, {0, 1, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(at(3, 3), kGreen);
}

TEST_F(FramebufferTest, ARenderbufferStartsEmptyAndIsBlitted) {
    Batch batch;
    pack::Renderbuffer(batch.buffer(), kColor, 0, GL_RGBA8, kSize, kSize);
    define_framebuffer(batch.buffer(), kFramebuffer, kColor, GL_RENDERBUFFER);
    pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
    session_->expect_run(batch);
    EXPECT_EQ(at(3, 3), Pixel{});
    Batch blit;
    clear(blit, {1, 0, 0, 1});
    pack::BindTargets(blit.buffer(), {}, kFramebuffer, 1);
    clear(blit, {0, 1, 0, 1});
    blit.block(1, [](auto& b) { pack::Blit(b, 0, 0, 8, 8, 10, 12, 18, 20, GL_COLOR_BUFFER_BIT, GL_NEAREST); });
    pack::BindTargets(blit.buffer(), {}, {}, 1);
    session_->expect_run(blit);
    EXPECT_EQ(at(9, 12), kGreen);
    EXPECT_EQ(at(10, 12), kRed);
    EXPECT_EQ(at(17, 19), kRed);
    EXPECT_EQ(at(18, 20), kGreen);
}

TEST_F(FramebufferTest, AWindowIsBlittedIntoItWhereOneLayerHasAllOfIt) {
    constexpr Pixel kBlue{0, 0, 255, 255};
    struct Case {
        std::int32_t x;
        std::uint32_t kind;
        Pixel expected;
    };
    std::uint32_t version = 10;
    for (const Case& each : {Case{0, wire::kTilesOnly, kRed},
                             {-8, wire::kTilesOnly, kBlue},
                             {-8, wire::kShownWholeWindow, kRed},
                             {0, wire::kOnlyWholeWindow, kRed}}) {
        const std::uint32_t slot = each.kind == wire::kTilesOnly ? 0 : wire::kOffscreenSlot;
        draw_texture();
        Batch batch;
        clear(batch, {0, 0, 1, 1});
        pack::BindTargets(batch.buffer(), {}, {}, 1);
        pack::SurfacePlace(batch.buffer(), SurfaceId(1), ++version, kSize, kSize, each.x, 0, kSize, kSize, each.kind);
        batch.set<el::clear_color>({1, 0, 0, 1});
        batch.block(std::uint64_t{1} << slot, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        pack::BindTargets(batch.buffer(), kFramebuffer, {}, 1);
        batch.block(1, [](auto& b) { pack::Blit(b, 4, 4, 12, 12, 10, 12, 18, 20, GL_COLOR_BUFFER_BIT, GL_NEAREST); });
        pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
        session_->expect_run(batch);
        EXPECT_EQ(at(10, 12), each.expected) << each.kind << " at " << each.x;
        EXPECT_EQ(at(17, 19), each.expected);
        EXPECT_EQ(at(9, 12), kBlue);
        EXPECT_EQ(at(18, 20), kBlue);
    }
}

TEST_F(FramebufferTest, SamplesOfItAreCountedOnOneNodeOnly) {
    draw_texture();
    for (const std::uint32_t counts : {1u, 0u}) {
        const ClientName query(90 + counts);
        Batch batch;
        pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, counts);
        batch.set<el::occlusion_query>(query.value);
        batch.block(1, [](auto& b) {
            pack::Begin(b, GL_POINTS);
            pack::Vertex2f(b, 0, 0);
            pack::End(b);
        });
        batch.set<el::occlusion_query>(0);
        pack::QueryResult(batch.buffer(), RequestId(6), query);
        session_->expect_run(batch);
        std::uint64_t samples = 99;
        const auto& answer = session_->replies[RequestId(6)];
        ASSERT_EQ(answer.size(), sizeof samples);
        std::memcpy(&samples, answer.data(), sizeof samples);
        EXPECT_EQ(samples, counts);
    }
}

TEST_F(FramebufferTest, TexelsThatWereDrawnCanBeAskedFor) {
    draw_texture();
    EXPECT_EQ(texels(kTexture), std::size_t{4} * kSize * kSize);
    const auto& answer = session_->replies[RequestId(5)];
    EXPECT_EQ(std::memcmp(answer.data(), kRed.data(), 4), 0);
    EXPECT_EQ(texels(kOther), 0u) << "no such texture";
}

TEST_F(FramebufferTest, MipmapsAreMadeOfWhatWasDrawn) {
    draw_texture();
    Batch batch;
    pack::TexMipmaps(batch.buffer(), kTexture, GL_TEXTURE_2D, 0, 1000);
    pack::TexRead(batch.buffer(), RequestId(5), kTexture, GL_TEXTURE_2D, 3, 0, 0, 4, GL_RGBA, GL_UNSIGNED_BYTE);
    session_->expect_run(batch);
    const auto& answer = session_->replies[RequestId(5)];
    ASSERT_EQ(answer.size(), std::size_t{4} * 4 * 4);
    EXPECT_EQ(std::memcmp(answer.data(), kRed.data(), 4), 0);
}

TEST_F(FramebufferTest, ThereAreNoMipmapsBehindALevelThatIsNotThere) {
    draw_texture();
    for (const int base : {5, 14, 15, 32, 1'000'000}) {
        Batch batch;
        pack::TexMipmaps(batch.buffer(), kTexture, GL_TEXTURE_2D, base, 1000);
        pack::TexRead(batch.buffer(), RequestId(5), kTexture, GL_TEXTURE_2D, 1, 0, 0, 4, GL_RGBA, GL_UNSIGNED_BYTE);
        session_->expect_run(batch);
        EXPECT_TRUE(session_->replies[RequestId(5)].empty()) << base;
    }
}

TEST_F(FramebufferTest, RefusesWhatAClientCannotSend) {
    EXPECT_THAT(refusal([](auto& b) { pack::Framebuffer(b, kFramebuffer, std::vector<std::byte>(7)); }),
                HasSubstr("no definition of a framebuffer"));
    EXPECT_THAT(refusal([](auto& b) { pack::Renderbuffer(b, kColor, 0, GL_RGBA8, 1 << 20, 4); }),
                HasSubstr("absurd size"));
    EXPECT_THAT(refusal([](auto& b) { pack::Renderbuffer(b, kColor, 1000, GL_RGBA8, 4, 4); }),
                HasSubstr("absurd size"));
    EXPECT_THAT(refusal([](auto& b) { pack::TexMipmaps(b, kOther, GL_TEXTURE_2D, 0, 1000); }),
                HasSubstr("no such texture"));
    EXPECT_THAT(refusal([](auto& b) {
                    pack::TexRead(b, RequestId(5), kTexture, GL_TEXTURE_2D, 0, -1, 0, 1, GL_RGBA, GL_FLOAT);
                }),
                HasSubstr("no such part"));
    EXPECT_THAT(refusal([](auto& b) {
                    define_framebuffer(b, kFramebuffer, kTexture);
                    define_framebuffer(b, kOther, kFramebuffer);
                    pack::BindTargets(b, kOther, kOther, 1);
                    Batch draw;
                    clear(draw, {});
                    b.append(draw.buffer(), {}, draw.buffer().mark());
                }),
                HasSubstr("framebuffer"))
        << "a framebuffer as an image";
}

// Of an incomplete cube map the driver gives no part, but all of a face.
TEST_F(FramebufferTest, AFaceIsReadWhereTheOthersAreMissing) {
    Batch batch;
    pack::TexImage(batch.buffer(), kTexture, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, 0, GL_RGBA8, 8, 8, 1, 0, GL_RGBA,
                   GL_UNSIGNED_BYTE, {});
    define_framebuffer(batch.buffer(), kFramebuffer, kTexture, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y);
    pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
    batch.set<el::scissor>({0, 0, 8, 4}).set<el::scissor_enabled>(1);
    clear(batch, {1, 0, 0, 1});
    pack::TexRead(batch.buffer(), RequestId(5), kTexture, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, 0, 0, 3, 2, GL_RGBA,
                  GL_UNSIGNED_BYTE);
    session_->expect_run(batch);
    const auto& answer = session_->replies[RequestId(5)];
    ASSERT_EQ(answer.size(), std::size_t{4} * 8 * 2);
    EXPECT_EQ(std::memcmp(answer.data(), kRed.data(), 4), 0);
    EXPECT_EQ(std::memcmp(answer.data() + 4 * 8, Pixel{}.data(), 4), 0);
}

// Mesa 22.3 forgets what fixed function samples when it looks at a framebuffer without colours that nothing is drawn
// to: a read is enough, also of another program's.
TEST_F(FramebufferTest, WhatFixedFunctionSamplesIsKeptWhileDepthIsRead) {
    const std::vector<Pixel> texels(std::size_t{kSize} * kSize, kGreen);
    Batch textured;
    auto& t = textured.buffer();
    pack::TexImage(t, kTexture, GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   std::as_bytes(std::span(texels)));
    pack::TexParameter(t, kTexture, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST, 0, 0, 0);
    textured.set<el::texture_2d_enabled>(1).set<el::texture_binding_2d>(kTexture.value);
    textured.set<el::tex_env_mode>(GL_REPLACE);
    session_->expect_run(textured);

    TestSession other(*node_.node, SessionId(2));
    other.open_surface(kSize, kSize, kWindow);
    Batch depth;
    pack::Renderbuffer(depth.buffer(), kColor, 0, GL_DEPTH_COMPONENT24, kSize, kSize);
    glstate::FramebufferDefinition definition;
    definition.draw_buffers = {GL_NONE};
    definition.read_buffer = GL_NONE;
    definition.attachments = {{GL_DEPTH_ATTACHMENT, kColor, GL_RENDERBUFFER, 0, 0}};
    pack::Framebuffer(depth.buffer(), kFramebuffer, encode(definition));
    other.expect_run(depth);

    for (int i = 0; i < 3; ++i) {
        Batch draw;
        clear(draw, {1, 0, 0, 1});
        draw_square(draw, 1);
        session_->expect_run(draw);
        EXPECT_EQ(at(3, 5), kGreen) << "time " << i;
        Batch read;
        pack::BindTargets(read.buffer(), kFramebuffer, kFramebuffer, 1);
        pack::ReadPixels(read.buffer(), RequestId(6), 0, 0, 0, kSize, kSize, GL_DEPTH_COMPONENT, GL_FLOAT);
        other.expect_run(read);
        EXPECT_EQ(other.replies[RequestId(6)].size(), sizeof(float) * kSize * kSize);
    }
}

// The driver refuses it; the renderbuffer is empty, and nothing else happens.
TEST_F(FramebufferTest, AFormatThatTheDriverDoesNotKnowIsAnEmptyImage) {
    Batch batch;
    pack::Renderbuffer(batch.buffer(), kColor, 0, GL_BACK, kSize, kSize);
    define_framebuffer(batch.buffer(), kFramebuffer, kColor, GL_RENDERBUFFER);
    pack::BindTargets(batch.buffer(), kFramebuffer, kFramebuffer, 1);
    clear(batch, {1, 0, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(at(3, 3), Pixel{});
}

}  // namespace
}  // namespace wall::tileserver::test
