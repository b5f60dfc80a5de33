// SPDX-License-Identifier: MIT
#include "client_lib/geometry/sight.h"

#include <algorithm>
#include <array>

#include "common/glstate/view_change.h"

namespace wall::client {
namespace {

/// As the view has it. A tile's pixels may be larger than the window's, and its primitives reach as many of them.
glstate::Projection seen(const glstate::Projection& own, const std::optional<glstate::Mat4>& change,
                         const SurfaceView& view) {
    glstate::Projection out = change ? glstate::seen(own, *change) : own;
    const float larger = std::max(1.0f, std::max(view.window_pixels_x, view.window_pixels_y));
    out.margin *= larger;
    out.reaches.points *= larger;
    out.reaches.lines *= larger;
    out.reaches.polygons *= larger;
    return out;
}

}  // namespace

void Sight::aim(const glstate::Projection& own, std::span<const SurfaceView> views) {
    own_ = &own;
    if (views.empty()) {
        through_.clear();
        views_.clear();
        return;
    }
    sees_all_ = own.anywhere_in_views();
    if (own.camera != camera_ || !std::ranges::equal(views, views_)) {
        camera_ = own.camera;
        views_.assign(views.begin(), views.end());
        through_.resize(views.size());
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto change = glstate::view_change(views[i].view, own.camera);
            through_[i].change = change ? std::optional(glstate::narrow(*change)) : std::nullopt;
        }
    }
    for (std::size_t i = 0; i < views.size(); ++i) through_[i].projection = seen(own, through_[i].change, views[i]);
}

Reach Sight::of(const Topology& topology, const VertexScan& vertices, std::size_t first) {
    rects_.clear();
    for (const Through& view : through_) {
        std::array<glstate::WindowVertex, kMostVertices> corners;
        const std::size_t count = corners_of(topology, vertices, first, corners);
        if (view.change)
            for (std::size_t i = 0; i < count; ++i)
                corners[i] = glstate::moved(view.projection, corners[i], *view.change);
        rects_.push_back(sees_all_ ? std::nullopt : hull_rect(view.projection, {corners.data(), count}));
    }
    return {window_rect(topology, vertices, first, *own_), rects_};
}

Reach Sight::of_image(const Drawn& image) {
    const glstate::WindowVertex own{*image.clip, 0, 0, false};  // where it is in the window counts nowhere else
    rects_.clear();
    for (std::size_t i = 0; i < through_.size(); ++i) {
        const auto& [change, projection] = through_[i];
        if (!change) {
            rects_.push_back(image.rect);
            continue;
        }
        const auto there = glstate::moved(projection, own, *change);
        auto rect = hull_rect(projection, {&there, 1});
        const float x = views_[i].window_pixels_x, y = views_[i].window_pixels_y;  // images keep the tile's pixels
        const PixelRect& around = image.covered;
        if (rect)
            rect = PixelRect{rect->x0 + around.x0 * x, rect->y0 + around.y0 * y, rect->x1 + around.x1 * x,
                             rect->y1 + around.y1 * y};
        rects_.push_back(rect);
    }
    return {image.rect, rects_};
}

}  // namespace wall::client
