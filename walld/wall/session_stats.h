// SPDX-License-Identifier: MIT
// What nodes tell of programs, with the processes of a parallel one together. Pure.
#pragma once

#include <map>

#include "walld/wall/wall.h"

namespace wall::walld {

/// Of the programs that have a stream to the node; of two streams of one process, the newer one's.
std::map<SessionId, proto::SessionStats> stats_by_session(const proto::NodeStats& stats);

/// What a program has on nodes.
struct HeldOnNodes {
    std::uint64_t memory_bytes = 0;  ///< of the driver's, for its objects, by estimate; the most on one
    std::uint64_t objects = 0;       ///< the same
    /// Of sort-last, all nodes together (docs/sort-last.md).
    struct {
        std::uint64_t bytes = 0, merged = 0, missed = 0;
        double seconds = 0, wait_seconds = 0;
    } partials;
};
/// Of each program that a node which is up tells of.
std::map<SessionId, HeldOnNodes> held_on_nodes(const Wall& wall);

}  // namespace wall::walld
