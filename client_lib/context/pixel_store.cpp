// SPDX-License-Identifier: MIT
#include "client_lib/context/pixel_store.h"

namespace wall::client {

glapi::PixelStore unpack_store(const glstate::State& state) {
    const auto& l = state.local;
    return {.swap_bytes = l.unpack_swap_bytes != 0,
            .lsb_first = l.unpack_lsb_first != 0,
            .row_length = l.unpack_row_length,
            .image_height = l.unpack_image_height,
            .skip_pixels = l.unpack_skip_pixels,
            .skip_rows = l.unpack_skip_rows,
            .skip_images = l.unpack_skip_images,
            .alignment = l.unpack_alignment,
            .block_width = l.unpack_compressed_block_width,
            .block_height = l.unpack_compressed_block_height,
            .block_depth = l.unpack_compressed_block_depth,
            .block_bytes = l.unpack_compressed_block_size};
}

glapi::PixelStore pack_store(const glstate::State& state) {
    const auto& l = state.local;
    return {.swap_bytes = l.pack_swap_bytes != 0,
            .lsb_first = l.pack_lsb_first != 0,
            .row_length = l.pack_row_length,
            .image_height = l.pack_image_height,
            .skip_pixels = l.pack_skip_pixels,
            .skip_rows = l.pack_skip_rows,
            .skip_images = l.pack_skip_images,
            .alignment = l.pack_alignment,
            .block_width = l.pack_compressed_block_width,
            .block_height = l.pack_compressed_block_height,
            .block_depth = l.pack_compressed_block_depth,
            .block_bytes = l.pack_compressed_block_size};
}

const void* image_source(Context& c, const MemoryImage& image, const void* pixels) {
    if (!c.state.local.pixel_unpack_buffer) return pixels;
    return unpack_source(c, pixels, glapi::memory_bytes(unpack_store(c.state), image.size, image.format, image.type));
}

PackTarget image_target(Context& c, const MemoryImage& image, void* pixels) {
    if (!c.state.local.pixel_pack_buffer) return PackTarget(pixels);
    return pack_target(c, pixels, glapi::memory_bytes(pack_store(c.state), image.size, image.format, image.type));
}

}  // namespace wall::client
