// SPDX-License-Identifier: MIT
// Group [framebuffer]: framebuffer objects as targets. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/geom/rect.h"
#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class FramebufferCommands {
public:
    /// `execution` outlives it.
    explicit FramebufferCommands(Execution& execution) : execution_(execution) {}

    void Framebuffer(ClientName framebuffer, std::span<const std::byte> definition);
    void BindTargets(ClientName draw, ClientName read, std::uint32_t counts);
    void TargetPart(ClientName framebuffer, std::int32_t x, std::int32_t y, std::uint32_t width, std::uint32_t height,
                    std::uint32_t images_width, std::uint32_t images_height);
    void TargetWhole(ClientName framebuffer);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
