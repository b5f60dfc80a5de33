// SPDX-License-Identifier: MIT
// The S3TC block formats (EXT_texture_compression_s3tc, EXT_texture_sRGB), decoded for glGetTexImage. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/glapi/block_formats.h"

namespace wall::client {

using glapi::kBlockSide;

/// Whether a part (first texel, texels, in one direction) of an image is made of blocks of so many texels; it may end
/// with the image.
constexpr bool is_whole_blocks(std::int32_t at, std::int32_t size, std::int32_t all, std::int32_t side) {
    return at % side == 0 && (size % side == 0 || std::int64_t{at} + size == all);
}
/// glapi::block_size, block_bytes and blocks_bytes of an internal format as programs give it.
constexpr glapi::BlockSize block_size(GLint internal_format) {
    return glapi::block_size(static_cast<GLenum>(internal_format));
}
constexpr std::size_t block_bytes(GLint internal_format) {
    return glapi::block_bytes(static_cast<GLenum>(internal_format));
}
constexpr std::size_t blocks_bytes(GLint internal_format, std::int32_t width, std::int32_t height) {
    return glapi::blocks_bytes(static_cast<GLenum>(internal_format), width, height);
}
/// Bytes of a row of blocks.
constexpr std::size_t row_of_blocks_bytes(GLint internal_format, std::int32_t width) {
    return blocks_bytes(internal_format, width, 1);
}
/// Whether decode_s3tc() knows it.
bool is_s3tc(GLint internal_format);
/// RGBA bytes, row by row, the curve of sRGB kept. `blocks` has blocks_bytes() bytes.
std::vector<std::byte> decode_s3tc(GLint internal_format, std::int32_t width, std::int32_t height,
                                   std::span<const std::byte> blocks);

}  // namespace wall::client
