// SPDX-License-Identifier: MIT
#include "tileserver/render/compositor.h"

#include <gtest/gtest.h>

#include <chrono>

#include "common/wire/whole_window.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kSlot = 3;
constexpr geom::Rect kTile{100, 0, 8, 4};

class TilePictures : public ::testing::Test {
protected:
    void SetUp() override {
        if (!test_node.usable()) GTEST_SKIP() << "no EGL here";
        test_node.node->tiles = {{kSlot, kTile}};
        compositor.emplace(*test_node.node, [](const StackEntry&) { return nullptr; });
        compositor->set_background(0xff8000);
    }
    void TearDown() override { compositor.reset(); }

    /// First pixel of a screenshot.
    std::uint32_t shot(bool output = false) {
        compositor->request({.slot = kSlot, .output = output});
        const auto pictures = compositor->collect(true);
        EXPECT_EQ(pictures.size(), 1u);
        if (pictures.empty() || pictures[0].rgba.empty()) return 0;
        const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(pictures[0].rgba[i]); };
        return byte(0) << 16 | byte(1) << 8 | byte(2);
    }

    test::TestNode test_node;
    std::optional<Compositor> compositor;
};

TEST_F(TilePictures, AreComposedOnceForAllWhoWantThem) {
    const auto picture = compositor->output(kSlot);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->width, kTile.width);
    EXPECT_EQ(picture->height, kTile.height);
    EXPECT_EQ(shot(), 0xff8000u);

    const auto& gl = test_node.driver->gl();
    constexpr float kOther[] = {0, 0, 1, 1};
    gl.ClearNamedFramebufferfv(picture->framebuffer, GL_COLOR, 0, kOther);
    EXPECT_EQ(compositor->output(kSlot)->framebuffer, picture->framebuffer);
    EXPECT_EQ(shot(), 0x0000ffu) << "nothing has changed, nothing is composed anew";
    ++test_node.node->damage;
    EXPECT_EQ(compositor->output(kSlot)->framebuffer, picture->framebuffer);
    EXPECT_EQ(shot(), 0xff8000u);
}

/// What is placed elsewhere stays where it is until the first frame drawn there is shown.
TEST_F(TilePictures, AreNoneOfAMoveBeforeItsFrame) {
    RenderNode& node = *test_node.node;
    node.present_at_once = true;
    test::TestSession session(node, SessionId(1));
    const auto swap = [&](std::uint32_t frame) {
        test::Batch batch;
        test::pack::Swap(batch.buffer(), SurfaceId(1), frame);
        session.expect_run(batch);
    };
    const auto move = [&](std::int32_t x, std::uint32_t offscreen = 0) {
        test::Batch batch;
        test::pack::SurfacePlace(batch.buffer(), SurfaceId(1), 2, 8, 4, x, 0, 8, 4, offscreen);
        session.expect_run(batch);
    };
    session.open_surface(8, 4, kTile);
    swap(1);
    const auto before = node.damage;
    move(102);
    EXPECT_EQ(node.damage, before);
    swap(2);
    EXPECT_GT(node.damage, before);
    const auto moved = node.damage;
    move(104, wire::kShownWholeWindow);
    EXPECT_GT(node.damage, moved) << "the layer of the whole window is seen at once where it is placed";
}

TEST_F(TilePictures, AreThoseOfBeforeWhereTheStackingIs) {
    const std::vector<StackEntry> stacking{{SessionId(1), SurfaceId(1)}, {SessionId(2), SurfaceId(1)}};
    const auto before = test_node.node->damage;
    compositor->set_stacking(stacking);
    const auto stacked = test_node.node->damage;
    EXPECT_GT(stacked, before);
    compositor->set_stacking(stacking);
    EXPECT_EQ(test_node.node->damage, stacked);
}

TEST_F(TilePictures, AreTestPicturesUntilTheyAreTakenAway) {
    const auto pattern = [](TestPattern::Kind kind, bool on_output) {
        return std::make_shared<const TestPattern>(TestPattern{.kind = kind, .on_output = on_output});
    };
    compositor->set_pattern(kSlot, pattern(TestPattern::Kind::white, false));
    EXPECT_EQ(shot(), 0xffffffu);
    const auto picture = compositor->output(kSlot);
    constexpr float kOther[] = {0, 0, 1, 1};
    test_node.driver->gl().ClearNamedFramebufferfv(picture->framebuffer, GL_COLOR, 0, kOther);
    ++test_node.node->damage;
    EXPECT_EQ(shot(), 0x0000ffu) << "what programs do behind it costs nothing";
    compositor->set_pattern(kSlot, pattern(TestPattern::Kind::black, true));
    EXPECT_EQ(shot(), 0xff8000u) << "it is not on the canvas";
    EXPECT_EQ(shot(true), 0u);
    compositor->set_pattern(kSlot, nullptr);
    EXPECT_EQ(shot(true), 0xff8000u);
    compositor->set_pattern(kSlot, pattern(TestPattern::Kind::white, false));
    compositor->tiles_changed();
    EXPECT_EQ(shot(), 0xff8000u);
}

TEST_F(TilePictures, AreWhatTheOutputShows) {
    geom::TileOutput output{.rotation = 90, .width = 2 * kTile.height, .height = 2 * kTile.width};
    output.color.emplace();
    output.color->curves.fill({1, 0});
    test_node.node->tiles = {{kSlot, kTile, std::make_shared<const geom::TileOutput>(output)}};
    const auto picture = compositor->output(kSlot);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->width, 2 * kTile.height);
    EXPECT_EQ(picture->height, 2 * kTile.width);
    EXPECT_EQ(shot(), 0xff8000u) << "the canvas";
    EXPECT_EQ(shot(true), 0x007fffu) << "inverted";
    compositor->request({.slot = kSlot, .crop = {2, 3, 4, 5}, .width = 2, .height = 2, .output = true});
    const auto part = compositor->collect(true);
    ASSERT_EQ(part.size(), 1u);
    EXPECT_EQ(part[0].width, 2u);
    EXPECT_EQ(std::to_integer<int>(part[0].rgba[2]), 0xff);
}

TEST_F(TilePictures, OfATileThatIsNotThereAreNone) { EXPECT_FALSE(compositor->output(kSlot + 1)); }

TEST_F(TilePictures, ThatAreManyArriveAFewAtATime) {
    for (std::uint32_t i = 0; i < 10; ++i) compositor->request({.id = PictureId(i), .slot = kSlot});
    std::uint32_t arrived = 0;
    for (const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
         arrived < 10 && std::chrono::steady_clock::now() < until;) {
        const auto pictures = compositor->collect(false);
        EXPECT_LE(pictures.size(), Compositor::kMostAtOnce);
        for (const auto& picture : pictures) {
            EXPECT_EQ(picture.request.id, PictureId(arrived++));
            EXPECT_TRUE(picture.hold) << "it counts until nobody has it any more";
        }
    }
    EXPECT_EQ(arrived, 10u);
    EXPECT_FALSE(compositor->busy());
}

}  // namespace
}  // namespace wall::tileserver
