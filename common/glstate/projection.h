// SPDX-License-Identifier: MIT
// From geometry to the pixels that it may touch, for sorting it among nodes (W3.2, T6.1) and pieces of it among tiles.
// Conservative: what cannot be bounded may touch all. Pure; the caller's thread.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "common/geom/box.h"
#include "common/geom/pixel_rect.h"
#include "common/glapi/position_program.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

using geom::PixelRect;

/// How far fragments lie from the vertices' hull at most, by what the primitives are: half the line width or point
/// size, and one for rounding; pixels. Polygons may be drawn as lines or points.
struct Reaches {
    float points = 1, lines = 1, polygons = 1;
    float of(GLenum mode) const;
};

/// The transformation of object space to window pixels, and how far rasterization may reach beyond the vertices.
struct Projection {
    Mat4 clip_from_object{};
    float viewport[4]{};  ///< x, y, width, height
    float margin = 1;     ///< pixels: the most of the reaches
    Reaches reaches;
    bool near_plane = true;     ///< clips; not while depths are clamped
    bool near_is_zero = false;  ///< it is where z is 0, not where z is -w (glClipControl)
    float y_up = 1;             ///< -1: the window's y goes down while that of clip space goes up (glClipControl)
    bool by_shader = false;     ///< which rounds in an order of its own, so that what it makes lies about there
    Mat4 camera{};              ///< whose clip coordinates these are (view_change.h); zeros: none that is known
    Mat4 sizes{};               ///< if by_shader: as of glapi::PositionTransform
    /// Where it is drawn is not known, or what its camera does only by its name.
    bool unknown_elsewhere = false;
    /// By another camera it may be anywhere. A shader of which no camera is known may use matrices of fixed function,
    /// which views change.
    bool anywhere_in_views() const { return unknown_elsewhere || (by_shader && camera == Mat4{}); }
};

Projection make_projection(const State& state);
/// The same of vertices that a shader places. `depth`: as of its position program.
Projection make_projection(const Projection& fixed_function, const glapi::PositionTransform& transform, bool depth);
/// `camera`: 16 numbers column by column, or none.
void set_camera(Projection& projection, std::span<const float> camera);
/// Every box may be anywhere. `camera`: as of a Projection.
Projection unknown_projection(const Mat4& camera = {});
Mat4 multiply(const Mat4& a, const Mat4& b);

/// Where the box can be drawn; nothing if that is unknown. Empty behind the eye.
std::optional<PixelRect> project(const Projection& projection, const geom::Box& box);
/// The same of primitives of one mode. A shader's point size is known by its limit only, which triangles do not reach.
std::optional<PixelRect> project(const Projection& projection, const geom::Box& box, GLenum mode);

struct WindowVertex {
    std::array<float, 4> clip;
    float x, y;
    bool in_front;  ///< of the eye; else x and y mean nothing
};
WindowVertex project(const Projection& projection, float x, float y, float z, float w);

/// A vertex whose clip coordinates were made by another projection, with what brings them to those of this one.
WindowVertex moved(const Projection& projection, const WindowVertex& vertex, const Mat4& change);

/// Where the convex hull of some vertices can be drawn, what clipping leaves of it; nothing if that is unknown.
std::optional<PixelRect> hull_rect(const Projection& projection, std::span<const WindowVertex> vertices);

}  // namespace wall::glstate
