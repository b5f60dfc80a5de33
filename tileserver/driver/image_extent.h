// SPDX-License-Identifier: MIT
// The size of an image. Any thread.
#pragma once

#include "common/glapi/gl_types.h"

namespace wall::tileserver {

struct ImageExtent {
    GLsizei width = 0, height = 0, depth = 0;  ///< texels
};

}  // namespace wall::tileserver
