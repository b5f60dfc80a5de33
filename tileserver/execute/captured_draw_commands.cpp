// SPDX-License-Identifier: MIT
#include "tileserver/execute/captured_draw_commands.h"

#include <algorithm>
#include <limits>

#include "tileserver/objects/capture.h"

namespace wall::tileserver {

/// The driver could draw from its own object as well, but would not look whether so many lie in the arrays.
void CapturedDrawCommands::DrawCaptured(ClientName name, ClientName capture, GLenum mode, std::uint32_t stream,
                                        std::int32_t instances) {
    const auto found = execution_.session.objects.get<Capture>(capture);
    if (!found) return execution_.refuse(found.error().message);
    if (!(*found)->ended() || stream >= kVertexStreams) return execution_.refuse("transform feedback that goes on");
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
    const auto count = static_cast<std::int32_t>(std::min((*found)->counts()[stream], kMost));
    VertexInput* input = instanced_.begin(name, mode, count, instances);
    if (input != nullptr && draws_.has_elements(*input, 0, count))
        execution_.gl.DrawArraysInstanced(mode, 0, count, instances);
}

}  // namespace wall::tileserver
