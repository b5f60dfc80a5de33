// SPDX-License-Identifier: MIT
// Internal formats of textures as the nodes' driver (Mesa's llvmpipe) answers for them. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::client {

/// Bits of each component.
struct ComponentBits {
    std::uint8_t red, green, blue, alpha, luminance, intensity, depth, stencil;
};

struct TextureFormat {
    GLint internal_format;
    GLenum base;   ///< GL_RGBA, GL_LUMINANCE, ...
    GLint answer;  ///< what GL_TEXTURE_INTERNAL_FORMAT says: the resolved one of a generic compressed format
    ComponentBits bits;
    GLenum component_type;  ///< of the colour components; 0: the driver says none
    bool compressed;
};

/// Null: no such internal format.
const TextureFormat* find_texture_format(GLint internal_format);
/// Bits as stored: an unsized format follows the pixels that it was defined with.
ComponentBits stored_bits(const TextureFormat& row, GLenum format, GLenum type);

}  // namespace wall::client
