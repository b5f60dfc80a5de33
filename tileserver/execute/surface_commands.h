// SPDX-License-Identifier: MIT
// Group [surface]: a session's windows, what contexts draw to, and frames. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class SurfaceCommands {
public:
    /// `execution` outlives it.
    explicit SurfaceCommands(Execution& execution) : execution_(execution) {}

    void SurfaceCreate(SurfaceId surface, std::uint32_t double_buffered, std::uint32_t alpha_bits,
                       std::uint32_t depth_bits, std::uint32_t stencil_bits, std::uint32_t accum_bits,
                       std::uint32_t samples, std::uint32_t srgb, std::uint32_t stereo);
    void SurfacePlace(SurfaceId surface, std::uint32_t layout_version, std::uint32_t window_width,
                      std::uint32_t window_height, std::int32_t x, std::int32_t y, std::uint32_t width,
                      std::uint32_t height, std::uint32_t offscreen);
    void SurfaceViews(SurfaceId surface, std::span<const std::byte> views);
    void SwapOffscreen(SurfaceId window);
    void SurfaceDestroy(SurfaceId surface);
    void Bind(SurfaceId draw_surface, SurfaceId read_surface);
    void ContextDestroy(ContextId context);
    void Swap(SurfaceId surface, std::uint32_t frame);

    /// Shows the frame if it waits, or one that followed it.
    void present(SurfaceId surface, std::uint32_t frame);

private:
    SurfaceReplica* known_surface(SurfaceId id);

    Execution& execution_;
};

}  // namespace wall::tileserver
