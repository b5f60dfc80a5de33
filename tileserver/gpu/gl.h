// SPDX-License-Identifier: MIT
// The driver's functions, as the tileserver calls them: always through a table loaded from the backend, never through
// libGL. Render thread.
#pragma once

#include "gen/glapi/gl_functions.gen.h"

namespace wall::tileserver {

using Gl = glapi::GlFunctions;

}  // namespace wall::tileserver
