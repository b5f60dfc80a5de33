// SPDX-License-Identifier: MIT
// What a stream shows, and the tiles that it takes: each gives a part of the picture. Pure; of the wall as it is now.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "walld/streams/watch_request.h"
#include "walld/wall/wall.h"

namespace wall::walld {

struct StreamScope {
    geom::Rect rect;                                          ///< of the canvas, or of the output
    bool output = false;                                      ///< what the tile's output shows
    std::uint32_t width = 0, height = 0;                      ///< of the picture, pixels
    SessionId session;                                        ///< only its windows; none: all
    SurfaceId surface;                                        ///< only this one; none: all
    std::optional<std::pair<NodeIndex, std::uint32_t>> tile;  ///< only this one (node, slot)
    bool operator==(const StreamScope&) const = default;
};

/// A tile's part of the picture.
struct StreamPart {
    NodeIndex node;
    std::uint32_t slot = 0;
    geom::Rect crop;  ///< what it shows, in pixels of the tile
    geom::Rect at;    ///< where it lies in the picture
};

/// The error says which member of the request is wrong (".tile: there is no tile 'x'").
Result<StreamScope> scope_of(const Wall& wall, const WatchRequest& request);

/// The parts in the order of nodes and slots, those of tiles that are away too. Edges are rounded, so that tiles that
/// touch on the canvas touch in the picture.
std::vector<StreamPart> parts_of(const Wall& wall, const StreamScope& scope);

}  // namespace wall::walld
