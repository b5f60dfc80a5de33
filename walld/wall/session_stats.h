// SPDX-License-Identifier: MIT
// What nodes tell of programs, with the processes of a parallel one together. Pure.
#pragma once

#include <map>

#include "walld/wall/wall.h"

namespace wall::walld {

/// Of the programs that have a stream to the node; of two streams of one process, the newer one's.
std::map<SessionId, proto::SessionStats> stats_by_session(const proto::NodeStats& stats);

/// What a program has on the node where it has most of it.
struct HeldOnNode {
    std::uint64_t memory_bytes = 0;  ///< of the driver's, for its objects, by estimate
    std::uint64_t objects = 0;
};
HeldOnNode held_by(const Wall& wall, SessionId session);

}  // namespace wall::walld
