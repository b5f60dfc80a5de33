// SPDX-License-Identifier: MIT
// Sizes of compressed images: the S3TC formats (EXT_texture_compression_s3tc, EXT_texture_sRGB), RGTC (OpenGL 3.0,
// appendix C), BPTC (OpenGL 4.2, appendix C.2), ETC2 and EAC (OpenGL 4.3, appendix C), which both ends hold against
// what they are given. Pure.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/glapi/gl_types.h"
#include "common/glapi/texture_target.h"

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
        case GL_COMPRESSED_SIGNED_RED_RGTC1:
        case GL_COMPRESSED_R11_EAC:
        case GL_COMPRESSED_SIGNED_R11_EAC:
        case GL_COMPRESSED_RGB8_ETC2:
        case GL_COMPRESSED_SRGB8_ETC2:
        case GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2:
        case GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2: return 8;
        case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
        case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT:
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT:
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT:
        case GL_COMPRESSED_RG_RGTC2:
        case GL_COMPRESSED_SIGNED_RG_RGTC2:
        case GL_COMPRESSED_RGBA_BPTC_UNORM:
        case GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM:
        case GL_COMPRESSED_RGB_BPTC_SIGNED_FLOAT:
        case GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT:
        case GL_COMPRESSED_RG11_EAC:
        case GL_COMPRESSED_SIGNED_RG11_EAC:
        case GL_COMPRESSED_RGBA8_ETC2_EAC:
        case GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC: return 16;
        default: return 0;
    }
}

/// Of the blocks of ETC2 and EAC, which drivers read and do not make.
constexpr bool is_etc2(GLenum format) {
    return format >= GL_COMPRESSED_R11_EAC && format <= GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC;
}

/// Of the blocks that three-dimensional images may be made of, slice by slice (OpenGL 4.2, 3.9.5: of those here only
/// BPTC).
constexpr bool is_for_volumes(GLenum format) {
    return format >= GL_COMPRESSED_RGBA_BPTC_UNORM && format <= GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT;
}

/// Whether a target's images may be made of a format's blocks.
constexpr bool may_have_blocks(const TextureTargetInfo& target, GLenum format) {
    return target.blocks || (spatial_dimensions_of(target) == 3 && is_for_volumes(format));
}

/// Bytes of an image, neither side negative; 0: not one of the formats, or nothing in it.
constexpr std::size_t blocks_bytes(GLenum format, std::int32_t width, std::int32_t height) {
    const auto blocks = [](std::int32_t texels) {
        return (static_cast<std::size_t>(texels) + kBlockSide - 1) / kBlockSide;
    };
    return blocks(width) * blocks(height) * block_bytes(format);
}

}  // namespace wall::glapi
