// SPDX-License-Identifier: MIT
// What all sessions of a node draw with: the driver, its tiles, and what sessions may share. Render thread.
#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "tileserver/driver/driver.h"
#include "tileserver/driver/soft_maps.h"
#include "tileserver/driver/tile_times.h"
#include "tileserver/objects/shared_content.h"
#include "tileserver/session/surface.h"
#include "tileserver/session/work.h"

namespace wall::tileserver {

struct SoftContext;
class CompileTrials;
class PartialBox;

/// What the executors of a node share.
struct RenderNode {
    Driver& driver;
    MapMirror maps;
    SharedContents shared;  ///< that several sessions hold, or may hold
    std::vector<Tile> tiles;
    TileTimes tile_times;
    std::uint64_t damage = 1;      ///< grows when a tile's picture may have changed
    bool present_at_once = false;  ///< nobody coordinates: show frames when they are done, but for held ones
    std::set<std::pair<SessionId, SurfaceId>> held;  ///< windows whose frames are shown only when somebody says so
    std::set<SessionId> returning;                   ///< whoever coordinates does not know them yet
    const SoftContext* current = nullptr;            ///< whose state the driver holds; only compared, it may be gone
    CompileTrials* trials = nullptr;                 ///< of shaders; null: the driver compiles them at once
    PartialBox* partials = nullptr;                  ///< that other nodes have sent; null: none can come
    bool orders_triangles = false;                   ///< of meshes that stay, where nobody sees it (index_orders.h)
    Work ended;                                      ///< of sessions that are gone

    explicit RenderNode(Driver& d) : driver(d), tile_times(d.gl()) {}
    /// The window's frame is shown when it is done, because nobody will say when.
    bool shows_at_once(SessionId session, SurfaceId surface) const {
        return (present_at_once || returning.contains(session)) && !held.contains({session, surface});
    }
};

/// The surface's back buffers are its next picture, which is shown `at_once` or waits to be presented.
void finish_frame(RenderNode& node, Work& work, SurfaceReplica& surface, std::uint32_t frame, bool at_once);

}  // namespace wall::tileserver
