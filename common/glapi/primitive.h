// SPDX-License-Identifier: MIT
// The primitives that vertices may make. Pure.
#pragma once

#include "common/glapi/gl_types.h"

namespace wall::glapi {

/// Whether glBegin and draws take it; those with adjacency are for geometry shaders, patches for
/// tessellation.
constexpr bool is_primitive(GLenum mode) { return mode <= GL_PATCHES; }
static_assert(GL_PATCHES == GL_TRIANGLE_STRIP_ADJACENCY + 1);

/// What single primitives a mode is made of: GL_POINTS, GL_LINES, GL_TRIANGLES, those with adjacency, or GL_PATCHES.
constexpr GLenum single_primitive(GLenum mode) {
    switch (mode) {
        case GL_POINTS:
        case GL_PATCHES:
        case GL_LINES_ADJACENCY:
        case GL_TRIANGLES_ADJACENCY: return mode;
        case GL_LINES:
        case GL_LINE_LOOP:
        case GL_LINE_STRIP: return GL_LINES;
        case GL_LINE_STRIP_ADJACENCY: return GL_LINES_ADJACENCY;
        case GL_TRIANGLE_STRIP_ADJACENCY: return GL_TRIANGLES_ADJACENCY;
        default: return GL_TRIANGLES;
    }
}

}  // namespace wall::glapi
