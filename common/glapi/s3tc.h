// SPDX-License-Identifier: MIT
// Sizes of images in the S3TC formats (EXT_texture_compression_s3tc), which both ends hold against what they are given.
// Pure.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

inline constexpr std::int32_t kS3tcBlock = 4;  ///< texels a side

/// Bytes of a block; 0: not one of the formats.
constexpr std::size_t s3tc_block_bytes(GLenum format) {
    switch (format) {
        case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
        case GL_COMPRESSED_RGBA_S3TC_DXT1_EXT: return 8;
        case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
        case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT: return 16;
        default: return 0;
    }
}

/// Bytes of an image, neither side negative; 0: not one of the formats, or nothing in it.
constexpr std::size_t s3tc_bytes(GLenum format, std::int32_t width, std::int32_t height) {
    const auto blocks = [](std::int32_t texels) {
        return (static_cast<std::size_t>(texels) + kS3tcBlock - 1) / kS3tcBlock;
    };
    return blocks(width) * blocks(height) * s3tc_block_bytes(format);
}

}  // namespace wall::glapi
