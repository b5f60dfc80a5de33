// SPDX-License-Identifier: MIT
// Where a new window goes. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "common/geom/rect.h"

namespace wall::walld {

/// How far one window of a cascade lies below and right of the one before.
inline constexpr std::int32_t kCascadeStep = 32;  // pixels

/// The first place, from the top left, row by row, where a window of that size fits on the canvas without covering
/// another one. If there is none: a cascade, `cascade` steps from the top left, kept on the canvas if it fits at all.
geom::Rect place(const geom::Rect& canvas, std::span<const geom::Rect> taken, std::int32_t width, std::int32_t height,
                 std::uint32_t cascade);

}  // namespace wall::walld
