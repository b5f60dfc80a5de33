// SPDX-License-Identifier: MIT
// Sort-first: from geometry to the tiles it may touch (W3.2, T6.1). Conservative: what cannot be bounded goes
// to every tile of the surface. Pure; the caller's thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/ids.h"
#include "common/geom/box.h"
#include "common/geom/rect.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Window pixels, origin bottom left, y up (OpenGL's window coordinates).
struct PixelRect {
    float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool overlaps(const PixelRect& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

/// A tile (or the offscreen layer) that shows a part of a surface.
struct Target {
    NodeIndex node;
    std::uint32_t slot = 0;
    PixelRect area;     ///< of the surface's window
    geom::Rect pixels;  ///< the same, whole pixels, rounded outwards
};

/// How a surface lies on the wall just now.
struct SurfaceLayout {
    std::uint32_t version = 0;
    std::uint32_t width = 0, height = 0;  ///< window
    geom::Rect rect;                      ///< canvas
    bool offscreen = false;
    std::vector<Target> targets;
};

/// The transformation of object space to window pixels, and how far rasterization may reach beyond the vertices.
struct Projection {
    glstate::Mat4 clip_from_object{};
    float viewport[4]{};     ///< x, y, width, height
    float margin = 1;        ///< pixels: half the line width or point size, and one for rounding
    bool near_plane = true;  ///< clips; not while depths are clamped
};

Projection make_projection(const glstate::State& state);
glstate::Mat4 multiply(const glstate::Mat4& a, const glstate::Mat4& b);

/// Where the box can be drawn; nothing if that is unknown. Empty behind the eye.
std::optional<PixelRect> project(const Projection& projection, const geom::Box& box);

struct WindowVertex {
    std::array<float, 4> clip;
    float x, y;
    bool in_front;  ///< of the eye; else x and y mean nothing
};
WindowVertex project(const Projection& projection, float x, float y, float z, float w);

/// Where the convex hull of some vertices can be drawn, what clipping leaves of it; nothing if that is unknown.
std::optional<PixelRect> hull_rect(const Projection& projection, std::span<const WindowVertex> vertices);

/// Some tiles of one node.
struct NodeMask {
    NodeIndex node;
    std::uint64_t slots;  ///< a bit each
};
using NodeMasks = std::vector<NodeMask>;

/// The tiles that a rectangle touches; nothing: all. Each node once.
NodeMasks targets_of(const SurfaceLayout& layout, const std::optional<PixelRect>& rect);
/// The same into a vector that is used again and again, so that no memory is asked for.
void targets_of(std::span<const Target> targets, const std::optional<PixelRect>& rect, NodeMasks& out);

}  // namespace wall::client
