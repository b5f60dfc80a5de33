// SPDX-License-Identifier: MIT
// What a context has for debugging (GL_KHR_debug). Application's thread.
#pragma once

#include <vector>

#include "client_lib/context/debug_log.h"
#include "client_lib/context/object_labels.h"

namespace wall::client {

struct DebugState {
    DebugLog log;
    std::vector<DebugMessage> untold;  ///< errors of the command that goes on
    ObjectLabels labels;               ///< of objects that no other context has; the others' are the share group's
};

/// About an error of the program. `where`: the function that found it; of an OpenGL command, its name without gl.
DebugMessage error_message(GLenum code, const char* where);

}  // namespace wall::client
