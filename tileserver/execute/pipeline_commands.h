// SPDX-License-Identifier: MIT
// Group [pipeline]: programs that are drawn with together. Render thread.
#pragma once

#include <cstddef>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class PipelineCommands {
public:
    /// `execution` outlives it.
    explicit PipelineCommands(Execution& execution) : execution_(execution) {}

    void Pipeline(ClientName pipeline, std::span<const std::byte> programs);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
