// SPDX-License-Identifier: MIT
#include "tests/golden/moved/reads.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "tests/golden/moved/place.h"
#include "tests/golden/moved/resolved.h"
#include "tests/golden/moved/share.h"

namespace golden::moved {
namespace {

struct Type {
    GLenum name = 0;
    std::size_t bytes = 0;  ///< of a component; of a pixel if `packed`
    bool packed = false;
};
constexpr std::array kTypes = {
    Type{GL_UNSIGNED_BYTE, 1},
    Type{GL_BYTE, 1},
    Type{GL_UNSIGNED_SHORT, 2},
    Type{GL_SHORT, 2},
    Type{GL_HALF_FLOAT, 2},
    Type{GL_UNSIGNED_INT, 4},
    Type{GL_INT, 4},
    Type{GL_FLOAT, 4},
    Type{GL_UNSIGNED_BYTE_3_3_2, 1, true},
    Type{GL_UNSIGNED_BYTE_2_3_3_REV, 1, true},
    Type{GL_UNSIGNED_SHORT_5_6_5, 2, true},
    Type{GL_UNSIGNED_SHORT_5_6_5_REV, 2, true},
    Type{GL_UNSIGNED_SHORT_4_4_4_4, 2, true},
    Type{GL_UNSIGNED_SHORT_4_4_4_4_REV, 2, true},
    Type{GL_UNSIGNED_SHORT_5_5_5_1, 2, true},
    Type{GL_UNSIGNED_SHORT_1_5_5_5_REV, 2, true},
    Type{GL_UNSIGNED_INT_8_8_8_8, 4, true},
    Type{GL_UNSIGNED_INT_8_8_8_8_REV, 4, true},
    Type{GL_UNSIGNED_INT_10_10_10_2, 4, true},
    Type{GL_UNSIGNED_INT_2_10_10_10_REV, 4, true},
    Type{GL_UNSIGNED_INT_24_8, 4, true},
};

std::size_t components(GLenum format) {
    switch (format) {
        case GL_RGBA:
        case GL_BGRA: return 4;
        case GL_RGB:
        case GL_BGR: return 3;
        case GL_LUMINANCE_ALPHA: return 2;
        case GL_DEPTH_STENCIL:
        case GL_DEPTH_COMPONENT:
        case GL_STENCIL_INDEX:
        case GL_RED:
        case GL_GREEN:
        case GL_BLUE:
        case GL_ALPHA:
        case GL_LUMINANCE: return 1;
        default: return 0;
    }
}

/// 0: Mesa refuses it.
std::size_t pixel_bytes(GLenum format, GLenum type) {
    for (const Type& each : kTypes)
        if (each.name == type)
            return each.packed && components(format) != 0 ? each.bytes : each.bytes * components(format);
    return 0;
}

/// Images travel as they are while it lives.
class PlainPixels {
public:
    PlainPixels() {
        mesa().PushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
        for (const auto name : {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS,
                                GL_PACK_SKIP_ROWS, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH,
                                GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS})
            mesa().PixelStorei(static_cast<GLenum>(name), 0);
        mesa().PixelStorei(GL_PACK_ALIGNMENT, 1);
        mesa().PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    }
    ~PlainPixels() { mesa().PopClientAttrib(); }
    PlainPixels(const PlainPixels&) = delete;
    PlainPixels& operator=(const PlainPixels&) = delete;
};

/// Pixel transfer changes nothing while it lives.
class PlainTransfer {
public:
    PlainTransfer() {
        for (auto& [name, neutral, value] : values_) {
            mesa().GetFloatv(name, &value);
            mesa().PixelTransferf(name, neutral);
        }
    }
    ~PlainTransfer() {
        for (const auto& [name, neutral, value] : values_) mesa().PixelTransferf(name, value);
    }
    PlainTransfer(const PlainTransfer&) = delete;
    PlainTransfer& operator=(const PlainTransfer&) = delete;

private:
    struct Value {
        GLenum name;
        float neutral, value = 0;
    };
    std::array<Value, 14> values_ = {{{GL_RED_SCALE, 1},
                                      {GL_GREEN_SCALE, 1},
                                      {GL_BLUE_SCALE, 1},
                                      {GL_ALPHA_SCALE, 1},
                                      {GL_DEPTH_SCALE, 1},
                                      {GL_RED_BIAS, 0},
                                      {GL_GREEN_BIAS, 0},
                                      {GL_BLUE_BIAS, 0},
                                      {GL_ALPHA_BIAS, 0},
                                      {GL_DEPTH_BIAS, 0},
                                      {GL_MAP_COLOR, 0},
                                      {GL_MAP_STENCIL, 0},
                                      {GL_INDEX_SHIFT, 0},
                                      {GL_INDEX_OFFSET, 0}}};
};

/// A call that must be executed, not compiled: what it does depends on pixels.
void must_execute(const char* function) {
    if (integer(GL_LIST_INDEX) != 0) stop(function);
}

std::vector<std::byte> gather(const Box& area, GLenum format, GLenum type) {
    const PlainTransfer transfer;
    std::vector<std::byte> pixels(pixel_bytes(format, type) * static_cast<std::size_t>(area.width) *
                                  static_cast<std::size_t>(area.height));
    ReadPixels(area.x, area.y, area.width, area.height, format, type, pixels.data());
    return pixels;
}

/// Calls `load(pixels)` with an area of the window as RGBA bytes.
template <class Load>
void copy_to_texture(const char* function, const Box& area, Load&& load) {
    must_execute(function);
    const PlainPixels plain;
    load(static_cast<const void*>(gather(area, GL_RGBA, GL_UNSIGNED_BYTE).data()));
}

/// A part of an image of `stride` bytes a row that begins at `to`, whose pixels have `bytes`.
void read_rows(const Box& part, GLenum format, GLenum type, std::byte* to, std::size_t stride, std::size_t bytes) {
    const std::size_t row = static_cast<std::size_t>(part.width) * bytes;
    std::vector<std::byte> line(row + 8);  // the alignment
    for (int y = 0; y < part.height; ++y, to += stride) {
        mesa().ReadPixels(part.x + place().dx(), part.y + y + place().dy(), part.width, 1, format, type, line.data());
        std::memcpy(to, line.data(), row);
    }
}

}  // namespace

/// Mesa packs this tile's part to where it belongs in the program's memory; the other tiles' parts are copied there.
void ReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* data) {
    const std::size_t bytes = pixel_bytes(format, type);
    if (bytes == 0 || width <= 0 || height <= 0 || !reads_from_window())
        return mesa().ReadPixels(x, y, width, height, format, type, data);
    if (is_es1()) {  // has rows as long as the image, and nothing is skipped
        const auto unit = static_cast<std::size_t>(integer(GL_PACK_ALIGNMENT));
        const std::size_t stride = (bytes * static_cast<std::size_t>(width) + unit - 1) / unit * unit;
        const Box all{x, y, width, height}, own = intersect(all, place().part());
        auto* first = static_cast<std::byte*>(data);
        if (!own.empty())
            read_rows(
                own, format, type,
                first + stride * static_cast<std::size_t>(own.y - y) + bytes * static_cast<std::size_t>(own.x - x),
                stride, bytes);
        return exchange({first, stride, bytes}, all);
    }
    if (integer(GL_PIXEL_PACK_BUFFER_BINDING) != 0) stop("glReadPixels into a buffer object");
    const int row_length = integer(GL_PACK_ROW_LENGTH), skip_pixels = integer(GL_PACK_SKIP_PIXELS),
              skip_rows = integer(GL_PACK_SKIP_ROWS), alignment = integer(GL_PACK_ALIGNMENT);
    const Box asked{x, y, width, height}, part = intersect(asked, place().part());
    if (!part.empty()) {
        mesa().PixelStorei(GL_PACK_ROW_LENGTH, row_length != 0 ? row_length : width);
        mesa().PixelStorei(GL_PACK_SKIP_PIXELS, skip_pixels + part.x - x);
        mesa().PixelStorei(GL_PACK_SKIP_ROWS, skip_rows + part.y - y);
        const int left = part.x + place().dx(), bottom = part.y + place().dy();
        const Resolved resolved(left + part.width, bottom + part.height, format);
        mesa().ReadPixels(left, bottom, part.width, part.height, format, type, data);
        mesa().PixelStorei(GL_PACK_ROW_LENGTH, row_length);
        mesa().PixelStorei(GL_PACK_SKIP_PIXELS, skip_pixels);
        mesa().PixelStorei(GL_PACK_SKIP_ROWS, skip_rows);
    }
    const auto unit = static_cast<std::size_t>(alignment);
    const std::size_t row = bytes * static_cast<std::size_t>(row_length != 0 ? row_length : width);
    const std::size_t stride = (row + unit - 1) / unit * unit;
    exchange({static_cast<std::byte*>(data) + stride * static_cast<std::size_t>(skip_rows) +
                  bytes * static_cast<std::size_t>(skip_pixels),
              stride, bytes},
             asked);
}

