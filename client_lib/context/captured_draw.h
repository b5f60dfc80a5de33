// SPDX-License-Identifier: MIT
// Draws of as many vertices as transform feedback has captured (OpenGL 4.0, 2.17.3). The nodes know how many those are,
// and the client need not ask. The context's thread.
#pragma once

#include <memory>

#include "client_lib/context/context.h"
#include "client_lib/objects/capture.h"

namespace wall::client {

struct CapturedDraw {
    GLenum mode = GL_POINTS;
    std::shared_ptr<Capture> capture;  ///< it has ended
    GLuint stream = 0;
    GLsizei instances = 1;
};

/// Streams of vertices that the nodes' drivers have.
GLuint vertex_streams(const Context& c);
/// At once, after the checks of its arguments.
void draw_captured(Context& c, const CapturedDraw& draw);

}  // namespace wall::client
