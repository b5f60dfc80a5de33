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

/// False: there is no such query as the context names, or the session may have no more.
[[nodiscard]] bool switch_to(RenderNode& node, SessionReplica& session, SoftContext& context, RenderTarget& target,
                             Counted counted);

}  // namespace wall::tileserver
