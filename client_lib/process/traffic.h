// SPDX-License-Identifier: MIT
// What a program has sent, as walld is told it. Counters since the program came to OpenGL.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "common/base/ids.h"

namespace wall::client {

/// Bytes of commands packed for one node, and how many went out for them.
struct NodeTraffic {
    NodeIndex node;
    std::uint64_t state_bytes = 0, object_bytes = 0, geometry_bytes = 0, link_bytes = 0;
};

struct Traffic {
    std::uint64_t frames = 0, round_trips = 0;
    std::uint64_t lossy_vertices = 0;      ///< that were sent a little off
    std::chrono::nanoseconds diff_time{};  ///< comparing contexts with what nodes hold; an estimate
    std::vector<NodeTraffic> nodes;        ///< those that something was packed for
    /// Windows that cover tiles that look elsewhere: seen through their views, or shown flat.
    std::vector<SurfaceId> seen, flat;
};

}  // namespace wall::client
