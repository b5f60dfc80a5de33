// SPDX-License-Identifier: MIT
// The soft context switch (Tracking Graphics State, section 5): the one driver context is brought from whatever it
// holds to what a session's context wants, on the target that is drawn to. What is the same costs a comparison of ids.
// Render thread.
#pragma once

#include "tileserver/session/render_node.h"
#include "tileserver/session/session.h"

namespace wall::tileserver {

/// Which queries of a context count what is drawn to a target.
struct Counted {
    bool samples = false;
    bool primitives = false;  ///< also captured ones
};

/// Whether what the context names was looked up since it or the session's objects changed.
inline bool textures_are_known(const SessionReplica& session, const SoftContext& context) {
    return context.textures.state_id == context.state.ids[static_cast<std::size_t>(glstate::Category::textures)] &&
           context.textures.version == session.objects.version(ObjectKind::texture);
}
inline bool samplers_are_known(const SessionReplica& session, const SoftContext& context) {
    return context.samplers.values == context.state.ids[static_cast<std::size_t>(glstate::Category::objects)] &&
           context.samplers.version == session.objects.version(ObjectKind::sampler);
}

/// switch_to() where the driver does not hold all that the context wants.
[[nodiscard]] bool bring_driver_to(RenderNode& node, SessionReplica& session, SoftContext& context,
                                   RenderTarget& target, Counted counted);

/// False: there is no such query as the context names, or the session may have no more.
[[nodiscard]] inline bool switch_to(RenderNode& node, SessionReplica& session, SoftContext& context,
                                    RenderTarget& target, Counted counted) {
    // Contexts without programs and queries that want what the last one wanted; a program may want something else for
    // each target.
    if (node.driver.holds(context.state) && textures_are_known(session, context) &&
        samplers_are_known(session, context) && context.samplers.only_samplers &&
        node.driver.has_bound(target, context.state, context.textures.bindings, context.samplers.bindings) &&
        node.maps.has_initial_evaluators(context.maps))
        return true;
    return bring_driver_to(node, session, context, target, counted);
}

}  // namespace wall::tileserver
