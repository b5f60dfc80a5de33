// SPDX-License-Identifier: MIT
#include "common/geom/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace wall::geom {
namespace {

constexpr float kClose = 1e-6f;

void expect_near(const Vec3& a, const Vec3& b, const std::string& what) {
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], kClose) << what << ' ' << i;
}

View view_of(const Screen& screen, const Vec3& eye = {}) {
    const auto found = view_of_screen(screen, eye);
    EXPECT_TRUE(std::holds_alternative<View>(found)) << std::get<const char*>(found);
    return std::get<View>(found);
}

TEST(View, AnglesTurnToTheRightThenUp) {
    const View right = view_of_angles(90, 0, 0, 90, 60);
    expect_near(right.ahead, {1, 0, 0}, "ahead");
    expect_near(right.right, {0, 0, -1}, "right");
    expect_near(right.up, {0, 1, 0}, "up");
    const View up = view_of_angles(0, 30, 0, 90, 60);
    expect_near(up.ahead, {0, 0.5f, std::sqrt(0.75f)}, "ahead");
    expect_near(up.right, {1, 0, 0}, "right");
    const View both = view_of_angles(-30, 10, 0, 90, 60);
    EXPECT_LT(both.ahead[0], 0);
    EXPECT_NEAR(both.ahead[1], std::sin(10 * M_PI / 180), kClose);
    EXPECT_NEAR(both.right[1], 0, kClose) << "without roll the horizon stays level";
}

TEST(View, RollTurnsClockwise) {
    const View turned = view_of_angles(0, 0, 90, 90, 60);
    expect_near(turned.up, {1, 0, 0}, "the upper edge points to the right");
    expect_near(turned.right, {0, -1, 0}, "and the right one down");
}

TEST(View, AnglesFromEdgeToEdge) {
    const View view = view_of_angles(0, 0, 0, 90, 60);
    EXPECT_NEAR(view.right_edge, 1, kClose);
    EXPECT_NEAR(view.left, -1, kClose);
    EXPECT_NEAR(view.top, std::tan(M_PI / 6), kClose);
    EXPECT_NEAR(angle_of_ratio(90, 1), 90, 1e-9);
    EXPECT_NEAR(angle_of_ratio(90, 0.5), 2 * std::atan(0.5) * 180 / M_PI, 1e-9);
}

/// The octagon: screens around the eye, each as far away, are the views that angles say.
TEST(View, ScreensAroundTheEyeAreTheirAngles) {
    const double half = 22.5 * M_PI / 180;
    for (int i = 0; i < 8; ++i) {
        const double yaw = i * 45 * M_PI / 180;
        // Corners at distance 1 along the screen's middle: angles yaw +- half, to the right is clockwise from above.
        const auto corner = [&](double at, float y) {
            return Vec3{static_cast<float>(std::sin(at) / std::cos(half)), y,
                        static_cast<float>(-std::cos(at) / std::cos(half))};
        };
        const View found = view_of({corner(yaw - half, -0.3f), corner(yaw + half, -0.3f), corner(yaw - half, 0.3f)});
        const View wanted = view_of_angles(i * 45, 0, 0, 45, 2 * std::atan(0.3) * 180 / M_PI);
        expect_near(found.ahead, wanted.ahead, "ahead");
        expect_near(found.right, wanted.right, "right");
        expect_near(found.up, wanted.up, "up");
        EXPECT_NEAR(found.left, wanted.left, kClose);
        EXPECT_NEAR(found.right_edge, wanted.right_edge, kClose);
        EXPECT_NEAR(found.bottom, wanted.bottom, kClose);
        EXPECT_NEAR(found.top, wanted.top, kClose);
    }
}

TEST(View, AScreenBesideTheEyeIsSeenAslant) {
    const View view = view_of({{1, 1, -2}, {3, 1, -2}, {1, 2, -2}}, {0, 1, 0});
    expect_near(view.ahead, {0, 0, 1}, "ahead");
    EXPECT_NEAR(view.left, 0.5f, kClose);
    EXPECT_NEAR(view.right_edge, 1.5f, kClose);
    EXPECT_NEAR(view.bottom, 0, kClose);
    EXPECT_NEAR(view.top, 0.5f, kClose);
}

TEST(View, ScreensThatCannotBeSeenAreRefused) {
    const auto why = [](const Screen& screen, const Vec3& eye = {}) {
        const auto found = view_of_screen(screen, eye);
        return std::holds_alternative<View>(found) ? "nothing" : std::string(std::get<const char*>(found));
    };
    EXPECT_EQ(why({{-1, -1, -2}, {1, -1, -2}, {-1, 1, -2}}), "nothing");
    EXPECT_EQ(why({{0, 0, -1}, {1, 0, -1}, {2, 0, -1}}), "the three corners lie on one line");
    EXPECT_EQ(why({{0, 0, -1}, {0, 0, -1}, {0, 1, -1}}), "two of the corners are the same");
    EXPECT_EQ(why({{0, 0, -1}, {1, 0, -1}, {0.5f, 1, -1}}), "the corners make no right angle at lower_left");
    EXPECT_EQ(why({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {5, 5, 0}), "the eye lies in the screen's plane");
    EXPECT_EQ(why({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}), "the eye is behind the screen");
}

TEST(View, WhatComesFromElsewhereIsChecked) {
    EXPECT_EQ(wrong_with(view_of_angles(10, 20, 30, 40, 50)), nullptr);
    View view;
    view.right[1] = 0.5f;
    EXPECT_NE(wrong_with(view), nullptr);
    view = {};
    view.up = {NAN, 1, 0};
    EXPECT_NE(wrong_with(view), nullptr);
    view = {};
    view.top = view.bottom;
    EXPECT_NE(wrong_with(view), nullptr);
    view = {};
    view.left = -INFINITY;
    EXPECT_NE(wrong_with(view), nullptr);
}

TEST(EyeView, GoesOverTheWireAsItIs) {
    for (const EyeView& view :
         {EyeView{}, EyeView{view_of_angles(30, 5, 1, 60, 40), {}}, EyeView{.parallax = {-0.02f, 7}},
          EyeView{view_of_angles(-90, 0, 0, 90, 60), {0.02f, 0.5f}}}) {
        const auto back = eye_view_of_values(values_of(view));
        ASSERT_TRUE(std::holds_alternative<EyeView>(back));
        EXPECT_EQ(std::get<EyeView>(back), view);
    }
}

TEST(EyeView, WhatComesFromElsewhereIsChecked) {
    const auto wrong = [](std::size_t at, float value) {
        auto values = values_of(EyeView{view_of_angles(30, 5, 1, 60, 40), {0.02f, 3}});
        values[at] = value;
        return std::holds_alternative<const char*>(eye_view_of_values(values));
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    for (const float shift : {1.5f, -1.5f, kNan, kInf}) EXPECT_TRUE(wrong(14, shift)) << shift;
    for (const float screen : {0.0f, -1.0f, kNan, kInf}) EXPECT_TRUE(wrong(15, screen)) << screen;
    EXPECT_TRUE(wrong(1, 5));
    EXPECT_FALSE(wrong(14, 0));
}

}  // namespace
}  // namespace wall::geom
