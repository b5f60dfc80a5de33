// SPDX-License-Identifier: MIT
// Groups [capture] and [capture_end]: transform feedback. Render thread.
#pragma once

#include <cstddef>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class Capture;

class CaptureCommands {
public:
    /// `execution` outlives it.
    explicit CaptureCommands(Execution& execution) : execution_(execution) {}

    void Capture(ClientName capture, GLenum mode, std::span<const std::byte> parts);
    void CaptureEnd(ClientName capture);
    void CaptureCounts(RequestId request, ClientName capture);
    void CaptureCounted(ClientName capture, std::span<const std::byte> counts);

private:
    /// One that is not defined yet; null: refused.
    tileserver::Capture* make(ClientName name);

    Execution& execution_;
};

}  // namespace wall::tileserver
