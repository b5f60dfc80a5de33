// SPDX-License-Identifier: MIT
// Pixels as OpenGL ES has them: few formats and types go with each internal format (OpenGL ES 3.0.6, 3.8.3; those of
// OpenGL ES 2.0 and of extensions are named by the pixels that they are made of). What a node is told are desktop
// formats. The tables are in proto/gl/es.toml. Pure.
#pragma once

#include "client_lib/objects/texture_formats.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

/// OpenGL ES 2.0 has a number of its own for halves (OES_texture_half_float).
inline constexpr GLenum kHalfFloatOes = 0x8D61;

struct EsImage {
    GLenum error = GL_NO_ERROR;
    GLint internal_format = 0;  ///< of desktop OpenGL
    GLenum type = 0;            ///< the same
};

/// Of glTexImage, in a version, times ten.
EsImage es_image(unsigned version, GLint internal_format, GLenum format, GLenum type);
/// Of glTexSubImage; `internal_format` is the texture's own, of desktop OpenGL.
EsImage es_pixels(unsigned version, GLint internal_format, GLenum format, GLenum type);
/// GL_HALF_FLOAT for the other word that OpenGL ES 2.0 has for it.
GLenum desktop_type(GLenum type);

/// Whether images of a format (as desktop OpenGL names it) may be drawn to in a version, times ten: in the first ones
/// the same.
bool es_is_drawn(unsigned version, GLint internal_format);

/// Of glCopyTexImage out of colours of a format, with `base` for their components (OpenGL ES 3.0.6, 3.8.5):
/// GL_INVALID_ENUM, or GL_INVALID_OPERATION where they lack a component or would be converted.
GLenum es_copy_error(unsigned version, GLenum internal_format, const TextureFormat& from, GLenum base);

/// What glReadPixels gives out of colours of a format besides what every context has: GL_IMPLEMENTATION_COLOR_READ_*.
PixelKind es_read_kind(const TextureFormat& from);
/// Whether glReadPixels gives them, out of colours (OpenGL ES 3.0.6, 4.3.2; GL_EXT_read_format_bgra) or, for a format
/// of them, out of depth and stencil (GL_NV_read_depth and its like). `type` as of desktop OpenGL.
bool es_can_read(GLenum format, GLenum type, const TextureFormat& from);

}  // namespace wall::client
