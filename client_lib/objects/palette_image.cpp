// SPDX-License-Identifier: MIT
#include "client_lib/objects/palette_image.h"

#include <cstring>

namespace wall::client {
namespace {

constexpr GLenum kFormats = GL_PALETTE8_RGBA8_OES - GL_PALETTE4_RGBA8_OES;  // with texels of four bits, then of eight

std::size_t level_bytes(const PaletteFormat& format, std::int32_t width, std::int32_t height, unsigned level) {
    const auto texels =
        static_cast<std::size_t>(size_of_level(width, level)) * static_cast<std::size_t>(size_of_level(height, level));
    return (texels * format.texel_bits + 7) / 8;
}

std::size_t levels_bytes(const PaletteFormat& format, std::int32_t width, std::int32_t height, unsigned levels) {
    std::size_t bytes = 0;
    for (unsigned level = 0; level < levels; ++level) bytes += level_bytes(format, width, height, level);
    return bytes;
}

}  // namespace

std::optional<PaletteFormat> palette_format(GLenum internal_format) {
    if (internal_format < GL_PALETTE4_RGB8_OES || internal_format > GL_PALETTE8_RGB5_A1_OES) return std::nullopt;
    const GLenum place = internal_format - GL_PALETTE4_RGB8_OES;
    const unsigned bits = place < kFormats ? 4 : 8;
    switch (place % kFormats + GL_PALETTE4_RGB8_OES) {
        case GL_PALETTE4_RGB8_OES: return PaletteFormat{{GL_RGB, GL_UNSIGNED_BYTE}, 3, bits};
        case GL_PALETTE4_RGBA8_OES: return PaletteFormat{{GL_RGBA, GL_UNSIGNED_BYTE}, 4, bits};
        case GL_PALETTE4_R5_G6_B5_OES: return PaletteFormat{{GL_RGB, GL_UNSIGNED_SHORT_5_6_5}, 2, bits};
        case GL_PALETTE4_RGBA4_OES: return PaletteFormat{{GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4}, 2, bits};
        default: return PaletteFormat{{GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1}, 2, bits};
    }
}

std::size_t palette_image_bytes(const PaletteFormat& format, std::int32_t width, std::int32_t height, unsigned levels) {
    return format.palette_bytes() + levels_bytes(format, width, height, levels);
}

std::vector<std::byte> palette_texels(const PaletteFormat& format, std::int32_t width, std::int32_t height,
                                      unsigned level, std::span<const std::byte> image) {
    const auto texels =
        static_cast<std::size_t>(size_of_level(width, level)) * static_cast<std::size_t>(size_of_level(height, level));
    const std::byte* numbers =
        image.data() + format.palette_bytes() + levels_bytes(format, width, height, level);  // behind those before
    std::vector<std::byte> out(texels * format.color_bytes);
    for (std::size_t i = 0; i < texels; ++i) {
        const bool whole = format.texel_bits == 8;
        const auto byte = std::to_integer<unsigned>(numbers[whole ? i : i / 2]);
        const unsigned number = whole ? byte : i % 2 == 0 ? byte >> 4 : byte & 15;
        std::memcpy(out.data() + i * format.color_bytes, image.data() + std::size_t{number} * format.color_bytes,
                    format.color_bytes);
    }
    return out;
}

}  // namespace wall::client
