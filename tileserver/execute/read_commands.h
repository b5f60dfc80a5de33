// SPDX-License-Identifier: MIT
// Group [read]: what the program reads back of its drawing. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class ReadCommands {
public:
    /// `execution` outlives it.
    explicit ReadCommands(Execution& execution) : execution_(execution) {}

    void ReadPixels(RequestId request, std::uint32_t slot, std::int32_t x, std::int32_t y, std::int32_t width,
                    std::int32_t height, GLenum format, GLenum type);
    void RenderMode(RequestId request, GLenum mode, GLenum feedback_type, std::uint32_t buffer_entries);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
