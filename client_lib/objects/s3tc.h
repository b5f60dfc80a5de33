// SPDX-License-Identifier: MIT
// The S3TC block formats (EXT_texture_compression_s3tc): sizes, and decoding for glGetTexImage. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/glapi/s3tc.h"

namespace wall::client {

using glapi::kS3tcBlock;

/// Whether a part (first texel, texels, in one direction) of an image is made of blocks; it may end with the image.
constexpr bool is_whole_blocks(std::int32_t at, std::int32_t size, std::int32_t all) {
    return at % kS3tcBlock == 0 && (size % kS3tcBlock == 0 || at + size == all);
}
/// glapi::s3tc_block_bytes and s3tc_bytes of an internal format as programs give it.
constexpr std::size_t s3tc_block_bytes(GLint internal_format) {
    return glapi::s3tc_block_bytes(static_cast<GLenum>(internal_format));
}
constexpr std::size_t s3tc_bytes(GLint internal_format, std::int32_t width, std::int32_t height) {
    return glapi::s3tc_bytes(static_cast<GLenum>(internal_format), width, height);
}
/// RGBA bytes, row by row. `blocks` has s3tc_bytes() bytes.
std::vector<std::byte> decode_s3tc(GLint internal_format, std::int32_t width, std::int32_t height,
                                   std::span<const std::byte> blocks);

}  // namespace wall::client
