// SPDX-License-Identifier: MIT
// Pixels drawn from client memory, the tables they go through, and the polygon stipple (OpenGL 1.2.1, 3.5.2, 3.6, 3.7).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/readback.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture.h"
#include "common/glstate/raster_place.h"
#include "common/wire/limits.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// How far rounding may carry a pixel beyond the exact rectangle.
constexpr float kMargin = 2;

PixelRect drawn_rect(const Context& c, float width, float height) {
    const auto& position = c.state.raster.raster_position;
    const auto& zoom = c.state.window.pixel_zoom;
    const float x = position[0] + width * zoom.x, y = position[1] + height * zoom.y;
    return {std::min(position[0], x) - kMargin, std::min(position[1], y) - kMargin, std::max(position[0], x) + kMargin,
            std::max(position[1], y) + kMargin};
}

/// An image is drawn at the raster position: in the program's own picture, or where only tiles see it that look
/// elsewhere.
bool may_draw_at_raster(const Context& c) {
    const auto& raster = c.state.raster;
    return raster.raster_position_valid || (raster.raster_clip[3] != 0.0f && c.state.local.render_mode == GL_RENDER);
}

/// `window`: what it covers there, if the raster position is valid.
template <class Pack>
void draw_at_raster(Context& c, const PixelRect& window, Pack&& pack) {
    const auto& raster = c.state.raster;
    if (raster.raster_clip[3] == 0.0f) return c.draw(window, std::forward<Pack>(pack));
    const auto projection = glstate::make_projection(c.state);
    const auto first = glstate::window_position(c.state, raster.raster_clip);
    const PixelRect around{window.x0 - first[0], window.y0 - first[1], window.x1 - first[0], window.y1 - first[1]};
    c.draw(Drawn::image(projection, raster.raster_clip, around,
                        raster.raster_position_valid ? std::optional(window) : std::nullopt),
           std::forward<Pack>(pack));
}

/// Whether the buffers that a format means exist.
bool buffers_exist(Context& c, GLenum format) {
    switch (format) {
        case GL_DEPTH_COMPONENT:
        case GL_DEPTH: return has_depth(c, false);
        case GL_STENCIL_INDEX:
        case GL_STENCIL: return has_stencil(c, false);
        case GL_DEPTH_STENCIL: return has_depth(c, false) && has_stencil(c, false);
        default: return true;
    }
}

void draw_tight(Context& c, GLsizei width, GLsizei height, GLenum format, GLenum type,
                std::span<const std::byte> pixels) {
    const bool color = format != GL_DEPTH_COMPONENT && format != GL_STENCIL_INDEX && format != GL_DEPTH_STENCIL;
    if (!color && c.draw_target()) c.draw_target().note_depth_image();
    draw_at_raster(
        c, drawn_rect(c, static_cast<float>(width), static_cast<float>(height)),
        [&](wire::PackBuffer& buffer) { glapi::pack::DrawPixels(buffer, width, height, format, type, pixels); });
}

void set_color_transfer(Context& c, const glstate::PixelTransferState& t) {
    c.set<el::map_color>(0, t.map_color);
    c.set<el::red_scale>(0, t.red_scale);
    c.set<el::green_scale>(0, t.green_scale);
    c.set<el::blue_scale>(0, t.blue_scale);
    c.set<el::alpha_transfer_scale>(0, t.alpha_transfer_scale);
    c.set<el::red_bias>(0, t.red_bias);
    c.set<el::green_bias>(0, t.green_bias);
    c.set<el::blue_bias>(0, t.blue_bias);
    c.set<el::alpha_transfer_bias>(0, t.alpha_transfer_bias);
}

