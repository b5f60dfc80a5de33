// SPDX-License-Identifier: MIT
// Which layers a surface has on a node: the last operand of SurfacePlace. Any thread.
#pragma once

#include <cstdint>

#include "common/wire/limits.h"

namespace wall::wire {

inline constexpr std::uint32_t kTilesOnly = 0;
inline constexpr std::uint32_t kOnlyWholeWindow = 1;   ///< one of the window's size in kOffscreenSlot, none on tiles
inline constexpr std::uint32_t kAlsoWholeWindow = 2;   ///< that one besides those on tiles, as soon as it is drawn on
inline constexpr std::uint32_t kShownWholeWindow = 3;  ///< only that one, of which tiles show parts

}  // namespace wall::wire
