// SPDX-License-Identifier: MIT
// The pixels of one surface on one tile: a framebuffer object that stands for the default framebuffer of the surface's
// window (DESIGN, section 5). Render thread.
//
// Where the driver has GL_MESA_framebuffer_flip_y the top row comes first in memory, as in a window of Mesa, so that
// its rasterizer yields the same pixels as for a window. Elsewhere the bottom row comes first.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/geom/rect.h"
#include "tileserver/driver/render_target.h"

namespace wall::tileserver {

struct LayerFormat {
    bool double_buffered = true;
    bool alpha = false, depth = true, stencil = true;
    bool operator==(const LayerFormat&) const = default;
};

/// Pixels that a session's layers may still take.
struct PixelBudget {
    std::int64_t left = 0;
};

class Layer final : public RenderTarget {
public:
    /// `budget` outlives the layer.
    Layer(const Gl& gl, bool flip_y, const LayerGeometry& geometry, const LayerFormat& format, PixelBudget& budget);
    ~Layer();

    std::int64_t pixels() const { return std::int64_t{width()} * height(); }
    bool top_row_first() const { return flip_y_; }

    void bind(GLenum draw_buffer, GLenum read_buffer) override;
    /// End of a frame: a copy of the back buffer waits to be shown. Nothing for a single-buffered surface.
    void finish_frame();
    /// The waiting frame becomes the front buffer.
    void show_frame();
    bool frame_waits() const { return frame_waits_; }
    /// The texture that is shown: the front buffer.
    GLuint front() const { return front_; }
    /// Takes over the common pixels of a layer of the same surface at an older place of the same scale.
    void take_content(const Layer& older);

    /// Textures of the buffers that are drawn to since bind().
    std::vector<GLuint> draw_textures() const;
    /// A rectangle of a colour texture as RGBA bytes, bottom row first. Pixel transfer must be neutral.
    void read_texture(GLuint texture, const geom::Rect& area, std::vector<std::uint8_t>& pixels) const;
    void write_texture(GLuint texture, const geom::Rect& area, std::vector<std::uint8_t>& pixels);

    /// The accumulation buffer: 4 signed 16-bit components a pixel, bottom row first; empty until it is used.
    std::vector<std::int16_t> accum;

private:
    /// To the program the frame that it ended last is the front buffer, shown or not.
    GLuint program_front() const { return frame_waits_ ? ready_ : front_; }
    GLuint make_texture(GLenum format);
    void attach(GLenum point, GLuint texture);
    void copy(GLuint from, const Layer& source, GLuint to) const;

    const Gl& gl_;
    PixelBudget& budget_;
    LayerFormat format_;
    bool flip_y_, frame_waits_ = false;
    GLuint front_ = 0, back_ = 0, ready_ = 0, depth_stencil_ = 0;           // textures; 0: none
    GLenum draw_buffer_ = GL_INVALID_ENUM, read_buffer_ = GL_INVALID_ENUM;  // bound last
};

}  // namespace wall::tileserver
