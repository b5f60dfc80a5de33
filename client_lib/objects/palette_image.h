// SPDX-License-Identifier: MIT
// Images of palettes (GL_OES_compressed_paletted_texture; of OpenGL ES 1.1): the colours, then for each level, the
// largest first, the number of a colour for each texel, four or eight bits. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client_lib/objects/texture_formats.h"

namespace wall::client {

/// What the colours of a palette are.
struct PaletteFormat {
    PixelKind colors;      ///< also what texels become
    unsigned color_bytes;  ///< of one
    unsigned texel_bits;   ///< 4 or 8
    std::size_t palette_bytes() const { return std::size_t{color_bytes} << texel_bits; }
};
/// Nothing: not one of the formats.
std::optional<PaletteFormat> palette_format(GLenum internal_format);

/// Of an image with so many levels, neither side negative.
std::size_t palette_image_bytes(const PaletteFormat& format, std::int32_t width, std::int32_t height, unsigned levels);
/// The texels of one level, tight, of an image that is as long as it has to be.
std::vector<std::byte> palette_texels(const PaletteFormat& format, std::int32_t width, std::int32_t height,
                                      unsigned level, std::span<const std::byte> image);

/// Of a side.
constexpr std::int32_t size_of_level(std::int32_t base, unsigned level) {
    return base >> level > 0 ? base >> level : base > 0 ? 1 : 0;
}

}  // namespace wall::client
