// SPDX-License-Identifier: MIT
// What commands draw to or read from, as a value (DESIGN, section 4, "Targets"). All that depends on which kind it is
// stands here: which layers on which nodes it has, what a node must be told of it first, whether a node takes part now,
// and what is noted when something was drawn. The session's mutex is held, but where a member says otherwise.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "client_lib/follow/image_parts.h"
#include "client_lib/follow/node.h"
#include "client_lib/follow/surface.h"
#include "client_lib/objects/drawn_target.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

/// Copied freely; what it is made of outlives it.
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
    /// A target of objects, in the layers of all nodes, which outlive it, or in those of its parts.
    DrawTarget(DrawnTarget& objects, const std::vector<TargetLayer>& everywhere)
        : objects_(&objects), everywhere_(&everywhere) {}

    explicit operator bool() const { return surface_ != nullptr || objects_ != nullptr; }
    /// All nodes hold the same of it.
    bool alike() const { return objects_ != nullptr || (surface_ != nullptr && only_ == nullptr && surface_->whole); }
    /// Not a window or pixel buffer: it is made of objects, and all nodes hold the same of it but for what
    /// DrawnTarget::parts() says.
    bool of_objects() const { return objects_ != nullptr; }
    /// All nodes draw the same of what its layers get.
    bool drawn_alike() const { return objects_ != nullptr && objects_->parts() == nullptr; }
    /// Null: it is not made of any.
    DrawnTarget* objects() const { return objects_; }

    // ---- any application thread that has it current ----
    /// Of a surface; that of one made of objects is nothing that a window promises.
    const SurfaceFormat& format() const;
    /// Of a window: colours are written by the curve of sRGB while GL_FRAMEBUFFER_SRGB is on.
    bool encodes_srgb() const;
    Extent size() const;
    /// There is no back buffer, so what is drawn is on show, and a frame ends with glFlush.
    bool shows_at_once() const { return surface_ != nullptr && !format().double_buffered; }
    /// glClear has left nothing of the back buffer from before.
    void note_cleared() const {
        if (surface_) surface_->cleared = true;
    }
    /// An image of depth or stencil values is drawn.
    void note_depth_image() const {
        if (surface_) surface_->depth_images = true;
    }

    // ---- nodes ----
    std::span<const TargetLayer> layers() const {
        if (only_) return std::span(only_, 1);
        if (!objects_) return surface_->layout.layers;
        const ImageParts* const parts = objects_->parts();
        return parts ? parts->layers : *everywhere_;
    }
    /// That some of the layers show.
    std::span<const SurfaceView> views() const {
        return surface_ && only_ == nullptr ? std::span<const SurfaceView>(surface_->layout.views)
                                            : std::span<const SurfaceView>();
    }
    /// Those that tiles have of a window, or would have if its camera were known.
    std::span<const geom::EyeView> offered_views() const {
        return surface_ ? std::span<const geom::EyeView>(surface_->views.offered) : std::span<const geom::EyeView>();
    }
    /// Vertices in this box, where one is known, are drawn by this projection.
    void note_camera(const glstate::Projection& projection, const geom::Box* box) const {
        if (surface_ && surface_->views.wanted()) surface_->views.note(projection, box);
    }
    /// The surface whose hidden part may be kept instead of being drawn; null: there is no such part, or no target.
    ClientSurface* with_hidden_part() const {
        return surface_ && only_ == nullptr && surface_->hidden ? surface_ : nullptr;
    }
    /// The surface, if what is drawn is its picture; null: there is none, or it is something else.
    ClientSurface* pictured_surface() const { return only_ == nullptr ? surface_ : nullptr; }
    /// Some nodes may need what it holds already (window_content.h).
    bool content_wanted() const { return surface_ && surface_->content_wanted && only_ == nullptr; }
    /// Whether what is drawn goes to a node that has a layer; a node may be left out for a while.
    bool goes_to(const Node& node) const {
        return node.alive() && (objects_ ? node.left_out.empty() : !node.left_out.contains(surface_->id));
    }
    /// Packs into the node's batch what it must know of a surface before anything is drawn, read or swapped there.
    void describe_to(Node& node) const;
    /// The node has been told of the surface, wherever it lay then.
    bool is_known_to(const Node& node) const { return node.surfaces.contains(surface_->id); }
    /// The same, and a context of its own, that of the node's batch, draws to the surface and reads from it.
    void bind_to(Node& node) const;
    void note_drawn() const {
        if (surface_) surface_->drawn = true;
    }
    /// Something was drawn on all nodes that it goes to.
    void note_content(ShareGroup& share) const;
    /// The objects whose images are drawn to. The share group's mutex is held.
    void for_each_image(const std::function<void(const Object&)>& use) const {
        if (objects_) objects_->for_each_image(use);
    }

    /// Packs into the node's batch, set to the context of `mirror`, what that context draws to and reads from, as far
    /// as the node does not know it.
    friend void bind_targets(Node& node, Mirror& mirror, const DrawTarget& draw, const DrawTarget& read);

private:
    ClientName object() const { return objects_ ? objects_->target_id() : ClientName(); }
    bool counts_samples_on(const Node& node) const;

    ClientSurface* surface_ = nullptr;
    const TargetLayer* only_ = nullptr;  ///< null: those of the surface
    DrawnTarget* objects_ = nullptr;     ///< instead of a surface
    const std::vector<TargetLayer>* everywhere_ = nullptr;
};

}  // namespace wall::client
