// SPDX-License-Identifier: MIT
#include "tileserver/objects/triangle_order.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "tileserver/execute/free_order.h"

namespace wall::tileserver {
namespace {

using Indices = std::vector<std::uint32_t>;
using Triangle = std::array<std::uint32_t, 3>;

/// A grid of triangles, the second half of whose vertices have large numbers.
Indices grid(std::uint32_t columns, std::uint32_t rows) {
    Indices out;
    const auto at = [&](std::uint32_t column, std::uint32_t row) {
        return row * (columns + 1) + column + (row > rows / 2 ? 1'000'000u : 0u);
    };
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
            out.insert(out.end(), {at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row),
                                   at(column + 1, row + 1), at(column, row + 1)});
    return out;
}

std::vector<Triangle> triangles_of(std::span<const std::uint32_t> indices) {
    std::vector<Triangle> out;
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3)
        out.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return out;
}

Indices shuffled(const Indices& indices) {
    auto triangles = triangles_of(indices);
    std::ranges::shuffle(triangles, std::mt19937(1));
    Indices out;
    for (const Triangle& each : triangles) out.insert(out.end(), each.begin(), each.end());
    return out;
}

/// Vertices that a cache of 16 processes for each triangle.
double misses(const Indices& indices) {
    return static_cast<double>(meshopt_analyzeVertexCache(indices.data(), indices.size(), 2'000'000, 16, 0, 0).acmr);
}

TEST(TriangleOrder, UsesVerticesAgainSoon) {
    Indices indices = shuffled(grid(64, 64));
    EXPECT_GT(misses(indices), 2.5);
    EXPECT_TRUE(order_triangles(indices, indices.size()));
    EXPECT_LT(misses(indices), 0.75);
}

TEST(TriangleOrder, KeepsEachTriangleAsItIs) {
    const Indices before = shuffled(grid(50, 40));
    Indices after = before;
    ASSERT_TRUE(order_triangles(after, after.size()));
    auto of_before = triangles_of(before), of_after = triangles_of(after);
    EXPECT_NE(of_before, of_after);
    std::ranges::sort(of_before);
    std::ranges::sort(of_after);
    EXPECT_EQ(of_before, of_after) << "with its first vertex first: flat colours are of one of them";
}

TEST(TriangleOrder, StaysWithinItsPieces) {
    constexpr std::size_t kStep = 768;
    const Indices before = shuffled(grid(50, 40));
    Indices after = before;
    ASSERT_TRUE(order_triangles(after, kStep));
    for (std::size_t first = 0; first < before.size(); first += kStep) {
        const std::size_t count = std::min(kStep, before.size() - first);
        auto piece = triangles_of(std::span(before).subspan(first, count)),
             now = triangles_of(std::span(after).subspan(first, count));
        std::ranges::sort(piece);
        std::ranges::sort(now);
        EXPECT_EQ(piece, now) << first;
    }
}

TEST(TriangleOrder, LeavesAGoodOrderAndWhatIsNoTriangle) {
    Indices indices = shuffled(grid(30, 30));
    ASSERT_TRUE(order_triangles(indices, indices.size()));
    const Indices good = indices;
    EXPECT_FALSE(order_triangles(indices, indices.size()));
    EXPECT_EQ(indices, good);
    Indices rest = shuffled(grid(30, 30));
    rest.insert(rest.end(), {7, 8});
    ASSERT_TRUE(order_triangles(rest, rest.size() + 1));
    EXPECT_EQ((std::array{rest[rest.size() - 2], rest.back()}), (std::array{7u, 8u}));
    Indices nothing;
    EXPECT_FALSE(order_triangles(nothing, 3));
    Indices two{1, 2};
    EXPECT_FALSE(order_triangles(two, 3));
}

TEST(FreeOrder, OnlyWhereTheNearestFragmentStaysAlone) {
    glstate::State state;
    EXPECT_FALSE(order_is_free(state)) << "without a depth test the last one stays";
    state.depth_stencil.depth_test = true;
    EXPECT_TRUE(order_is_free(state));
    const auto but = [&](auto&& change) {
        glstate::State changed = state;
        change(changed);
        return order_is_free(changed);
    };
    EXPECT_FALSE(but([](auto& s) { s.depth_stencil.depth_mask = false; }));
    EXPECT_FALSE(but([](auto& s) { s.depth_stencil.depth_func = GL_ALWAYS; }));
    EXPECT_FALSE(but([](auto& s) { s.depth_stencil.depth_func = GL_EQUAL; }));
    EXPECT_TRUE(but([](auto& s) { s.depth_stencil.depth_func = GL_GEQUAL; }));
    EXPECT_FALSE(but([](auto& s) { s.depth_stencil.stencil_test = true; }));
    EXPECT_FALSE(but([](auto& s) { s.color_buffer.blend_enabled = 2; })) << "of any draw buffer";
    EXPECT_FALSE(but([](auto& s) { s.color_buffer.color_logic_op = true; }));
    EXPECT_FALSE(but([](auto& s) { s.polygon.polygon_mode[1] = GL_LINE; }));
    EXPECT_FALSE(but([](auto& s) { s.objects.occlusion_query = 5; })) << "how many fragments pass depends on it";
    EXPECT_FALSE(but([](auto& s) { s.objects.capture = 5; }));
}

}  // namespace
}  // namespace wall::tileserver
