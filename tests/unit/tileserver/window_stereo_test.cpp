// SPDX-License-Identifier: MIT
// Windows with buffers for two eyes (OpenGL 4.6, 17.4.1): a layer for each on every tile.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

using geom::Eye;

constexpr int kWidth = 64, kHeight = 48;
constexpr SurfaceId kSurface{1};
const Pixels kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255}, kBlack{0, 0, 0};

/// Halves of the window on a tile for both eyes; over the left one lie tiles for one each.
class AStereoWindow : public ::testing::TestWithParam<std::uint32_t> {
protected:
    static constexpr std::uint64_t kAll = 0b1111;

    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        const geom::Rect left{0, 0, kWidth / 2, kHeight}, right{kWidth / 2, 0, kWidth / 2, kHeight};
        node_.node->tiles = {{.slot = 0, .rect = left},
                             {.slot = 1, .rect = right},
                             {.slot = 2, .rect = left, .eye = Eye::left},
                             {.slot = 3, .rect = left, .eye = Eye::right}};
        session_.emplace(*node_.node, SessionId(1));
        Batch batch;
        pack::SurfaceCreate(batch.buffer(), kSurface, 1, 0, 24, 8, GetParam() == 0 ? 16 : 0, GetParam(), 1, 1);
        pack::SurfacePlace(batch.buffer(), kSurface, 1, kWidth, kHeight, 0, 0, kWidth, kHeight, 0);
        pack::Bind(batch.buffer(), kSurface, kSurface);
        batch.set<el::viewport>({0, 0, kWidth, kHeight}).set<el::scissor>({0, 0, kWidth, kHeight});
        batch.set<el::read_buffer>(GL_BACK);
        session_->expect_run(batch);
    }
    void clear(GLenum buffer, const Pixels& color, GLbitfield mask = GL_COLOR_BUFFER_BIT) {
        Batch batch;
        const auto part = [&](std::size_t i) { return static_cast<float>(color[i]) / 255.0f; };
        batch.set<el::draw_buffer>(buffer).set<el::clear_color>({part(0), part(1), part(2), 1});
        batch.block(kAll, [&](auto& b) { pack::Clear(b, mask); });
        session_->expect_run(batch);
    }
    /// The whole window, at a depth of -1 (near) to 1.
    void draw(GLenum buffer, const Pixels& color, float depth, std::uint64_t tiles = kAll) {
        Batch batch;
        batch.set<el::draw_buffer>(buffer).set<el::depth_test>(1);
        batch.block(tiles, [&](auto& b) {
            pack::Begin(b, GL_QUADS);
            pack::Color3f(b, color[0] / 255.0f, color[1] / 255.0f, color[2] / 255.0f);
            for (const auto& [x, y] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
                pack::Vertex3f(b, x, y, depth);
            pack::End(b);
        });
        session_->expect_run(batch);
    }
    void swap() {
        Batch batch;
        pack::Swap(batch.buffer(), kSurface, ++frame_);
        session_->expect_run(batch);
        session_->executor.present(kSurface, frame_);
    }
    Pixels read(GLenum buffer, std::uint32_t slot = 0) {
        Batch batch;
        batch.set<el::read_buffer>(buffer);
        session_->expect_run(batch);
        auto pixels = session_->read(slot, {slot == 1 ? 40 : 5, 7, 1, 1});
        pixels.resize(3);
        return pixels;
    }
    Pixels shown(std::size_t tile) {
        const Layer* layer = session_->session.surface(kSurface)->shown_layer(node_.node->tiles[tile]);
        Pixels pixels(std::size_t{4} * static_cast<std::size_t>(layer->width()) * kHeight);
        node_.driver->neutral_pixel_transfer();
        layer->read_texture(layer->front(), {0, 0, layer->width(), kHeight}, pixels);
        pixels.resize(3);
        return pixels;
    }

    TestNode node_;
    std::optional<TestSession> session_;
    std::uint32_t frame_ = 0;
};

TEST_P(AStereoWindow, ShowsEachEyeOnTilesForThatAndTheLeftOneOnOthers) {
    clear(GL_BACK_LEFT, kRed);
    clear(GL_BACK_RIGHT, kGreen);
    EXPECT_EQ(shown(0), kBlack) << "not yet";
    swap();
    EXPECT_EQ(shown(0), kRed);
    EXPECT_EQ(shown(1), kRed);
    EXPECT_EQ(shown(2), kRed);
    EXPECT_EQ(shown(3), kGreen);
}

