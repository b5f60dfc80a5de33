// SPDX-License-Identifier: MIT
// Group [texture_buffer]: textures whose texels are a buffer's. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class TextureBufferCommands {
public:
    /// `execution` outlives it.
    explicit TextureBufferCommands(Execution& execution) : execution_(execution) {}

    void TexBuffer(ClientName texture, GLenum internal_format, ClientName buffer, std::uint32_t offset,
                   std::uint32_t bytes);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
