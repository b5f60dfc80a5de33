// SPDX-License-Identifier: MIT
// Which nodes get a surface's next frame. A node that has not drawn a frame in time (stopped, dead without a word,
// slow) is left out: nothing of the surface is sent to it until it has drawn the last frame that it got. Then the
// difference brings it up to date, since its mirror has stood still as well. So its queue stays short, and neither the
// program nor the other nodes wait for it. Pure.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wall::client {

/// Packing one while the nodes draw the other.
inline constexpr std::uint32_t kFramesInFlight = 2;

/// More than this is not queued for a node that is late, whatever it costs.
inline constexpr std::size_t kMaxLateBytes = 8u << 20;

struct NodeProgress {
    bool done = false;      ///< drew in time what was waited for
    bool left_out = false;  ///< already
    std::size_t queued_bytes = 0;
};

/// `others_done`: another node of the surface was in time, so it is not that all are held or slow alike.
/// `whole_frames`: frames start by clearing everything, so that one may be missed. A frame that builds on the one
/// before is kept for a late node as long as its queue allows.
constexpr bool leave_out(const NodeProgress& node, bool others_done, bool whole_frames) {
    if (node.done) return false;
    return node.left_out || (others_done && whole_frames) || node.queued_bytes > kMaxLateBytes;
}

}  // namespace wall::client
