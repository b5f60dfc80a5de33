// SPDX-License-Identifier: MIT
// Group [framebuffer]: framebuffer objects as targets. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class FramebufferCommands {
public:
    /// `execution` outlives it.
    explicit FramebufferCommands(Execution& execution) : execution_(execution) {}

    void Framebuffer(ClientName framebuffer, std::span<const std::byte> definition);
    void BindTargets(ClientName draw, ClientName read, std::uint32_t counts);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
