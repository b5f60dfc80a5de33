// SPDX-License-Identifier: MIT
// Where a layer's pixels lie in the application's window, as programs that read their own place need it
// (shader_patch.h, assembly_patch.h). Pure.
#pragma once

#include <array>

#include "tileserver/driver/render_target.h"

namespace wall::tileserver {

/// From the layer's pixels to the window's: scale, then offset. `upper_left`: y goes down. `whole_centers`: the first
/// pixel's middle is at 0.
std::array<float, 4> window_of(const LayerGeometry& layer, bool upper_left, bool whole_centers);

}  // namespace wall::tileserver
