// SPDX-License-Identifier: MIT
// Pixels as OpenGL ES has them: a texture's format is that of the pixels it is made of, and few types go with each
// (OpenGL ES 2.0, 3.7.1; the extensions are named in proto/gl/es.toml). What a node is told are desktop formats. Pure.
#pragma once

#include "common/glapi/gl_types.h"

namespace wall::client {

/// OpenGL ES 2.0 has a number of its own for halves (OES_texture_half_float).
inline constexpr GLenum kHalfFloatOes = 0x8D61;

struct EsImage {
    GLenum error = GL_NO_ERROR;
    GLint internal_format = 0;  ///< of desktop OpenGL
    GLenum type = 0;            ///< the same
};

/// Of glTexImage.
EsImage es_image(GLint internal_format, GLenum format, GLenum type);
/// Of glTexSubImage, where the texture's own format is not looked at.
EsImage es_pixels(GLenum format, GLenum type);
/// GL_HALF_FLOAT for the other word that OpenGL ES 2.0 has for it.
GLenum desktop_type(GLenum type);

/// Of glCopyTexImage: GL_INVALID_ENUM, or GL_INVALID_OPERATION where the framebuffer's base format lacks a component.
GLenum es_copy_error(GLenum internal_format, GLenum framebuffer_base);
/// Whether glReadPixels gives them out of a framebuffer whose colours are floats, or are not.
bool es_can_read(GLenum format, GLenum type, bool floats);

}  // namespace wall::client
