// SPDX-License-Identifier: MIT
// Windows that are drawn to by the curve of sRGB while GL_FRAMEBUFFER_SRGB is on (OpenGL 4.6, 17.3.7).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr SurfaceId kSurface{1};

std::uint8_t encoded(float linear) {
    return static_cast<std::uint8_t>(std::lround(255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055)));
}
std::uint8_t plain(float value) { return static_cast<std::uint8_t>(std::lround(255 * value)); }

struct Kind {
    std::uint32_t alpha = 0, samples = 0;
    bool double_buffered = true;
};

class AnSrgbWindow : public ::testing::TestWithParam<Kind> {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, {0, 0, kWidth, kHeight}}};
        session_.emplace(*node_.node, SessionId(1));
    }
    GLenum buffer() const { return GetParam().double_buffered ? GL_BACK : GL_FRONT; }
    void open(bool srgb) {
        Batch batch;
        pack::SurfaceCreate(batch.buffer(), kSurface, GetParam().double_buffered, GetParam().alpha, 24, 8, 0,
                            GetParam().samples, srgb, 0);
        place(batch, 0);
        pack::Bind(batch.buffer(), kSurface, kSurface);
        batch.set<el::viewport>({0, 0, kWidth, kHeight}).set<el::scissor>({0, 0, kWidth, kHeight});
        batch.set<el::draw_buffer>(buffer()).set<el::read_buffer>(buffer());
        session_->expect_run(batch);
    }
    void place(Batch& batch, std::int32_t x) {
        pack::SurfacePlace(batch.buffer(), kSurface, ++version_, kWidth, kHeight, x, 0, kWidth, kHeight, 0);
    }
    void clear(bool encode) {
        Batch batch;
        batch.set<el::framebuffer_srgb>(encode).set<el::clear_color>({0.5f, 0.25f, 0.1f, 0.5f});
        batch.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        session_->expect_run(batch);
    }
    void swap() {
        Batch batch;
        pack::Swap(batch.buffer(), kSurface, ++frame_);
        session_->expect_run(batch);
        session_->executor.present(kSurface, frame_);
    }
    Pixels read() {
        auto pixels = session_->read(0, {5, 7, 1, 1});
        pixels.resize(3);
        return pixels;
    }
    Pixels shown() {
        const Layer* layer = session_->session.surface(kSurface)->shown_layer({});
        Pixels pixels(std::size_t{4} * kWidth * kHeight);
        node_.driver->neutral_pixel_transfer();
        layer->read_texture(layer->front(), {0, 0, kWidth, kHeight}, pixels);
        pixels.resize(3);
        return pixels;
    }

    TestNode node_;
    std::optional<TestSession> session_;
    std::uint32_t version_ = 0, frame_ = 0;
};

const Pixels kEncoded{encoded(0.5f), encoded(0.25f), encoded(0.1f)}, kPlain{plain(0.5f), plain(0.25f), plain(0.1f)};

TEST_P(AnSrgbWindow, IsDrawnToByTheCurveWhileItIsOn) {
    open(true);
    for (const bool on : {false, true, false, true}) {
        clear(on);
        EXPECT_EQ(read(), on ? kEncoded : kPlain);
        if (GetParam().double_buffered) swap();
        EXPECT_EQ(shown(), on ? kEncoded : kPlain) << "on the wall, whatever is on meanwhile";
    }
}

TEST_P(AnSrgbWindow, BlendsLight) {
    open(true);
    clear(true);
    Batch batch;
    batch.set<el::blend_enabled>(1).set<el::blend_func>({GL_ONE, GL_ONE, GL_ONE, GL_ONE});
    batch.block(1, [](auto& b) {
        pack::Begin(b, GL_QUADS);
        pack::Color3f(b, 0.25f, 0.25f, 0.25f);
        for (const auto& [x, y] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
            pack::Vertex3f(b, x, y, 0);
        pack::End(b);
    });
    session_->expect_run(batch);
    const auto drawn = read();
    const Pixels expected{encoded(0.75f), encoded(0.5f), encoded(0.35f)};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(drawn[i], expected[i], 1) << i;  // rounded twice
}

TEST_P(AnSrgbWindow, StaysAsItIsWhenItIsMoved) {
    open(true);
    clear(true);
    if (GetParam().double_buffered) swap();
    clear(true);
    Batch batch;
    place(batch, -10);
    session_->expect_run(batch);
    EXPECT_EQ(session_->read(0, {20, 7, 1, 1})[0], kEncoded[0]);
    clear(false);
    EXPECT_EQ(session_->read(0, {20, 7, 1, 1})[0], kPlain[0]);
}

TEST_P(AnSrgbWindow, IsOneOnlyWhereItWasMadeSo) {
    open(false);
    clear(true);
    EXPECT_EQ(read(), kPlain);
}

TEST_P(AnSrgbWindow, LeavesNothingBehind) {
    const DriverObjects before = *node_.driver->gl().objects;
    open(true);
    clear(true);
    if (GetParam().double_buffered) swap();
    clear(false);
    session_.reset();
    EXPECT_EQ(*node_.driver->gl().objects, before);
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, AnSrgbWindow,
                         testing::Values(Kind{}, Kind{8, 0, true}, Kind{8, 0, false}, Kind{0, 4, true},
                                         Kind{8, 4, false}));

}  // namespace
}  // namespace wall::tileserver::test