/// Mesa draws images of colour indices wrongly once it has to clip them, as at a tile's border: they travel as colours,
/// which are past scale, bias and maps (OpenGL 1.2.1, 3.6.4).
void draw_indices(Context& c, GLsizei width, GLsizei height, std::span<const float> indices) {
    const auto colors = indices_to_colors(c.state, c.maps->pixel, indices);
    const auto kept = c.state.pixel_transfer;
    set_color_transfer(c, {});
    draw_tight(c, width, height, GL_RGBA, GL_FLOAT, std::as_bytes(std::span(colors)));
    set_color_transfer(c, kept);
}

// ---- pixel maps ----

bool is_index_map(GLenum map) { return map == GL_PIXEL_MAP_I_TO_I || map == GL_PIXEL_MAP_S_TO_S; }
bool is_pixel_map(GLenum map) { return map >= GL_PIXEL_MAP_I_TO_I && map <= GL_PIXEL_MAP_A_TO_A; }

void set_pixel_map(Context& c, GLenum map, std::vector<float> values) {
    if (!is_index_map(map))
        for (float& value : values) value = std::clamp(value, 0.0f, 1.0f);
    const unsigned i = map - GL_PIXEL_MAP_I_TO_I;
    if (c.maps->pixel.tables[i] == values) return;
    c.flush_block();
    c.maps->pixel.tables[i] = std::move(values);
    c.maps->stamp = c.maps->pixel_maps[i].stamp = next_stamp();
}

/// `scale` makes fractions of integers, for maps of colours.
template <class In>
void pixel_map(Context& c, GLenum map, GLsizei size, const In* values, double scale) {
    if (!is_pixel_map(map)) return c.error(GL_INVALID_ENUM);
    if (size < 1 || size > kMaxPixelMapTable) return c.error(GL_INVALID_VALUE);
    if (map <= GL_PIXEL_MAP_I_TO_A && !std::has_single_bit(static_cast<unsigned>(size)))
        return c.error(GL_INVALID_VALUE);
    std::vector<float> table(static_cast<std::size_t>(size));
    const auto* from = static_cast<const std::byte*>(unpack_source(c, values, table.size() * sizeof(In)));
    if (!from) return;
    for (float& entry : table) {
        In value;
        std::memcpy(&value, from, sizeof value);
        from += sizeof value;
        entry = static_cast<float>(is_index_map(map) ? static_cast<double>(value) : value * scale);
    }
    set_pixel_map(c, map, std::move(table));
}

/// Whether the program's memory has room for so many bytes; a buffer says so by itself, and so does what has not said.
bool has_room(const Context& c, std::optional<GLsizei> room, std::size_t bytes) {
    if (!room || c.state.local.pixel_pack_buffer != 0) return true;
    return *room >= 0 && static_cast<std::size_t>(*room) >= bytes;
}

template <class Out>
void get_pixel_map(Context& c, GLenum map, Out* out, double scale, std::optional<GLsizei> room = std::nullopt) {
    if (!is_pixel_map(map)) return c.error(GL_INVALID_ENUM);
    constexpr double kRounding = std::is_same_v<Out, GLushort> ? 0.5 : 0.0;  // Mesa rounds these only
    const auto values = c.maps->pixel.of(map);
    if (!has_room(c, room, values.size() * sizeof(Out))) return c.error(GL_INVALID_OPERATION);
    const PackTarget target = pack_target(c, out, values.size() * sizeof(Out));
    if (!target) return;
    auto* to = static_cast<std::byte*>(target.get());
    for (const float value : values) {
        const auto result = static_cast<Out>(is_index_map(map) ? value : value * scale + kRounding);
        std::memcpy(to, &result, sizeof result);
        to += sizeof result;
    }
}

// ---- buffers ----

