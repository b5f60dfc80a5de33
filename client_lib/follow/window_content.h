// SPDX-License-Identifier: MIT
// What windows hold of the frames before: programs that draw over it, instead of clearing it first, need it wherever
// they are drawn. A recording that begins, or begins again, and the nodes of a wall that a program has moved to have
// seen none of these frames; they get it as images, drawn by a context of its own before anything else is. A program
// that clears its window first costs nothing.
//
// One sample a pixel, or the pixels that the samples make; not of windows with buffers for each eye, and not what lies
// off the wall. The session's mutex is held.
#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "client_lib/follow/draw_target.h"
#include "client_lib/follow/nodes.h"
#include "common/geom/rect.h"

namespace wall::client {

class Dealer;

/// What one layer holds: its next picture, and depth and stencil values where the window has them.
struct WindowPart {
    geom::Rect area;                        ///< window pixels, origin bottom left
    std::vector<std::byte> colors, depths;  ///< RGBA bytes; GL_UNSIGNED_INT_24_8, or GL_UNSIGNED_INT without stencil
};

class WindowContents {
public:
    /// They outlive it.
    WindowContents(Nodes& nodes, Dealer& dealer) : nodes_(nodes), dealer_(dealer) {}

    /// Before something is drawn to the target, or its frame ends: nodes that do not know the window get what it holds.
    void bring(const DrawTarget& target) {
        if (target.content_wanted()) bring_now(target, true);
    }
    /// The same before something that leaves nothing of it.
    void before_wiping(const DrawTarget& target) {
        if (target.content_wanted()) bring_now(target, false);
    }
    /// Keeps what the surface holds for the nodes of another wall.
    void keep(ClientSurface& surface);
    /// The surface's first frame there has ended.
    void forget(SurfaceId surface) {
        if (!kept_.empty()) kept_.erase(surface);
    }
    void forget_all() { kept_.clear(); }

private:
    void bring_now(const DrawTarget& target, bool anything_left);
    std::vector<WindowPart> read(const DrawTarget& target);
    bool read_part(Node& node, ContextId context, const DrawTarget& target, std::uint32_t slot, WindowPart& part);
    void draw(Node& node, const DrawTarget& target, const std::vector<WindowPart>& parts);

    /// One of its own, empty whenever it is used; nodes keep room for each that there ever was.
    ContextId context();

    Nodes& nodes_;
    Dealer& dealer_;
    std::optional<ContextId> context_;
    std::unordered_map<SurfaceId, std::vector<WindowPart>> kept_;
};

}  // namespace wall::client
