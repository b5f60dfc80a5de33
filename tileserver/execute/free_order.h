// SPDX-License-Identifier: MIT
// Whether it can be seen, or counted, in which order the triangles of a draw come. Pure.
#pragma once

#include "gen/glstate/state.gen.h"

namespace wall::tileserver {

/// Not: of all fragments at a pixel the nearest one stays, and nothing of the others. (Of two at the very same depth it
/// is the first or the last; then another one may stay.) What the program's shaders do is not looked at, and that there
/// are depths at all is supposed.
inline bool order_is_free(const glstate::State& state) {
    const auto& depth = state.depth_stencil;
    const bool nearest_stays = depth.depth_func == GL_LESS || depth.depth_func == GL_LEQUAL ||
                               depth.depth_func == GL_GREATER || depth.depth_func == GL_GEQUAL;
    const auto& pixels = state.color_buffer;
    const auto& objects = state.objects;
    return depth.depth_test && depth.depth_mask && nearest_stays && !depth.stencil_test && pixels.blend_enabled == 0 &&
           !pixels.color_logic_op && !pixels.index_logic_op && state.polygon.polygon_mode[0] == GL_FILL &&
           state.polygon.polygon_mode[1] == GL_FILL && objects.occlusion_query == 0 && objects.capture == 0;
}

}  // namespace wall::tileserver
