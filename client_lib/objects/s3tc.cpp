// SPDX-License-Identifier: MIT
#include "client_lib/objects/s3tc.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace wall::client {
namespace {

using Texel = std::array<std::uint8_t, 4>;

std::uint32_t load(const std::byte* at, std::size_t bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, bytes);
    return value;
}

Texel from_565(std::uint32_t c) {
    const std::uint32_t r = c >> 11 & 31, g = c >> 5 & 63, b = c & 31;
    return {static_cast<std::uint8_t>(r << 3 | r >> 2), static_cast<std::uint8_t>(g << 2 | g >> 4),
            static_cast<std::uint8_t>(b << 3 | b >> 2), 255};
}

Texel mixed(const Texel& a, const Texel& b, unsigned of_a, unsigned of_b) {
    Texel out{0, 0, 0, 255};
    for (unsigned i = 0; i < 3; ++i) out[i] = static_cast<std::uint8_t>((a[i] * of_a + b[i] * of_b) / (of_a + of_b));
    return out;
}

/// Eight bytes: two colours and two bits a texel. Only DXT1 has the three-colour mode, whose fourth is black.
std::array<Texel, 16> colors(const std::byte* block, bool dxt1, bool transparent) {
    const std::uint32_t c0 = load(block, 2), c1 = load(block + 2, 2), bits = load(block + 4, 4);
    std::array<Texel, 4> palette{from_565(c0), from_565(c1)};
    if (!dxt1 || c0 > c1) {
        palette[2] = mixed(palette[0], palette[1], 2, 1);
        palette[3] = mixed(palette[0], palette[1], 1, 2);
    } else {
        palette[2] = mixed(palette[0], palette[1], 1, 1);
        palette[3] = {0, 0, 0, static_cast<std::uint8_t>(transparent ? 0 : 255)};
    }
    std::array<Texel, 16> out;
    for (unsigned i = 0; i < 16; ++i) out[i] = palette[bits >> (2 * i) & 3];
    return out;
}

/// DXT3: four bits a texel.
std::uint8_t explicit_alpha(const std::byte* block, unsigned i) {
    return static_cast<std::uint8_t>((std::to_integer<unsigned>(block[i / 2]) >> (4 * (i % 2)) & 15) * 17);
}

/// DXT5: two alphas and three bits a texel.
std::uint8_t interpolated_alpha(const std::byte* block, unsigned i) {
    const unsigned a0 = std::to_integer<unsigned>(block[0]), a1 = std::to_integer<unsigned>(block[1]);
    std::uint64_t bits = 0;
    std::memcpy(&bits, block + 2, 6);
    const unsigned code = bits >> (3 * i) & 7;
    if (code < 2) return static_cast<std::uint8_t>(code == 0 ? a0 : a1);
    if (a0 > a1) return static_cast<std::uint8_t>((a0 * (8 - code) + a1 * (code - 1)) / 7);
    if (code >= 6) return code == 6 ? 0 : 255;
    return static_cast<std::uint8_t>((a0 * (6 - code) + a1 * (code - 1)) / 5);
}

/// The same blocks without the curve of sRGB.
GLint linear_format(GLint format) {
    switch (format) {
        case GL_COMPRESSED_SRGB_S3TC_DXT1_EXT: return GL_COMPRESSED_RGB_S3TC_DXT1_EXT;
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT: return GL_COMPRESSED_RGBA_S3TC_DXT1_EXT;
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT: return GL_COMPRESSED_RGBA_S3TC_DXT3_EXT;
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT: return GL_COMPRESSED_RGBA_S3TC_DXT5_EXT;
        default: return format;
    }
}

std::array<Texel, 16> decode_block(GLint format, const std::byte* block) {
    if (block_bytes(format) == 8) return colors(block, true, format == GL_COMPRESSED_RGBA_S3TC_DXT1_EXT);
    auto out = colors(block + 8, false, false);
    for (unsigned i = 0; i < 16; ++i)
        out[i][3] =
            format == GL_COMPRESSED_RGBA_S3TC_DXT3_EXT ? explicit_alpha(block, i) : interpolated_alpha(block, i);
    return out;
}

}  // namespace

bool is_s3tc(GLint format) {
    const GLint linear = linear_format(format);
    return linear >= GL_COMPRESSED_RGB_S3TC_DXT1_EXT && linear <= GL_COMPRESSED_RGBA_S3TC_DXT5_EXT;
}

std::vector<std::byte> decode_s3tc(GLint internal_format, std::int32_t width, std::int32_t height,
                                   std::span<const std::byte> blocks) {
    const GLint format = linear_format(internal_format);
    std::vector<std::byte> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    const std::byte* block = blocks.data();
    for (std::int32_t y = 0; y < height; y += kBlockSide)
        for (std::int32_t x = 0; x < width; x += kBlockSide, block += block_bytes(format)) {
            const auto texels = decode_block(format, block);
            const std::int32_t columns = std::min(kBlockSide, width - x);
            for (std::int32_t row = 0; row < std::min(kBlockSide, height - y); ++row)
                std::memcpy(out.data() + (static_cast<std::size_t>(y + row) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(x)) *
                                             4,
                            &texels[static_cast<std::size_t>(row * kBlockSide)], static_cast<std::size_t>(columns) * 4);
        }
    return out;
}

}  // namespace wall::client
