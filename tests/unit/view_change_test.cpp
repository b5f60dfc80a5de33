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
geom::EyeView view(double yaw, double pitch, double fov, double aspect) {
    return {geom::view_of_angles(yaw, pitch, 0, fov, geom::angle_of_ratio(fov, 1 / aspect))};
}

void expect_near(const Mat4& a, const Mat4& b, float tolerance = 2e-6f) {
    float largest = 0;
    for (const float v : b) largest = std::max(largest, std::abs(v));
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance * largest) << i;
}

Mat4 seen(const geom::EyeView& through, const Mat4& camera) {
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

/// Two cameras beside each other whose pictures meet at a distance (an off-axis frustum each).
TEST(ViewChange, AnEyeBesideItIsWhatOneDrawsByHand) {
    const double near = 0.5, far = 80, screen = 6;
    for (const double shift : {-0.04, 0.04}) {
        const double half = 0.3 / near, aside = shift * screen * half;  // half of the width at distance 1
        const double moved = aside * near / screen;
        const Mat4 by_hand = multiply(frustum(-0.3 - moved, 0.3 - moved, -0.2, 0.25, near, far),
                                      translation(static_cast<float>(-aside), 0, 0));
        const geom::EyeView eye{.parallax = {static_cast<float>(shift), static_cast<float>(screen)}};
        const Mat4 camera = frustum(-0.3, 0.3, -0.2, 0.25, near, far);
        expect_near(seen(eye, camera), by_hand);
        const Mat4 model = multiply(rotation(33, 1), multiply(translation(3, -2, -7), scale(2, 2, 2)));
        expect_near(seen(eye, multiply(camera, model)), multiply(by_hand, model));
    }
}

TEST(ViewChange, AnEyeBesideAViewMovesAlongItsScreen) {
    const double near = 1, far = 50, screen = 4, shift = 0.05;
    const double half = std::tan(50 * M_PI / 360), aside = shift * screen * half, moved = aside * near / screen;
    const Mat4 by_hand = multiply(frustum(-half - moved, half - moved, -half, half, near, far),
                                  multiply(translation(static_cast<float>(-aside), 0, 0), rotation(60, 1)));
    geom::EyeView eye = view(60, 0, 50, 1);
    eye.parallax = {static_cast<float>(shift), static_cast<float>(screen)};
    expect_near(seen(eye, frustum(-0.4, 0.4, -0.3, 0.3, near, far)), by_hand);
}

/// In half widths of the picture: shift * (1 - screen / distance), whatever the depths are.
TEST(ViewChange, EyesAreAsFarApartAsTheDistanceSays) {
    const Mat4 usual = frustum(-1, 1, -1, 1, 1, 100), endless{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -2, 0},
               reversed{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
    const geom::EyeView right{.parallax = {0.03f, 5}};
    for (const Mat4& camera : {usual, endless, reversed})
        for (const float distance : {2.0f, 5.0f, 20.0f}) {
            const Mat4 at = multiply(seen(right, camera), translation(0.5f, 0.25f, -distance)),
                       own = multiply(camera, translation(0.5f, 0.25f, -distance));
            EXPECT_NEAR(at[12] / at[15] - own[12] / own[15], 0.03f * (1 - 5 / distance), 1e-6) << distance;
            EXPECT_FLOAT_EQ(at[13] / at[15], own[13] / own[15]) << "eyes lie beside each other";
            EXPECT_FLOAT_EQ(at[14] / at[15], own[14] / own[15]) << "depths stay";
        }
}

}  // namespace
}  // namespace wall::glstate
