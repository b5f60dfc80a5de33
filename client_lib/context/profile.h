// SPDX-License-Identifier: MIT
// What a context was made as: the profile, and what the program asked for beside it. It never changes.
#pragma once

#include "client_lib/objects/es_kind.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

struct ContextProfile {
    bool core = false;  ///< without what OpenGL 3.1 removed
    bool forward_compatible = false;
    bool debug = false;
    bool robust = false;
    bool notifies_of_resets = false;  ///< GL_LOSE_CONTEXT_ON_RESET
    unsigned es = 0;                  ///< of OpenGL ES: its version, times ten; 0: of OpenGL

    bool is_es() const { return es != 0; }
    /// Of the first OpenGL ES, which has fixed function and no shaders; the later ones have shaders only.
    bool is_es1() const { return is_first_es(es); }
    /// Whether it has what shaders replaced: matrices, lights, texture environments and the arrays for them.
    bool has_fixed_function() const { return is_es() ? is_es1() : !core; }
    /// Whether vertices are given one by one, and commands go into display lists.
    bool has_begin() const { return !core && !is_es(); }

    /// GL_CONTEXT_FLAGS.
    GLbitfield flags() const {
        return (forward_compatible ? GL_CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT : 0u) |
               (debug ? GL_CONTEXT_FLAG_DEBUG_BIT : 0u) | (robust ? GL_CONTEXT_FLAG_ROBUST_ACCESS_BIT : 0u);
    }
    /// GL_CONTEXT_PROFILE_MASK.
    GLbitfield mask() const { return core ? GL_CONTEXT_CORE_PROFILE_BIT : GL_CONTEXT_COMPATIBILITY_PROFILE_BIT; }
};

}  // namespace wall::client
