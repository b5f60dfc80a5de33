// SPDX-License-Identifier: MIT
// What a context was made as: the profile, and what the program asked for beside it. It never changes.
#pragma once

#include "common/glapi/gl_types.h"

namespace wall::client {

struct ContextProfile {
    bool core = false;  ///< without what OpenGL 3.1 removed
    bool forward_compatible = false;
    bool debug = false;
    bool robust = false;
    bool notifies_of_resets = false;  ///< GL_LOSE_CONTEXT_ON_RESET
    unsigned es = 0;                  ///< of OpenGL ES: its version, times ten; 0: of OpenGL

    /// Whether it has what shaders replaced, glBegin and display lists.
    bool has_fixed_function() const { return !core && es == 0; }

    /// GL_CONTEXT_FLAGS.
    GLbitfield flags() const {
        return (forward_compatible ? GL_CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT : 0u) |
               (debug ? GL_CONTEXT_FLAG_DEBUG_BIT : 0u) | (robust ? GL_CONTEXT_FLAG_ROBUST_ACCESS_BIT : 0u);
    }
    /// GL_CONTEXT_PROFILE_MASK.
    GLbitfield mask() const { return core ? GL_CONTEXT_CORE_PROFILE_BIT : GL_CONTEXT_COMPATIBILITY_PROFILE_BIT; }
};

}  // namespace wall::client
