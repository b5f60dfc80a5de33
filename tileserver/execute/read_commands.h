// SPDX-License-Identifier: MIT
// Group [read]: what the program reads back of its drawing. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tileserver/driver/window_values.h"
#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class ReadCommands {
public:
    /// `execution` outlives it.
    explicit ReadCommands(Execution& execution) : execution_(execution) {}

    void ReadPixels(RequestId request, std::uint32_t slot, std::int32_t x, std::int32_t y, std::int32_t width,
                    std::int32_t height, GLenum format, GLenum type);
    void SamplePosition(RequestId request, std::uint32_t samples, std::uint32_t index, std::uint32_t of_window);
    void RasterPosition(RequestId request, float x, float y, float z, float w);
    void RenderMode(RequestId request, GLenum mode, GLenum feedback_type, std::uint32_t buffer_entries);

private:
    void read_framebuffer(ClientName framebuffer, const WindowValues::IntBox& box, GLenum format, GLenum type,
                          std::span<std::byte> answer);

    Execution& execution_;
};

}  // namespace wall::tileserver
