// SPDX-License-Identifier: MIT
#include "client_lib/objects/block_store.h"

#include <cstring>

#include "client_lib/objects/s3tc.h"

namespace wall::client {
namespace {

std::size_t blocks_in(GLint texels, GLint block) {
    return (static_cast<std::size_t>(texels) + static_cast<std::size_t>(block) - 1) / static_cast<std::size_t>(block);
}

/// How many dimensions glPixelStore's values are for: each needs the size of a block in those before it.
unsigned counted_dimensions(const glapi::PixelStore& store, unsigned dimensions) {
    if (store.block_bytes == 0 || store.block_width == 0) return 0;
    if (store.block_height == 0 || dimensions < 2) return 1;
    return store.block_depth == 0 || dimensions < 3 ? 2 : 3;
}

/// Where rows of blocks lie in a program's memory, in bytes.
struct Rows {
    std::size_t wanted, step, image_step, skipped;
    std::size_t count;  ///< in a slice
};

Rows rows_of(const glapi::PixelStore& store, const BlockImage& image) {
    const unsigned counted = counted_dimensions(store, image.size.dimensions);
    Rows rows{};
    rows.wanted = rows.step = row_of_blocks_bytes(image.format, image.size.width);
    rows.count = blocks_in(image.size.height, block_size(image.format).height);
    const auto block = static_cast<std::size_t>(store.block_bytes);
    if (counted > 0 && store.row_length > 0) rows.step = block * blocks_in(store.row_length, store.block_width);
    rows.image_step =
        rows.step *
        (counted > 1 && store.image_height > 0 ? blocks_in(store.image_height, store.block_height) : rows.count);
    if (counted > 0) rows.skipped += block * static_cast<std::size_t>(store.skip_pixels / store.block_width);
    if (counted > 1) rows.skipped += rows.step * static_cast<std::size_t>(store.skip_rows / store.block_height);
    if (counted > 2) rows.skipped += rows.image_step * static_cast<std::size_t>(store.skip_images / store.block_depth);
    return rows;
}

/// Calls use(tight bytes before it, bytes before it in the program's memory, bytes) for each row of blocks.
template <class Use>
void for_each_row(const glapi::PixelStore& store, const BlockImage& image, Use&& use) {
    const Rows rows = rows_of(store, image);
    if (rows.wanted == 0) return;
    std::size_t tight = 0;
    for (std::size_t slice = 0; slice < static_cast<std::size_t>(image.size.depth); ++slice)
        for (std::size_t row = 0; row < rows.count; ++row, tight += rows.wanted)
            use(tight, rows.skipped + slice * rows.image_step + row * rows.step, rows.wanted);
}

}  // namespace

GLenum block_store_error(const glapi::PixelStore& store, unsigned dimensions) {
    const unsigned counted = counted_dimensions(store, dimensions);
    const bool whole = (counted < 1 || store.skip_pixels % store.block_width == 0) &&
                       (counted < 2 || store.skip_rows % store.block_height == 0) &&
                       (counted < 3 || store.skip_images % store.block_depth == 0);
    return whole ? GL_NO_ERROR : GL_INVALID_OPERATION;
}

std::size_t block_slice_offset(const glapi::PixelStore& store, const BlockImage& image, GLint slice) {
    const Rows rows = rows_of(store, image);
    return rows.skipped + rows.image_step * static_cast<std::size_t>(slice);
}

std::size_t block_memory_bytes(const glapi::PixelStore& store, const BlockImage& image) {
    const Rows rows = rows_of(store, image);
    if (rows.wanted == 0 || rows.count == 0 || image.size.depth == 0) return 0;
    return block_slice_offset(store, image, image.size.depth - 1) + (rows.count - 1) * rows.step + rows.wanted;
}

std::vector<std::byte> unpack_blocks(const glapi::PixelStore& store, const BlockImage& image, const std::byte* from) {
    const auto [width, height, depth, dimensions] = image.size;
    std::vector<std::byte> out(blocks_bytes(image.format, width, height) * static_cast<std::size_t>(depth));
    for_each_row(store, image, [&](std::size_t tight, std::size_t memory, std::size_t bytes) {
        std::memcpy(out.data() + tight, from + memory, bytes);
    });
    return out;
}

void pack_blocks(const glapi::PixelStore& store, const BlockImage& image, std::span<const std::byte> tight,
                 std::byte* to) {
    for_each_row(store, image, [&](std::size_t at, std::size_t memory, std::size_t bytes) {
        std::memcpy(to + memory, tight.data() + at, bytes);
    });
}

}  // namespace wall::client
