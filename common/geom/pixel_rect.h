// SPDX-License-Identifier: MIT
// A rectangle of a window's pixels, with fractions. Pure.
#pragma once

namespace wall::geom {

/// Window pixels, origin bottom left, y up (OpenGL's window coordinates).
struct PixelRect {
    float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool overlaps(const PixelRect& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

}  // namespace wall::geom
