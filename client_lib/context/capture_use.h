// SPDX-License-Identifier: MIT
// Transform feedback of a context (OpenGL 4.0, 2.17): while it is active and not paused every draw is made twice,
// captured on every node and then as usual. The objects are the context's own; no node knows them, but what was
// captured last with each. The context's thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "client_lib/objects/capture.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// Buffers that values may go to at once.
inline constexpr unsigned kCaptureBuffers = glstate::el::feedback_buffer::count;

/// A transform feedback object.
struct FeedbackObject {
    std::shared_ptr<Capture> active;   ///< between glBeginTransformFeedback and its end; else null
    std::shared_ptr<Program> program;  ///< whose varyings they are
    bool paused = false;
    std::shared_ptr<Capture> ended;  ///< the latest one that is over; null: there was none
    /// Its places for buffers, while it is not bound: then they are those of the state.
    std::array<glstate::BufferRange, kCaptureBuffers> buffers{};
};

class CaptureUse {
public:
    NameTable<FeedbackObject> names;
    Capture* now = nullptr;            ///< what is sent now is for it
    std::shared_ptr<Capture> counter;  ///< of primitives that are not seen; null: not needed yet

    /// That commands are about now; of name 0, if no other.
    FeedbackObject& bound() { return *bound_; }
    const FeedbackObject& bound() const { return *bound_; }
    /// Null: no such object.
    std::shared_ptr<FeedbackObject> find(GLuint name) const { return name == 0 ? unnamed_ : names.find(name); }
    void bind(std::shared_ptr<FeedbackObject> object) { bound_ = std::move(object); }
    /// What is drawn now is captured for it; null: for none.
    Capture* captures() const { return bound_->paused ? nullptr : bound_->active.get(); }
    /// Calls look(object) with all of them.
    template <class Look>
    void for_each_object(Look&& look) const {
        look(std::as_const(*unnamed_));
        names.for_each(look);
    }
    /// Whether an object, bound or not, goes on with that program.
    bool uses(const Program& program) const;

private:
    const std::shared_ptr<FeedbackObject> unnamed_ = std::make_shared<FeedbackObject>();
    std::shared_ptr<FeedbackObject> bound_ = unnamed_;
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
    const std::array<std::uint32_t, kVertexStreams> primitives_, captured_;
};

/// What a draw has to be made for besides what is seen: what is captured, or a count of primitives; null: nothing.
Capture* captured_by(const glstate::State& state, CaptureUse& use);

/// Calls `draw()` for the draw target, and before that for what is captured, if anything is.
template <class Draw>
void draw_in_passes(glstate::State& state, CaptureUse& use, Draw&& draw) {
    const bool seen = state.local.rasterizer_discard == 0;
    if (!use.captures() && seen) return draw();
    if (Capture* capture = captured_by(state, use)) {
        const CapturePass pass(state, use, *capture);
        draw();
    }
    if (!seen) return;
    const SeenPass pass(state);
    draw();
}

}  // namespace wall::client
