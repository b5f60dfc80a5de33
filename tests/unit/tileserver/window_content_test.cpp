// SPDX-License-Identifier: MIT
// What a window held, read from the tiles of one node and given to those of another, which lie otherwise.
#include <gmock/gmock.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

constexpr int kColumns = 90, kRows = 70;
constexpr SurfaceId kWindowId{1};
constexpr RequestId kAnswer(7);
using Words = std::vector<std::uint32_t>;

struct WindowKind {
    std::uint32_t double_buffered = 1, stencil_bits = 8, samples = 0;
};

class ContentOfAWindow : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
    }
    void open(const std::vector<Tile>& tiles, const WindowKind& kind = {}, int scale = 1) {
        node_.node->tiles = tiles;
        session_.emplace(*node_.node, SessionId(1));
        Batch batch;
        pack::SurfaceCreate(batch.buffer(), kWindowId, kind.double_buffered, 8, 24, kind.stencil_bits, 0, kind.samples,
                            0, 0);
        pack::SurfacePlace(batch.buffer(), kWindowId, 1, kColumns, kRows, 0, 0,
                           static_cast<std::uint32_t>(kColumns * scale), static_cast<std::uint32_t>(kRows * scale), 0);
        pack::Bind(batch.buffer(), kWindowId, kWindowId);
        session_->expect_run(batch);
    }
    /// A part of the window, as the layer of one tile has it.
    Words read(std::uint32_t slot, const geom::Rect& area, GLenum format, GLenum type) {
        Batch batch;
        pack::ReadPixels(batch.buffer(), kAnswer, slot, area.x, area.y, area.width, area.height, format, type);
        session_->expect_run(batch);
        const auto& bytes = session_->replies[kAnswer];
        Words words(bytes.size() / sizeof(std::uint32_t));
        std::memcpy(words.data(), bytes.data(), bytes.size());
        return words;
    }
    void give(std::uint64_t slots, const geom::Rect& area, GLenum format, GLenum type, const Words& words) {
        Batch batch;
        batch.block(slots, [&](auto& b) {
            pack::WindowContent(b, area.x, area.y, area.width, area.height, format, type,
                                std::as_bytes(std::span(words)));
        });
        session_->expect_run(batch);
    }
    std::string refusal(const geom::Rect& area, GLenum format, GLenum type, std::size_t words) {
        Batch batch;
        const Words pixels(words);
        batch.block(1, [&](auto& b) {
            pack::WindowContent(b, area.x, area.y, area.width, area.height, format, type,
                                std::as_bytes(std::span(pixels)));
        });
        const auto done = session_->run(batch);
        return done ? "" : done.error().message;
    }
    /// Values of all bits.
    static Words any_values() {
        Words words(std::size_t{kColumns} * kRows);
        std::uint32_t value = 1;
        for (auto& word : words) word = value = value * 1664525 + 1013904223;
        return words;
    }
    static Words part_of(const Words& whole, const geom::Rect& part) {
        Words out;
        for (int row = part.y; row < part.y + part.height; ++row)
            for (int column = part.x; column < part.x + part.width; ++column)
                out.push_back(whole[static_cast<std::size_t>(row * kColumns + column)]);
        return out;
    }

    static constexpr geom::Rect kAll{0, 0, kColumns, kRows};
    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(ContentOfAWindow, IsTheSameToTheLastBit) {
    const Words colors = any_values(), depths = any_values();
    for (const WindowKind& kind : {WindowKind{}, {.double_buffered = 0}}) {
        open({{0, {0, 0, 40, kRows}}, {1, {40, 20, 50, 50}}}, kind);
        give(3, kAll, GL_RGBA, GL_UNSIGNED_BYTE, colors);
        give(3, kAll, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, depths);
        for (const auto& [slot, part] : {std::pair{0u, geom::Rect{0, 0, 40, kRows}}, {1u, {40, 0, 50, 50}}}) {
            EXPECT_EQ(read(slot, part, GL_RGBA, GL_UNSIGNED_BYTE), part_of(colors, part)) << slot;
            EXPECT_EQ(read(slot, part, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8), part_of(depths, part)) << slot;
        }
    }
}

TEST_F(ContentOfAWindow, MayBeOfDepthsAlone) {
    open({{0, kAll}}, {.stencil_bits = 0});
    give(1, kAll, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, any_values());
    const Words first = read(0, kAll, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    const Words values = any_values();
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(first[i] >> 8, values[i] >> 8) << i;
    open({{0, kAll}}, {.stencil_bits = 0});
    give(1, kAll, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, first);
    EXPECT_EQ(read(0, kAll, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT), first) << "what was read, read again";
}

TEST_F(ContentOfAWindow, IsScaledWithTheWindowAndFillsAllSamples) {
    const Words colors = any_values();
    const auto worst = [](const Words& a, const Words& b) {
        int out = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            for (unsigned shift = 0; shift < 32; shift += 8)
                out = std::max(
                    out, std::abs(static_cast<int>(a[i] >> shift & 0xff) - static_cast<int>(b[i] >> shift & 0xff)));
        return out;
    };
    open({{0, {0, 0, 2 * kColumns, 2 * kRows}}}, {}, 2);
    give(1, kAll, GL_RGBA, GL_UNSIGNED_BYTE, colors);
    EXPECT_LE(worst(read(0, kAll, GL_RGBA, GL_UNSIGNED_BYTE), colors), 1);
    open({{0, kAll}}, {.samples = 4});
    give(1, kAll, GL_RGBA, GL_UNSIGNED_BYTE, colors);
    EXPECT_LE(worst(read(0, kAll, GL_RGBA, GL_UNSIGNED_BYTE), colors), 1);
}

TEST_F(ContentOfAWindow, IsRefusedIfNoWindowHasSuch) {
    open({{0, kAll}});
    constexpr std::size_t kWords = std::size_t{kColumns} * kRows;
    EXPECT_EQ(refusal(kAll, GL_RGBA, GL_UNSIGNED_BYTE, kWords), "");
    EXPECT_EQ(refusal({kColumns, kRows, 5, 5}, GL_RGBA, GL_UNSIGNED_BYTE, 25), "") << "it lies on no tile";
    EXPECT_THAT(refusal(kAll, GL_RGBA, GL_FLOAT, 4 * kWords), ::testing::HasSubstr("no content"));
    EXPECT_THAT(refusal({-1, 0, kColumns, kRows}, GL_RGBA, GL_UNSIGNED_BYTE, kWords),
                ::testing::HasSubstr("no content"));
    EXPECT_THAT(refusal({0, 0, 0, kRows}, GL_RGBA, GL_UNSIGNED_BYTE, 0), ::testing::HasSubstr("no content"));
    EXPECT_NE(refusal(kAll, GL_RGBA, GL_UNSIGNED_BYTE, kWords - 1), "");
}

}  // namespace
}  // namespace wall::tileserver::test
