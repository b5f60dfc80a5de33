// SPDX-License-Identifier: MIT
// Group [blit]: pixels from one target to another. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class BlitCommands {
public:
    /// Both outlive it.
    BlitCommands(Execution& execution, OpenBlock& block) : execution_(execution), block_(block) {}

    void Blit(std::int32_t from_x0, std::int32_t from_y0, std::int32_t from_x1, std::int32_t from_y1,
              std::int32_t to_x0, std::int32_t to_y0, std::int32_t to_x1, std::int32_t to_y1, std::uint32_t mask,
              GLenum filter);

private:
    const RenderTarget* source();

    Execution& execution_;
    OpenBlock& block_;
};

}  // namespace wall::tileserver
