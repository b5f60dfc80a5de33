// SPDX-License-Identifier: MIT
#include "client_lib/objects/blend_support.h"

#include <gtest/gtest.h>

#include <bit>

namespace wall::client {
namespace {

TEST(BlendSupport, EachEquationHasABit) {
    EXPECT_EQ(advanced_equation_bit(GL_FUNC_ADD), 0u);
    EXPECT_EQ(advanced_equation_bit(GL_MAX), 0u);
    std::uint32_t all = 0;
    for (GLenum word = GL_MULTIPLY_KHR; word <= GL_HSL_LUMINOSITY_KHR; ++word) all |= advanced_equation_bit(word);
    EXPECT_EQ(std::popcount(all), 15);
    EXPECT_EQ(blend_support_of("layout(blend_support_all_equations) out;"), all);
}

TEST(BlendSupport, IsWhatShadersName) {
    EXPECT_EQ(blend_support_of("void main() {}"), 0u);
    EXPECT_EQ(blend_support_of("layout(blend_support_screen, blend_support_hsl_color) out;"),
              advanced_equation_bit(GL_SCREEN_KHR) | advanced_equation_bit(GL_HSL_COLOR_KHR));
    EXPECT_EQ(blend_support_of("layout(blend_support_colordodge) out;"), advanced_equation_bit(GL_COLORDODGE_KHR));
    EXPECT_EQ(blend_support_of("blend_support_"), 0u);
}

}  // namespace
}  // namespace wall::client