TEST_P(AStereoWindow, HasWordsForBuffersOfBothEyes) {
    clear(GL_BACK, kBlue);
    clear(GL_FRONT_LEFT, kRed);
    EXPECT_EQ(shown(2), kRed) << "at once";
    EXPECT_EQ(shown(3), kBlack);
    clear(GL_FRONT, kGreen);
    EXPECT_EQ(shown(2), kGreen);
    EXPECT_EQ(shown(3), kGreen);
    clear(GL_RIGHT, kRed);
    EXPECT_EQ(shown(2), kGreen);
    EXPECT_EQ(shown(3), kRed);
    EXPECT_EQ(read(GL_BACK_RIGHT), kRed);
    EXPECT_EQ(read(GL_BACK_LEFT), kBlue);
    clear(GL_FRONT_AND_BACK, kBlack);
    for (const GLenum buffer : {GL_FRONT_LEFT, GL_FRONT_RIGHT, GL_BACK_LEFT, GL_BACK_RIGHT})
        EXPECT_EQ(read(buffer), kBlack) << buffer;
}

TEST_P(AStereoWindow, IsReadByEyeWhereverItLies) {
    clear(GL_BACK_LEFT, kRed);
    clear(GL_BACK_RIGHT, kGreen);
    for (const std::uint32_t slot : {0u, 1u, 2u, 3u}) {
        SCOPED_TRACE(slot);
        EXPECT_EQ(read(GL_BACK, slot), kRed) << "the left one (OpenGL 4.6, 18.2.1)";
        EXPECT_EQ(read(GL_BACK_LEFT, slot), kRed);
        EXPECT_EQ(read(GL_BACK_RIGHT, slot), kGreen);
    }
}

TEST_P(AStereoWindow, AccumulatesWhatIsReadWhicheverEyeItIsDrawnTo) {
    if (GetParam() != 0) GTEST_SKIP() << "a window with samples has no accumulation buffer";
    for (const GLenum from : {GL_BACK, GL_BACK_LEFT, GL_BACK_RIGHT}) {
        clear(GL_BACK_LEFT, kRed);
        clear(GL_BACK_RIGHT, kGreen);
        for (const auto& [op, to] : {std::pair{GL_LOAD, GL_BACK_LEFT}, {GL_RETURN, GL_BACK_RIGHT}}) {
            Batch batch;
            batch.set<el::read_buffer>(from).set<el::draw_buffer>(to);
            batch.block(kAll, [op = op](auto& b) { pack::Accum(b, op, 1); });
            session_->expect_run(batch);
        }
        EXPECT_EQ(read(GL_BACK_RIGHT), from == GL_BACK_RIGHT ? kGreen : kRed) << from;
        EXPECT_EQ(read(GL_BACK_LEFT), kRed);
    }
}

TEST_P(AStereoWindow, HasOneDepthBuffer) {
    clear(GL_BACK, kBlack, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw(GL_BACK_LEFT, kRed, -0.5f);
    draw(GL_BACK_RIGHT, kGreen, 0.5f);
    EXPECT_EQ(read(GL_BACK_LEFT), kRed);
    EXPECT_EQ(read(GL_BACK_RIGHT), kBlack) << "what the left eye sees is before it";
    clear(GL_BACK_RIGHT, kBlue, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw(GL_BACK_RIGHT, kGreen, 0.5f);
    EXPECT_EQ(read(GL_BACK_RIGHT), kGreen);
    EXPECT_EQ(read(GL_BACK_LEFT), kRed);
}

TEST_P(AStereoWindow, KeepsBothPicturesWhenItIsMoved) {
    clear(GL_BACK_LEFT, kRed);
    clear(GL_BACK_RIGHT, kGreen);
    swap();
    clear(GL_BACK_LEFT, kBlue);
    Batch batch;
    pack::SurfacePlace(batch.buffer(), kSurface, 2, kWidth, kHeight, 4, 0, kWidth, kHeight, 0);
    session_->expect_run(batch);
    EXPECT_EQ(shown(3), kGreen);
    EXPECT_EQ(read(GL_BACK_LEFT), kBlue);
    swap();
    EXPECT_EQ(read(GL_FRONT_LEFT), kBlue);
}

TEST_P(AStereoWindow, CountsSamplesOnce) {
    ClientName query(7);
    for (const GLenum buffer : {GL_BACK, GL_BACK_LEFT, GL_BACK_RIGHT}) {
        clear(buffer, kBlack, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        Batch begin;
        begin.set<el::occlusion_query>(query.value);
        session_->expect_run(begin);
        draw(buffer, kRed, 0, 0b11);
        Batch ask;
        ask.set<el::occlusion_query>(0);
        pack::QueryResult(ask.buffer(), RequestId(9), query);
        session_->expect_run(ask);
        std::uint64_t counted = 0;
        ASSERT_EQ(session_->replies.at(RequestId(9)).size(), sizeof counted);
        std::memcpy(&counted, session_->replies.at(RequestId(9)).data(), sizeof counted);
        EXPECT_EQ(counted, std::uint64_t{kWidth} * kHeight * std::max(GetParam(), 1u)) << buffer;
        query = ClientName(query.value + 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Samples, AStereoWindow, ::testing::Values(0u, 4u));

}  // namespace
}  // namespace wall::tileserver::test
