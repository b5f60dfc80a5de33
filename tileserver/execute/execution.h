// SPDX-License-Identifier: MIT
// What the commands of all groups share while a session's stream is executed: whose stream it is, what its batch draws
// to, the block that is open, and the refusal of a command that a correct client cannot send. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "common/glapi/decoder.h"
#include "tileserver/driver/attribute_trail.h"
#include "tileserver/driver/render_modes.h"
#include "tileserver/objects/framebuffer.h"
#include "tileserver/session/render_node.h"
#include "tileserver/session/session.h"
#include "tileserver/session/session_output.h"

namespace wall::tileserver {

/// How much is executed before others have their turn.
struct Slice {
    using Clock = std::chrono::steady_clock;
    Clock::time_point until = Clock::time_point::max();
    std::uint64_t commands = std::numeric_limits<std::uint64_t>::max();  ///< about
};

/// One for each stream. What it refers to outlives it.
struct Execution {
    using Clock = Slice::Clock;

    Execution(RenderNode& n, SessionReplica& s, SessionOutput& o, glapi::Refusal& r)
        : node(n), session(s), output(o), gl(n.driver.gl()), refusal(r), modes(gl) {}

    /// With it the stream ends; the first reason stays.
    void refuse(std::string why) { refusal.refuse(std::move(why)); }
    bool refused() const { return refusal.refused(); }
    bool slice_is_over() const { return told >= slice.commands || Clock::now() >= slice.until; }
    void look_up_targets() {
        const ClientName framebuffer = context->draw_framebuffer;
        draw_surface = framebuffer ? nullptr : session.surface(context->draw);
        draw_framebuffer = framebuffer ? session.objects.find<Framebuffer>(framebuffer) : nullptr;
        targets_known = true;
    }
    /// The framebuffer as the session's objects are now; null: there is none that can be drawn to or read.
    Framebuffer* updated(Framebuffer* framebuffer) {
        if (framebuffer == nullptr) return nullptr;
        const auto done = framebuffer->update(session.objects, node.shared);
        if (!done) refuse(done.error().message);
        return done && framebuffer->complete() ? framebuffer : nullptr;
    }

    RenderNode& node;
    SessionReplica& session;
    SessionOutput& output;
    const Gl& gl;
    glapi::Refusal& refusal;
    RenderModes modes;

    /// Of the next draw's pieces those that are drawn here; `behind` 0: all.
    struct PieceRange {
        std::uint32_t first = 0, behind = 0;
    };

    // Of the batch.
    ContextId context_id;
    SoftContext* context = nullptr;
    // Of the context, while `targets_known`: one or none of them.
    SurfaceReplica* draw_surface = nullptr;
    Framebuffer* draw_framebuffer = nullptr;
    bool targets_known = false;
    PieceRange pieces;
    Slice slice;
    std::uint64_t told = 0;  ///< commands in it
};

/// A block in the tile that it is being executed for. Within it the driver's current attributes run ahead of the soft
/// context: `trail` notes what the commands leave behind. Each tile starts from the soft context's values; the soft
/// context takes the trail at the end.
struct OpenBlock {
    bool draws = false;  ///< false: only the effects on the soft context count
    bool in_begin = false;
    bool open = false;
    bool tile_open = false;
    unsigned slot = 0;               ///< of the tile
    RenderTarget* target = nullptr;  ///< that it draws to
    Layer* layer = nullptr;          ///< the same; null: it is a framebuffer object
    std::uint64_t vertices = 0;      ///< so far, of all blocks
    /// The last Begin.
    struct {
        GLenum mode = 0;
        std::uint64_t vertices = 0;  ///< OpenBlock::vertices there
        bool countable = true;       ///< every vertex since then is counted
    } begin;
    bool begun = false;  ///< the driver is within its Begin, so that vertices mean something
    /// Bits of primitive modes that the driver takes with the tile's state, and that it refuses; neither: not known.
    std::uint32_t drawable = 0, undrawable = 0;
    AttributeTrail trail;
    glstate::Vec4 raster{};  ///< position as the block's bitmaps move it
};

}  // namespace wall::tileserver
