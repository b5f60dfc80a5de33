// SPDX-License-Identifier: MIT
// Pixel rectangles in client memory: sizes of every format and type up to OpenGL 3.x, and the way between a program's
// memory (glPixelStore) and the tight form that is stored and sent: no padding, native byte order, bitmaps with the
// first pixel in the highest bit. Pure; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

/// glPixelStore's values for one direction.
struct PixelStore {
    bool swap_bytes = false;
    bool lsb_first = false;
    std::int32_t row_length = 0, image_height = 0;
    std::int32_t skip_pixels = 0, skip_rows = 0, skip_images = 0;
    std::int32_t alignment = 4;
    std::int32_t block_width = 0, block_height = 0, block_depth = 0;  ///< texels; of images in compressed blocks
    std::int32_t block_bytes = 0;
};

/// Components of a format (GL_RGBA: 4); 0: no such format.
unsigned components_of(GLenum format);
bool is_packed_type(GLenum type);
bool is_integer_format(GLenum format);

/// How one pixel lies in memory. GL_BITMAP: pixel_bytes is 0 and `bitmap` true.
struct PixelLayout {
    unsigned pixel_bytes = 0;
    unsigned element_bytes = 1;  ///< what GL_*_SWAP_BYTES turns around
    unsigned components = 0;
    bool bitmap = false;
};

/// GL_NO_ERROR, or the error that OpenGL gives for this pair (of glTexImage, glDrawPixels, glReadPixels).
GLenum format_type_error(GLenum format, GLenum type);
/// Nothing if the pair is not allowed.
std::optional<PixelLayout> pixel_layout(GLenum format, GLenum type);

/// Bytes of one tight row.
std::size_t row_bytes(const PixelLayout& layout, std::int32_t width);
/// Bytes of a tight image; nothing if the pair is not allowed, a size is negative or the product overflows 2^31.
std::optional<std::size_t> image_bytes(GLenum format, GLenum type, std::int32_t width, std::int32_t height,
                                       std::int32_t depth);

struct ImageSize {
    std::int32_t width = 0, height = 1, depth = 1;
    unsigned dimensions = 2;  ///< 3: image_height and skip_images count
};

/// Where a row starts in a program's memory, relative to the pointer it gave; bitmaps: plus `skip_pixels` bits.
std::size_t row_offset(const PixelStore& store, const PixelLayout& layout, const ImageSize& size, std::int32_t row,
                       std::int32_t slice);

/// Bytes of a program's memory that an image reaches over, from the pointer it gave.
std::size_t memory_bytes(const PixelStore& store, const ImageSize& size, GLenum format, GLenum type);

/// Copies an image from a program's memory. `size`, `format` and `type` have been checked (image_bytes gives a value).
std::vector<std::byte> unpack_image(const PixelStore& store, const ImageSize& size, GLenum format, GLenum type,
                                    const void* pixels);
/// Copies an image into a program's memory; only the pixels themselves are written.
void pack_image(const PixelStore& store, const ImageSize& size, GLenum format, GLenum type,
                std::span<const std::byte> tight, void* pixels);

/// Copies a rectangle of a tight image into another tight image of the same layout; both lie inside their images.
struct TightImage {
    std::byte* pixels;
    std::int32_t width, height;
};
void copy_rect(const PixelLayout& layout, const TightImage& to, std::int32_t to_x, std::int32_t to_y,
               const std::byte* from, std::int32_t from_width, std::int32_t width, std::int32_t height);

}  // namespace wall::glapi
