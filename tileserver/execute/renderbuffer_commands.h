// SPDX-License-Identifier: MIT
// Group [renderbuffer]: images that nothing samples. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class RenderbufferCommands {
public:
    /// `execution` outlives it.
    explicit RenderbufferCommands(Execution& execution) : execution_(execution) {}

    void Renderbuffer(ClientName renderbuffer, std::uint32_t samples, GLenum internal_format, std::uint32_t width,
                      std::uint32_t height);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
