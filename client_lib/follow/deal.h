// SPDX-License-Identifier: MIT
// Sort-last: geometry whose order cannot matter is dealt to the nodes of the session that render, each of which draws
// what it gets of the whole window, for nobody to be seen; what they have drawn is composed by depth into the layers
// that tiles show (A3.3, docs/sort-last.md). Everything else is drawn there as ever, behind what was composed until
// then, so a frame is any number of deals with other commands between them.
//
// Each node gets one run of a frame's draws, in the order of the nodes, so that of two fragments of the same depth the
// one wins that the depth function lets win. Where runs end comes from how many elements the frame before had, and from
// how long the nodes have taken for theirs.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "client_lib/follow/fence.h"
#include "client_lib/geometry/dealable.h"
#include "client_lib/geometry/target_layers.h"
#include "common/base/ids.h"

namespace wall::client {

/// How long nodes have taken for what they were dealt, and what share of the next frame each gets by that. Pure.
class NodePaces {
public:
    /// The node has taken so long for so many elements.
    void note(NodeIndex node, double elements, std::chrono::nanoseconds took);
    /// Where the runs of these nodes end in a frame, of 1. One that was not measured yet counts as the mean of the
    /// others.
    std::vector<double> ends(std::span<const NodeIndex> nodes) const;

private:
    std::map<NodeIndex, double> paces_;  ///< nanoseconds an element, smoothed
};

/// How a window's geometry is dealt; of ClientSurface.
struct Deal {
    struct Hand {
        NodeIndex node;
        double end = 1;       ///< of its run, in a frame
        bool drew = false;    ///< since the last composition
        double elements = 0;  ///< the same
    };
    /// A node will say how long it took.
    struct Asked {
        NodeIndex node;
        double elements = 0;
        Fence answer;
    };
    std::vector<Hand> hands;             ///< by node, in the order in which they draw
    std::vector<NodeIndex> compositors;  ///< that put together what they have drawn; none: who shows it does
    /// Layers that what was dealt will be composed in; a block for them names them by their places here.
    std::vector<TargetLayer> receivers;
    bool open = false;                 ///< something was dealt and not composed
    bool chosen = false;               ///< `hands` are this frame's
    std::uint32_t by = 0;              ///< how what is open will be composed (composed_by())
    std::uint32_t sequence = 0;        ///< of the last composition
    double cost = 0, cost_before = 0;  ///< elements dealt in this frame, and in the one before
    NodePaces paces;
    std::vector<Asked> asked;
    MarkingState::Ids marking{};
};

}  // namespace wall::client
