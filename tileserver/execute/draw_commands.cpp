// SPDX-License-Identifier: MIT
#include "tileserver/execute/draw_commands.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/glstate/draw_buffers.h"
#include "common/glstate/raster_place.h"
#include "tileserver/driver/accum.h"
#include "tileserver/execute/image_check.h"

namespace wall::tileserver {
namespace {

constexpr std::int64_t kMaxScaledBitmap = std::int64_t{1} << 28;  // pixels
constexpr std::int32_t kMaxEvalSteps = 1 << 16;                   // of a mesh, in each direction

/// A bitmap in which every pixel is repeated: glBitmap knows no zoom. Nearest, anchored at the bottom left.
std::vector<GLubyte> scale_bitmap(std::span<const std::byte> bits, std::int32_t width, std::int32_t height,
                                  std::int32_t new_width, std::int32_t new_height) {
    const std::size_t row = (static_cast<std::size_t>(width) + 7) / 8,
                      new_row = (static_cast<std::size_t>(new_width) + 7) / 8;
    std::vector<GLubyte> out(new_row * static_cast<std::size_t>(new_height));
    for (std::int32_t y = 0; y < new_height; ++y) {
        const std::byte* from = bits.data() + row * static_cast<std::size_t>(std::int64_t{y} * height / new_height);
        for (std::int32_t x = 0; x < new_width; ++x) {
            const auto source = static_cast<std::size_t>(std::int64_t{x} * width / new_width);
            if ((std::to_integer<unsigned>(from[source / 8]) >> (7 - source % 8) & 1) != 0)
                out[new_row * static_cast<std::size_t>(y) + static_cast<std::size_t>(x) / 8] |=
                    static_cast<GLubyte>(0x80u >> (x % 8));
        }
    }
    return out;
}

/// Gives all samples of a part of a layer the stencil values of the first ones: Mesa 22.3 writes no others by
/// glDrawPixels.
void spread_stencil(const Gl& gl, const Layer& layer, const LayerPoint& from, const LayerPoint& to) {
    const auto x0 = static_cast<GLint>(std::lround(std::clamp<double>(std::min(from.x, to.x), 0, layer.width()))),
               y0 = static_cast<GLint>(std::lround(std::clamp<double>(std::min(from.y, to.y), 0, layer.height()))),
               x1 = static_cast<GLint>(std::lround(std::clamp<double>(std::max(from.x, to.x), 0, layer.width()))),
               y1 = static_cast<GLint>(std::lround(std::clamp<double>(std::max(from.y, to.y), 0, layer.height())));
    if (x0 >= x1 || y0 >= y1) return;
    GLuint image = 0, framebuffer = 0;
    gl.CreateRenderbuffers(1, &image);
    gl.NamedRenderbufferStorage(image, GL_DEPTH24_STENCIL8, layer.width(), layer.height());
    gl.CreateFramebuffers(1, &framebuffer);
    gl.NamedFramebufferRenderbuffer(framebuffer, GL_STENCIL_ATTACHMENT, GL_RENDERBUFFER, image);
    for (const auto& [source, target] :
         {std::pair{layer.framebuffer(), framebuffer}, {framebuffer, layer.framebuffer()}})
        gl.BlitNamedFramebuffer(source, target, x0, y0, x1, y1, x0, y0, x1, y1, GL_STENCIL_BUFFER_BIT, GL_NEAREST);
    gl.DeleteFramebuffers(1, &framebuffer);
    gl.DeleteRenderbuffers(1, &image);
}

/// Whether the values of a buffer may be given in a type.
bool clears_by(GLenum buffer, GLenum type) {
    switch (buffer) {
        case GL_COLOR: return type == GL_FLOAT || type == GL_INT || type == GL_UNSIGNED_INT;
        case GL_DEPTH: return type == GL_FLOAT;
        case GL_STENCIL: return type == GL_INT;
        case GL_DEPTH_STENCIL: return type == GL_FLOAT_32_UNSIGNED_INT_24_8_REV;
        default: return false;
    }
}

/// glClearBuffer with four values, as bits of the type.
void clear_buffer(const Gl& gl, GLenum buffer, GLint drawbuffer, GLenum type, const std::array<std::uint32_t, 4>& v) {
    const std::array real = {std::bit_cast<float>(v[0]), std::bit_cast<float>(v[1]), std::bit_cast<float>(v[2]),
                             std::bit_cast<float>(v[3])};
    const std::array whole = {static_cast<GLint>(v[0]), static_cast<GLint>(v[1]), static_cast<GLint>(v[2]),
                              static_cast<GLint>(v[3])};
    if (type == GL_FLOAT) gl.ClearBufferfv(buffer, drawbuffer, real.data());
    else if (type == GL_INT) gl.ClearBufferiv(buffer, drawbuffer, whole.data());
    else if (type == GL_UNSIGNED_INT) gl.ClearBufferuiv(buffer, drawbuffer, v.data());
    else gl.ClearBufferfi(buffer, drawbuffer, real[0], whole[1]);
}

/// What WindowContent may be.
bool is_content(GLenum format, GLenum type) {
    return (format == GL_RGBA && type == GL_UNSIGNED_BYTE) ||
           (format == GL_DEPTH_STENCIL && type == GL_UNSIGNED_INT_24_8) ||
           (format == GL_DEPTH_COMPONENT && type == GL_UNSIGNED_INT);
}

}  // namespace

bool DrawCommands::outside_begin() {
    if (block_.in_begin) execution_.refuse("between Begin and End");
    return !block_.in_begin;
}

void DrawCommands::EvalMesh1(GLenum mode, std::int32_t i1, std::int32_t i2) {
    if (!outside_begin()) return;
    if (std::int64_t{i2} - i1 > kMaxEvalSteps) return execution_.refuse("mesh is too fine");
    if (block_.draws) execution_.gl.EvalMesh1(mode, i1, i2);
}
void DrawCommands::EvalMesh2(GLenum mode, std::int32_t i1, std::int32_t i2, std::int32_t j1, std::int32_t j2) {
    if (!outside_begin()) return;
    const std::int64_t across = std::int64_t{i2} - i1, along = std::int64_t{j2} - j1;
    if (across > kMaxEvalSteps || along > kMaxEvalSteps ||
        (across > 0 && along > 0 && across * along > std::int64_t{kMaxEvalSteps} * 64))
        return execution_.refuse("mesh is too fine");
    if (block_.draws) execution_.gl.EvalMesh2(mode, i1, i2, j1, j2);
}

void DrawCommands::Clear(std::uint32_t mask) {
    if (!outside_begin()) return;
    constexpr GLbitfield kBuffers = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if ((mask & ~(kBuffers | GL_ACCUM_BUFFER_BIT)) != 0) return execution_.refuse("no such buffer");
    if (!block_.draws) return;
    if ((mask & kBuffers) != 0) execution_.gl.Clear(mask & kBuffers);
    if ((mask & GL_ACCUM_BUFFER_BIT) != 0 && has_accum())
        clear_accum(*block_.layer, accum_area(*block_.layer, execution_.context->state),
                    glstate::el::clear_accum::ref(execution_.context->state));
}

void DrawCommands::ClearBuffer(GLenum buffer, std::int32_t drawbuffer, GLenum type, std::uint32_t v0, std::uint32_t v1,
                               std::uint32_t v2, std::uint32_t v3) {
    if (!outside_begin()) return;
    if (!clears_by(buffer, type)) return execution_.refuse("no such buffer, or not by such values");
    const bool color = buffer == GL_COLOR;
    if (drawbuffer < 0 || drawbuffer >= (color ? static_cast<std::int32_t>(glstate::kDrawBuffers) : 1))
        return execution_.refuse("no such draw buffer");
    if (!block_.draws) return;
    // A window has one draw buffer, which may be the front and the back: two of the layer.
    auto behind = drawbuffer + 1;
    if (color && block_.layer != nullptr && drawbuffer == 0)
        behind = static_cast<std::int32_t>(block_.layer->draw_textures().size());
    for (std::int32_t i = drawbuffer; i < behind; ++i) clear_buffer(execution_.gl, buffer, i, type, {v0, v1, v2, v3});
}

void DrawCommands::Accum(GLenum op, float value) {
    if (!outside_begin()) return;
    if (op < GL_ACCUM || op > GL_ADD) return execution_.refuse("no such operation");
    if (block_.draws && has_accum())
        accumulate(execution_.node.driver, *block_.layer, execution_.context->state, op, value);
}

// ---- images at the raster position ----

/// Where an image is drawn on the target, and how large its pixels are there.
struct RasterPlace {
    float x = 0, y = 0, z = 0;        ///< as glWindowPos has them
    double scale_x = 1, scale_y = 1;  ///< target pixels of one of the image's
    bool seen = false;                ///< through a view; images and lines of text are not drawn smaller there
};

namespace {

/// Nothing: it is drawn nowhere.
std::optional<RasterPlace> raster_place(const glstate::State& state, const glstate::Vec4& raster,
                                        const LayerGeometry& g) {
    namespace el = glstate::el;
    RasterPlace out{.scale_x = g.scale_x(), .scale_y = g.scale_y()};
    glstate::SeenRaster there{el::raster_position_valid::ref(state) != 0, raster};
    if (const auto seen = g.view ? glstate::raster_in_view(*g.view, state, raster) : std::nullopt) {
        there = *seen;
        out = {.seen = true};
    }
    const auto& [x, y, z, w] = there.position;
    if (!there.valid || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return std::nullopt;
    const auto at = layer_point(g, x, y);
    out.x = static_cast<float>(at.x) + there.right;
    out.y = static_cast<float>(at.y) + there.up;
    const auto& depth = el::depth_range::ref(state);
    const double range = depth.far_value - depth.near_value;
    out.z = range == 0 ? 0.0f : static_cast<float>((z - depth.near_value) / range);
    return out;
}

}  // namespace

/// Calls `draw` with the target's raster position, and with the driver's there and its colour the raster colour.
template <class Draw>
void DrawCommands::at_raster_position(Draw&& draw) {
    namespace el = glstate::el;
    const glstate::State& state = execution_.context->state;
    const auto place = raster_place(state, block_.raster, block_.target->geometry());
    if (!place) return;
    Driver& driver = execution_.node.driver;
    block_.trail.fold_into(driver.mirror);
    // glWindowPos takes the current colour for the raster colour, and maps z through the depth range.
    const bool tracking = driver.mirror.material.color_material_enabled != 0;
    if (tracking) execution_.gl.Disable(GL_COLOR_MATERIAL);
    const auto& color = el::raster_color::ref(state);
    const auto& secondary = el::raster_secondary_color::ref(state);
    execution_.gl.Color4f(color[0], color[1], color[2], color[3]);
    execution_.gl.SecondaryColor3f(secondary[0], secondary[1], secondary[2]);
    execution_.gl.WindowPos3f(place->x, place->y, place->z);
    draw(*place);
    const auto& now = driver.mirror.current;
    execution_.gl.Color4f(now.color[0], now.color[1], now.color[2], now.color[3]);
    execution_.gl.SecondaryColor3f(now.secondary_color[0], now.secondary_color[1], now.secondary_color[2]);
    if (tracking) execution_.gl.Enable(GL_COLOR_MATERIAL);
}

/// An image of stencil values has been drawn to a window of samples, by the driver to one of each pixel's.
void DrawCommands::spread_stencil_of_image(const RasterPlace& place, std::int32_t width, std::int32_t height) {
    const auto& zoom = glstate::el::pixel_zoom::ref(execution_.context->state);
    spread_stencil(execution_.gl, *block_.layer, {place.x, place.y},
                   {place.x + static_cast<double>(width) * zoom.x * place.scale_x,
                    place.y + static_cast<double>(height) * zoom.y * place.scale_y});
}

void DrawCommands::DrawPixels(std::int32_t width, std::int32_t height, GLenum format, GLenum type,
                              std::span<const std::byte> pixels) {
    if (!outside_begin() || !image_fits(execution_, format, type, {width, height, 1}, pixels)) return;
    if (!block_.draws || width == 0 || height == 0) return;
    execution_.node.maps.sync_pixel_maps(execution_.gl, execution_.context->maps);
    at_raster_position([&](const RasterPlace& place) {
        const auto& zoom = glstate::el::pixel_zoom::ref(execution_.context->state);
        if (place.seen) execution_.gl.PixelZoom(zoom.x, zoom.y);
        execution_.gl.DrawPixels(width, height, format, type, pixels.data());
        if (place.seen) execution_.node.driver.restore_pixel_zoom();
        if (block_.layer != nullptr && block_.layer->samples() != 0 && format == GL_STENCIL_INDEX)
            spread_stencil_of_image(place, width, height);
    });
}

void DrawCommands::WindowContent(std::int32_t x, std::int32_t y, std::int32_t width, std::int32_t height, GLenum format,
                                 GLenum type, std::span<const std::byte> pixels) {
    constexpr std::int32_t kMost = wire::kMaxSurfaceExtent;
    if (!outside_begin()) return;
    if (!is_content(format, type) || x < 0 || y < 0 || width <= 0 || height <= 0 || x > kMost || y > kMost ||
        width > kMost || height > kMost)
        return execution_.refuse("no content that a window can have");
    if (!image_fits(execution_, format, type, {width, height, 1}, pixels)) return;
    if (!block_.draws || block_.layer == nullptr) return;
    const geom::Rect area{x, y, width, height};
    const LayerGeometry& geometry = block_.layer->geometry();
    if (geometry.scaled() || geometry.view || block_.layer->samples() != 0)
        return draw_scaled_content(area, format, type, pixels);
    block_.layer->write_content(area, format, pixels);
}

/// As an image, which goes through the driver's rounding.
void DrawCommands::draw_scaled_content(const geom::Rect& area, GLenum format, GLenum type,
                                       std::span<const std::byte> pixels) {
    const auto kept = std::exchange(block_.raster, {static_cast<float>(area.x), static_cast<float>(area.y), 0, 1});
    at_raster_position([&](const RasterPlace& place) {
        execution_.gl.DrawPixels(area.width, area.height, format, type, pixels.data());
        if (block_.layer->samples() != 0 && format == GL_DEPTH_STENCIL)
            spread_stencil_of_image(place, area.width, area.height);
    });
    block_.raster = kept;
}

void DrawCommands::Bitmap(std::int32_t width, std::int32_t height, float xorig, float yorig, float xmove, float ymove,
                          std::span<const std::byte> bits) {
    if (!outside_begin()) return;
    if (width < 0 || height < 0 || width > (1 << 16) || height > (1 << 16)) return execution_.refuse("absurd size");
    if (bits.size() != (static_cast<std::size_t>(width) + 7) / 8 * static_cast<std::size_t>(height))
        return execution_.refuse("size does not fit the bits");
    if (block_.draws && width != 0 && height != 0) {
        execution_.node.driver.hold_bitmap();
        at_raster_position([&](const RasterPlace& place) {
            if (place.scale_x == 1 && place.scale_y == 1)
                return execution_.gl.Bitmap(width, height, xorig, yorig, 0, 0,
                                            reinterpret_cast<const GLubyte*>(bits.data()));
            const auto new_width = std::max(1, static_cast<std::int32_t>(std::lround(width * place.scale_x)));
            const auto new_height = std::max(1, static_cast<std::int32_t>(std::lround(height * place.scale_y)));
            if (std::int64_t{new_width} * new_height > kMaxScaledBitmap) return;
            const auto scaled = scale_bitmap(bits, width, height, new_width, new_height);
            execution_.gl.Bitmap(new_width, new_height, static_cast<float>(xorig * place.scale_x),
                                 static_cast<float>(yorig * place.scale_y), 0, 0, scaled.data());
        });
    }
    if (glstate::el::raster_position_valid::ref(execution_.context->state) == 0) return;
    block_.raster[0] += xmove;
    block_.raster[1] += ymove;
}

// ---- selection and feedback ----

void DrawCommands::InitNames() {
    if (outside_begin() && block_.draws) execution_.modes.init_names();
}
void DrawCommands::LoadName(std::uint32_t name) {
    if (outside_begin() && block_.draws) execution_.modes.load_name(name);
}
void DrawCommands::PushName(std::uint32_t name) {
    if (outside_begin() && block_.draws) execution_.modes.push_name(name);
}
void DrawCommands::PopName() {
    if (outside_begin() && block_.draws) execution_.modes.pop_name();
}
void DrawCommands::PassThrough(float token) {
    if (outside_begin() && block_.draws) execution_.gl.PassThrough(token);
}

// ---- runs ----

void DrawCommands::RunCall(ClientName id) {
    if (!outside_begin()) return;
    const Run* run = execution_.session.objects.find<Run>(id);
    if (run == nullptr) return execution_.refuse(execution_.session.objects.get<Run>(id).error().message);
    next_ = 0;
    if (!call_parts(*run->content())) called_ = run->content();
}

void DrawCommands::go_on() {
    if (call_parts(*called_)) called_.reset();
}

bool DrawCommands::call_parts(const RunContent& run) {
    while (next_ < run.parts.size()) {
        const RunContent::Part& part = run.parts[next_++];
        if (block_.draws) execution_.gl.CallList(part.list);
        block_.trail.append(part.trail);
        ++execution_.told;
        if (next_ < run.parts.size() && execution_.slice_is_over()) return false;
    }
    return true;
}

}  // namespace wall::tileserver
