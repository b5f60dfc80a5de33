// SPDX-License-Identifier: MIT
// Images of palettes: their sizes, and which colour each texel has.
#include "client_lib/objects/palette_image.h"

#include <gtest/gtest.h>

#include <vector>

namespace wall::client {
namespace {

TEST(PaletteImage, HasTenFormats) {
    EXPECT_FALSE(palette_format(GL_PALETTE4_RGB8_OES - 1));
    EXPECT_FALSE(palette_format(GL_PALETTE8_RGB5_A1_OES + 1));
    const auto small = palette_format(GL_PALETTE4_RGB5_A1_OES), large = palette_format(GL_PALETTE8_RGBA8_OES);
    ASSERT_TRUE(small && large);
    EXPECT_EQ(small->colors.type, GLenum{GL_UNSIGNED_SHORT_5_5_5_1});
    EXPECT_EQ(small->palette_bytes(), 32u);
    EXPECT_EQ(large->colors.format, GLenum{GL_RGBA});
    EXPECT_EQ(large->palette_bytes(), 1024u);
}

TEST(PaletteImage, HasItsLevelsInARow) {
    const PaletteFormat format = *palette_format(GL_PALETTE4_R5_G6_B5_OES);
    EXPECT_EQ(palette_image_bytes(format, 5, 3, 1), 32u + 8);
    EXPECT_EQ(palette_image_bytes(format, 5, 3, 3), 32u + 8 + 1 + 1);
    EXPECT_EQ(palette_image_bytes(format, 0, 3, 1), 32u);
}

TEST(PaletteImage, FindsTheColorOfEachTexel) {
    const PaletteFormat format = *palette_format(GL_PALETTE4_RGBA4_OES);
    std::vector<std::byte> image(palette_image_bytes(format, 3, 1, 2));
    for (std::size_t i = 0; i < 16; ++i) image[2 * i] = std::byte(i);
    image[32] = std::byte{0x5A}, image[33] = std::byte{0xF0}, image[34] = std::byte{0x70};
    const std::byte zero{};
    EXPECT_EQ(palette_texels(format, 3, 1, 0, image),
              (std::vector<std::byte>{std::byte{5}, zero, std::byte{10}, zero, std::byte{15}, zero}));
    EXPECT_EQ(palette_texels(format, 3, 1, 1, image), (std::vector<std::byte>{std::byte{7}, zero}));
}

}  // namespace
}  // namespace wall::client
