// SPDX-License-Identifier: MIT
#include "common/glstate/raster_place.h"

#include <GL/gl.h>
#include <GL/glext.h>
#include <gtest/gtest.h>

#include "common/glstate/projection.h"
#include "common/glstate/view_change.h"

namespace wall::glstate {
namespace {

/// 90 degrees wide, from 0.1 to 10.
const Mat4 kCamera{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -10.1f / 9.9f, -1, 0, 0, -2 / 9.9f, 0};
const Mat4 kParallel{0.1f, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, 1};
const geom::EyeView kToTheRight{geom::view_of_angles(90, 0, 0, 90, 90)};

State state_with(const Mat4& projection) {
    State out;
    out.matrix.projection = projection;
    out.window.viewport = {10, 20, 200, 100};
    return out;
}
Vec4 times(const Mat4& m, const Vec4& v) {
    Vec4 out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t i = 0; i < 4; ++i) out[row] += m[4 * i + row] * v[i];
    return out;
}
/// As glRasterPos leaves it at a place before the camera.
State at(const Vec4& eye, const Mat4& projection = kCamera) {
    State out = state_with(projection);
    const Vec4 clip = times(projection, eye);
    out.raster.raster_position_valid = in_view_volume(out, clip);
    out.raster.raster_clip = raster_clip(out, clip);
    out.raster.raster_position = window_position(out, clip);
    return out;
}

void expect_near(const Vec4& a, const Vec4& b) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], 1e-3f) << i;
}

TEST(RasterPlace, IsTheViewportsPixelAndDepth) {
    const State ahead = at({1, 0.5f, -2, 1});
    EXPECT_TRUE(ahead.raster.raster_position_valid);
    expect_near(ahead.raster.raster_position, {160, 82.5f, (10.1f / 9.9f - 0.1f / 0.99f + 1) / 2, 2});
    EXPECT_FALSE(at({3, 0, -2, 1}).raster.raster_position_valid) << "to the right of the window";
    EXPECT_FALSE(at({0, 0, -11, 1}).raster.raster_position_valid) << "behind the far plane";
    State clamped = state_with(kCamera);
    clamped.transform.depth_clamp = 1;
    EXPECT_TRUE(in_view_volume(clamped, times(kCamera, {0, 0, -11, 1})));
    EXPECT_EQ(window_position(clamped, times(kCamera, {0, 0, -11, 1}))[2], 1.0f);
    State turned = state_with(kCamera);
    turned.transform.clip_control.origin = GL_UPPER_LEFT;
    EXPECT_NEAR(window_position(turned, times(kCamera, {1, 0.5f, -2, 1}))[1], 57.5f, 1e-3f);
}

TEST(RasterPlace, OfAViewIsWhereItsOwnMatricesPutIt) {
    for (const Vec4& eye : {Vec4{5, 1, 0.5f, 1}, {4, -2, -3, 1}, {6, 0, 4, 1}}) {
        const State state = at(eye);
        EXPECT_FALSE(state.raster.raster_position_valid) << "the program's camera does not see it";
        const auto seen = raster_in_view(kToTheRight, state, state.raster.raster_position);
        ASSERT_TRUE(seen);
        EXPECT_TRUE(seen->valid);
        const State own = at(eye, product(*view_change(kToTheRight, kCamera), kCamera));
        expect_near(seen->position, own.raster.raster_position);
        EXPECT_EQ(seen->right, 0);
        EXPECT_EQ(seen->up, 0);
    }
    const State ahead = at({0, 0, -3, 1});
    const auto seen = raster_in_view(kToTheRight, ahead, ahead.raster.raster_position);
    ASSERT_TRUE(seen);
    EXPECT_FALSE(seen->valid) << "to its left";
}

TEST(RasterPlace, IsMovedByPixelsOfTheView) {
    const State state = at({5, 0, 1, 1});
    Vec4 moved = state.raster.raster_position;
    moved[0] += 9;
    moved[1] -= 2;
    const auto first = raster_in_view(kToTheRight, state, state.raster.raster_position),
               second = raster_in_view(kToTheRight, state, moved);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->position, second->position);
    EXPECT_NEAR(second->right, 9, 1e-3f);
    EXPECT_NEAR(second->up, -2, 1e-3f);
}

TEST(RasterPlace, ThatNoCameraHasPlacedIsTheSameInAllViews) {
    const State title = at({3, 2, 0, 1}, kParallel);
    EXPECT_EQ(title.raster.raster_clip, Vec4{});
    EXPECT_FALSE(raster_in_view(kToTheRight, title, title.raster.raster_position));
    State left = at({5, 0, 1, 1});
    left.matrix.projection = kParallel;  // the program draws a title next
    EXPECT_FALSE(raster_in_view(kToTheRight, left, left.raster.raster_position));
}

}  // namespace
}  // namespace wall::glstate
