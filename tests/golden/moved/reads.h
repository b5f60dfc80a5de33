// SPDX-License-Identifier: MIT
// What reads the window: its pixels are those of all tiles, each drawn by a process of its own.
#pragma once

#include "tests/golden/moved/mesa.h"

namespace golden::moved {

void ReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* data);
void CopyPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum what);
void CopyTexImage1D(GLenum target, GLint level, GLenum internal, GLint x, GLint y, GLsizei width, GLint border);
void CopyTexImage2D(GLenum target, GLint level, GLenum internal, GLint x, GLint y, GLsizei width, GLsizei height,
                    GLint border);
void CopyTexSubImage1D(GLenum target, GLint level, GLint to, GLint x, GLint y, GLsizei width);
void CopyTexSubImage2D(GLenum target, GLint level, GLint to_x, GLint to_y, GLint x, GLint y, GLsizei width,
                       GLsizei height);

}  // namespace golden::moved
