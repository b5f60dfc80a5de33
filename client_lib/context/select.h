// SPDX-License-Identifier: MIT
// Selection and feedback (OpenGL 1.2.1, 5.2 and 5.3). Nothing is drawn then: all geometry goes to one node, which runs
// it through its driver in that mode with the whole window as one layer, and answers when the mode ends.
#pragma once

#include <optional>

#include "client_lib/geometry/target_layers.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

class Context;

inline constexpr unsigned kNameStackLimit = 64;

struct SelectState {
    std::optional<TargetLayer> layer;  ///< the one that all goes to; nothing while drawing
    GLuint* select_buffer = nullptr;   ///< the application's
    GLsizei select_entries = -1;       ///< -1: never given
    GLfloat* feedback_buffer = nullptr;
    GLsizei feedback_entries = -1;
    GLenum feedback_type = GL_2D;
    unsigned name_depth = 0;
};

}  // namespace wall::client
