// SPDX-License-Identifier: MIT
#include "client_lib/geometry/snap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "client_lib/context/context.h"

namespace wall::client {

void GLAPIENTRY gl_entry_Vertex2f(GLfloat x, GLfloat y);
void GLAPIENTRY gl_entry_Vertex3f(GLfloat x, GLfloat y, GLfloat z);
void GLAPIENTRY gl_entry_Vertex4f(GLfloat x, GLfloat y, GLfloat z, GLfloat w);
void GLAPIENTRY gl_entry_Normal3f(GLfloat x, GLfloat y, GLfloat z);

namespace {

using Point = std::array<double, 4>;
using Pixels = std::array<double, 2>;

constexpr std::array<float, 2> kOneToOne{1, 1};
constexpr float kQuarter = 0.25f;

glstate::Mat4 frustum(double half_angle, double ratio, double near, double far) {
    const double f = 1 / std::tan(half_angle);
    glstate::Mat4 out{};
    out[0] = static_cast<float>(f / ratio);
    out[5] = static_cast<float>(f);
    out[10] = static_cast<float>((far + near) / (near - far));
    out[11] = -1;
    out[14] = static_cast<float>(2 * far * near / (near - far));
    return out;
}

glstate::Mat4 placed(double turn, double scale, double x, double y, double z) {
    const auto c = static_cast<float>(std::cos(turn) * scale), s = static_cast<float>(std::sin(turn) * scale);
    return {c,
            s,
            0,
            0,
            -s * 0.8f,
            c * 0.8f,
            0.6f * static_cast<float>(scale),
            0,
            s * 0.6f,
            -c * 0.6f,
            0.8f * static_cast<float>(scale),
            0,
            static_cast<float>(x),
            static_cast<float>(y),
            static_cast<float>(z),
            1};
}

glstate::Projection projection_of(const glstate::Mat4& clip, float width = 1280, float height = 960) {
    glstate::Projection out;
    out.clip_from_object = clip;
    out.viewport[2] = width;
    out.viewport[3] = height;
    return out;
}

__m128 vector_of(const Point& p) {
    return _mm_setr_ps(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]), 1);
}

Point point_of(__m128 v) {
    std::array<float, 4> values{};
    _mm_storeu_ps(values.data(), v);
    return {static_cast<double>(values[0]), static_cast<double>(values[1]), static_cast<double>(values[2]),
            static_cast<double>(values[3])};
}

Point times(const glstate::Mat4& m, const Point& p) {
    Point out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            out[row] += static_cast<double>(m[4 * column + row]) * p[column];
    return out;
}

bool is_seen(const Point& clip) {
    return clip[3] > 0 && std::max({std::abs(clip[0]), std::abs(clip[1]), std::abs(clip[2])}) <= clip[3];
}

Pixels pixels_of(const Point& clip, const glstate::Projection& by) {
    return {clip[0] / clip[3] * static_cast<double>(by.viewport[2]) / 2,
            clip[1] / clip[3] * static_cast<double>(by.viewport[3]) / 2};
}