/// Bits of the four colour buffers a word names: 1 front left, 2 back left, 4 front right, 8 back right; -1: no such
/// word.
int named_buffers(GLenum word) {
    switch (word) {
        case GL_NONE: return 0;
        case GL_FRONT_LEFT: return 1;
        case GL_BACK_LEFT: return 2;
        case GL_FRONT_RIGHT: return 4;
        case GL_BACK_RIGHT: return 8;
        case GL_FRONT: return 1 | 4;
        case GL_BACK: return 2 | 8;
        case GL_LEFT: return 1 | 2;
        case GL_RIGHT: return 4 | 8;
        case GL_FRONT_AND_BACK: return 15;
        case GL_AUX0:
        case GL_AUX1:
        case GL_AUX2:
        case GL_AUX3: return 16;
        default: return word >= GL_COLOR_ATTACHMENT0 && word <= GL_COLOR_ATTACHMENT15 ? 16 : -1;
    }
}

int existing_buffers(const DrawTarget& target) {
    const int left = !target || target.format().double_buffered ? 3 : 1;
    return target && target.format().stereo ? left | left << 2 : left;
}

GLenum buffer_error(GLenum word, const DrawTarget& target) {
    const int named = named_buffers(word);
    if (named < 0) return GL_INVALID_ENUM;
    return named == 0 || (named & existing_buffers(target)) ? GL_NO_ERROR : GL_INVALID_OPERATION;
}

/// Of a framebuffer object's.
GLenum attachment_buffer_error(GLenum word) {
    if (word == GL_NONE ||
        (glstate::attachment_place(word) && word != GL_DEPTH_ATTACHMENT && word != GL_STENCIL_ATTACHMENT))
        return GL_NO_ERROR;
    return named_buffers(word) < 0 ? GL_INVALID_ENUM : GL_INVALID_OPERATION;
}

constexpr std::byte kOnePixel[4] = {};

/// Fragment programs draw what raster positions place, too.
bool may_draw_fragments(Context& c) {
    if (!may_draw_to_target(c)) return false;
    if (may_use_assembly(c, glapi::AssemblyStage::fragment)) return true;
    c.error(GL_INVALID_OPERATION);
    return false;
}

/// While nothing is drawn an image is a token in the feedback buffer, of whatever size it is.
template <class Pack>
void feed_back(Context& c, Pack&& pack) {
    if (c.state.local.render_mode == GL_FEEDBACK) c.draw(std::nullopt, std::forward<Pack>(pack));
}

}  // namespace

void DrawPixels(Context& c, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels) {
    if (width < 0 || height < 0) return c.error(GL_INVALID_VALUE);
    if (glapi::is_integer_format(format)) return c.error(GL_INVALID_OPERATION);
    if (const GLenum error = glapi::format_type_error(format, type)) return c.error(error);
    if (!may_draw_fragments(c)) return;
    if (!buffers_exist(c, format)) return c.error(GL_INVALID_OPERATION);
    if (!may_draw_at_raster(c)) return;
    if (c.state.local.render_mode != GL_RENDER)
        return feed_back(
            c, [](wire::PackBuffer& b) { glapi::pack::DrawPixels(b, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, kOnePixel); });
    if (width == 0 || height == 0) return;
    const auto bytes = glapi::image_bytes(format, type, width, height, 1);
    if (!bytes || *bytes > wire::kMaxBlockBytes) return c.error(GL_OUT_OF_MEMORY);
    const void* from = image_source(c, {{width, height}, format, type}, pixels);
    if (!from) return;
    const auto tight = glapi::unpack_image(unpack_store(c.state), {width, height}, format, type, from);
    if (format == GL_COLOR_INDEX) return draw_indices(c, width, height, to_indices(type, tight, width, height));
    draw_tight(c, width, height, format, type, tight);
}

