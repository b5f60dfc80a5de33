// SPDX-License-Identifier: MIT
// A window with several samples a pixel, read as OpenGL says: Mesa 22.3's glReadPixels gives the first sample of each
// pixel instead of what is made of all of them, as blits and glCopyTexImage do.
#pragma once

#include "tests/golden/moved/mesa.h"

namespace golden::moved {

/// While it lives, this process's window is read from as pixels; depth and stencil values as they are. Nothing where it
/// has no samples.
class Resolved {
public:
    /// Pixels from the window's bottom left that are to be read.
    Resolved(int width, int height, GLenum format);
    ~Resolved();
    Resolved(const Resolved&) = delete;
    Resolved& operator=(const Resolved&) = delete;

private:
    void blit(int width, int height);

    GLuint framebuffer_ = 0, renderbuffer_ = 0;
};

}  // namespace golden::moved
