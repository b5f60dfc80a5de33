// SPDX-License-Identifier: MIT
#include "common/glstate/view_change.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "common/glstate/projection.h"

namespace wall::glstate {
namespace {

/// glFrustum's.
Mat4 frustum(double l, double r, double b, double t, double n, double f) {
    const auto to = [](double v) { return static_cast<float>(v); };
    return {to(2 * n / (r - l)),
            0,
            0,
            0,
            0,
            to(2 * n / (t - b)),
            0,
            0,
            to((r + l) / (r - l)),
            to((t + b) / (t - b)),
            to(-(f + n) / (f - n)),
            -1,
            0,
            0,
            to(-2 * f * n / (f - n)),
            0};
}

/// glRotate's, about x or y.
Mat4 rotation(double degrees, int axis) {
    const double a = degrees * M_PI / 180;
    const auto c = static_cast<float>(std::cos(a)), s = static_cast<float>(std::sin(a));
    if (axis == 0) return {1, 0, 0, 0, 0, c, s, 0, 0, -s, c, 0, 0, 0, 0, 1};
    return {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1};
}
Mat4 translation(float x, float y, float z) { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}; }
Mat4 scale(float x, float y, float z) { return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}; }

/// What a program would draw with if it drew this view itself.
Mat4 drawn_by_hand(double yaw, double pitch, double fov, double aspect, double n, double f) {
    const double x = std::tan(fov * M_PI / 360), y = x / aspect;
    return multiply(frustum(-x * n, x * n, -y * n, y * n, n, f), multiply(rotation(-pitch, 0), rotation(yaw, 1)));
}
geom::View view(double yaw, double pitch, double fov, double aspect) {
    return geom::view_of_angles(yaw, pitch, 0, fov, geom::angle_of_ratio(fov, 1 / aspect));
}

void expect_near(const Mat4& a, const Mat4& b, float tolerance = 2e-6f) {
    float largest = 0;
    for (const float v : b) largest = std::max(largest, std::abs(v));
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance * largest) << i;
}

Mat4 seen(const geom::View& through, const Mat4& camera) {
    const auto change = view_change(through, camera);
    EXPECT_TRUE(change.has_value());
    return change ? product(*change, camera) : Mat4{};
}

TEST(ViewChange, OfAProjectionIsWhatOneDrawsByHand) {
    for (const double yaw : {0.0, 45.0, -100.0, 180.0})
        for (const double pitch : {0.0, 20.0, -75.0})
            expect_near(seen(view(yaw, pitch, 70, 1.5), frustum(-0.3, 0.4, -0.2, 0.25, 0.5, 80)),
                        drawn_by_hand(yaw, pitch, 70, 1.5, 0.5, 80));
}

TEST(ViewChange, TheProgramsOwnViewChangesNothing) {
    const Mat4 camera = frustum(-1, 1, -0.5, 0.5, 1, 100);
    const auto change = view_change(view(0, 0, 90, 2), camera);
    ASSERT_TRUE(change.has_value());
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR((*change)[i], i % 5 == 0 ? 1 : 0, 1e-7) << i;
}

/// A camera that stands in the projection matrix, or everything in one matrix of a shader.
TEST(ViewChange, KnowsTheCameraBehindItsMatrix) {
    const Mat4 camera = frustum(-0.4, 0.4, -0.3, 0.3, 1, 50);
    const Mat4 model =
        multiply(multiply(rotation(33, 1), rotation(-12, 0)), multiply(translation(3, -2, 7), scale(4, 4, 4)));
    const Mat4 by_hand = multiply(drawn_by_hand(60, -10, 50, 1, 1, 50), model);
    expect_near(seen(view(60, -10, 50, 1), multiply(camera, model)), by_hand);
}

TEST(ViewChange, DepthGoesOnAsTheProgramHasIt) {
    // Endless, and reversed: 1 at the near plane, 0 far away, with z from 0 to w.
    const Mat4 endless{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -2, 0},
        reversed{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
    for (const Mat4& camera : {endless, reversed}) {
        const Mat4 turned = seen(view(90, 0, 90, 1), camera);
        // A point 5 to the right is 5 ahead of that view.
        const Mat4 points = multiply(turned, translation(5, 0, 0)), before = multiply(camera, translation(0, 0, -5));
        EXPECT_NEAR(points[14], before[14], 1e-5);
        EXPECT_NEAR(points[15], before[15], 1e-5);
    }
}

TEST(ViewChange, ThePictureGoesOnToTheRightAlsoWhereItIsMirrored) {
    const Mat4 mirrored = multiply(frustum(-1, 1, -1, 1, 1, 10), scale(-1, 1, 1));
    // What is at the right edge of the picture is in the middle of a view turned by 45 degrees.
    const Mat4 at = multiply(seen(view(45, 0, 90, 1), mirrored), translation(-3, 0, -3));
    EXPECT_NEAR(at[12] / at[15], 0, 1e-6);
    EXPECT_GT(at[15], 0);
}

TEST(ViewChange, WhatIsNoPerspectiveOrShearedHasNone) {
    const Mat4 parallel = scale(0.5f, 0.5f, -0.1f), nothing{};
    EXPECT_FALSE(view_change(view(45, 0, 90, 1), parallel));
    EXPECT_FALSE(view_change(view(45, 0, 90, 1), nothing));
    const Mat4 camera = frustum(-1, 1, -1, 1, 1, 10);
    EXPECT_FALSE(view_change(view(45, 0, 90, 1),
                             multiply(camera, multiply(rotation(40, 1), multiply(rotation(30, 0), scale(1, 3, 1))))));
    Mat4 broken = camera;
    broken[0] = NAN;
    EXPECT_FALSE(view_change(view(45, 0, 90, 1), broken));
    broken[0] = INFINITY;
    EXPECT_FALSE(view_change(view(45, 0, 90, 1), broken));
}

}  // namespace
}  // namespace wall::glstate
