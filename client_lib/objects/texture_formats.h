// SPDX-License-Identifier: MIT
// Internal formats of textures as the nodes' driver (Mesa's llvmpipe) answers for them. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::client {

/// Bits of each component.
struct ComponentBits {
    std::uint8_t red, green, blue, alpha, luminance, intensity, depth, stencil;
};

/// What an image of a format may be used for besides being sampled.
enum class ImageUse : std::uint8_t {
    sampled,  ///< nothing else
    drawn,    ///< drawn to
    blocks,   ///< its texels are compressed
};

struct TextureFormat {
    GLint internal_format;
    GLenum base;   ///< GL_RGBA, GL_LUMINANCE, ...
    GLint answer;  ///< what GL_TEXTURE_INTERNAL_FORMAT says: the resolved one of a generic compressed format
    ComponentBits bits;
    GLenum component_type;  ///< GL_FLOAT, GL_INT, ...; 0: of stencil
    ImageUse use;
    bool srgb = false;  ///< colours are stored by the curve of sRGB

    bool compressed() const { return use == ImageUse::blocks; }
    /// Whether colours are whole numbers, which nothing converts.
    bool whole() const { return component_type == GL_INT || component_type == GL_UNSIGNED_INT; }
};

/// Whether it says how its texels are stored, and does not leave that to the driver.
bool is_sized(const TextureFormat& format);
/// Null: no such internal format.
const TextureFormat* find_texture_format(GLint internal_format);
/// Bits as stored: an unsized format follows the pixels that it was defined with.
ComponentBits stored_bits(const TextureFormat& row, GLenum format, GLenum type);

/// The format and type of an image's pixels.
struct PixelKind {
    GLenum format, type;
};
/// How texels travel between nodes, so that none of them changes. `bits`: as they are stored.
PixelKind exact_pixels(const TextureFormat& format, const ComponentBits& bits);

/// Calls `use(first_row, rows)` for parts of an image as they are asked for, so that no answer is too large.
template <class Use>
void for_each_rows(std::int32_t width, std::int32_t height, Use&& use) {
    constexpr std::int32_t kMostAsked = 1 << 22;  // texels, of 16 bytes at most
    const std::int32_t rows = std::max(1, kMostAsked / std::max(1, width));
    for (std::int32_t y = 0; y < height; y += rows) use(y, std::min(rows, height - y));
}

}  // namespace wall::client
