// SPDX-License-Identifier: MIT
// Cutting a large draw: every primitive is in one piece, with all of its elements.
#include "common/glstate/pieces.h"

#include <gtest/gtest.h>

#include <utility>

namespace wall::glstate {
namespace {

using Runs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Pieces of a draw whose boxes lie at 0, 1, 2 ... on the x axis.
std::vector<PieceBox> row(std::size_t count) {
    std::vector<PieceBox> out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>(i);
        out.push_back({{x, 0, 0}, {x, 0, 0}});
    }
    return out;
}

Runs runs_of(const Cut& cut, std::size_t pieces, std::uint32_t elements, auto&& wanted) {
    Runs out;
    for_each_run(
        cut, row(pieces), elements,
        [&](const geom::Box& box) { return wanted(static_cast<int>(_mm_cvtss_f32(box.min))); },
        [&](std::uint32_t first, std::uint32_t count) { out.emplace_back(first, count); });
    return out;
}

TEST(Pieces, NeighboursAreDrawnAtOnce) {
    const auto all = [](int) { return true; };
    EXPECT_EQ(runs_of({12, 0}, 4, 40, all), (Runs{{0, 40}}));
    EXPECT_EQ(runs_of({12, 0}, 4, 40, [](int i) { return i != 1; }), (Runs{{0, 12}, {24, 16}}));
    EXPECT_EQ(runs_of({12, 0}, 4, 40, [](int) { return false; }), Runs{});
}

TEST(Pieces, AStripsPieceTakesTheNextOnesFirstElementsAlong) {
    EXPECT_EQ(runs_of({12, 2}, 4, 40, [](int i) { return i == 1; }), (Runs{{12, 14}}));
    EXPECT_EQ(runs_of({12, 2}, 4, 40, [](int i) { return i == 3; }), (Runs{{36, 4}})) << "there is no next one";
}

TEST(Pieces, AreCutWherePrimitivesEnd) {
    for (const GLenum mode : {GL_POINTS, GL_LINES, GL_TRIANGLES, GL_QUADS}) {
        const auto cut = cut_of(mode, 1 << 20);
        ASSERT_TRUE(cut);
        EXPECT_EQ(cut->overlap, 0u);
        EXPECT_EQ(cut->step % 12, 0u) << "of 1, 2, 3 or 4 elements";
    }
    EXPECT_EQ(cut_of(GL_LINE_STRIP, 1 << 20)->overlap, 1u);
    EXPECT_EQ(cut_of(GL_TRIANGLE_STRIP, 1 << 20)->overlap, 2u);
    EXPECT_EQ(cut_of(GL_TRIANGLE_STRIP, 1 << 20)->step % 2, 0u) << "or front and back would change places";
    for (const GLenum mode : {GL_TRIANGLE_FAN, GL_POLYGON, GL_LINE_LOOP}) EXPECT_FALSE(cut_of(mode, 1 << 20));
    EXPECT_FALSE(cut_of(GL_TRIANGLES, kPieceElements)) << "too few to be worth while";
}

TEST(Pieces, AreNeverTooMany) {
    for (std::uint32_t elements = 1 << 12; elements < 1u << 31; elements *= 2) {
        const auto cut = cut_of(GL_TRIANGLES, elements - 1);
        ASSERT_TRUE(cut);
        EXPECT_LE((elements - 1 + cut->step - 1) / cut->step, kMostPieces) << elements;
    }
}

}  // namespace
}  // namespace wall::glstate
