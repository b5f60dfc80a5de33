// SPDX-License-Identifier: MIT
// Transform feedback of a context (OpenGL 3.0, 2.15): while it is active every draw is made twice, captured on every
// node and then as usual. The context's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "client_lib/objects/capture.h"
#include "client_lib/objects/program.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Buffers that values may go to at once.
inline constexpr unsigned kCaptureBuffers = glstate::el::feedback_buffer::count;

struct CaptureUse {
    std::shared_ptr<Capture> active;   ///< null: none
    std::shared_ptr<Program> program;  ///< whose varyings they are
    Capture* now = nullptr;            ///< what is sent now is for it
    std::shared_ptr<Capture> counter;  ///< of primitives that are not seen; null: not needed yet
};

/// Sets a context's state up for what is captured, and back.
class CapturePass {
public:
    CapturePass(glstate::State& state, CaptureUse& use, Capture& capture);
    ~CapturePass();
    CapturePass(const CapturePass&) = delete;

private:
    glstate::State& state_;
    CaptureUse& use_;
};

/// What is seen of a draw that was captured: its primitives have been counted.
class SeenPass {
public:
    explicit SeenPass(glstate::State& state);
    ~SeenPass();
    SeenPass(const SeenPass&) = delete;

private:
    glstate::State& state_;
    const std::uint32_t primitives_, captured_;
};

/// What a draw has to be made for besides what is seen: what is captured, or a count of primitives; null: nothing.
Capture* captured_by(const glstate::State& state, CaptureUse& use);

/// Calls `draw()` for the draw target, and before that for what is captured, if anything is.
template <class Draw>
void draw_in_passes(glstate::State& state, CaptureUse& use, Draw&& draw) {
    const bool seen = state.local.rasterizer_discard == 0;
    if (!use.active && seen) return draw();
    if (Capture* capture = captured_by(state, use)) {
        const CapturePass pass(state, use, *capture);
        draw();
    }
    if (!seen) return;
    const SeenPass pass(state);
    draw();
}

}  // namespace wall::client
