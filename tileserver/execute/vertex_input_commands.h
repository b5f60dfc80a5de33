// SPDX-License-Identifier: MIT
// Group [vertex_input]: what a draw from arrays reads. Render thread.
#pragma once

#include <cstddef>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class VertexInputCommands {
public:
    /// `execution` outlives it.
    explicit VertexInputCommands(Execution& execution) : execution_(execution) {}

    void VertexInput(ClientName input, std::span<const std::byte> definition);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
