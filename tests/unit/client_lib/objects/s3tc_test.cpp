// SPDX-License-Identifier: MIT
#include "client_lib/objects/s3tc.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
    std::vector<std::byte> out;
    for (const int value : values) out.push_back(static_cast<std::byte>(value));
    return out;
}

TEST(S3tc, Sizes) {
    EXPECT_EQ(blocks_bytes(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 5, 4), 16u);
    EXPECT_EQ(blocks_bytes(GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, 1, 1), 16u);
    EXPECT_EQ(blocks_bytes(GL_RGBA, 4, 4), 0u);
}

TEST(S3tc, FourAndThreeColours) {
    // Red above blue; the first four texels use the four codes.
    const auto four =
        decode_s3tc(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 4, 1, bytes({0x00, 0xf8, 0x1f, 0x00, 0b11100100, 0, 0, 0}));
    EXPECT_EQ(four, bytes({255, 0, 0, 255, 0, 0, 255, 255, 170, 0, 85, 255, 85, 0, 170, 255}));
    const auto three =
        decode_s3tc(GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, 4, 1, bytes({0x1f, 0x00, 0x00, 0xf8, 0b11100100, 0, 0, 0}));
    EXPECT_EQ(three, bytes({0, 0, 255, 255, 255, 0, 0, 255, 127, 0, 127, 255, 0, 0, 0, 0}));
}

TEST(S3tc, Alpha) {
    const auto dxt3 = decode_s3tc(GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, 2, 1,
                                  bytes({0xf8, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(dxt3, bytes({255, 255, 255, 136, 255, 255, 255, 255}));
    const auto dxt5 = decode_s3tc(GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, 3, 1,
                                  bytes({140, 0, 0b10001000, 0, 0, 0, 0, 0, 0xff, 0xff, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(dxt5, bytes({255, 255, 255, 140, 255, 255, 255, 0, 255, 255, 255, 120}));
}

}  // namespace
}  // namespace wall::client
