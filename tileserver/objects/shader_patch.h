// SPDX-License-Identifier: MIT
// A fragment shader that reads gl_FragCoord must see the pixels of the application's window, not those of the layer
// that it draws into. Its source is changed on the way to the driver: the token becomes a macro over a uniform that is
// set for each layer. Pure.
#pragma once

#include <string>

namespace wall::tileserver {

/// vec4: window = layer * xy + zw.
inline constexpr const char* kWindowUniform = "wallgl_Window";

struct PatchedShader {
    std::string source;
    bool reads_window = false;   ///< has the uniform
    bool upper_left = false;     ///< origin_upper_left: y goes down
    bool whole_centers = false;  ///< pixel_center_integer: the first pixel's middle is at 0
};

/// Comments, directives and redeclarations of gl_FragCoord stay as they are.
PatchedShader patch_fragment_shader(std::string source);

}  // namespace wall::tileserver