// The client's raster position is the only one: the command that travels moves nothing.
void Bitmap(Context& c, GLsizei width, GLsizei height, GLfloat xorig, GLfloat yorig, GLfloat xmove, GLfloat ymove,
            const GLubyte* bitmap) {
    if (width < 0 || height < 0) return c.error(GL_INVALID_VALUE);
    if (!may_draw_fragments(c)) return;
    if (!may_draw_at_raster(c)) return;
    auto position = c.state.raster.raster_position;
    const bool drawing = c.state.local.render_mode == GL_RENDER;
    if (!drawing)
        feed_back(c,
                  [](wire::PackBuffer& b) { glapi::pack::Bitmap(b, 1, 1, 0, 0, 0, 0, std::span(kOnePixel).first(1)); });
    const void* from = drawing && width > 0 && height > 0
                           ? image_source(c, {{width, height}, GL_COLOR_INDEX, GL_BITMAP}, bitmap)
                           : nullptr;
    if (from) {
        const auto bits = glapi::unpack_image(unpack_store(c.state), {width, height}, GL_COLOR_INDEX, GL_BITMAP, from);
        const float x = position[0] - xorig - kMargin, y = position[1] - yorig - kMargin;
        const PixelRect box{x, y, x + static_cast<float>(width) + 2 * kMargin,
                            y + static_cast<float>(height) + 2 * kMargin};
        draw_at_raster(c, box, [&](wire::PackBuffer& buffer) {
            glapi::pack::Bitmap(buffer, width, height, xorig, yorig, 0, 0, bits);
        });
    }
    position[0] += xmove;
    position[1] += ymove;
    c.set<el::raster_position>(0, position);
}

namespace {

/// Colours are read as light and written as light where both lie by the curve of sRGB (OpenGL 4.6, 17.3.7 and 18.3.2).
bool copies_light(Context& c, GLenum what) {
    if (what != GL_COLOR || !c.get<el::framebuffer_srgb>()) return false;
    const TextureFormat* colors = read_color_format(c);
    return colors && colors->srgb;
}

/// RGBA bytes as floats, the colours taken off the curve of sRGB (OpenGL 4.6, 8.24).
std::vector<std::byte> as_light(std::span<const std::byte> pixels) {
    const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    std::vector<float> light(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double value = std::to_integer<int>(pixels[i]) / 255.0;
        light[i] = static_cast<float>(i % 4 == 3 ? value : linear(value));
    }
    const auto bytes = std::as_bytes(std::span(light));
    return {bytes.begin(), bytes.end()};
}

}  // namespace

void CopyPixels(Context& c, GLint x, GLint y, GLsizei width, GLsizei height, GLenum what) {
    if (width < 0 || height < 0) return c.error(GL_INVALID_VALUE);
    if (what != GL_COLOR && what != GL_DEPTH && what != GL_STENCIL && what != GL_DEPTH_STENCIL)
        return c.error(GL_INVALID_ENUM);
    if (!may_draw_fragments(c) || !may_read_pixels(c)) return;
    if (!buffers_exist(c, what)) return c.error(GL_INVALID_OPERATION);
    if (!may_draw_at_raster(c) || c.state.local.render_mode == GL_SELECT) return;
    const PixelBox from = clip_to_window(c, {x, y, width, height});
    if (from.empty()) return;
    const GLenum format = what == GL_COLOR     ? GL_RGBA
                          : what == GL_DEPTH   ? GL_DEPTH_COMPONENT
                          : what == GL_STENCIL ? GL_STENCIL_INDEX
                                               : GL_DEPTH_STENCIL;
    const GLenum type = what == GL_DEPTH           ? GL_UNSIGNED_INT
                        : what == GL_DEPTH_STENCIL ? GL_UNSIGNED_INT_24_8
                                                   : GL_UNSIGNED_BYTE;
    auto pixels = gather_plain(c, from, format, type, "glCopyPixels");
    const bool light = copies_light(c, what);
    if (light) pixels = as_light(pixels);
    const auto position = c.state.raster.raster_position;
    const auto& zoom = c.state.window.pixel_zoom;
    auto moved = position;  // where the part that lies in the window goes
    moved[0] += static_cast<float>(from.x - x) * zoom.x;
    moved[1] += static_cast<float>(from.y - y) * zoom.y;
    c.set<el::raster_position>(0, moved);
    draw_tight(c, from.width, from.height, format, light ? GLenum{GL_FLOAT} : type, pixels);
    c.set<el::raster_position>(0, position);
}

