// SPDX-License-Identifier: MIT
// Groups [stream] and [begin_again]: the state of soft contexts, how far the stream is executed, and where it begins
// again. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/glstate/elements.h"
#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class StreamCommands {
public:
    /// `execution` outlives it.
    explicit StreamCommands(Execution& execution) : execution_(execution) {}

    std::uint32_t state_bytes(std::uint32_t id) const { return glstate::element_bytes(id); }
    bool State(std::uint32_t id, std::span<const std::byte> value);
    void StateSmall(std::uint32_t word);
    void StateRecall(std::uint32_t word);
    void Sync(RequestId request);
    void BeginAgain();

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
