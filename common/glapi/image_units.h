// SPDX-License-Identifier: MIT
// What an image of a texture is that shaders read and write (OpenGL 4.2, 3.9.20 and table 3.33). Pure.
#pragma once

#include <algorithm>
#include <array>

#include "common/glapi/gl_types.h"

namespace wall::glapi {

/// How shaders may take the texels of a texture to be stored.
inline constexpr auto kImageUnitFormats = std::to_array<GLenum>({
    GL_RGBA32F,   GL_RGBA16F,   GL_RG32F,    GL_RG16F,        GL_R11F_G11F_B10F, GL_R32F,
    GL_R16F,      GL_RGBA32UI,  GL_RGBA16UI, GL_RGB10_A2UI,   GL_RGBA8UI,        GL_RG32UI,
    GL_RG16UI,    GL_RG8UI,     GL_R32UI,    GL_R16UI,        GL_R8UI,           GL_RGBA32I,
    GL_RGBA16I,   GL_RGBA8I,    GL_RG32I,    GL_RG16I,        GL_RG8I,           GL_R32I,
    GL_R16I,      GL_R8I,       GL_RGBA16,   GL_RGB10_A2,     GL_RGBA8,          GL_RG16,
    GL_RG8,       GL_R16,       GL_R8,       GL_RGBA16_SNORM, GL_RGBA8_SNORM,    GL_RG16_SNORM,
    GL_RG8_SNORM, GL_R16_SNORM, GL_R8_SNORM,
});
inline bool is_image_unit_format(GLenum format) {
    return std::ranges::find(kImageUnitFormats, format) != kImageUnitFormats.end();
}

inline bool is_image_access(GLenum access) {
    return access == GL_READ_ONLY || access == GL_WRITE_ONLY || access == GL_READ_WRITE;
}

}  // namespace wall::glapi
