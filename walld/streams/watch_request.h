// SPDX-License-Identifier: MIT
// What a viewer asks to see (docs/streams.md): a tile, the wall, a part of either, or a program's window. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/geom/rect.h"

namespace wall::walld {

struct WatchRequest {
    static constexpr std::size_t kMost = 256;  ///< of one viewer
    static constexpr std::uint32_t kMaxFps = 60;

    std::string tile;   ///< this tile; or
    bool wall = false;  ///< the canvas; or, without either, a window of the session
    SessionId session;  ///< with a tile or the wall: only its windows; none: all
    SurfaceId surface;  ///< only this window; none: all of the session, or its topmost if nothing else is shown
    std::optional<geom::Rect> region;  ///< in pixels of the tile or the canvas
    bool output = false;               ///< of a tile: what its output shows, in its pixels
    std::string codec = "huffyuv";
    std::uint32_t width = 0, height = 0;  ///< of the picture; 0: of what it shows
    bool fit = false;                     ///< width and height are a box; proportions stay
    std::uint32_t fps = 10;

    /// A window, wherever it is.
    bool follows() const { return tile.empty() && !wall; }

    /// A viewer's message {"watch": [...]}. The error says what was expected, and where.
    static Result<std::vector<WatchRequest>> parse(std::string_view json);
};

}  // namespace wall::walld
