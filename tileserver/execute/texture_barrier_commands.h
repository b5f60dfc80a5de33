// SPDX-License-Identifier: MIT
// Group [texture_barrier]: a program draws to a texture that it samples as well (GL_ARB_texture_barrier). Render
// thread.
#pragma once

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class TextureBarrierCommands {
public:
    /// Both outlive it.
    TextureBarrierCommands(Execution& execution, OpenBlock& block) : execution_(execution), block_(block) {}

    void TextureBarrier() {
        if (block_.in_begin) return execution_.refuse("between Begin and End");
        if (block_.draws) execution_.gl.TextureBarrier();
    }

private:
    Execution& execution_;
    OpenBlock& block_;
};

}  // namespace wall::tileserver
