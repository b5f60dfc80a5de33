// SPDX-License-Identifier: MIT
// After a swap: a program is at most two frames ahead of the wall. Application threads.
#pragma once

#include <chrono>
#include <mutex>

#include "client_lib/follow/nodes.h"
#include "client_lib/follow/surface.h"

namespace wall::client {

/// What the waits share. `mutex`, which guards nodes and surfaces, is taken in them.
struct FrameWait {
    std::mutex& mutex;
    Nodes& nodes;
    std::chrono::milliseconds limit;  ///< for a node that is late while another is not
};

/// Waits for the nodes that show the surface. One that has stopped is left out. `whole_frames`: frames begin with a
/// clear of everything, so that one can do without those before it.
void wait_for_nodes(const FrameWait& wait, ClientSurface& surface, bool whole_frames);

/// The same in a parallel program: until some node has drawn the frame, however long that takes.
void wait_for_group(const FrameWait& wait, const ClientSurface& surface);

}  // namespace wall::client
