// SPDX-License-Identifier: MIT
// What the driver draws to: a layer of a window, or a framebuffer object of the program. Render thread.
#pragma once

#include <cstdint>
#include <optional>

#include "common/geom/pixel_rect.h"
#include "common/geom/rect.h"
#include "common/geom/view.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

/// What decides how a window's pixels lie in a layer; `area` within `surface`.
struct LayerGeometry {
    geom::Rect surface;  ///< canvas pixels; offscreen: {0, 0, window}
    geom::Rect area;     ///< canvas pixels that the layer holds
    std::uint32_t window_width = 0, window_height = 0;
    std::optional<geom::EyeView> view;  ///< that the layer has of what is drawn by a camera; none: the camera's own
    std::optional<geom::Rect> part;     ///< only these pixels of it change, y up; none: all
    bool operator==(const LayerGeometry&) const = default;

    bool scaled() const {
        return surface.width != static_cast<std::int32_t>(window_width) ||
               surface.height != static_cast<std::int32_t>(window_height);
    }
    double scale_x() const { return static_cast<double>(surface.width) / window_width; }
    double scale_y() const { return static_cast<double>(surface.height) / window_height; }
    /// The layer's bottom left in the surface's pixels, y up.
    std::int32_t offset_x() const { return area.x - surface.x; }
    std::int32_t offset_y() const { return surface.bottom() - area.bottom(); }
    /// The layer in the surface's pixels, y up; in the window's, if it is not scaled.
    geom::Rect pixels() const { return {offset_x(), offset_y(), area.width, area.height}; }
    /// What the layer holds of the window, as far as it changes.
    geom::PixelRect window_area() const {
        if (part)
            return {static_cast<float>(part->x), static_cast<float>(part->y), static_cast<float>(part->x + part->width),
                    static_cast<float>(part->y + part->height)};
        const auto left = static_cast<float>(offset_x() / scale_x()),
                   bottom = static_cast<float>(offset_y() / scale_y());
        return {left, bottom, left + static_cast<float>(area.width / scale_x()),
                bottom + static_cast<float>(area.height / scale_y())};
    }
};

/// Pixels at their own places, without an offset and unscaled.
inline LayerGeometry plain_geometry(std::int32_t width, std::int32_t height) {
    const geom::Rect all{0, 0, width, height};
    return {all, all, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

class RenderTarget {
public:
    RenderTarget() = default;
    RenderTarget(const RenderTarget&) = delete;

    const LayerGeometry& geometry() const { return geometry_; }
    std::int32_t width() const { return geometry_.area.width; }
    std::int32_t height() const { return geometry_.area.height; }
    /// Whether it can be drawn to.
    bool complete() const { return complete_; }
    /// The driver's.
    GLuint framebuffer() const { return framebuffer_; }

    /// Makes it the framebuffer that is drawn to and read from, with these buffers of a window (GL_BACK, GL_NONE...).
    virtual void bind(GLenum draw_buffer, GLenum read_buffer) = 0;
    /// Whether what is drawn to it as it was bound last may have colours.
    virtual bool draws_colors() const = 0;
    /// Whether it has a depth buffer.
    virtual bool has_depth() const = 0;

protected:
    ~RenderTarget() = default;

    LayerGeometry geometry_;
    bool complete_ = false;
    GLuint framebuffer_ = 0;
};

}  // namespace wall::tileserver