namespace {

/// The colours of RGBA bytes as light, where Mesa would take them so.
std::vector<std::byte> as_light(const std::vector<std::byte>& pixels) {
    std::vector<float> light;
    for (const std::byte byte : pixels) {
        const float value = static_cast<float>(byte) / 255;
        const bool alpha = light.size() % 4 == 3;
        light.push_back(alpha ? value : value < 0.0405f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f));
    }
    const auto* bytes = reinterpret_cast<const std::byte*>(light.data());
    return {bytes, bytes + light.size() * sizeof(float)};
}

}  // namespace

/// What lies beyond the window is not copied, so that the rest begins later.
void CopyPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum what) {
    must_execute("glCopyPixels in a list");
    if (!reads_from_window()) stop("glCopyPixels out of a framebuffer object");
    const Box from = intersect({x, y, width, height}, place().window);
    GLboolean valid = static_cast<GLboolean>(integer(GL_CURRENT_RASTER_POSITION_VALID));
    if (from.empty() || !valid) return;
    const PlainPixels plain;
    const GLenum format = what == GL_COLOR ? GL_RGBA : what == GL_DEPTH ? GL_DEPTH_COMPONENT : GL_STENCIL_INDEX;
    const GLenum type = what == GL_DEPTH ? GL_UNSIGNED_INT : GL_UNSIGNED_BYTE;
    auto pixels = gather(from, format, type);
    const bool light = what == GL_COLOR && mesa().IsEnabled(GL_FRAMEBUFFER_SRGB);  // every window has it
    if (light) pixels = as_light(pixels);
    float zoom_x = 1, zoom_y = 1;
    mesa().GetFloatv(GL_ZOOM_X, &zoom_x);
    mesa().GetFloatv(GL_ZOOM_Y, &zoom_y);
    const float right = static_cast<float>(from.x - x) * zoom_x, up = static_cast<float>(from.y - y) * zoom_y;
    mesa().Bitmap(0, 0, 0, 0, right, up, nullptr);
    mesa().DrawPixels(from.width, from.height, format, light ? GLenum{GL_FLOAT} : type, pixels.data());
    mesa().Bitmap(0, 0, 0, 0, -right, -up, nullptr);
}

