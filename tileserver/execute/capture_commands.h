// SPDX-License-Identifier: MIT
// Group [capture]: transform feedback. Render thread.
#pragma once

#include <cstddef>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class CaptureCommands {
public:
    /// `execution` outlives it.
    explicit CaptureCommands(Execution& execution) : execution_(execution) {}

    void Capture(ClientName capture, GLenum mode, std::span<const std::byte> parts);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
