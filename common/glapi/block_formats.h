// SPDX-License-Identifier: MIT
// Sizes of compressed images: the S3TC formats (EXT_texture_compression_s3tc, EXT_texture_sRGB), RGTC (OpenGL 3.0,
// appendix C), BPTC (OpenGL 4.2, appendix C.2), ETC2 and EAC (OpenGL 4.3, appendix C) and ASTC
// (KHR_texture_compression_astc_ldr), which both ends hold against what they are given. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "common/glapi/gl_types.h"
#include "common/glapi/texture_target.h"

namespace wall::glapi {

inline constexpr std::int32_t kBlockSide = 4;  ///< texels a side, but for ASTC

/// Of the blocks of ASTC, by the curve of sRGB or not: of 14 sizes each.
constexpr bool is_astc(GLenum format) {
    return (format >= GL_COMPRESSED_RGBA_ASTC_4x4_KHR && format <= GL_COMPRESSED_RGBA_ASTC_12x12_KHR) ||
           (format >= GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR && format <= GL_COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR);
}

/// Texels of a block.
struct BlockSize {
    std::int32_t width = kBlockSide, height = kBlockSide;
    bool operator==(const BlockSize&) const = default;
};
constexpr BlockSize block_size(GLenum format) {
    constexpr BlockSize kAstc[] = {{4, 4}, {5, 4},  {5, 5},  {6, 5},  {6, 6},   {8, 5},   {8, 6},
                                   {8, 8}, {10, 5}, {10, 6}, {10, 8}, {10, 10}, {12, 10}, {12, 12}};
    static_assert(std::size(kAstc) == GL_COMPRESSED_RGBA_ASTC_12x12_KHR - GL_COMPRESSED_RGBA_ASTC_4x4_KHR + 1);
    if (!is_astc(format)) return {};
    const bool srgb = format >= GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR;
    return kAstc[format - (srgb ? GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR : GL_COMPRESSED_RGBA_ASTC_4x4_KHR)];
}

/// Bytes of a block; 0: not one of the formats.
constexpr std::size_t block_bytes(GLenum format) {
    if (is_astc(format)) return 16;
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

/// Of the blocks of ETC2 and EAC.
constexpr bool is_etc2(GLenum format) {
    return format >= GL_COMPRESSED_R11_EAC && format <= GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC;
}
/// Of blocks that drivers read and do not make.
constexpr bool is_only_given(GLenum format) { return is_etc2(format) || is_astc(format); }

/// Of the blocks that three-dimensional images may be made of, slice by slice (OpenGL 4.2, 3.9.5: BPTC;
/// KHR_texture_compression_astc_sliced_3d).
constexpr bool is_for_volumes(GLenum format) {
    return (format >= GL_COMPRESSED_RGBA_BPTC_UNORM && format <= GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT) ||
           is_astc(format);
}

/// Whether a target's images may be made of a format's blocks.
constexpr bool may_have_blocks(const TextureTargetInfo& target, GLenum format) {
    return target.blocks || (spatial_dimensions_of(target) == 3 && is_for_volumes(format));
}

/// Bytes of an image, neither side negative; 0: not one of the formats, or nothing in it.
constexpr std::size_t blocks_bytes(GLenum format, std::int32_t width, std::int32_t height) {
    const auto blocks = [](std::int32_t texels, std::int32_t side) {
        return (static_cast<std::size_t>(texels) + static_cast<std::size_t>(side) - 1) / static_cast<std::size_t>(side);
    };
    const BlockSize block = block_size(format);
    return blocks(width, block.width) * blocks(height, block.height) * block_bytes(format);
}

}  // namespace wall::glapi
