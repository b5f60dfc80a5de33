// SPDX-License-Identifier: MIT
// What nodes tell of programs, with the processes of a parallel one together. Pure.
#pragma once

#include <map>

#include "walld/wall/wall.h"

namespace wall::walld {

/// Of the programs that have a stream to the node; of two streams of one process, the newer one's.
std::map<SessionId, proto::SessionStats> stats_by_session(const proto::NodeStats& stats);

/// What a program has on a node.
struct HeldOnNode {
    std::uint64_t memory_bytes = 0;  ///< of the driver's, for its objects, by estimate
    std::uint64_t objects = 0;
};
/// Of each program that a node which is up tells of: of each, the most that it has on one.
std::map<SessionId, HeldOnNode> most_held(const Wall& wall);

}  // namespace wall::walld
