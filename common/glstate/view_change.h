// SPDX-License-Identifier: MIT
// From the picture that a program draws to what is seen of the same scene through a tile that looks elsewhere. A
// camera's clip coordinates x, y and w are a 3x3 matrix times directions from the eye (what photographers call the
// intrinsic one), so another direction and field of view are one matrix on clip coordinates, whatever made them, fixed
// function or a shader. Depth follows w. Pure.
#pragma once

#include <array>
#include <optional>

#include "common/geom/view.h"
#include "common/glstate/projection.h"

namespace wall::glstate {

using ViewChange = std::array<double, 16>;  ///< column by column

/// `camera`: a projection, or one with model and view before it, as long as these neither shear nor stretch one axis
/// more than another. What brings its clip coordinates to those of the view. Nothing: it is no perspective, or sheared.
///
/// With (x, y, w) = K (right, up, ahead) and z = a w + b:  (x', y', w') = K_view axes K^-1 (x, y, w), z' = z + a (w' -
/// w). Then an eye beside it: x'' = x' + shift (w' - screen), where the 1 in `screen` is (z - a w) / b.
std::optional<ViewChange> view_change(const geom::EyeView& view, const Mat4& camera);
/// For sorting, where single precision does.
Mat4 narrow(const ViewChange& change);
/// What comes of clip coordinates by it.
Projection seen(const Projection& own, const Mat4& change);
/// Rounded once, so that what a driver is told has no more error than what the program has told.
Mat4 product(const ViewChange& change, const Mat4& camera);

}  // namespace wall::glstate
