// SPDX-License-Identifier: MIT
#include "tileserver/session/parallel_group.h"

#include "tileserver/session/render_node.h"

namespace wall::tileserver {

SurfaceReplica* ParallelGroup::surface(SurfaceId id) {
    const auto at = surfaces_.find(id);
    return at == surfaces_.end() ? nullptr : at->second.get();
}

SurfaceReplica* ParallelGroup::open_surface(Rank rank, SurfaceId id, const SurfaceFormat& format) {
    auto& surface = surfaces_[id];
    if (!surface) surface = std::make_unique<SurfaceReplica>(driver_.gl(), driver_.flip_y(), format, pixels_);
    if (!(surface->format() == format)) return nullptr;
    sync.surface_open(rank, id);
    return surface.get();
}

void ParallelGroup::close_surface(Rank rank, SurfaceId id) {
    if (!sync.surface_close(rank, id)) return;
    driver_.forget_target();
    surfaces_.erase(id);
}

std::vector<FinishedFrame> ParallelGroup::finish_frames(RenderNode& node, Work& work, SessionId session) {
    auto finished = sync.take_finished();
    for (const auto& [id, frame] : finished)
        if (SurfaceReplica* shared = surface(id))
            // Also where it is on no tile: all nodes keep step.
            finish_frame(node, work, *shared, frame, node.shows_at_once(session, id));
    return finished;
}

}  // namespace wall::tileserver
