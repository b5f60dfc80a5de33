// SPDX-License-Identifier: MIT
// Images of compressed blocks in a program's memory, as glPixelStore says that they lie there (OpenGL 4.2, 3.7.1 and
// 3.9.5; ARB_compressed_texture_pixel_storage), and the tight form that is kept and sent. Pure; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/glapi/image.h"

namespace wall::client {

/// Sizes in texels, none negative. `format` is one of common/glapi/block_formats.h.
struct BlockImage {
    GLint format;
    glapi::ImageSize size;
};

/// GL_INVALID_OPERATION where what is skipped is no whole number of the blocks that glPixelStore names; GL_NO_ERROR.
/// Rows count for two dimensions and more, images for three.
GLenum block_store_error(const glapi::PixelStore& store, unsigned dimensions);

/// Bytes from the pointer that the program gave to where a slice begins; block_store_error() has nothing against it.
std::size_t block_slice_offset(const glapi::PixelStore& store, const BlockImage& image, GLint slice);

/// Bytes of a program's memory that an image reaches over, from the pointer it gave; 0: there is nothing in the image.
std::size_t block_memory_bytes(const glapi::PixelStore& store, const BlockImage& image);

/// Copies an image from a program's memory: its blocks row by row, slice by slice.
std::vector<std::byte> unpack_blocks(const glapi::PixelStore& store, const BlockImage& image, const std::byte* from);

/// Copies an image into a program's memory; only the blocks themselves are written. `tight` has all of them.
void pack_blocks(const glapi::PixelStore& store, const BlockImage& image, std::span<const std::byte> tight,
                 std::byte* to);

}  // namespace wall::client
