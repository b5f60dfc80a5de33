// SPDX-License-Identifier: MIT
// Windows whose pixels have several samples, compared with plain Mesa's.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "common/wire/whole_window.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

constexpr int kWidth = 160, kHeight = 120, kSamples = 4;
constexpr geom::Rect kWindow{0, 0, kWidth, kHeight}, kLeft{0, 0, 67, kHeight}, kRight{67, 0, 93, kHeight};
constexpr GLbitfield kAll = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
constexpr SurfaceId kSurface{1};

class AWindowWithSamples : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kLeft}, {1, kRight}};
        session_.emplace(*node_.node, SessionId(1));
    }
    void place(Batch& batch, const geom::Rect& rect, std::uint32_t kind = wire::kTilesOnly) {
        pack::SurfacePlace(batch.buffer(), kSurface, ++version_, kWidth, kHeight, rect.x, rect.y,
                           static_cast<std::uint32_t>(rect.width), static_cast<std::uint32_t>(rect.height), kind);
    }
    void open(const geom::Rect& rect, bool double_buffered = true, std::uint32_t kind = wire::kTilesOnly) {
        Batch batch;
        pack::SurfaceCreate(batch.buffer(), kSurface, double_buffered, 0, 24, 8, 0, kSamples, 1, 0);
        place(batch, rect, kind);
        pack::Bind(batch.buffer(), kSurface, kSurface);
        batch.set<el::viewport>({0, 0, kWidth, kHeight}).set<el::scissor>({0, 0, kWidth, kHeight});
        if (!double_buffered) batch.set<el::draw_buffer>(GL_FRONT).set<el::read_buffer>(GL_FRONT);
        session_->expect_run(batch);
    }
    void draw(std::uint64_t tiles, const std::function<void(wire::PackBuffer&)>& body, GLenum buffer = 0) {
        Batch batch;
        batch.set<el::depth_test>(1);
        if (buffer != 0) batch.set<el::draw_buffer>(buffer);
        batch.block(tiles, body);
        session_->expect_run(batch);
    }
    void swap(std::uint32_t frame) {
        Batch batch;
        pack::Swap(batch.buffer(), kSurface, frame);
        session_->expect_run(batch);
        session_->executor.present(kSurface, frame);
    }
    /// What plain Mesa makes of `draw` in a window of a tile's size, with its viewport moved.
    Pixels reference(const geom::Rect& tile, const std::function<void(const Gl&)>& draw) {
        Pixels pixels;
        {
            ReferenceWindow window(tile.width, tile.height, false, kSamples);
            window.gl().Viewport(-tile.x, tile.bottom() - kHeight, kWidth, kHeight);
            window.gl().Enable(GL_DEPTH_TEST);
            draw(window.gl());
            pixels = window.read();
        }
        node_.make_current();
        return pixels;
    }
    Pixels shown(std::uint32_t slot) {
        const Layer* layer = session_->session.surface(kSurface)->shown_layer({.slot = slot});
        if (layer == nullptr) return {};
        Pixels pixels(std::size_t{4} * static_cast<std::size_t>(layer->width() * layer->height()));
        node_.driver->neutral_pixel_transfer();
        layer->read_texture(layer->front(), {0, 0, layer->width(), layer->height()}, pixels);
        return pixels;
    }
    template <class T>
    std::vector<T> read_values(std::uint32_t slot, const geom::Rect& part, GLenum format, GLenum type) {
        Batch batch;
        pack::ReadPixels(batch.buffer(), TestSession::kReadRequest, slot, part.x, part.y, part.width, part.height,
                         format, type);
        session_->expect_run(batch);
        const auto& answer = session_->replies[TestSession::kReadRequest];
        std::vector<T> values(answer.size() / sizeof(T));
        std::memcpy(values.data(), answer.data(), values.size() * sizeof(T));
        return values;
    }

    TestNode node_;
    std::optional<TestSession> session_;
    std::uint32_t version_ = 0;
};

constexpr std::size_t kTriangles = 9;

