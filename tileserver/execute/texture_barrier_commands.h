// SPDX-License-Identifier: MIT
// Group [texture_barrier]: a program draws to a texture that it samples as well (GL_ARB_texture_barrier), or to what
// its fragment shaders or advanced blending read (GL_KHR_blend_equation_advanced). Render thread.
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
    void BlendBarrier() {
        if (block_.in_begin) return execution_.refuse("between Begin and End");
        if (block_.draws && execution_.gl.BlendBarrierKHR) execution_.gl.BlendBarrierKHR();
    }

private:
    Execution& execution_;
    OpenBlock& block_;
};

}  // namespace wall::tileserver
