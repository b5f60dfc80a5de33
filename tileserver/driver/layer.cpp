// SPDX-License-Identifier: MIT
#include "tileserver/driver/layer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "common/glapi/texture_target.h"
#include "common/glstate/draw_buffers.h"

namespace wall::tileserver {
namespace {

constexpr GLenum kBack = GL_COLOR_ATTACHMENT0, kFront = GL_COLOR_ATTACHMENT1;

/// What the right eye's buffers are called, as if they were the left one's, and the other way round.
GLenum for_other_eye(GLenum buffer) {
    switch (buffer) {
        case GL_FRONT_LEFT: return GL_FRONT_RIGHT;
        case GL_FRONT_RIGHT: return GL_FRONT_LEFT;
        case GL_BACK_LEFT: return GL_BACK_RIGHT;
        case GL_BACK_RIGHT: return GL_BACK_LEFT;
        case GL_LEFT: return GL_RIGHT;
        case GL_RIGHT: return GL_LEFT;
        default: return buffer;  // of both eyes, or none
    }
}

/// The attachments that a buffer of the window means. The right eye has none here.
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

GLenum target_of(std::uint32_t samples) {
    using glapi::TextureTarget;
    return glapi::info_of(samples != 0 ? TextureTarget::t2d_multisample : TextureTarget::t2d).target;
}

/// A window starts all zero.
void clear_texture(const Gl& gl, GLuint texture, GLenum format) {
    const bool color = format != GL_DEPTH24_STENCIL8;
    gl.ClearTexImage(texture, 0, color ? GL_RGBA : GL_DEPTH_STENCIL, color ? GL_UNSIGNED_BYTE : GL_UNSIGNED_INT_24_8,
                     nullptr);
}

/// Copies one texture's pixels to another of the same size, whose pixels have another number of samples: as many pixels
/// are made of samples, or samples of pixels. The first scissor takes part in a blit, and is off meanwhile.
void convert_samples(const Gl& gl, GLuint from, GLuint to, std::int32_t width, std::int32_t height) {
    std::array<GLuint, 2> framebuffers{};
    gl.CreateFramebuffers(2, framebuffers.data());
    gl.NamedFramebufferTexture(framebuffers[0], GL_COLOR_ATTACHMENT0, from, 0);
    gl.NamedFramebufferTexture(framebuffers[1], GL_COLOR_ATTACHMENT0, to, 0);
    const bool scissor = gl.IsEnabledi(GL_SCISSOR_TEST, 0) == GL_TRUE;
    if (scissor) gl.Disablei(GL_SCISSOR_TEST, 0);
    gl.BlitNamedFramebuffer(framebuffers[0], framebuffers[1], 0, 0, width, height, 0, 0, width, height,
                            GL_COLOR_BUFFER_BIT, GL_NEAREST);
    if (scissor) gl.Enablei(GL_SCISSOR_TEST, 0);
    gl.DeleteFramebuffers(2, framebuffers.data());
}

}  // namespace

Layer::Layer(const Gl& gl, bool flip_y, const LayerGeometry& geometry, const LayerFormat& format, PixelBudget& budget)
    : gl_(gl), budget_(budget), format_(format), flip_y_(flip_y) {
    geometry_ = geometry;
    budget_.left -= pixels_taken(geometry_, format_);
    front_ = make_texture(color_format(), 0);
    if (format.double_buffered) {
        back_ = make_texture(color_format(), format.samples);
        ready_ = make_texture(color_format(), 0);
    }
    if (format.depth || format.stencil) depth_stencil_ = make_texture(GL_DEPTH24_STENCIL8, format.samples);
    gl_.CreateFramebuffers(1, &framebuffer_);
    if (format.double_buffered) attach(kBack, drawn_as(back_));
    if (format.samples == 0) attach(format.double_buffered ? kFront : kBack, drawn_as(front_));
    else if (!format.double_buffered) need_front_samples();
    if (format.depth) attach(GL_DEPTH_ATTACHMENT, depth_stencil_);
    if (format.stencil) attach(GL_STENCIL_ATTACHMENT, depth_stencil_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (flip_y_) gl_.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, 1);
    complete_ = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

Layer::~Layer() {
    budget_.left += pixels_taken(geometry_, format_);
    const std::array textures = {front_, back_, ready_, depth_stencil_, front_samples_};
    gl_.DeleteFramebuffers(1, &framebuffer_);
    for (const auto& [texture, view] : views_) gl_.DeleteTextures(1, &view);
    gl_.DeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
}

GLuint Layer::make_texture(GLenum format, std::uint32_t samples) const {
    GLuint texture = 0;
    gl_.CreateTextures(target_of(samples), 1, &texture);
    if (samples != 0)
        gl_.TextureStorage2DMultisample(texture, static_cast<GLsizei>(samples), format, width(), height(), GL_TRUE);
    else gl_.TextureStorage2D(texture, 1, format, width(), height());
    clear_texture(gl_, texture, format);
    return texture;
}

void Layer::attach(GLenum point, GLuint texture) { gl_.NamedFramebufferTexture(framebuffer_, point, texture, 0); }

GLuint Layer::drawn_as(GLuint texture) {
    if (!format_.srgb) return texture;
    const auto known = std::ranges::find(views_, texture, &std::pair<GLuint, GLuint>::first);
    if (known != views_.end()) return known->second;
    GLint samples = 0;
    gl_.GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_SAMPLES, &samples);
    GLuint view = 0;
    gl_.GenTextures(1, &view);
    gl_.TextureView(view, target_of(static_cast<std::uint32_t>(samples)), texture,
                    format_.alpha ? GL_SRGB8_ALPHA8 : GL_SRGB8, 0, 1, 0, 1);
    views_.emplace_back(texture, view);
    return view;
}

void Layer::forget_view(GLuint texture) {
    const auto known = std::ranges::find(views_, texture, &std::pair<GLuint, GLuint>::first);
    if (known == views_.end()) return;
    gl_.DeleteTextures(1, &known->second);
    views_.erase(known);
}

bool Layer::draws_to_front() const {
    const auto [first, second] = attachments(draw_buffer_, format_.double_buffered);
    return !format_.double_buffered ? first != GL_NONE : first == kFront || second == kFront;
}

void Layer::need_front_samples() {
    if (front_samples_ != 0) return;
    front_samples_ = make_texture(color_format(), format_.samples);
    if (format_.double_buffered) convert_samples(gl_, program_front(), front_samples_, width(), height());
    attach(format_.double_buffered ? kFront : kBack, drawn_as(front_samples_));
}

void Layer::drop_front_samples() {
    if (front_samples_ == 0) return;
    attach(kFront, 0);
    forget_view(front_samples_);
    gl_.DeleteTextures(1, &front_samples_);
    front_samples_ = 0;
    front_drawn_ = false;
}

void Layer::settle_front() const {
    if (front_samples_ == 0 || !(front_drawn_ || draws_to_front())) return;
    convert_samples(gl_, front_samples_, program_front(), width(), height());
    front_drawn_ = false;
}

GLuint Layer::front() const {
    if (!frame_waits_) settle_front();
    return front_;
}

void Layer::bind(GLenum draw_buffer, GLenum read_buffer) {
    const bool right = format_.eye == geom::Eye::right;
    const bool reads_right = glstate::eye_of(read_buffer) == geom::Eye::right;  // else what is read is the left eye's
    if (right) {
        draw_buffer = for_other_eye(draw_buffer);
        read_buffer = for_other_eye(read_buffer);
    }
    if (draws_to_front()) front_drawn_ = true;
    prepare(draw_buffer);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (std::exchange(draw_buffer_, draw_buffer) != draw_buffer) {
        const auto [first, second] = attachments(draw_buffer, format_.double_buffered);
        const std::array buffers = {first, second};
        gl_.DrawBuffers(second == GL_NONE ? 1 : 2, buffers.data());
    }
    if (other_eye_ == nullptr || reads_right == right) return choose_read(read_buffer);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, other_eye_->framebuffer_);
    other_eye_->choose_read(for_other_eye(read_buffer));
}

