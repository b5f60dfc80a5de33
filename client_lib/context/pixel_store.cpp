// SPDX-License-Identifier: MIT
#include "client_lib/context/pixel_store.h"

namespace wall::client {

glapi::PixelStore unpack_store(const glstate::State& state) {
    const auto& l = state.local;
    return {l.unpack_swap_bytes != 0, l.unpack_lsb_first != 0, l.unpack_row_length,  l.unpack_image_height,
            l.unpack_skip_pixels,     l.unpack_skip_rows,      l.unpack_skip_images, l.unpack_alignment};
}

glapi::PixelStore pack_store(const glstate::State& state) {
    const auto& l = state.local;
    return {l.pack_swap_bytes != 0, l.pack_lsb_first != 0, l.pack_row_length,  l.pack_image_height,
            l.pack_skip_pixels,     l.pack_skip_rows,      l.pack_skip_images, l.pack_alignment};
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
