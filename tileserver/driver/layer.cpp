// SPDX-License-Identifier: MIT
#include "tileserver/driver/layer.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr GLenum kBack = GL_COLOR_ATTACHMENT0, kFront = GL_COLOR_ATTACHMENT1;

/// The attachments that a buffer of the window means. There is no right eye.
std::pair<GLenum, GLenum> attachments(GLenum buffer, bool double_buffered) {
    const GLenum front = double_buffered ? kFront : kBack;
    switch (buffer) {
        case GL_FRONT:
        case GL_FRONT_LEFT: return {front, GL_NONE};
        case GL_BACK:
        case GL_BACK_LEFT: return {kBack, GL_NONE};
        case GL_LEFT:
        case GL_FRONT_AND_BACK: return double_buffered ? std::pair{kBack, kFront} : std::pair{front, GLenum{GL_NONE}};
        default: return {GL_NONE, GL_NONE};
    }
}

}  // namespace

Layer::Layer(const Gl& gl, bool flip_y, const LayerGeometry& geometry, const LayerFormat& format, PixelBudget& budget)
    : gl_(gl), budget_(budget), format_(format), flip_y_(flip_y) {
    geometry_ = geometry;
    budget_.left -= pixels();
    const GLenum color = format.alpha ? GL_RGBA8 : GL_RGB8;
    front_ = make_texture(color);
    if (format.double_buffered) {
        back_ = make_texture(color);
        ready_ = make_texture(color);
    }
    if (format.depth || format.stencil) depth_stencil_ = make_texture(GL_DEPTH24_STENCIL8);
    gl_.CreateFramebuffers(1, &framebuffer_);
    attach(kBack, format.double_buffered ? back_ : front_);
    if (format.double_buffered) attach(kFront, front_);
    if (format.depth) attach(GL_DEPTH_ATTACHMENT, depth_stencil_);
    if (format.stencil) attach(GL_STENCIL_ATTACHMENT, depth_stencil_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (flip_y_) gl_.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, 1);
    complete_ = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

Layer::~Layer() {
    budget_.left += pixels();
    const std::array textures = {front_, back_, ready_, depth_stencil_};
    gl_.DeleteFramebuffers(1, &framebuffer_);
    gl_.DeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
}

GLuint Layer::make_texture(GLenum format) {
    GLuint texture = 0;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &texture);
    gl_.TextureStorage2D(texture, 1, format, width(), height());
    const bool color = format != GL_DEPTH24_STENCIL8;  // a window starts all zero
    gl_.ClearTexImage(texture, 0, color ? GL_RGBA : GL_DEPTH_STENCIL, color ? GL_UNSIGNED_BYTE : GL_UNSIGNED_INT_24_8,
                      nullptr);
    return texture;
}

void Layer::attach(GLenum point, GLuint texture) { gl_.NamedFramebufferTexture(framebuffer_, point, texture, 0); }

void Layer::bind(GLenum draw_buffer, GLenum read_buffer) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (std::exchange(draw_buffer_, draw_buffer) != draw_buffer) {
        const auto [first, second] = attachments(draw_buffer, format_.double_buffered);
        const std::array buffers = {first, second};
        gl_.DrawBuffers(second == GL_NONE ? 1 : 2, buffers.data());
    }
    if (std::exchange(read_buffer_, read_buffer) != read_buffer)
        gl_.ReadBuffer(attachments(read_buffer, format_.double_buffered).first);
}

std::vector<GLuint> Layer::draw_textures() const {
    std::vector<GLuint> textures;
    const auto [first, second] = attachments(draw_buffer_, format_.double_buffered);
    for (const GLenum attachment : {first, second})
        if (attachment != GL_NONE)
            textures.push_back(attachment == kFront || !format_.double_buffered ? program_front() : back_);
    return textures;
}

namespace {

/// Turns an image upside down where the driver's rows go down.
void reverse_rows(std::vector<std::uint8_t>& pixels, std::size_t row_bytes, std::size_t rows) {
    for (std::size_t y = 0; y < rows / 2; ++y)
        std::swap_ranges(&pixels[y * row_bytes], &pixels[y * row_bytes] + row_bytes,
                         &pixels[(rows - 1 - y) * row_bytes]);
}

}  // namespace

void Layer::read_texture(GLuint texture, const geom::Rect& area, std::vector<std::uint8_t>& pixels) const {
    const std::int32_t y = flip_y_ ? height() - area.bottom() : area.y;
    gl_.GetTextureSubImage(texture, 0, area.x, y, 0, area.width, area.height, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                           static_cast<GLsizei>(pixels.size()), pixels.data());
    if (flip_y_) reverse_rows(pixels, static_cast<std::size_t>(area.width) * 4, static_cast<std::size_t>(area.height));
}

void Layer::write_texture(GLuint texture, const geom::Rect& area, std::vector<std::uint8_t>& pixels) {
    const std::int32_t y = flip_y_ ? height() - area.bottom() : area.y;
    if (flip_y_) reverse_rows(pixels, static_cast<std::size_t>(area.width) * 4, static_cast<std::size_t>(area.height));
    gl_.TextureSubImage2D(texture, 0, area.x, y, area.width, area.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

void Layer::copy(GLuint from, const Layer& source, GLuint to) const {
    // Where the two areas overlap on the canvas, placed within each texture.
    const geom::Rect common = geom::intersect(geometry_.area, source.geometry_.area);
    if (common.empty()) return;
    const auto row = [&](const Layer& layer) {
        const geom::Rect& area = layer.geometry_.area;
        return flip_y_ ? common.y - area.y : area.bottom() - common.bottom();
    };
    gl_.Flush();  // Mesa 22.3 leaves vertices of glBegin/glEnd that it still holds out of the copy
    gl_.CopyImageSubData(from, GL_TEXTURE_2D, 0, common.x - source.geometry_.area.x, row(source), 0, to, GL_TEXTURE_2D,
                         0, common.x - geometry_.area.x, row(*this), 0, common.width, common.height, 1);
}

void Layer::finish_frame() {
    if (!format_.double_buffered) return;
    copy(back_, *this, ready_);
    frame_waits_ = true;
    attach(kFront, program_front());
}

void Layer::show_frame() {
    if (std::exchange(frame_waits_, false)) std::swap(front_, ready_);  // what is attached as the front stays
}

void Layer::take_content(const Layer& older) {
    // Compare within the surface, not on the canvas: a moved window keeps its content.
    LayerGeometry& mine = geometry_;
    const geom::Rect place = mine.area;
    mine.area.x += older.geometry_.surface.x - mine.surface.x;
    mine.area.y += older.geometry_.surface.bottom() - mine.surface.bottom();
    copy(older.front_, older, front_);
    if (format_.double_buffered && older.format_.double_buffered) {
        copy(older.back_, older, back_);
        copy(older.ready_, older, ready_);
        frame_waits_ = older.frame_waits_;
        attach(kFront, program_front());
    }
    if (depth_stencil_ != 0 && older.depth_stencil_ != 0) copy(older.depth_stencil_, older, depth_stencil_);
    mine.area = place;
}

}  // namespace wall::tileserver
