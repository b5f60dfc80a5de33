// SPDX-License-Identifier: MIT
// A layer must be, pixel by pixel, what plain Mesa draws in a window (DESIGN, section 8: "same").
#include "tileserver/driver/layer.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/unit/tileserver/reference_window.h"
#include "tests/unit/tileserver/scene.h"
#include "tileserver/gpu/backend.h"

namespace wall::tileserver {
namespace {

constexpr int kWidth = 301, kHeight = 207;

/// Backend, alpha, samples.
class LayerTest : public ::testing::TestWithParam<std::tuple<const char*, bool, int>> {};

TEST_P(LayerTest, DrawsTheSamePixelsAsAWindow) {
    const auto [backend_name, alpha, samples] = GetParam();
    auto backend = open_backend(backend_name);
    if (!backend) GTEST_SKIP() << backend.error().message;
    test::Pixels expected, drawn;
    {
        test::ReferenceWindow window(kWidth, kHeight, alpha, samples);
        test::draw_scene(window.gl(), kWidth, kHeight);
        expected = window.read();
    }
    ASSERT_TRUE((*backend)->make_current());
    Gl gl;
    gl.load([&](const char* name) { return (*backend)->get_proc_address(name); });
    {
        const geom::Rect all{0, 0, kWidth, kHeight};
        PixelBudget budget;
        Layer layer(gl, true, {all, all, kWidth, kHeight},
                    {.alpha = alpha, .samples = static_cast<std::uint32_t>(samples)}, budget);
        ASSERT_TRUE(layer.complete());
        layer.bind(GL_BACK, GL_BACK);
        gl.Viewport(0, 0, kWidth, kHeight);
        test::draw_scene(gl, kWidth, kHeight);
        layer.finish_frame();
        layer.show_frame();
        drawn.resize(expected.size());
        layer.read_texture(layer.front(), all, drawn);
    }
    EXPECT_EQ(gl.GetError(), GLenum{GL_NO_ERROR});
    const auto different = test::count_different(expected, drawn);
    EXPECT_EQ(different, 0u);
    if (different != 0) {
        test::write_ppm("layer_expected.ppm", expected, kWidth, kHeight);
        test::write_ppm("layer_drawn.ppm", drawn, kWidth, kHeight);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, LayerTest,
                         ::testing::Combine(::testing::Values("egl", "osmesa"), ::testing::Bool(),
                                            ::testing::Values(0, 4)));

}  // namespace
}  // namespace wall::tileserver
