// SPDX-License-Identifier: MIT
#include "common/glstate/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace wall::glstate {
namespace {

/// An eye at the origin that looks down -z, 90 degrees wide; window of 100x100.
Projection perspective(float near_plane, float far_plane) {
    Projection p;
    const float depth = near_plane - far_plane;
    p.clip_from_object = {
        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, (far_plane + near_plane) / depth, -1, 0, 0, 2 * far_plane * near_plane / depth,
        0};
    p.viewport[2] = p.viewport[3] = 100;
    return p;
}

geom::Box box_of(std::array<float, 3> a, std::array<float, 3> b) {
    geom::Box box;
    box.add(_mm_set_ps(0, a[2], a[1], a[0]));
    box.add(_mm_set_ps(0, b[2], b[1], b[0]));
    return box;
}

TEST(Projection, ABoxBehindTheEyeIsNowhere) {
    const auto rect = project(perspective(1, 100), box_of({-1, -1, 1}, {1, 1, 20}));
    ASSERT_TRUE(rect.has_value());
    EXPECT_FALSE(rect->overlaps({-1e9f, -1e9f, 1e9f, 1e9f}));
}

TEST(Projection, ClipSpaceMayBeUpsideDown) {
    Projection p = perspective(1, 100);
    const geom::Box box = box_of({-0.5f, 0.25f, -10}, {-0.25f, 0.5f, -2});
    const auto upright = project(p, box);
    p.y_up = -1;
    const auto turned = project(p, box);
    ASSERT_TRUE(upright && turned);
    EXPECT_NEAR(turned->y0, 100 - upright->y1, 0.01);
    EXPECT_NEAR(turned->y1, 100 - upright->y0, 0.01);
    EXPECT_NEAR(turned->x0, upright->x0, 0.01);
    const auto through = project(p, box_of({-0.5f, 0.25f, -10}, {-0.25f, 0.5f, 10}));
    ASSERT_TRUE(through.has_value());
    EXPECT_NEAR(through->y1, 50 - 1.25 + 1, 0.01);
}

TEST(Projection, ABoxThroughTheNearPlaneIsBoundedByWhatIsInFront) {
    const auto rect = project(perspective(1, 100), box_of({-0.5f, 0.25f, -10}, {-0.25f, 0.5f, 10}));
    ASSERT_TRUE(rect.has_value());
    EXPECT_NEAR(rect->x0, 25 - 1, 0.01);  // x = -0.5 on the near plane
    EXPECT_NEAR(rect->x1, 50 - 1.25 + 1, 0.01);
    EXPECT_NEAR(rect->y0, 51.25 - 1, 0.01);
    EXPECT_NEAR(rect->y1, 75 + 1, 0.01);
}

TEST(Projection, ClampedDepthsAreNotClipped) {
    Projection p = perspective(1, 100);
    p.near_plane = false;
    const auto rect = project(p, box_of({-0.5f, 0, -10}, {-0.25f, 0, 10}));
    ASSERT_TRUE(rect.has_value());
    EXPECT_LT(rect->x0, -1000);
}

TEST(Projection, WhatCannotBeComputedIsUnknown) {
    EXPECT_FALSE(project(perspective(1, 100), box_of({0, 0, 0}, {3e38f, 3e38f, 3e38f})).has_value());
    geom::Box box;
    box.make_unbounded();
    EXPECT_FALSE(project(perspective(1, 100), box).has_value());
}

TEST(Projection, OfAShaderHasAMarginForItsRounding) {
    const Projection fixed = perspective(1, 100);
    const geom::Box box = box_of({-1, -1, -10}, {1, 1, -5});
    glapi::PositionTransform transform;
    transform.linear = fixed.clip_from_object;
    for (std::size_t i = 0; i < 16; ++i) transform.sizes[i] = std::abs(transform.linear[i]);
    const auto exact = project(fixed, box), usual = project(make_projection(fixed, transform, true), box);
    ASSERT_TRUE(exact && usual);
    EXPECT_LE(usual->x0, exact->x0);
    EXPECT_GT(usual->x0, exact->x0 - 0.01f);
    transform.sizes[12] += 1e6f;  // x was moved far away, and back again
    const auto far = project(make_projection(fixed, transform, true), box);
    ASSERT_TRUE(far);
    EXPECT_LT(far->x0, exact->x0 - 10);
    EXPECT_GT(far->x1, exact->x1 + 10);
    EXPECT_NEAR(far->y0, exact->y0, 0.01f);
    EXPECT_FALSE(project(make_projection(fixed, transform, true), box_of({-1, -1, -5}, {1, 1, 5})));
    transform.sizes[12] = 0;
    EXPECT_TRUE(project(make_projection(fixed, transform, true), box_of({-1, -1, -5}, {1, 1, 5})));
    EXPECT_FALSE(project(unknown_projection(), box));
}

TEST(Projection, WithoutDepthNothingIsClipped) {
    const Projection fixed = perspective(1, 100);
    glapi::PositionTransform transform;
    transform.linear = fixed.clip_from_object;
    EXPECT_TRUE(make_projection(fixed, transform, true).near_plane);
    EXPECT_FALSE(make_projection(fixed, transform, false).near_plane);
}

TEST(Projection, OfABoxIsThatOfItsCorners) {
    const Projection p = perspective(1, 100);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> place(-30, 30);
    int known = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::array<float, 3> a = {place(random), place(random), place(random) - 25};
        const std::array<float, 3> b = {place(random), place(random), place(random) - 25};
        std::array<WindowVertex, 8> corners;
        for (unsigned corner = 0; corner < corners.size(); ++corner) {
            const auto of = [&](unsigned axis) {
                return corner >> axis & 1 ? std::max(a[axis], b[axis]) : std::min(a[axis], b[axis]);
            };
            corners[corner] = project(p, of(0), of(1), of(2), 1);
        }
        const auto rect = project(p, box_of(a, b)), expected = hull_rect(p, corners);
        ASSERT_EQ(rect.has_value(), expected.has_value());
        if (!rect) continue;
        ++known;
        EXPECT_EQ(rect->x0, expected->x0);
        EXPECT_EQ(rect->y0, expected->y0);
        EXPECT_EQ(rect->x1, expected->x1);
        EXPECT_EQ(rect->y1, expected->y1);
    }
    EXPECT_GT(known, 1000);
}

