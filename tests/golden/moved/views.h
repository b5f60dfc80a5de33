// SPDX-License-Identifier: MIT
// A reference of a tile that looks elsewhere or is for one eye (docs/walls.md, "Views", "Stereo"): while GOLDEN_VIEW is
// set, to the 16 numbers of geom::values_of() of an EyeView, the projection that the program sets becomes that of the
// view in Mesa. The program's own is kept beside it, for what it multiplies it by, its stack and its questions. So do
// matrices that it sets as uniforms of the names in GOLDEN_CAMERA.
#pragma once

#include <string_view>

#include "tests/golden/moved/mesa.h"

namespace golden::moved {

/// Stands in the place of a function of Mesa; null: none does, or there is no view.
void* view_replacement(std::string_view name);
/// The program's own projection, if that is what it asks for. False: it is not, or there is no view.
bool own_projection(GLenum name, float* values);

}  // namespace golden::moved