void Layer::prepare(GLenum buffer) {
    if (format_.samples == 0 || !format_.double_buffered) return;
    const auto [first, second] = attachments(buffer, true);
    if (first == kFront || second == kFront) need_front_samples();
}

void Layer::choose_read(GLenum buffer) {
    prepare(buffer);
    if (std::exchange(read_buffer_, buffer) != buffer)
        gl_.ReadBuffer(attachments(buffer, format_.double_buffered).first);
}

bool Layer::draws_colors() const { return attachments(draw_buffer_, format_.double_buffered).first != GL_NONE; }

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

/// In the texture, whose rows may go down; `area` in window pixels.
void Layer::read_block(PixelBlock& block) const {
    block.top_row_first = flip_y_;
    block.colors.resize(block.pixels());
    block.depths.resize(block.pixels());
    const auto bytes = static_cast<GLsizei>(block.pixels() * sizeof(std::uint32_t));
    const auto [x, y] = texture_place(block.area);
    gl_.Flush();  // as in copy()
    gl_.GetTextureSubImage(format_.double_buffered ? back_ : front_, 0, x, y, 0, block.area.width, block.area.height, 1,
                           GL_RGBA, GL_UNSIGNED_BYTE, bytes, block.colors.data());
    gl_.GetTextureSubImage(depth_stencil_, 0, x, y, 0, block.area.width, block.area.height, 1, GL_DEPTH_STENCIL,
                           GL_UNSIGNED_INT_24_8, bytes, block.depths.data());
}

