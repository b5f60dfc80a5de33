// SPDX-License-Identifier: MIT
// What this node holds of one application: soft contexts, surfaces, objects. It lives as long as the
// application's stream; all of it can be sent again. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/base/ids.h"
#include "common/glstate/value_history.h"
#include "gen/glstate/state.gen.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/soft_maps.h"
#include "tileserver/objects/content_store.h"
#include "tileserver/objects/object_table.h"
#include "tileserver/session/limits.h"
#include "tileserver/session/parallel_group.h"
#include "tileserver/session/partial_layers.h"
#include "tileserver/session/surface.h"
#include "tileserver/session/work.h"

namespace wall::tileserver {

/// A soft context's texture bindings in the driver's names, and what they were looked up from.
struct BoundTextures {
    std::uint64_t state_id = 0,
                  version = 0;  ///< value id of the category `textures`, ObjectTable::version()
    TextureBindings bindings;
};

/// The same of its samplers.
struct BoundSamplers {
    std::uint64_t values = 0, version = 0;  ///< value id of the category `objects`, ObjectTable::version()
    SamplerBindings bindings;
    bool only_samplers = false;  ///< that category names nothing else: no program, no query, no capture
};

struct SoftContext {
    glstate::State state;
    glstate::ValueHistory history;
    SurfaceId draw, read;
    ClientName draw_framebuffer, read_framebuffer;  ///< instead of these; 0: none
    bool counts_samples = true;                     ///< of what is drawn to the framebuffer: one node does
    SoftMaps maps;
    BoundTextures textures;
    BoundSamplers samplers;
};

class SessionReplica {
public:
    /// `group`: of a parallel program, of which this is the member `rank`; outlives the session.
    SessionReplica(Driver& driver, SessionId id, ParallelGroup* group = nullptr, Rank rank = 0)
        : driver_(driver), id_(id), group_(group), rank_(rank) {}
    ~SessionReplica() { driver_.forget_target(); }
    SessionReplica(const SessionReplica&) = delete;

    SessionId id() const { return id_; }
    /// Of all its windows' layers.
    void set_most_pixels(std::int64_t most) { pixels_.set(most); }
    ContentAsker asker() const { return ContentAsker(std::uint64_t{id_.value} << 32 | rank_); }
    ParallelGroup* group() const { return group_; }
    Rank rank() const { return rank_; }
    SoftContext& context(ContextId id) { return contexts_[id]; }
    void destroy_context(ContextId id) { contexts_.erase(id); }
    /// As if nothing had come of contexts and objects. Surfaces stay as they are.
    void begin_again() {
        contexts_.clear();
        objects.clear();
    }
    std::size_t context_count() const { return contexts_.size(); }

    /// Of its own or, in a parallel program, of all members.
    SurfaceReplica* surface(SurfaceId id);
    bool shares(SurfaceId id) const { return group_ != nullptr && ParallelGroup::shares(id); }
    template <class Visit>
    void for_each_surface(Visit&& visit) const {
        for (const auto& [id, surface] : surfaces_) visit(id, *surface);
        if (group_ == nullptr) return;
        for (const auto& [id, surface] : group_->surfaces()) visit(id, *surface);
    }
    /// Null if the session has too many, or if the other members have made it in another format.
    SurfaceReplica* create_surface(SurfaceId id, const SurfaceFormat& format);
    void destroy_surface(SurfaceId id);
    /// What this stream draws of a window for other nodes.
    PartialLayers& partials(SurfaceId id) { return partials_[id]; }

    ObjectTable objects;
    Work work;

private:
    Driver& driver_;
    SessionId id_;
    ParallelGroup* group_;
    Rank rank_;
    std::unordered_map<ContextId, SoftContext> contexts_;
    PixelBudget pixels_{kMaxLayerPixels};  // before the surfaces, which use it to the end
    std::unordered_map<SurfaceId, std::unique_ptr<SurfaceReplica>> surfaces_;
    std::unordered_map<SurfaceId, PartialLayers> partials_;
};

}  // namespace wall::tileserver
