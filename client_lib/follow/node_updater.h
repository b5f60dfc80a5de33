// SPDX-License-Identifier: MIT
// The lazy update (T4, W3.3): before a node draws with a context, its batch gets what its mirror lacks. The session's
// mutex is held.
#pragma once

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/hand_on.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/geometry/needs.h"

namespace wall::client {

class NodeUpdater {
public:
    /// `nodes` outlives it.
    explicit NodeUpdater(Nodes& nodes) : nodes_(nodes), hand_on_(nodes) {}

    /// Before the next one is called for each of these: what they lack alike of what drawing with the context needs,
    /// and of what the draw names.
    template <class Named = NamesNone>
    void prepare_all(const NodeMasks& nodes, const DrawSource& source, const Named& named = {}) {
        hand_on_.bring_used(nodes, source);
        hand_on_.bring_named(nodes, source, named);
    }

    /// The node's batch after everything that drawing with this context needs: targets, objects, state.
    wire::PackBuffer& prepare(Node& node, const DrawSource& source, const Needs& needs = {});

private:
    Nodes& nodes_;
    HandOn hand_on_;
    std::uint32_t prepared_ = 0;  ///< counts towards the next sample of the diff time
};

}  // namespace wall::client
