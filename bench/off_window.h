// SPDX-License-Identifier: MIT
// A framebuffer object whose picture comes to the window as it is: by a blit, or as a texture on a rectangle that a
// shader draws, as toolkits do it.
#pragma once

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#include <GL/gl.h>
#include <GL/glext.h>

namespace wall::bench {

inline GLuint shader(GLenum type, const char* source) {
    const GLuint name = glCreateShader(type);
    glShaderSource(name, 1, &source, nullptr);
    glCompileShader(name);
    return name;
}

class OffWindow {
public:
    /// Colours and depths of so many pixels; bound to be drawn to from now on.
    OffWindow(int width, int height, bool as_texture);
    /// Its picture comes to the window. It is bound again behind that, and the program that was in use is again.
    void show() const;

private:
    void attach_texture();
    void make_program();
    void draw_rectangle() const;

    const int width_, height_;
    GLuint framebuffer_ = 0, texture_ = 0, program_ = 0,
           corners_ = 0;  ///< 0, but for the first: it is copied by a blit
};

}  // namespace wall::bench
