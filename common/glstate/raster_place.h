// SPDX-License-Identifier: MIT
// Where bitmaps and pixel images lie (OpenGL 4.6 compatibility, 14.1.3): the current raster position from clip
// coordinates, in the program's own picture and in views of the same scene (view_change.h), with the float operations
// of Mesa's _mesa_RasterPos in their order, so that text lands on the same pixels as in a window. Pure.
#pragma once

#include <optional>

#include "common/geom/view.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// Whether clipping leaves a point there, but for clip planes.
bool in_view_volume(const State& state, const Vec4& clip);
/// Window x, y and z by the first viewport and depth range, and clip w.
Vec4 window_position(const State& state, const Vec4& clip);

/// What RasterState::raster_clip is by the state's projection: `clip` where a camera has placed it, which views can
/// change, else zeros.
Vec4 raster_clip(const State& state, const Vec4& clip);

/// A raster position as a view of the scene has it.
struct SeenRaster {
    bool valid = false;
    Vec4 position;            ///< as glRasterPos would have it there
    float right = 0, up = 0;  ///< pixels of the target that bitmaps have moved it by: text is not drawn larger there
};
/// `own`: in the program's own picture, moved. Nothing: no camera has placed it, so it is the same in all views.
std::optional<SeenRaster> raster_in_view(const geom::EyeView& view, const State& state, const Vec4& own);

}  // namespace wall::glstate
