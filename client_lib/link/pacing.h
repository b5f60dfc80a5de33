// SPDX-License-Identifier: MIT
// Which nodes get a surface's next frame. A node that has not drawn a frame in time (stopped, dead without a word,
// slow) is left out: nothing of the surface is sent to it until it has drawn the last frame that it got. Then the
// difference brings it up to date, since its mirror has stood still as well. So its queue stays short, and neither the
// program nor the other nodes wait for it. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace wall::client {

/// Packing one while the nodes draw the other.
inline constexpr std::uint32_t kFramesInFlight = 2;

/// More than this is not queued for a node that is late, whatever it costs.
inline constexpr std::size_t kMaxLateBytes = 8u << 20;

struct NodeProgress {
    std::uint32_t frame = 0;  ///< that was waited for
    bool done = false;        ///< drew it in time
    bool left_out = false;    ///< already
    std::size_t queued_bytes = 0;
};

/// The newest frame that a node of the surface has drawn in time; 0 = none has.
constexpr std::uint32_t newest_done(std::span<const NodeProgress> nodes) {
    std::uint32_t newest = 0;
    for (const NodeProgress& node : nodes)
        if (node.done) newest = std::max(newest, node.frame);
    return newest;
}

/// `newest`: what newest_done() says of all. A node is late alone only if another has drawn the same frame or a later
/// one: otherwise all are held or slow alike, even if one has just drawn an old frame with which it comes back.
/// `whole_frames`: frames start by clearing everything, so that one may be missed. A frame that builds on the one
/// before is kept for a late node as long as its queue allows.
constexpr bool leave_out(const NodeProgress& node, std::uint32_t newest, bool whole_frames) {
    if (node.done) return false;
    return node.left_out || (newest >= node.frame && whole_frames) || node.queued_bytes > kMaxLateBytes;
}

}  // namespace wall::client
