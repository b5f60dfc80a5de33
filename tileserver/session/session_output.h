// SPDX-License-Identifier: MIT
// What executing a session's stream tells the world: answers to the client, frames to walld. Called by the render
// thread; must not block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/ids.h"

namespace wall::tileserver {

class SessionOutput {
public:
    virtual ~SessionOutput() = default;
    virtual void reply(RequestId request, std::vector<std::byte> answer) = 0;
    /// All of this node's layers of the surface hold the frame; it waits to be shown.
    virtual void frame_rendered(SurfaceId surface, std::uint32_t frame) = 0;
    /// A partial picture (tileserver/partials/partial_format.h) for another node of the session.
    virtual void partial(NodeIndex to, std::vector<std::byte> message) = 0;
};

}  // namespace wall::tileserver
