// SPDX-License-Identifier: MIT
#include "client_lib/context/element_bounds.h"

#include <gtest/gtest.h>

#include <array>

namespace wall::client {
namespace {

using Floats = std::array<float, 4>;

Floats floats(__m128 v) {
    Floats out;
    _mm_storeu_ps(out.data(), v);
    return out;
}

ArraySource positions(std::span<const float> values, GLint size) {
    return array_source({.buffer = ClientName(1), .type = GL_FLOAT, .size = size}, std::as_bytes(values));
}

ElementRange indexed(std::span<const GLushort> indices) {
    ElementRange out;
    out.count = static_cast<GLsizei>(indices.size());
    out.type = GL_UNSIGNED_SHORT;
    out.indices = indices.data();
    return out;
}

constexpr float kThree[] = {0, 0, 0, 1, 2, 3, -4, 5, -6, 100, 100, 100};

TEST(ElementBounds, AreThoseOfTheElementsThatAreDrawn) {
    constexpr GLushort kIndices[] = {1, 2, 1};
    const auto bounds = bounds_of(positions(kThree, 3), indexed(kIndices), {});
    EXPECT_EQ(floats(bounds.box.min)[0], -4);
    EXPECT_EQ(floats(bounds.box.max)[1], 5);
    EXPECT_EQ(floats(bounds.box.min)[2], -6);
    EXPECT_EQ(bounds.last, 2u);
    EXPECT_TRUE(bounds.pieces.empty());
    ElementRange row;
    row.first = 1;
    row.count = 3;
    EXPECT_EQ(bounds_of(positions(kThree, 3), row, {}).last, 3u);
}

TEST(ElementBounds, ABaseIsAddedAndARestartIsNoElement) {
    constexpr GLushort kIndices[] = {0, 0xffff, 1};
    ElementRange range = indexed(kIndices);
    range.base_vertex = 1;
    range.restart = 0xffff;
    const auto bounds = bounds_of(positions(kThree, 3), range, {});
    EXPECT_EQ(bounds.first, 1u);
    EXPECT_EQ(bounds.last, 2u);
    EXPECT_EQ(floats(bounds.box.min)[0], -4);
    range.base_vertex = -1;
    EXPECT_EQ(bounds_of(positions(kThree, 3), range, {}).last, ~GLuint{0}) << "before the first";
}

TEST(ElementBounds, OfPlanePositionsHaveNoDepth) {
    ElementRange row;
    row.count = 2;
    const auto bounds = bounds_of(positions(kThree, 2), row, {});
    EXPECT_EQ(floats(bounds.box.max)[2], 0);
}

TEST(ElementBounds, NothingBoundsAVertexWithAWOfItsOwn) {
    ElementRange row;
    row.count = 3;
    constexpr float kFour[] = {0, 0, 0, 1, 2, 3, 4, 1, 2, 3, 4, 0.5f};
    EXPECT_TRUE(bounds_of(positions(kFour, 4), row, glstate::Cut{1, 0}).box.unbounded());
    EXPECT_TRUE(bounds_of(positions(kFour, 4), row, glstate::Cut{1, 0}).pieces.empty());
    row.count = 2;
    EXPECT_FALSE(bounds_of(positions(kFour, 4), row, {}).box.unbounded());
}

TEST(ElementBounds, AnElementBeyondTheArrayIsToldAndNotLookedAt) {
    constexpr GLushort kIndices[] = {0, 60000};
    const auto bounds = bounds_of(positions(kThree, 3), indexed(kIndices), {});
    EXPECT_EQ(bounds.last, 60000u);
    EXPECT_EQ(floats(bounds.box.max)[0], 0);
}

TEST(ElementBounds, EachPieceHasItsOwnWithWhatItTakesOfTheNext) {
    constexpr GLushort kIndices[] = {0, 1, 2, 3};
    const auto apart = bounds_of(positions(kThree, 3), indexed(kIndices), glstate::Cut{2, 0});
    ASSERT_EQ(apart.pieces.size(), 2u);
    EXPECT_EQ(apart.pieces[0].max[0], 1);
    EXPECT_EQ(apart.pieces[1].max[0], 100);
    EXPECT_EQ(apart.pieces[1].min[0], -4);
    const auto strip = bounds_of(positions(kThree, 3), indexed(kIndices), glstate::Cut{2, 1});
    EXPECT_EQ(strip.pieces[0].min[0], -4);
}

}  // namespace
}  // namespace wall::client
