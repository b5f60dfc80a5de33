// SPDX-License-Identifier: MIT
// Where a context stands in compiling and calling display lists (lists.h). The application's thread.
#pragma once

#include <cstddef>
#include <vector>

#include "common/glapi/gl_types.h"
#include "common/glapi/recorder.h"

namespace wall::client {

struct ListState {
    GLuint name = 0;  ///< of the list being compiled; 0: none
    GLenum mode = 0;  ///< GL_COMPILE, GL_COMPILE_AND_EXECUTE; 0: none
    glapi::ListRecorder recorder;
    unsigned depth = 0;                    ///< of calls being executed
    bool packing = false;                  ///< a run is being packed: materials go into the packer
    std::vector<std::size_t> array_draws;  ///< of the run being packed
};

}  // namespace wall::client
