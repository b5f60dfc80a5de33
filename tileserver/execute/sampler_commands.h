// SPDX-License-Identifier: MIT
// Group [sampler]: how textures are looked up. Render thread.
#pragma once

#include <cstdint>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class SamplerCommands {
public:
    /// `execution` outlives it.
    explicit SamplerCommands(Execution& execution) : execution_(execution) {}

    void SamplerParameter(ClientName sampler, GLenum pname, GLenum type, std::uint32_t v0, std::uint32_t v1,
                          std::uint32_t v2, std::uint32_t v3);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
