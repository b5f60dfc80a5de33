// SPDX-License-Identifier: MIT
// Group [dispatch]: compute shaders, in a block of a target that nobody sees, which every node has. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class DispatchCommands {
public:
    /// Both outlive it.
    DispatchCommands(Execution& execution, OpenBlock& block) : execution_(execution), block_(block) {}

    /// Groups of the context's program in each dimension. Nothing where that has no compute shader.
    void Dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z);

private:
    Execution& execution_;
    OpenBlock& block_;
};

}  // namespace wall::tileserver