void Layer::write_block(const PixelBlock& block) {
    const auto [x, y] = texture_place(block.area);
    gl_.TextureSubImage2D(format_.double_buffered ? back_ : front_, 0, x, y, block.area.width, block.area.height,
                          GL_RGBA, GL_UNSIGNED_BYTE, block.colors.data());
    gl_.TextureSubImage2D(depth_stencil_, 0, x, y, block.area.width, block.area.height, GL_DEPTH_STENCIL,
                          GL_UNSIGNED_INT_24_8, block.depths.data());
}

void Layer::write_content(const geom::Rect& area, GLenum format, std::span<const std::byte> pixels) {
    constexpr std::size_t kPixel = sizeof(std::uint32_t);
    const bool colors = format == GL_RGBA;
    const geom::Rect part = geom::intersect(area, geometry_.pixels());
    if (part.empty() || (!colors && depth_stencil_ == 0)) return;
    const auto columns = static_cast<std::size_t>(part.width), rows = static_cast<std::size_t>(part.height);
    std::vector<std::uint32_t> values(columns * rows);
    for (std::size_t row = 0; row < rows; ++row) {
        const auto from = static_cast<std::size_t>(part.y - area.y) + row;
        const std::size_t at = from * static_cast<std::size_t>(area.width) + static_cast<std::size_t>(part.x - area.x);
        std::memcpy(&values[(flip_y_ ? rows - 1 - row : row) * columns], &pixels[at * kPixel], columns * kPixel);
    }
    if (format == GL_DEPTH_COMPONENT)
        for (std::uint32_t& value : values) value &= 0xffffff00;
    const auto [x, y] = texture_place(part);
    gl_.Flush();  // as in copy()
    if (colors)
        gl_.TextureSubImage2D(format_.double_buffered ? back_ : front_, 0, x, y, part.width, part.height, GL_RGBA,
                              GL_UNSIGNED_BYTE, values.data());
    else
        gl_.TextureSubImage2D(depth_stencil_, 0, x, y, part.width, part.height, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                              values.data());
}

std::pair<std::int32_t, std::int32_t> Layer::texture_place(const geom::Rect& area) const {
    const std::int32_t x = area.x - geometry_.offset_x(), y = area.y - geometry_.offset_y();
    return {x, flip_y_ ? height() - (y + area.height) : y};
}

void Layer::clear_to_depth(std::uint32_t depth) {
    gl_.Flush();
    clear_texture(gl_, format_.double_buffered ? back_ : front_, color_format());
    const std::uint32_t value = depth != 0 ? 0xffffff00 : 0;
    gl_.ClearTexImage(depth_stencil_, 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, &value);
}

void Layer::copy(GLuint from, const Layer& source, GLuint to, GLenum target) const {
    // Where the two areas overlap on the canvas, placed within each texture.
    const geom::Rect common = geom::intersect(geometry_.area, source.geometry_.area);
    if (common.empty()) return;
    const auto row = [&](const Layer& layer) {
        const geom::Rect& area = layer.geometry_.area;
        return flip_y_ ? common.y - area.y : area.bottom() - common.bottom();
    };
    gl_.Flush();  // Mesa 22.3 leaves vertices of glBegin/glEnd that it still holds out of the copy
    gl_.CopyImageSubData(from, target, 0, common.x - source.geometry_.area.x, row(source), 0, to, target, 0,
                         common.x - geometry_.area.x, row(*this), 0, common.width, common.height, 1);
}

void Layer::finish_frame() {
    if (!format_.double_buffered) return;
    if (format_.samples != 0) {
        settle_front();
        drop_front_samples();
        convert_samples(gl_, back_, ready_, width(), height());
    } else {
        copy(back_, *this, ready_);
    }
    frame_waits_ = true;
    if (format_.samples == 0) attach(kFront, drawn_as(program_front()));
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
    const GLenum drawn_to = target_of(format_.samples);
    older.settle_front();
    copy(older.front_, older, front_);
    if (format_.double_buffered && older.format_.double_buffered) {
        copy(older.back_, older, back_, drawn_to);
        copy(older.ready_, older, ready_);
        frame_waits_ = older.frame_waits_;
        if (format_.samples == 0) attach(kFront, drawn_as(program_front()));
    } else if (format_.samples != 0 && !format_.double_buffered) {
        copy(older.front_samples_, older, front_samples_, drawn_to);
    }
    if (depth_stencil_ != 0 && older.depth_stencil_ != 0) copy(older.depth_stencil_, older, depth_stencil_, drawn_to);
    mine.area = place;
}

}  // namespace wall::tileserver