void CopyTexImage1D(GLenum target, GLint level, GLenum internal, GLint x, GLint y, GLsizei width, GLint border) {
    if (!reads_from_window()) return mesa().CopyTexImage1D(target, level, internal, x, y, width, border);
    copy_to_texture("glCopyTexImage1D in a list", {x, y, width, 1}, [&](const void* pixels) {
        mesa().TexImage1D(target, level, static_cast<GLint>(internal), width, border, GL_RGBA, GL_UNSIGNED_BYTE,
                          pixels);
    });
}
void CopyTexImage2D(GLenum target, GLint level, GLenum internal, GLint x, GLint y, GLsizei width, GLsizei height,
                    GLint border) {
    if (!reads_from_window()) return mesa().CopyTexImage2D(target, level, internal, x, y, width, height, border);
    copy_to_texture("glCopyTexImage2D in a list", {x, y, width, height}, [&](const void* pixels) {
        mesa().TexImage2D(target, level, static_cast<GLint>(internal), width, height, border, GL_RGBA, GL_UNSIGNED_BYTE,
                          pixels);
    });
}
void CopyTexSubImage1D(GLenum target, GLint level, GLint to, GLint x, GLint y, GLsizei width) {
    if (!reads_from_window()) return mesa().CopyTexSubImage1D(target, level, to, x, y, width);
    copy_to_texture("glCopyTexSubImage1D in a list", {x, y, width, 1}, [&](const void* pixels) {
        mesa().TexSubImage1D(target, level, to, width, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    });
}
void CopyTexSubImage2D(GLenum target, GLint level, GLint to_x, GLint to_y, GLint x, GLint y, GLsizei width,
                       GLsizei height) {
    if (!reads_from_window()) return mesa().CopyTexSubImage2D(target, level, to_x, to_y, x, y, width, height);
    copy_to_texture("glCopyTexSubImage2D in a list", {x, y, width, height}, [&](const void* pixels) {
        mesa().TexSubImage2D(target, level, to_x, to_y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    });
}

}  // namespace golden::moved