void pack_triangles(wire::PackBuffer& b) {
    pack::Clear(b, kAll);
    pack::Begin(b, GL_TRIANGLES);
    for (std::size_t i = 0; i < 3 * kTriangles; ++i) {
        const auto a = static_cast<float>(i);
        pack::Color3f(b, 0.5f + 0.5f * std::cos(a), 0.3f, 0.03f * a);
        pack::Vertex3f(b, 0.9f * std::cos(a * 2.1f), 0.9f * std::sin(a * 1.3f), 0.6f * std::cos(a));
    }
    pack::End(b);
}
void draw_triangles(const Gl& gl) {
    gl.Clear(kAll);
    gl.Begin(GL_TRIANGLES);
    for (std::size_t i = 0; i < 3 * kTriangles; ++i) {
        const auto a = static_cast<float>(i);
        gl.Color3f(0.5f + 0.5f * std::cos(a), 0.3f, 0.03f * a);
        gl.Vertex3f(0.9f * std::cos(a * 2.1f), 0.9f * std::sin(a * 1.3f), 0.6f * std::cos(a));
    }
    gl.End();
}

void pack_green(wire::PackBuffer& b) {
    pack::Begin(b, GL_TRIANGLES);
    pack::Color3f(b, 0, 1, 0);
    for (const float x : {-0.9f, 0.7f, 0.9f}) pack::Vertex3f(b, x, x * x * x, -0.9f);
    pack::End(b);
}
void draw_green(const Gl& gl) {
    gl.Begin(GL_TRIANGLES);
    gl.Color3f(0, 1, 0);
    for (const float x : {-0.9f, 0.7f, 0.9f}) gl.Vertex3f(x, x * x * x, -0.9f);
    gl.End();
}

TEST_F(AWindowWithSamples, IsReadAndShownAsPlainMesaMakesPixelsOfSamples) {
    open(kWindow);
    draw(3, pack_triangles);
    for (std::uint32_t slot = 0; slot < 2; ++slot) {
        const geom::Rect& tile = slot == 0 ? kLeft : kRight;
        const Pixels expected = reference(tile, draw_triangles);
        EXPECT_EQ(count_different(expected, session_->read(slot, tile)), 0u) << slot;
        EXPECT_EQ(count_different(expected, shown(slot)) == 0, false) << "it is not shown yet";
    }
    swap(1);
    EXPECT_EQ(count_different(reference(kLeft, draw_triangles), shown(0)), 0u);
    EXPECT_EQ(count_different(reference(kRight, draw_triangles), shown(1)), 0u);
}

TEST_F(AWindowWithSamples, GivesDepthAndStencilValues) {
    open(kWindow);
    Batch batch;
    batch.set<el::stencil_test>(1);
    for (const unsigned face : {0u, 1u}) batch.set<el::stencil_op>({GL_KEEP, GL_KEEP, GL_INCR}, face);
    session_->expect_run(batch);
    draw(3, pack_triangles);
    std::vector<float> depths(static_cast<std::size_t>(kLeft.width) * kLeft.height);
    std::vector<GLubyte> stencils(depths.size());
    reference(kLeft, [&](const Gl& gl) {
        gl.Enable(GL_STENCIL_TEST);
        gl.StencilOp(GL_KEEP, GL_KEEP, GL_INCR);
        draw_triangles(gl);
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.ReadPixels(0, 0, kLeft.width, kLeft.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        gl.ReadPixels(0, 0, kLeft.width, kLeft.height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencils.data());
    });
    constexpr double kStep = 1.0 / (1 << 24);  // a blit rounds once more
    EXPECT_THAT(read_values<float>(0, kLeft, GL_DEPTH_COMPONENT, GL_FLOAT),
                testing::Pointwise(testing::DoubleNear(1.1 * kStep), depths));
    EXPECT_EQ(read_values<GLubyte>(0, kLeft, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE), stencils);
}

TEST_F(AWindowWithSamples, IsDrawnOnWhileItIsShown) {
    open(kWindow);
    draw(3, pack_triangles);
    swap(1);
    draw(3, pack_green, GL_FRONT);
    const Pixels before = reference(kLeft, draw_triangles), after = shown(0);
    EXPECT_NE(count_different(before, after), 0u);
    Batch reading;
    reading.set<el::read_buffer>(GL_FRONT);
    session_->expect_run(reading);
    EXPECT_EQ(count_different(after, session_->read(0, kLeft)), 0u);
    reading.set<el::read_buffer>(GL_BACK);
    session_->expect_run(reading);
    EXPECT_EQ(count_different(before, session_->read(0, kLeft)), 0u) << "the back buffer has nothing of it";
    draw(
        3, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); }, GL_BACK);
    swap(2);
    EXPECT_EQ(count_different(Pixels(after.size()), shown(0)) != 0, true) << "alpha is 1";
    EXPECT_EQ(shown(0)[0], 0);
}