// Every visible point of a hull lies in its rectangle.
TEST(Projection, HullsAreBoundedConservatively) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-20, 20), part(0, 1);
    std::size_t crossing = 0, visible = 0;
    for (int round = 0; round < 2000; ++round) {
        const Projection p = perspective(round % 2 ? 0.01f : 2.0f, 50);
        std::array<WindowVertex, 4> hull;
        for (auto& v : hull) v = project(p, place(random), place(random), place(random), 1);
        const auto rect = hull_rect(p, hull);
        ASSERT_TRUE(rect.has_value());
        const auto in_front = std::count_if(hull.begin(), hull.end(), [](const WindowVertex& v) { return v.in_front; });
        crossing += in_front > 0 && in_front < 4;
        for (int sample = 0; sample < 50; ++sample) {
            std::array<float, 4> weight, clip{};
            float sum = 0;
            for (auto& w : weight) sum += w = part(random);
            for (std::size_t i = 0; i < hull.size(); ++i)
                for (std::size_t c = 0; c < 4; ++c) clip[c] += hull[i].clip[c] * weight[i] / sum;
            if (clip[2] < -clip[3]) continue;  // clipped
            const float x = (clip[0] / clip[3] + 1) * 50, y = (clip[1] / clip[3] + 1) * 50;
            ++visible;
            ASSERT_TRUE(rect->overlaps({x - 0.01f, y - 0.01f, x + 0.01f, y + 0.01f})) << "round " << round;
        }
    }
    EXPECT_GT(crossing, 200u);
    EXPECT_GT(visible, 2000u);
}

TEST(Projection, MapsClipSpaceToTheViewport) {
    Projection p;
    p.clip_from_object = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    p.viewport[2] = 200;
    p.viewport[3] = 100;
    p.margin = 1;
    geom::Box box;
    box.add(_mm_set_ps(0, 0, -0.5f, -1));
    box.add(_mm_set_ps(0, 0, 0.5f, 0));
    const auto rect = project(p, box);
    ASSERT_TRUE(rect.has_value());
    EXPECT_EQ(rect->x0, -1);
    EXPECT_EQ(rect->x1, 101);
    EXPECT_EQ(rect->y0, 24);
    EXPECT_EQ(rect->y1, 76);
}

TEST(Projection, OnlyPointsReachAsFarAsAShaderMayMakeThem) {
    State state;
    state.window.viewport = {0, 0, 100, 100};
    state.line_point.program_point_size = 1;
    state.line_point.point_size_max = 60;
    state.line_point.line_width = 8;
    geom::Box box;
    box.add(_mm_set_ps(0, 0, 0, 0));
    const auto reach = [&](GLenum mode) { return 50 - project(make_projection(state), box, mode)->x0; };
    EXPECT_EQ(reach(GL_POINTS), 31);
    EXPECT_EQ(reach(GL_LINE_STRIP), 5);
    EXPECT_EQ(reach(GL_TRIANGLES), 1);
    EXPECT_EQ(reach(GL_POLYGON), 1);
    state.polygon.polygon_mode[1] = GL_LINE;
    EXPECT_EQ(reach(GL_TRIANGLES), 5);
    state.polygon.polygon_mode[0] = GL_POINT;
    EXPECT_EQ(reach(GL_TRIANGLE_STRIP), 31);
}

}  // namespace
}  // namespace wall::glstate