void PixelMapfv(Context& c, GLenum map, GLsizei size, const GLfloat* values) { pixel_map(c, map, size, values, 1.0); }
void PixelMapuiv(Context& c, GLenum map, GLsizei size, const GLuint* values) {
    pixel_map(c, map, size, values, 1 / 4294967295.0);
}
void PixelMapusv(Context& c, GLenum map, GLsizei size, const GLushort* values) {
    pixel_map(c, map, size, values, 1 / 65535.0);
}
void GetPixelMapfv(Context& c, GLenum map, GLfloat* values) { get_pixel_map(c, map, values, 1.0); }
void GetPixelMapuiv(Context& c, GLenum map, GLuint* values) { get_pixel_map(c, map, values, 4294967295.0); }
void GetPixelMapusv(Context& c, GLenum map, GLushort* values) { get_pixel_map(c, map, values, 65535.0); }

void GetnPixelMapfv(Context& c, GLenum map, GLsizei room, GLfloat* values) { get_pixel_map(c, map, values, 1.0, room); }
void GetnPixelMapuiv(Context& c, GLenum map, GLsizei room, GLuint* values) {
    get_pixel_map(c, map, values, 4294967295.0, room);
}
void GetnPixelMapusv(Context& c, GLenum map, GLsizei room, GLushort* values) {
    get_pixel_map(c, map, values, 65535.0, room);
}

// A word a row, the bottom one first; its first byte in memory has the leftmost pixels, the first in the highest bit.
void PolygonStipple(Context& c, const GLubyte* mask) {
    const void* from = image_source(c, {{32, 32}, GL_COLOR_INDEX, GL_BITMAP}, mask);
    if (!from) return;
    const auto rows = glapi::unpack_image(unpack_store(c.state), {32, 32}, GL_COLOR_INDEX, GL_BITMAP, from);
    glstate::Words32 words;
    std::memcpy(words.data(), rows.data(), sizeof words);
    c.set<el::polygon_stipple>(0, words);
}

void GetPolygonStipple(Context& c, GLubyte* mask) {
    const PackTarget to = image_target(c, {{32, 32}, GL_COLOR_INDEX, GL_BITMAP}, mask);
    if (!to) return;
    const glstate::Words32& words = c.state.window.polygon_stipple;
    glapi::pack_image(pack_store(c.state), {32, 32}, GL_COLOR_INDEX, GL_BITMAP, std::as_bytes(std::span(words)),
                      to.get());
}

void GetnPolygonStipple(Context& c, GLsizei room, GLubyte* mask) {
    const std::size_t needed = glapi::memory_bytes(pack_store(c.state), {32, 32}, GL_COLOR_INDEX, GL_BITMAP);
    if (!has_room(c, room, needed)) return c.error(GL_INVALID_OPERATION);
    GetPolygonStipple(c, mask);
}

void DrawBuffer(Context& c, GLenum buffer) {
    if (const auto framebuffer = c.framebuffers->draw) {
        if (const GLenum error = attachment_buffer_error(buffer)) return c.error(error);
        return change_framebuffer(c, *framebuffer, [&](Framebuffer& f) { f.set_draw_buffers({buffer}); });
    }
    if (const GLenum error = buffer_error(buffer, c.draw_target())) return c.error(error);
    c.set<el::draw_buffer>(0, buffer);
}

void ReadBuffer(Context& c, GLenum buffer) {
    if (const auto framebuffer = c.framebuffers->read) {
        if (const GLenum error = attachment_buffer_error(buffer)) return c.error(error);
        return change_framebuffer(c, *framebuffer, [&](Framebuffer& f) { f.set_read_buffer(buffer); });
    }
    if (const GLenum error = buffer_error(buffer, c.read_target())) return c.error(error);
    c.set<el::read_buffer>(0, buffer);
}

}  // namespace wall::client::api
