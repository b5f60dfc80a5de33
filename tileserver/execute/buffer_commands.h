// SPDX-License-Identifier: MIT
// Group [buffer]: memory that draws read. Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class BufferCommands {
public:
    /// `execution` outlives it.
    explicit BufferCommands(Execution& execution) : execution_(execution) {}

    void BufferData(ClientName buffer, std::uint32_t size, GLenum usage);
    void BufferRead(RequestId request, ClientName buffer, std::uint32_t offset, std::uint32_t size);
    void BufferSubData(ClientName buffer, std::uint32_t offset, std::span<const std::byte> content);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
