// SPDX-License-Identifier: MIT
// OpenGL's types and enumerants, from the headers of libgl-dev. No function of libGL may be called through them: a
// program's entry points are ours, a driver's come from glapi::GlFunctions.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>

// Words of OpenGL ES that the desktop's headers do not have.
#define GL_ETC1_RGB8_OES 0x8D64
#define GL_POINT_SIZE_ARRAY_BUFFER_BINDING_OES 0x8B9F
#define GL_POINT_SIZE_ARRAY_OES 0x8B9C
#define GL_POINT_SIZE_ARRAY_POINTER_OES 0x898C
#define GL_POINT_SIZE_ARRAY_STRIDE_OES 0x898B
#define GL_POINT_SIZE_ARRAY_TYPE_OES 0x898A
#define GL_TEXTURE_CROP_RECT_OES 0x8B9D
#define GL_TEXTURE_GEN_STR_OES 0x8D60
using GLclampx = GLfixed;