TEST_F(AWindowWithSamples, WithoutABackBufferShowsWhatIsDrawn) {
    open(kWindow, false);
    draw(3, pack_triangles);
    EXPECT_EQ(count_different(reference(kLeft, draw_triangles), shown(0)), 0u);
    EXPECT_EQ(count_different(reference(kLeft, draw_triangles), session_->read(0, kLeft)), 0u);
    draw(3, pack_green);
    const auto both = [](const Gl& gl) {
        draw_triangles(gl);
        draw_green(gl);
    };
    EXPECT_EQ(count_different(reference(kLeft, both), shown(0)), 0u);
    EXPECT_EQ(count_different(reference(kRight, both), shown(1)), 0u);
}

TEST_F(AWindowWithSamples, KeepsItsSamplesWhenItIsMoved) {
    for (const bool double_buffered : {true, false}) {
        SCOPED_TRACE(double_buffered);
        session_.emplace(*node_.node, SessionId(1));
        open({0, 0, kWidth, kHeight}, double_buffered);
        draw(3, pack_triangles);
        Batch batch;
        place(batch, {-20, -30, kWidth, kHeight});
        session_->expect_run(batch);
        draw(3, pack_green);  // among the triangles: by depth, sample by sample
        const geom::Rect rest{20, 30, 47, kHeight - 30};
        const Pixels expected = reference(rest, [](const Gl& gl) {
            draw_triangles(gl);
            draw_green(gl);
        });
        const geom::Rect part{20, 0, 47, kHeight - 30};
        EXPECT_EQ(count_different(expected, session_->read(0, part)), 0u);
    }
}

TEST_F(AWindowWithSamples, IsReadAtItsOwnSizeWhereItIsShownLarger) {
    open({0, 0, 2 * kWidth, 2 * kHeight});
    draw(1, [](auto& b) { pack::Clear(b, kAll); });
    Batch batch;
    batch.set<el::clear_color>({1, 0.5f, 0, 1});
    batch.block(1, [](auto& b) { pack::Clear(b, kAll); });
    session_->expect_run(batch);
    const Pixels pixels = session_->read(0, {3, kHeight - 20, 12, 7});
    ASSERT_EQ(pixels.size(), 12u * 7 * 4);
    for (std::size_t i = 0; i < pixels.size(); i += 4)
        EXPECT_EQ((std::array{pixels[i], pixels[i + 1], pixels[i + 2]}), (std::array<std::uint8_t, 3>{255, 128, 0}));
}

TEST_F(AWindowWithSamples, BesideTheWallIsALayerAsWell) {
    open({-1000, 0, kWidth, kHeight}, true, wire::kOnlyWholeWindow);
    draw(std::uint64_t{1} << wire::kOffscreenSlot, pack_triangles);
    EXPECT_EQ(count_different(reference(kWindow, draw_triangles), session_->read(wire::kOffscreenSlot, kWindow)), 0u);
}

TEST_F(AWindowWithSamples, IsShownWhateverTheScissor) {
    open(kWindow);
    draw(3, [](auto& b) { pack::Clear(b, kAll); });
    Batch batch;
    batch.set<el::scissor_enabled>(0xffff);
    batch.set<el::scissor>({5, 5, 20, 20});
    session_->expect_run(batch);
    draw(3, pack_triangles);
    swap(1);  // making pixels of samples, no scissor counts
    const auto scissored = [](const Gl& gl) {
        gl.Clear(kAll);
        gl.Enable(GL_SCISSOR_TEST);
        gl.Scissor(5, 5, 20, 20);
        draw_triangles(gl);
    };
    EXPECT_EQ(count_different(reference(kLeft, scissored), shown(0)), 0u);
    draw(3, pack_green, GL_FRONT);
    const Pixels outside = shown(0);
    EXPECT_EQ(outside[0], 0) << "nothing is drawn outside of the scissor";
    EXPECT_EQ(count_different(reference(kLeft, scissored), session_->read(0, kLeft)), 0u);
}

