// SPDX-License-Identifier: MIT
// A recorded command as one node of a wall gets it: windows have the names and the tiles that they have there, and
// nobody waits for answers. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>

#include "common/base/ids.h"
#include "common/glstate/command_walk.h"
#include "common/wire/pack_buffer.h"

namespace wall::wallplay {

/// What a node is told of the windows now.
struct NodeView {
    /// Its name on this wall; 0: it is not open.
    std::function<SurfaceId(SurfaceId recorded)> surface;
    /// The node's tiles that show it, as a Block's mask; 0: none.
    std::function<std::uint64_t(SurfaceId recorded)> slots;
};

/// What each context draws to. One for each reader of the stream, from the segment's beginning on.
class DrawnSurfaces {
public:
    /// Takes note of it, if it says so.
    void note(ContextId context, const glstate::Command& command);
    /// 0: nothing yet.
    SurfaceId of(ContextId context) const;

private:
    std::unordered_map<ContextId, SurfaceId> draws_;
};

/// Whether who plays a recording sees to it instead of the nodes: what windows there are, where they lie, and when a
/// frame ends.
bool is_of_windows(glapi::Op op);

/// Appends it; `drawn`: what its context draws to. Not one that is_of_windows().
void rewrite(const glstate::Command& command, SurfaceId drawn, const NodeView& view, wire::PackBuffer& to);

}  // namespace wall::wallplay
