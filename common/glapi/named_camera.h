// SPDX-License-Identifier: MIT
// The camera of programs whose vertices go ways that are not followed (skinning, instances, geometry shaders): whoever
// starts the program says how the uniform is called that holds the projection, or projection and view, and tiles that
// look elsewhere change that (docs/walls.md, "Views"). Pure.
#pragma once

#include <string>
#include <vector>

#include "common/glapi/position_program.h"
#include "common/glapi/program_format.h"

namespace wall::glapi {

/// Notes in `position` the first of `names` that is an active matrix of 4 x 4 floats, in no block, which may be an
/// element of an array. None is, or one is noted: it stays as it is.
void name_camera(PositionProgram& position, const std::vector<std::string>& names,
                 const std::vector<ActiveUniform>& uniforms);

}  // namespace wall::glapi
