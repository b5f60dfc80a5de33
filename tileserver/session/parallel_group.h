// SPDX-License-Identifier: MIT
// What the members of a parallel program share on this node: the windows (their layers, with depth and stencil), and
// the order between their streams. Contexts and objects are each member's own (SessionReplica). Lives as long as the
// first to the last of the members' streams. Render thread.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "tileserver/session/group_sync.h"
#include "tileserver/session/limits.h"
#include "tileserver/session/surface.h"
#include "tileserver/session/work.h"

namespace wall::tileserver {

struct RenderNode;
class Driver;

/// What walld says of a session's members.
struct Membership {
    std::uint32_t members = 0;  ///< 0: no parallel program
    std::set<Rank> left;        ///< before this node came to the session
};

class ParallelGroup {
public:
    ParallelGroup(Driver& driver, const Membership& membership)
        : sync(membership.members, membership.left), driver_(driver) {}

    GroupSync sync;

    static bool shares(SurfaceId id) { return id.value != 0 && id.value <= wire::kMaxSharedSurfaces; }

    /// As SessionReplica's.
    void set_most_pixels(std::int64_t most) { pixels_.set(most); }
    SurfaceReplica* surface(SurfaceId id);
    const std::map<SurfaceId, std::unique_ptr<SurfaceReplica>>& surfaces() const { return surfaces_; }
    /// The first member makes it. Null: it has another format.
    SurfaceReplica* open_surface(Rank rank, SurfaceId id, const SurfaceFormat& format);
    void close_surface(Rank rank, SurfaceId id);
    /// All frames that the members have ended since the last call become the surfaces' waiting frames. `work`: of who
    /// ended them; `session`: the group's.
    std::vector<FinishedFrame> finish_frames(RenderNode& node, Work& work, SessionId session = {});

private:
    Driver& driver_;
    PixelBudget pixels_{kMaxLayerPixels};  // before the surfaces, which use it to the end
    std::map<SurfaceId, std::unique_ptr<SurfaceReplica>> surfaces_;
};

}  // namespace wall::tileserver
