// SPDX-License-Identifier: MIT
// The pixels of one surface on one tile: a framebuffer object that stands for the default framebuffer of the surface's
// window (DESIGN, section 5). Render thread.
//
// Where the driver has GL_MESA_framebuffer_flip_y the top row comes first in memory, as in a window of Mesa, so that
// its rasterizer yields the same pixels as for a window. Elsewhere the bottom row comes first.
//
// Where a pixel has several samples, what is drawn to has them, and what is shown has been made of them: the back
// buffer at the end of a frame, the front buffer when somebody looks at it (OpenGL 4.6, 14.3.1 and 17.4.2).
//
// A window with buffers for two eyes (OpenGL 4.6, 17.4.1) has a layer for each. All that is drawn is drawn to both, and
// colours only where the draw buffer is that eye's, so that depth and stencil, which the eyes share, are the same.
//
// Colours are kept as they are shown. Where a window can be drawn to by the curve of sRGB, what is attached are views
// of them as sRGB, which are the same until GL_FRAMEBUFFER_SRGB is on (OpenGL 4.6, 17.3.7).
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/geom/rect.h"
#include "common/geom/view.h"
#include "tileserver/driver/render_target.h"
#include "tileserver/partials/partial_format.h"

namespace wall::tileserver {

struct LayerFormat {
    bool double_buffered = true;
    bool alpha = false, depth = true, stencil = true;
    std::uint32_t samples = 0;        ///< of a pixel; 0: it has no sample buffers
    bool srgb = false;                ///< what is drawn goes by the curve of sRGB while GL_FRAMEBUFFER_SRGB is on
    geom::Eye eye = geom::Eye::both;  ///< whose buffers it has, of a window with some for each
    bool operator==(const LayerFormat&) const = default;
};

/// Pixels that a session's layers may still take; one with several samples counts as often.
struct PixelBudget {
    PixelBudget() : PixelBudget(0) {}
    explicit PixelBudget(std::int64_t all) : left(all), all_(all) {}
    /// So many in all from now on. Who has more keeps them, and gets no other.
    void set(std::int64_t all) { left += all - std::exchange(all_, all); }

    std::int64_t left;

private:
    std::int64_t all_;
};
inline std::int64_t pixels_taken(const LayerGeometry& geometry, const LayerFormat& format) {
    return std::int64_t{geometry.area.width} * geometry.area.height * std::max(format.samples, 1u);
}

class Layer final : public RenderTarget {
public:
    /// `budget` outlives the layer.
    Layer(const Gl& gl, bool flip_y, const LayerGeometry& geometry, const LayerFormat& format, PixelBudget& budget);
    ~Layer();

    bool top_row_first() const { return flip_y_; }
    std::uint32_t samples() const { return format_.samples; }

    void bind(GLenum draw_buffer, GLenum read_buffer) override;
    /// The layer of the window's other eye on the same tile, whose buffers can be read where this one is drawn to.
    /// Null: there is none.
    void set_other_eye(Layer* layer) { other_eye_ = layer; }
    /// End of a frame: a copy of the back buffer waits to be shown. Nothing for a single-buffered surface.
    void finish_frame();
    /// The waiting frame becomes the front buffer.
    void show_frame();
    bool frame_waits() const { return frame_waits_; }
    /// The texture that is shown: the front buffer, as it is now. It has one sample a pixel.
    GLuint front() const;
    /// Takes over the common pixels of a layer of the same surface, and so format, at an older place of the same scale.
    void take_content(const Layer& older);

    bool draws_colors() const override;
    bool has_depth() const override { return format_.depth; }
    /// Textures of the buffers that are drawn to since bind().
    std::vector<GLuint> draw_textures() const;
    /// A rectangle of a colour texture of one sample a pixel as RGBA bytes, bottom row first. Pixel transfer must be
    /// neutral.
    void read_texture(GLuint texture, const geom::Rect& area, std::vector<std::uint8_t>& pixels) const;
    void write_texture(GLuint texture, const geom::Rect& area, std::vector<std::uint8_t>& pixels);
    /// What the window's next picture has in `block.area`, which the layer holds, of a layer with depth and stencil
    /// values and one sample a pixel, 1:1. Pixel transfer must be neutral.
    void read_block(PixelBlock& block) const;
    /// The same, written; of the stencil values those that were read.
    void write_block(const PixelBlock& block);
    /// The same of one plane of an image of `area`, in window pixels and bottom row first: GL_RGBA of bytes,
    /// GL_DEPTH_STENCIL of 24 and 8 bits, or GL_DEPTH_COMPONENT of 32. What the layer does not hold is left out, and so
    /// are depths of a layer without them.
    void write_content(const geom::Rect& area, GLenum format, std::span<const std::byte> pixels);
    /// All of it has no colour, this depth (0 or 1) and stencil value 0.
    void clear_to_depth(std::uint32_t depth);

    /// The accumulation buffer: 4 signed 16-bit components a pixel, bottom row first; empty until it is used.
    std::vector<std::int16_t> accum;

private:
    /// To the program the frame that it ended last is the front buffer, shown or not.
    GLuint program_front() const { return frame_waits_ ? ready_ : front_; }
    /// Where a part of the window begins in the layer's textures.
    std::pair<std::int32_t, std::int32_t> texture_place(const geom::Rect& area) const;
    GLuint make_texture(GLenum format, std::uint32_t samples) const;
    void attach(GLenum point, GLuint texture);
    /// The same texels, as what is drawn to sees them: a view of them as sRGB, where the window has that.
    GLuint drawn_as(GLuint texture);
    void forget_view(GLuint texture);
    void copy(GLuint from, const Layer& source, GLuint to, GLenum target = GL_TEXTURE_2D) const;
    GLenum color_format() const { return format_.alpha ? GL_RGBA8 : GL_RGB8; }
    bool draws_to_front() const;
    /// For a buffer that is about to be drawn to or read.
    void prepare(GLenum buffer);
    void choose_read(GLenum buffer);
    /// A front buffer that is drawn to or read from: it has samples only then.
    void need_front_samples();
    void drop_front_samples();
    /// What was drawn to the front buffer's samples becomes its picture.
    void settle_front() const;

    const Gl& gl_;
    PixelBudget& budget_;
    LayerFormat format_;
    bool flip_y_, frame_waits_ = false;
    GLuint front_ = 0, back_ = 0, ready_ = 0, depth_stencil_ = 0;  // textures; 0: none
    std::vector<std::pair<GLuint, GLuint>> views_;                 // of colours as sRGB: texture, view
    GLuint front_samples_ = 0;          // what is drawn to the front buffer, where pixels have several; 0: none
    mutable bool front_drawn_ = false;  // its picture is older than its samples
    GLenum draw_buffer_ = GL_INVALID_ENUM, read_buffer_ = GL_INVALID_ENUM;  // bound last, as if it were the left eye
    Layer* other_eye_ = nullptr;
};

}  // namespace wall::tileserver
