// SPDX-License-Identifier: MIT
// Where on a target geometry is drawn: in the program's own picture, and in each of the views that tiles have of the
// scene instead (docs/walls.md, "Views"). Sorting asks for it by boxes and by single triangles; where there are no
// views it costs a comparison. Keeps its memory; the session's mutex guards it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client_lib/geometry/primitive_scan.h"
#include "client_lib/geometry/target_layers.h"
#include "common/glstate/projection.h"

namespace wall::client {

/// What is drawn, as far as it says where.
struct Drawn {
    /// By a rectangle of the window (a clear, an image); nothing: anywhere.
    Drawn(const std::optional<PixelRect>& window) : rect(window) {}  // NOLINT: of either kind is drawn alike
    Drawn(const PixelRect& window) : rect(window) {}                 // NOLINT: as those
    Drawn(std::nullopt_t) {}                                         // NOLINT: as those
    /// Primitives in a box, of one mode if it is given.
    Drawn(const glstate::Projection& by, const geom::Box& around, std::optional<GLenum> primitives = {})
        : projection(&by), box(&around), mode(primitives), seen_by(&by) {}
    /// Vertices that lie anywhere; `by` says what camera draws them, and nothing of where.
    static Drawn anywhere(const glstate::Projection& by) {
        Drawn out{std::nullopt};
        out.seen_by = &by;
        return out;
    }

    /// An image that covers `covered` about the place of `clip`, which the camera of `by` has made (raster_place.h).
    /// `window`: what it covers in the program's own picture; nothing: it is not drawn there.
    static Drawn image(const glstate::Projection& by, const glstate::Vec4& clip, const PixelRect& covered,
                       const std::optional<PixelRect>& window) {
        Drawn out(window.value_or(PixelRect{}));
        out.seen_by = &by;
        out.clip = clip;
        out.covered = covered;
        return out;
    }

    std::optional<PixelRect> rect;
    const glstate::Projection* projection = nullptr;  ///< null: `rect` holds
    const geom::Box* box = nullptr;
    std::optional<GLenum> mode;
    const glstate::Projection* seen_by = nullptr;  ///< whose camera draws them; null: none does
    double elements = 0;                           ///< about so many, of geometry; 0: it is something else
    std::uint32_t pieces = 0;                      ///< in which it may be drawn by several nodes; 0: it is not cut
    std::optional<glstate::Vec4> clip;             ///< of an image(), in views
    PixelRect covered{};                           ///< of it, about that place
};

class Sight {
public:
    /// Of this projection, through these views; both stay until the next call.
    void aim(const glstate::Projection& own, std::span<const SurfaceView> views);

    /// Good until the next call of anything.
    Reach of(const geom::Box& box) {
        return of_box([&](const auto& p) { return project(p, box); });
    }
    Reach of(const geom::Box& box, GLenum mode) {
        return of_box([&](const auto& p) { return project(p, box, mode); });
    }
    /// Of an image(), by whose camera it was aimed.
    Reach of_image(const Drawn& image);
    /// The point, line, triangle or quad that starts at vertex `first`, scanned by the program's own projection.
    Reach of(const Topology& topology, const VertexScan& vertices, std::size_t first);

private:
    template <class Project>
    Reach of_box(Project&& project_by) {
        rects_.clear();
        for (const Through& view : through_) rects_.push_back(sees_all_ ? std::nullopt : project_by(view.projection));
        return {project_by(*own_), rects_};
    }

    struct Through {
        std::optional<glstate::Mat4> change;  ///< of clip coordinates; none: as the program's own picture
        glstate::Projection projection;
    };
    const glstate::Projection* own_ = nullptr;
    std::vector<Through> through_;  ///< by view
    std::vector<std::optional<PixelRect>> rects_;
    bool sees_all_ = false;  // Projection::anywhere_in_views()
    // What `through_[].change` was made of.
    glstate::Mat4 camera_{};
    std::vector<SurfaceView> views_;
};

}  // namespace wall::client