TEST_F(AWindowWithSamples, TakesStencilImagesInAllSamples) {
    open(kWindow);
    draw(3, [](auto& b) { pack::Clear(b, kAll); });
    Batch batch;
    batch.set<el::raster_position>({10, 20, 0, 1}).set<el::pixel_zoom>({2, 1}).set<el::stencil_test>(1);
    for (const unsigned face : {0u, 1u}) batch.set<el::stencil_func>({GL_EQUAL, 7, 0xff}, face);
    batch.block(3, [](auto& b) {
        pack::DrawPixels(b, 30, 9, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, std::vector(30 * 9, std::byte{7}));
        pack::Begin(b, GL_TRIANGLES);
        pack::Color3f(b, 1, 1, 1);
        for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {3.0f, -1.0f}, {-1.0f, 3.0f}}) pack::Vertex3f(b, x, y, 0);
        pack::End(b);
    });
    session_->expect_run(batch);
    for (const auto& [slot, tile] : {std::pair{0u, kLeft}, {1u, kRight}}) {
        const Pixels pixels = session_->read(slot, tile);
        std::size_t white = 0, wrong = 0;
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x) {
                const auto red = pixels[static_cast<std::size_t>(y * tile.width + x) * 4];
                const bool inside = x + tile.x >= 10 && x + tile.x < 70 && y >= 20 && y < 29;
                white += red == 255;
                wrong += red != (inside ? 255 : 0);
            }
        EXPECT_EQ(wrong, 0u) << slot;
        EXPECT_EQ(white, slot == 0 ? 57u * 9 : 3u * 9);
    }
}

TEST_F(AWindowWithSamples, HasThemWhereAWindowOfMesaHasThem) {
    open(kWindow);
    for (GLuint i = 0; i < kSamples; ++i) {
        std::array<float, 2> expected{}, found{};
        reference(kLeft, [&](const Gl& gl) { gl.GetMultisamplefv(GL_SAMPLE_POSITION, i, expected.data()); });
        Batch batch;
        pack::SamplePosition(batch.buffer(), RequestId(7), kSamples, i, 1);
        session_->expect_run(batch);
        const auto& answer = session_->replies[RequestId(7)];
        ASSERT_EQ(answer.size(), sizeof found);
        std::memcpy(found.data(), answer.data(), sizeof found);
        EXPECT_EQ(found, expected) << i;
    }
}

TEST_F(AWindowWithSamples, CountsAsOftenAgainstTheBudget) {
    const LayerGeometry geometry = plain_geometry(10, 20);
    EXPECT_EQ(pixels_taken(geometry, {}), 200);
    EXPECT_EQ(pixels_taken(geometry, {.samples = 4}), 800);
}

TEST_F(AWindowWithSamples, IsRefusedWhereNoDriverHasSuch) {
    Batch too_many, with_accum;
    pack::SurfaceCreate(too_many.buffer(), kSurface, 1, 0, 24, 8, 0, 65, 1, 0);
    EXPECT_FALSE(session_->run(too_many));
    pack::SurfaceCreate(with_accum.buffer(), kSurface, 1, 0, 24, 8, 16, 4, 1, 0);
    EXPECT_FALSE(session_->run(with_accum));
    TestSession other(*node_.node, SessionId(2));
    Batch more_than_it_has;
    pack::SurfaceCreate(more_than_it_has.buffer(), kSurface, 1, 0, 24, 8, 0, 64, 1, 0);
    place(more_than_it_has, kWindow);
    pack::Bind(more_than_it_has.buffer(), kSurface, kSurface);
    more_than_it_has.block(3, pack_triangles);
    other.expect_run(more_than_it_has);
}

}  // namespace
}  // namespace wall::tileserver::test