double apart(const Pixels& a, const Pixels& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

class SnapTest : public testing::Test {
protected:
    void SetUp() override { tls_packer = &packer; }
    void TearDown() override { tls_packer = nullptr; }

    double between(double least, double most) { return std::uniform_real_distribution(least, most)(random_); }
    double decade(double least, double most) { return std::pow(10, between(least, most)); }

    glstate::Projection any_camera() {
        const double near = decade(-2, 1);
        const auto eye = frustum(between(0.15, 0.9), between(0.5, 3), near, near * decade(1, 4));
        return projection_of(glstate::multiply(eye, placed(between(0, 6.3), decade(-1, 1), between(-3, 3) * near,
                                                           between(-3, 3) * near, between(-20, 2) * near)),
                             static_cast<float>(between(100, 4000)), static_cast<float>(between(100, 4000)));
    }
    Packer packer;

private:
    std::mt19937 random_{4711};
};

// What is seen of a triangle between vertices that were moved, and where it was: also of one that reaches behind the
// eye.
TEST_F(SnapTest, NothingIsSeenFartherOffThanTheBound) {
    std::size_t seen = 0, behind = 0;
    double worst = 0;
    for (int camera = 0; camera < 400; ++camera) {
        const auto projection = any_camera();
        const auto bound = static_cast<float>(decade(-2, 0.5));
        const auto grid = SnapGrid::make(projection, kOneToOne, bound);
        ASSERT_TRUE(grid);
        const double size = decade(-1, 2);
        for (int n = 0; n < 100; ++n) {
            std::array<Point, 3> before{}, after{};
            float reach = 0;
            geom::Box box;
            for (Point& p : before) {
                p = {between(-size, size), between(-size, size), between(-size, size), 1};
                p = point_of(vector_of(p));
                box.add(vector_of(p));
            }
            if (const auto [least, most] = grid->w_of(box); least <= 0) reach = most;
            for (std::size_t i = 0; i < 3; ++i) after[i] = point_of(grid->snapped(vector_of(before[i]), reach));
            for (int sample = 0; sample < 40; ++sample) {
                double a = between(0, 1), b = between(0, 1);
                if (a + b > 1) a = 1 - a, b = 1 - b;
                const std::array<double, 3> shares{a, b, 1 - a - b};
                Point from{}, to{};
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t axis = 0; axis < 4; ++axis)
                        from[axis] += shares[i] * before[i][axis], to[axis] += shares[i] * after[i][axis];
                const Point clip = times(projection.clip_from_object, from);
                if (!is_seen(clip)) continue;
                ++seen;
                behind += reach > 0 ? 1 : 0;
                const double off =
                    apart(pixels_of(clip, projection), pixels_of(times(projection.clip_from_object, to), projection));
                worst = std::max(worst, off / static_cast<double>(bound));
            }
        }
    }
    EXPECT_GT(seen, 10'000u);
    EXPECT_GT(behind, 1'000u);
    EXPECT_LE(worst, 1 + 1e-2) << "of the bound: what the bound is in small pictures moves w, too";
    EXPECT_GT(worst, 0.2) << "a grid that is much finer than it needs to be saves nothing";
}

TEST_F(SnapTest, TheFartherAwayTheCoarser) {
    const auto projection = projection_of(frustum(0.5, 1, 1, 1000));
    const auto grid = SnapGrid::make(projection, kOneToOne, kQuarter);
    ASSERT_TRUE(grid);
    const auto bits_kept = [&](float depth) {  // of a coordinate about 1, on the average
        int kept = 0;
        for (int i = 0; i < 100; ++i) {
            const auto snapped =
                point_of(grid->snapped(_mm_setr_ps(1 + 0.009137f * static_cast<float>(i), 0, -depth, 1), 0));
            const auto x = static_cast<float>(snapped[0]);
            std::uint32_t bits = 0;
            std::memcpy(&bits, &x, sizeof bits);
            kept = std::max(kept, 23 - std::countr_zero(bits | 1u << 23));
        }
        return kept;
    };
    EXPECT_EQ(bits_kept(20), bits_kept(40) + 1);
    EXPECT_EQ(bits_kept(20), bits_kept(80) + 2);
    EXPECT_LT(bits_kept(20), 12) << "of 23";
}

TEST_F(SnapTest, PixelsOfAFlatPictureStayWhereTheyAre) {
    glstate::Mat4 flat{};
    flat[0] = 2 / 640.0f, flat[5] = 2 / 480.0f, flat[10] = -1, flat[12] = flat[13] = -1, flat[15] = 1;
    const auto grid = SnapGrid::make(projection_of(flat, 640, 480), kOneToOne, kQuarter);
    ASSERT_TRUE(grid);
    for (const double x : {0.0, 0.5, 17.0, 319.5, 640.0}) {
        const Point p{x, 480 - x, 0.5, 1};
        EXPECT_EQ(point_of(grid->snapped(vector_of(p), 0)), p);
    }
}

TEST_F(SnapTest, AScaledWindowIsJudgedByTheWallsPixels) {
    const auto projection = projection_of(frustum(0.5, 1, 1, 1000));
    const auto one = SnapGrid::make(projection, kOneToOne, kQuarter),
               large = SnapGrid::make(projection, {4, 4}, kQuarter);
    ASSERT_TRUE(one && large);
    const __m128 a = _mm_setr_ps(1.2345f, 2.3456f, -20, 1), b = _mm_setr_ps(1.3345f, 2.3456f, -20, 1);
    EXPECT_NEAR(*large->distance(a, b), 4 * *one->distance(a, b), 1e-9);
    EXPECT_LE(*large->distance(a, large->snapped(a, 0)), 0.25);
}

TEST_F(SnapTest, WhatIsNotKnownStays) {
    const auto good = projection_of(frustum(0.5, 1, 1, 1000));
    EXPECT_TRUE(SnapGrid::make(good, kOneToOne, kQuarter));
    auto by_shader = good, clamped = good, nowhere = good, lost = good;
    by_shader.by_shader = true;
    clamped.near_plane = false;
    nowhere.unknown_elsewhere = true;
    lost.clip_from_object[0] = NAN;
    EXPECT_FALSE(SnapGrid::make(by_shader, kOneToOne, kQuarter));
    EXPECT_FALSE(SnapGrid::make(clamped, kOneToOne, kQuarter));
    EXPECT_FALSE(SnapGrid::make(nowhere, kOneToOne, kQuarter));
    EXPECT_FALSE(SnapGrid::make(lost, kOneToOne, kQuarter));
    EXPECT_FALSE(SnapGrid::make(projection_of(glstate::Mat4{}), kOneToOne, kQuarter)) << "all on one point";
    EXPECT_FALSE(SnapGrid::make(good, kOneToOne, 0));
    const auto grid = SnapGrid::make(good, kOneToOne, kQuarter);
    for (const float odd : {INFINITY, 1e30f, 3e8f}) {
        const auto p = point_of(grid->snapped(_mm_setr_ps(odd, -odd, -20, 1), 0));
        EXPECT_EQ(p[0], static_cast<double>(odd));
        EXPECT_EQ(p[1], -static_cast<double>(odd));
    }
    EXPECT_TRUE(std::isnan(point_of(grid->snapped(_mm_setr_ps(NAN, 0, -20, 1), 0))[0]));
}

TEST_F(SnapTest, MovesTheVerticesAndNormalsOfABlock) {
    const auto grid = SnapGrid::make(projection_of(frustum(0.5, 1, 1, 1000)), kOneToOne, kQuarter);
    packer.begin(GL_TRIANGLES);
    gl_entry_Normal3f(0.12345678f, 0.23456789f, 0.96416967f);
    gl_entry_Vertex3f(1.2345678f, 2.3456789f, -20.123456f);
    gl_entry_Vertex2f(0.12345678f, 0.23456789f);
    gl_entry_Normal3f(0.12345678f, 0.23456789f, 0.96416967f);
    gl_entry_Vertex3f(1.2345678f, 2.3456789f, -20.123456f);
    packer.end();
    const Snapped done = snap(packer, {}, packer.mark(), *grid, 0, true);
    EXPECT_EQ(done.vertices, 3u);
    EXPECT_GT(done.farthest, 0);
    EXPECT_LE(done.farthest, 0.25);
    const auto value = [&](std::size_t index) {
        float out = 0;
        std::memcpy(&out, packer.operand_at(index * sizeof out), sizeof out);
        return out;
    };
    constexpr std::size_t kNormal = 1, kFirst = 4, kLastNormal = 9, kLast = 12;  // behind Begin's mode
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NE(value(kFirst + i), value(kNormal + i));
        EXPECT_EQ(value(kFirst + i), value(kLast + i)) << "the same vertex is put on the same place";
    }
    EXPECT_NEAR(value(kFirst), 1.2345678f, 0.05);
    EXPECT_NEAR(value(kNormal), 0.12345678f, 0.001);
    EXPECT_NE(value(kNormal), 0.12345678f);
    EXPECT_EQ(value(kLastNormal), 0.12345678f) << "the current one behind the block";
}

TEST_F(SnapTest, KnowsHowFarPrimitivesReachThatGoBehindTheEye) {
    const auto grid = SnapGrid::make(projection_of(frustum(0.5, 1, 1, 1000)), kOneToOne, kQuarter);
    const auto line = [&](float from, float to) {
        packer.begin(GL_LINES);
        gl_entry_Vertex3f(0, 0, -from);
        gl_entry_Vertex3f(0, 0, -to);
        packer.end();
    };
    line(50, 60);
    EXPECT_EQ(reach_behind(packer, *grid), 0);
    line(0.001f, 70);
    EXPECT_EQ(reach_behind(packer, *grid), 0) << "before the near plane, and in front of the eye";
    line(-1, 20);
    line(-100, 10);
    EXPECT_NEAR(reach_behind(packer, *grid), 20, 1e-3);
    EXPECT_GT(reach_behind(packer, *grid), 20) << "as its vertices may have been rounded";
}

}  // namespace
}  // namespace wall::client
