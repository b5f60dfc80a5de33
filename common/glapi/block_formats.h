// SPDX-License-Identifier: MIT
// Sizes of compressed images: the S3TC formats (EXT_texture_compression_s3tc, EXT_texture_sRGB) and RGTC (OpenGL 3.0,
// appendix C), which both ends hold against what they are given. Pure.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

inline constexpr std::int32_t kBlockSide = 4;  ///< texels a side

/// Bytes of a block; 0: not one of the formats.
constexpr std::size_t block_bytes(GLenum format) {
    switch (format) {
        case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
        case GL_COMPRESSED_RGBA_S3TC_DXT1_EXT:
        case GL_COMPRESSED_SRGB_S3TC_DXT1_EXT:
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT:
        case GL_COMPRESSED_RED_RGTC1:
        case GL_COMPRESSED_SIGNED_RED_RGTC1: return 8;
        case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
        case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT:
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT:
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT:
        case GL_COMPRESSED_RG_RGTC2:
        case GL_COMPRESSED_SIGNED_RG_RGTC2: return 16;
        default: return 0;
    }
}

/// Bytes of an image, neither side negative; 0: not one of the formats, or nothing in it.
constexpr std::size_t blocks_bytes(GLenum format, std::int32_t width, std::int32_t height) {
    const auto blocks = [](std::int32_t texels) {
        return (static_cast<std::size_t>(texels) + kBlockSide - 1) / kBlockSide;
    };
    return blocks(width) * blocks(height) * block_bytes(format);
}

}  // namespace wall::glapi
