// SPDX-License-Identifier: MIT
#include "bench/off_window.h"

namespace wall::bench {

OffWindow::OffWindow(int width, int height, bool as_texture) : width_(width), height_(height) {
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    const auto attach = [&](GLenum point, GLenum format) {
        GLuint image = 0;
        glGenRenderbuffers(1, &image);
        glBindRenderbuffer(GL_RENDERBUFFER, image);
        glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, point, GL_RENDERBUFFER, image);
    };
    attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24);
    if (as_texture) {
        attach_texture();
        make_program();
    } else {
        attach(GL_COLOR_ATTACHMENT0, GL_RGBA8);
    }
}

void OffWindow::attach_texture() {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
}

void OffWindow::make_program() {
    program_ = glCreateProgram();
    glAttachShader(program_, shader(GL_VERTEX_SHADER,
                                    "attribute vec2 corner; varying vec2 uv;\n"
                                    "void main() {\n"
                                    "    uv = 0.5 * corner + 0.5;\n"
                                    "    gl_Position = vec4(corner, 0.0, 1.0);\n"
                                    "}\n"));
    glAttachShader(program_, shader(GL_FRAGMENT_SHADER,
                                    "uniform sampler2D picture; varying vec2 uv;\n"
                                    "void main() { gl_FragColor = texture2D(picture, uv); }\n"));
    glBindAttribLocation(program_, 0, "corner");
    glLinkProgram(program_);
    static const GLfloat corners[] = {-1, -1, 1, -1, -1, 1, 1, 1};
    glGenBuffers(1, &corners_);
    glBindBuffer(GL_ARRAY_BUFFER, corners_);
    glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
}

void OffWindow::show() const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    if (program_ != 0) draw_rectangle();
    else glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
}

void OffWindow::draw_rectangle() const {
    GLint before = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &before);
    glUseProgram(program_);
    glDisable(GL_DEPTH_TEST);
    glBindBuffer(GL_ARRAY_BUFFER, corners_);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisableVertexAttribArray(0);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(static_cast<GLuint>(before));
}

}  // namespace wall::bench
