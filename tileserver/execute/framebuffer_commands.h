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
    void TargetPart(ClientName framebuffer, std::int32_t x, std::int32_t y, std::uint32_t width, std::uint32_t height);
    void TargetWhole(ClientName framebuffer);

private:
    void draw_part(ClientName framebuffer, const std::optional<geom::Rect>& part);

    Execution& execution_;
};

}  // namespace wall::tileserver
