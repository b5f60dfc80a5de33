// SPDX-License-Identifier: MIT
// What perfect sorting would send of a program's blocks, to hold our own traffic against (WALLGL_IDEAL=1,
// bench/traffic.py). Each node gets exactly the vertices (with their attribute commands) of the primitives whose own
// window rectangle touches one of its tiles, and the matrices only of blocks of which it gets something. The session's
// mutex is held.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <utility>

#include "client_lib/follow/draw_source.h"
#include "client_lib/geometry/packer.h"
#include "common/glstate/projection.h"

namespace wall::client {

/// One block's share.
struct IdealBlock {
    std::size_t bytes = 0;      ///< of geometry, over all nodes
    std::set<NodeIndex> nodes;  ///< that get something
};
IdealBlock ideal_block(const Packer& packer, const glstate::Projection& projection,
                       std::span<const TargetLayer> layers);

/// Adds the blocks up in the counters `ideal_geometry_bytes` and `ideal_matrices`. The latter counts a set of matrices
/// for each node that draws with it: state that changes with every object cannot be sent less often.
class IdealTraffic {
public:
    void count(const DrawSource& source, const Packer& packer, const glstate::Projection& projection);

private:
    std::pair<ContextId, std::uint64_t> matrices_;  ///< context and value id of the latest block's
    std::set<NodeIndex> nodes_;                     ///< that have been counted for them
};

}  // namespace wall::client
