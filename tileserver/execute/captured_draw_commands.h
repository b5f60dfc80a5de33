// SPDX-License-Identifier: MIT
// Group [captured_draw]: draws of as many vertices as transform feedback has captured, in a block. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/instanced_draw_commands.h"

namespace wall::tileserver {

class CapturedDrawCommands {
public:
    /// All outlive it.
    CapturedDrawCommands(Execution& execution, ArrayDrawCommands& draws, InstancedDrawCommands& instanced)
        : execution_(execution), draws_(draws), instanced_(instanced) {}

    void DrawCaptured(ClientName input, ClientName capture, GLenum mode, std::uint32_t stream, std::int32_t instances);

private:
    Execution& execution_;
    ArrayDrawCommands& draws_;
    InstancedDrawCommands& instanced_;
};

}  // namespace wall::tileserver
