// SPDX-License-Identifier: MIT
#include "client_lib/objects/texture_formats.h"

#include <algorithm>
#include <iterator>

namespace wall::client {
namespace {

// What glGetTexLevelParameter answers on llvmpipe of Mesa 22.3, red, green, blue, alpha, luminance, intensity, depth,
// stencil.
constexpr TextureFormat kFormats[] = {
    {1, GL_LUMINANCE, 1, {0, 0, 0, 0, 8, 0, 0, 0}, 0, false},
    {2, GL_LUMINANCE_ALPHA, 2, {0, 0, 0, 8, 8, 0, 0, 0}, 0, false},
    {3, GL_RGB, 3, {8, 8, 8, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {4, GL_RGBA, 4, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_ALPHA, GL_ALPHA, GL_ALPHA, {0, 0, 0, 8, 0, 0, 0, 0}, 0, false},
    {GL_ALPHA4, GL_ALPHA, GL_ALPHA4, {0, 0, 0, 8, 0, 0, 0, 0}, 0, false},
    {GL_ALPHA8, GL_ALPHA, GL_ALPHA8, {0, 0, 0, 8, 0, 0, 0, 0}, 0, false},
    {GL_ALPHA12, GL_ALPHA, GL_ALPHA12, {0, 0, 0, 16, 0, 0, 0, 0}, 0, false},
    {GL_ALPHA16, GL_ALPHA, GL_ALPHA16, {0, 0, 0, 16, 0, 0, 0, 0}, 0, false},
    {GL_LUMINANCE, GL_LUMINANCE, GL_LUMINANCE, {0, 0, 0, 0, 8, 0, 0, 0}, 0, false},
    {GL_LUMINANCE4, GL_LUMINANCE, GL_LUMINANCE4, {0, 0, 0, 0, 8, 0, 0, 0}, 0, false},
    {GL_LUMINANCE8, GL_LUMINANCE, GL_LUMINANCE8, {0, 0, 0, 0, 8, 0, 0, 0}, 0, false},
    {GL_LUMINANCE12, GL_LUMINANCE, GL_LUMINANCE12, {0, 0, 0, 0, 16, 0, 0, 0}, 0, false},
    {GL_LUMINANCE16, GL_LUMINANCE, GL_LUMINANCE16, {0, 0, 0, 0, 16, 0, 0, 0}, 0, false},
    {GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, {0, 0, 0, 8, 8, 0, 0, 0}, 0, false},
    {GL_LUMINANCE4_ALPHA4, GL_LUMINANCE_ALPHA, GL_LUMINANCE4_ALPHA4, {0, 0, 0, 4, 4, 0, 0, 0}, 0, false},
    {GL_LUMINANCE6_ALPHA2, GL_LUMINANCE_ALPHA, GL_LUMINANCE6_ALPHA2, {0, 0, 0, 8, 8, 0, 0, 0}, 0, false},
    {GL_LUMINANCE8_ALPHA8, GL_LUMINANCE_ALPHA, GL_LUMINANCE8_ALPHA8, {0, 0, 0, 8, 8, 0, 0, 0}, 0, false},
    {GL_LUMINANCE12_ALPHA4, GL_LUMINANCE_ALPHA, GL_LUMINANCE12_ALPHA4, {0, 0, 0, 16, 16, 0, 0, 0}, 0, false},
    {GL_LUMINANCE12_ALPHA12, GL_LUMINANCE_ALPHA, GL_LUMINANCE12_ALPHA12, {0, 0, 0, 16, 16, 0, 0, 0}, 0, false},
    {GL_LUMINANCE16_ALPHA16, GL_LUMINANCE_ALPHA, GL_LUMINANCE16_ALPHA16, {0, 0, 0, 16, 16, 0, 0, 0}, 0, false},
    {GL_INTENSITY, GL_INTENSITY, GL_INTENSITY, {0, 0, 0, 0, 0, 8, 0, 0}, 0, false},
    {GL_INTENSITY4, GL_INTENSITY, GL_INTENSITY4, {0, 0, 0, 0, 0, 8, 0, 0}, 0, false},
    {GL_INTENSITY8, GL_INTENSITY, GL_INTENSITY8, {0, 0, 0, 0, 0, 8, 0, 0}, 0, false},
    {GL_INTENSITY12, GL_INTENSITY, GL_INTENSITY12, {0, 0, 0, 0, 0, 16, 0, 0}, 0, false},
    {GL_INTENSITY16, GL_INTENSITY, GL_INTENSITY16, {0, 0, 0, 0, 0, 16, 0, 0}, 0, false},
    {GL_RGB, GL_RGB, GL_RGB, {8, 8, 8, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_R3_G3_B2, GL_RGB, GL_R3_G3_B2, {3, 3, 2, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB4, GL_RGB, GL_RGB4, {4, 4, 4, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB5, GL_RGB, GL_RGB5, {5, 5, 5, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB565, GL_RGB, GL_RGB565, {5, 6, 5, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB8, GL_RGB, GL_RGB8, {8, 8, 8, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB10, GL_RGB, GL_RGB10, {10, 10, 10, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB12, GL_RGB, GL_RGB12, {16, 16, 16, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB16, GL_RGB, GL_RGB16, {16, 16, 16, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGBA, GL_RGBA, GL_RGBA, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGBA2, GL_RGBA, GL_RGBA2, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGBA4, GL_RGBA, GL_RGBA4, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB5_A1, GL_RGBA, GL_RGB5_A1, {5, 5, 5, 1, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGBA8, GL_RGBA, GL_RGBA8, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGB10_A2, GL_RGBA, GL_RGB10_A2, {10, 10, 10, 2, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGBA12, GL_RGBA, GL_RGBA12, {16, 16, 16, 16, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RGBA16, GL_RGBA, GL_RGBA16, {16, 16, 16, 16, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT, {0, 0, 0, 0, 0, 0, 16, 0}, 0, false},
    {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT16, {0, 0, 0, 0, 0, 0, 16, 0}, 0, false},
    {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT24, {0, 0, 0, 0, 0, 0, 24, 0}, 0, false},
    {GL_DEPTH_COMPONENT32, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT32, {0, 0, 0, 0, 0, 0, 32, 0}, 0, false},
    {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT32F, {0, 0, 0, 0, 0, 0, 32, 0}, 0, false},
    {GL_DEPTH_STENCIL, GL_DEPTH_STENCIL, GL_DEPTH_STENCIL, {0, 0, 0, 0, 0, 0, 24, 8}, 0, false},
    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_DEPTH24_STENCIL8, {0, 0, 0, 0, 0, 0, 24, 8}, 0, false},
    {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_DEPTH32F_STENCIL8, {0, 0, 0, 0, 0, 0, 32, 8}, 0, false},
    {GL_COMPRESSED_ALPHA, GL_ALPHA, 0x1906, {0, 0, 0, 8, 0, 0, 0, 0}, 0, false},
    {GL_COMPRESSED_LUMINANCE, GL_LUMINANCE, 0x8C70, {0, 0, 0, 0, 8, 0, 0, 0}, 0, true},
    {GL_COMPRESSED_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, 0x8C72, {0, 0, 0, 8, 8, 0, 0, 0}, 0, true},
    {GL_COMPRESSED_INTENSITY, GL_INTENSITY, 0x8049, {0, 0, 0, 0, 0, 8, 0, 0}, 0, false},
    {GL_COMPRESSED_RGB, GL_RGB, 0x83F0, {4, 4, 4, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_RGBA, GL_RGBA, 0x83F3, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_RGB, 0x83F0, {4, 4, 4, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, GL_RGBA, 0x83F1, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, GL_RGBA, 0x83F2, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_RGBA, 0x83F3, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_SRGB, GL_RGB, GL_SRGB, {8, 8, 8, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_SRGB8, GL_RGB, GL_SRGB8, {8, 8, 8, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_SRGB_ALPHA, GL_RGBA, GL_SRGB_ALPHA, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_SRGB8_ALPHA8, GL_RGBA, GL_SRGB8_ALPHA8, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_SLUMINANCE, GL_LUMINANCE, GL_SLUMINANCE, {0, 0, 0, 0, 8, 0, 0, 0}, 0, false},
    {GL_SLUMINANCE8, GL_LUMINANCE, GL_SLUMINANCE8, {0, 0, 0, 0, 8, 0, 0, 0}, 0, false},
    {GL_SLUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_SLUMINANCE_ALPHA, {0, 0, 0, 8, 8, 0, 0, 0}, 0, false},
    {GL_SLUMINANCE8_ALPHA8, GL_LUMINANCE_ALPHA, GL_SLUMINANCE8_ALPHA8, {0, 0, 0, 8, 8, 0, 0, 0}, 0, false},
    {GL_RED, GL_RED, GL_RED, {8, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_R8, GL_RED, GL_R8, {8, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_R16, GL_RED, GL_R16, {16, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RG, GL_RG, GL_RG, {8, 8, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RG8, GL_RG, GL_RG8, {8, 8, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_RG16, GL_RG, GL_RG16, {16, 16, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, false},
    {GL_R16F, GL_RED, GL_R16F, {16, 0, 0, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_R32F, GL_RED, GL_R32F, {32, 0, 0, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RG16F, GL_RG, GL_RG16F, {16, 16, 0, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RG32F, GL_RG, GL_RG32F, {32, 32, 0, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RGB16F, GL_RGB, GL_RGB16F, {16, 16, 16, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RGB32F, GL_RGB, GL_RGB32F, {32, 32, 32, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RGBA16F, GL_RGBA, GL_RGBA16F, {16, 16, 16, 16, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RGBA32F, GL_RGBA, GL_RGBA32F, {32, 32, 32, 32, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_ALPHA16F_ARB, GL_ALPHA, GL_ALPHA16F_ARB, {0, 0, 0, 16, 0, 0, 0, 0}, 0, false},
    {GL_ALPHA32F_ARB, GL_ALPHA, GL_ALPHA32F_ARB, {0, 0, 0, 32, 0, 0, 0, 0}, 0, false},
    {GL_LUMINANCE16F_ARB, GL_LUMINANCE, GL_LUMINANCE16F_ARB, {0, 0, 0, 0, 16, 0, 0, 0}, 0, false},
    {GL_LUMINANCE32F_ARB, GL_LUMINANCE, GL_LUMINANCE32F_ARB, {0, 0, 0, 0, 32, 0, 0, 0}, 0, false},
    {GL_LUMINANCE_ALPHA16F_ARB, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA16F_ARB, {0, 0, 0, 16, 16, 0, 0, 0}, 0, false},
    {GL_LUMINANCE_ALPHA32F_ARB, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA32F_ARB, {0, 0, 0, 32, 32, 0, 0, 0}, 0, false},
    {GL_INTENSITY16F_ARB, GL_INTENSITY, GL_INTENSITY16F_ARB, {0, 0, 0, 0, 0, 16, 0, 0}, 0, false},
    {GL_INTENSITY32F_ARB, GL_INTENSITY, GL_INTENSITY32F_ARB, {0, 0, 0, 0, 0, 32, 0, 0}, 0, false},
    {GL_R11F_G11F_B10F, GL_RGB, GL_R11F_G11F_B10F, {11, 11, 10, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_RGB9_E5, GL_RGB, GL_RGB9_E5, {9, 9, 9, 0, 0, 0, 0, 0}, GL_FLOAT, false},
    {GL_R8_SNORM, GL_RED, GL_R8_SNORM, {8, 0, 0, 0, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_RG8_SNORM, GL_RG, GL_RG8_SNORM, {8, 8, 0, 0, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_RGB8_SNORM, GL_RGB, GL_RGB8_SNORM, {8, 8, 8, 0, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_RGBA8_SNORM, GL_RGBA, GL_RGBA8_SNORM, {8, 8, 8, 8, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_R16_SNORM, GL_RED, GL_R16_SNORM, {16, 0, 0, 0, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_RG16_SNORM, GL_RG, GL_RG16_SNORM, {16, 16, 0, 0, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_RGB16_SNORM, GL_RGB, GL_RGB16_SNORM, {16, 16, 16, 0, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_RGBA16_SNORM, GL_RGBA, GL_RGBA16_SNORM, {16, 16, 16, 16, 0, 0, 0, 0}, GL_SIGNED_NORMALIZED, false},
    {GL_R8I, GL_RED, GL_R8I, {8, 0, 0, 0, 0, 0, 0, 0}, GL_INT, false},
    {GL_R8UI, GL_RED, GL_R8UI, {8, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, false},
    {GL_RGBA8I, GL_RGBA, GL_RGBA8I, {8, 8, 8, 8, 0, 0, 0, 0}, GL_INT, false},
    {GL_RGBA8UI, GL_RGBA, GL_RGBA8UI, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_INT, false},
    {GL_RGBA16I, GL_RGBA, GL_RGBA16I, {16, 16, 16, 16, 0, 0, 0, 0}, GL_INT, false},
    {GL_RGBA16UI, GL_RGBA, GL_RGBA16UI, {16, 16, 16, 16, 0, 0, 0, 0}, GL_UNSIGNED_INT, false},
    {GL_RGBA32I, GL_RGBA, GL_RGBA32I, {32, 32, 32, 32, 0, 0, 0, 0}, GL_INT, false},
    {GL_RGBA32UI, GL_RGBA, GL_RGBA32UI, {32, 32, 32, 32, 0, 0, 0, 0}, GL_UNSIGNED_INT, false},
    {GL_COMPRESSED_RED, GL_RED, 0x8DBB, {8, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_RG, GL_RG, 0x8DBD, {8, 8, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_SRGB, GL_RGB, 0x8C4C, {4, 4, 4, 0, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_COMPRESSED_SRGB_ALPHA, GL_RGBA, 0x8C4E, {4, 4, 4, 4, 0, 0, 0, 0}, GL_UNSIGNED_NORMALIZED, true},
    {GL_STENCIL_INDEX8, GL_STENCIL_INDEX, GL_STENCIL_INDEX8, {0, 0, 0, 0, 0, 0, 0, 8}, 0, false},
};

/// Unsized formats for which the driver takes the storage of the pixels when they fit (st_choose_matching_format).
struct Matching {
    GLenum base, format, type;
    ComponentBits bits;
};
constexpr Matching kMatching[] = {
    {GL_RGB, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, {5, 6, 5, 0, 0, 0, 0, 0}},
    {GL_RGB, GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, {5, 5, 5, 0, 0, 0, 0, 0}},
    {GL_RGB, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, {10, 10, 10, 0, 0, 0, 0, 0}},
    {GL_RGB, GL_RGB, GL_UNSIGNED_BYTE_3_3_2, {3, 3, 2, 0, 0, 0, 0, 0}},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, {4, 4, 4, 4, 0, 0, 0, 0}},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, {5, 5, 5, 1, 0, 0, 0, 0}},
    {GL_RGBA, GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV, {5, 5, 5, 1, 0, 0, 0, 0}},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, {10, 10, 10, 2, 0, 0, 0, 0}},
};

}  // namespace

const TextureFormat* find_texture_format(GLint internal_format) {
    const auto* at = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const TextureFormat& row) { return row.internal_format == internal_format; });
    return at == std::end(kFormats) ? nullptr : at;
}

ComponentBits stored_bits(const TextureFormat& row, GLenum format, GLenum type) {
    const auto internal = static_cast<GLenum>(row.internal_format);
    if (internal == GL_DEPTH_COMPONENT && type != GL_UNSIGNED_SHORT) return {0, 0, 0, 0, 0, 0, 24, 0};
    if (internal != GL_RGB && internal != GL_RGBA) return row.bits;
    for (const Matching& m : kMatching)
        if (m.base == internal && m.format == format && m.type == type) return m.bits;
    return row.bits;
}

}  // namespace wall::client
