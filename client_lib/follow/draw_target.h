// SPDX-License-Identifier: MIT
// What commands draw to or read from, as a value (DESIGN, section 4, "Targets"). All that depends on which kind it is
// stands here: which layers on which nodes it has, what a node must be told of it first, whether a node takes part now,
// and what is noted when something was drawn. The session's mutex is held, but where a member says otherwise.
#pragma once

#include <span>

#include "client_lib/follow/node.h"
#include "client_lib/follow/surface.h"

namespace wall::client {

/// Copied freely; the surface outlives it.
class DrawTarget {
public:
    /// Nothing: a context without a surface. Only what says so may be called, and operator bool.
    DrawTarget() = default;
    /// A surface as it lies whenever it is asked: the tiles that show a window and its hidden part, or the one layer of
    /// a pixel buffer.
    explicit DrawTarget(ClientSurface& surface) : surface_(&surface) {}
    /// One layer in place of those (selection, feedback): nothing of the surface changes by what is sent there. `only`
    /// outlives the target.
    DrawTarget(ClientSurface& surface, const TargetLayer& only) : surface_(&surface), only_(&only) {}

    explicit operator bool() const { return surface_ != nullptr; }

    // ---- any application thread that has it current ----
    const SurfaceFormat& format() const { return surface_->options.format; }
    Extent size() const { return {surface_->layout.width, surface_->layout.height}; }
    /// There is no back buffer, so what is drawn is on show, and a frame ends with glFlush.
    bool shows_at_once() const { return !format().double_buffered; }
    /// glClear has left nothing of the back buffer from before.
    void note_cleared() const { surface_->cleared = true; }
    /// An image of depth or stencil values is drawn.
    void note_depth_image() const { surface_->depth_images = true; }

    // ---- nodes ----
    std::span<const TargetLayer> layers() const {
        return only_ ? std::span(only_, 1) : std::span<const TargetLayer>(surface_->layout.layers);
    }
    /// The surface whose hidden part may be kept instead of being drawn; null: there is no such part, or no target.
    ClientSurface* with_hidden_part() const {
        return surface_ && only_ == nullptr && surface_->hidden ? surface_ : nullptr;
    }
    /// Whether what is drawn goes to a node that has a layer; a node may be left out for a while.
    bool goes_to(const Node& node) const { return node.alive() && !node.left_out.contains(surface_->id); }
    /// Packs into the node's batch what it must know before anything is drawn, read or swapped there.
    void describe_to(Node& node) const;
    void note_drawn() const { surface_->drawn = true; }

    /// Packs into the node's batch, set to the context of `mirror`, what that context draws to and reads from, as far
    /// as the node does not know it.
    friend void bind_targets(Node& node, Mirror& mirror, const DrawTarget& draw, const DrawTarget& read);

private:
    ClientSurface* surface_ = nullptr;
    const TargetLayer* only_ = nullptr;  ///< null: those of the surface
};

}  // namespace wall::client
