// SPDX-License-Identifier: MIT
// A fragment program that reads fragment.position must see the pixels of the application's window, as a shader that
// reads gl_FragCoord (shader_patch.h). Its source is changed on the way to the driver: the binding becomes a temporary,
// which the program's first instruction makes of it with two environment parameters that are set for each layer. Pure.
#pragma once

#include <string>

namespace wall::tileserver {

struct PatchedAssembly {
    std::string source;
    bool reads_window = false;   ///< has the instruction
    bool upper_left = false;     ///< ARB_fragment_coord_origin_upper_left: y goes down
    bool whole_centers = false;  ///< ARB_fragment_coord_pixel_center_integer: the first pixel's middle is at 0
};

/// `first`: the index of the first of the node's own parameters (kWindowParameters).
PatchedAssembly patch_fragment_program(std::string source, unsigned first);

}  // namespace wall::tileserver
