// SPDX-License-Identifier: MIT
// Commands with client memory in display lists: what the memory holds when the list is compiled goes into the list,
// with tight rows, and is given to the immediate function as such when the list is called (OpenGL 1.2.1, 5.4).
#include <tuple>

#include "client_lib/context/context.h"
#include "client_lib/context/lists.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/texture.h"

namespace wall::client {
namespace {

/// While it lives glPixelStore has the values of a tight image.
class TightUnpack {
public:
    explicit TightUnpack(Context& c) : local_(c.state.local), saved_(c.state.local) {
        local_.unpack_swap_bytes = local_.unpack_lsb_first = 0;
        local_.unpack_row_length = local_.unpack_image_height = 0;
        local_.unpack_skip_pixels = local_.unpack_skip_rows = local_.unpack_skip_images = 0;
        local_.unpack_alignment = 1;
        local_.pixel_unpack_buffer = 0;
    }
    ~TightUnpack() {
        local_.unpack_swap_bytes = saved_.unpack_swap_bytes;
        local_.unpack_lsb_first = saved_.unpack_lsb_first;
        local_.unpack_row_length = saved_.unpack_row_length;
        local_.unpack_image_height = saved_.unpack_image_height;
        local_.unpack_skip_pixels = saved_.unpack_skip_pixels;
        local_.unpack_skip_rows = saved_.unpack_skip_rows;
        local_.unpack_skip_images = saved_.unpack_skip_images;
        local_.unpack_alignment = saved_.unpack_alignment;
        local_.pixel_unpack_buffer = saved_.pixel_unpack_buffer;
    }
    TightUnpack(const TightUnpack&) = delete;

private:
    glstate::LocalState& local_;
    const glstate::LocalState saved_;
};

struct Image {
    glapi::ImageSize size;
    GLenum format, type;
    const void* pixels;
};

/// Empty where the call will fail or has no pixels.
std::vector<std::byte> tight(Context& c, const Image& image) {
    if (!glapi::image_bytes(image.format, image.type, image.size.width, image.size.height, image.size.depth)) return {};
    return glapi::unpack_image(unpack_store(c.state), image.size, image.format, image.type,
                               image_source(c, {image.size, image.format, image.type}, image.pixels));
}

/// Records the arguments, whether there were pixels, and the pixels.
template <class... Args>
void record(Context& c, CommandId command, const Image& image, const Args&... args) {
    const auto bytes = tight(c, image);
    const std::uint32_t present = !bytes.empty();
    c.list().record(static_cast<std::uint16_t>(command), args..., present,
                    glapi::recorded_array(bytes.data(), static_cast<std::ptrdiff_t>(bytes.size())));
}

/// A recorded argument: a number, map points, or whether there were pixels and the pixels.
template <class T>
T read(glapi::RecordReader& in) {
    if constexpr (!std::is_pointer_v<T>) {
        return in.get<T>();
    } else if constexpr (std::is_same_v<T, const GLfloat*>) {
        return in.array<GLfloat>();
    } else {
        const bool present = in.get<std::uint32_t>() != 0;
        const auto* bytes = in.array<GLubyte>();
        return present ? bytes : nullptr;
    }
}

template <class... Args>
void call(Context& c, std::span<const std::byte> payload, void (*GlTable::*function)(Context&, Args...)) {
    glapi::RecordReader in(payload);
    const std::tuple<Args...> args{read<Args>(in)...};  // braces: in order
    const TightUnpack unpack(c);
    std::apply([&](const Args&... values) { (execution_table(c).*function)(c, values...); }, args);
}

}  // namespace

namespace compile {

void TexImage1D(Context& c, GLenum target, GLint level, GLint internal, GLsizei width, GLint border, GLenum format,
                GLenum type, const void* pixels) {
    if (is_proxy(target)) return api::TexImage1D(c, target, level, internal, width, border, format, type, pixels);
    record(c, CommandId::TexImage1D, {{width, 1, 1, 1}, format, type, pixels}, target, level, internal, width, border,
           format, type);
    if (c.list().execute)
        execution_table(c).TexImage1D(c, target, level, internal, width, border, format, type, pixels);
}

void TexImage2D(Context& c, GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLint border,
                GLenum format, GLenum type, const void* pixels) {
    if (is_proxy(target))
        return api::TexImage2D(c, target, level, internal, width, height, border, format, type, pixels);
    record(c, CommandId::TexImage2D, {{width, height, 1, 2}, format, type, pixels}, target, level, internal, width,
           height, border, format, type);
    if (c.list().execute)
        execution_table(c).TexImage2D(c, target, level, internal, width, height, border, format, type, pixels);
}

void TexImage3D(Context& c, GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLsizei depth,
                GLint border, GLenum format, GLenum type, const void* pixels) {
    if (is_proxy(target))
        return api::TexImage3D(c, target, level, internal, width, height, depth, border, format, type, pixels);
    record(c, CommandId::TexImage3D, {{width, height, depth, 3}, format, type, pixels}, target, level, internal, width,
           height, depth, border, format, type);
    if (c.list().execute)
        execution_table(c).TexImage3D(c, target, level, internal, width, height, depth, border, format, type, pixels);
}

void TexSubImage1D(Context& c, GLenum target, GLint level, GLint x, GLsizei width, GLenum format, GLenum type,
                   const void* pixels) {
    record(c, CommandId::TexSubImage1D, {{width, 1, 1, 1}, format, type, pixels}, target, level, x, width, format,
           type);
    if (c.list().execute) execution_table(c).TexSubImage1D(c, target, level, x, width, format, type, pixels);
}

void TexSubImage2D(Context& c, GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                   GLenum format, GLenum type, const void* pixels) {
    record(c, CommandId::TexSubImage2D, {{width, height, 1, 2}, format, type, pixels}, target, level, x, y, width,
           height, format, type);
    if (c.list().execute) execution_table(c).TexSubImage2D(c, target, level, x, y, width, height, format, type, pixels);
}

void TexSubImage3D(Context& c, GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                   GLsizei depth, GLenum format, GLenum type, const void* pixels) {
    record(c, CommandId::TexSubImage3D, {{width, height, depth, 3}, format, type, pixels}, target, level, x, y, z,
           width, height, depth, format, type);
    if (c.list().execute)
        execution_table(c).TexSubImage3D(c, target, level, x, y, z, width, height, depth, format, type, pixels);
}

void DrawPixels(Context& c, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels) {
    record(c, CommandId::DrawPixels, {{width, height, 1, 2}, format, type, pixels}, width, height, format, type);
    if (c.list().execute) execution_table(c).DrawPixels(c, width, height, format, type, pixels);
}

void Bitmap(Context& c, GLsizei width, GLsizei height, GLfloat xorig, GLfloat yorig, GLfloat xmove, GLfloat ymove,
            const GLubyte* bitmap) {
    record(c, CommandId::Bitmap, {{width, height, 1, 2}, GL_COLOR_INDEX, GL_BITMAP, bitmap}, width, height, xorig,
           yorig, xmove, ymove);
    if (c.list().execute) execution_table(c).Bitmap(c, width, height, xorig, yorig, xmove, ymove, bitmap);
}

void PolygonStipple(Context& c, const GLubyte* mask) {
    record(c, CommandId::PolygonStipple, {{32, 32, 1, 2}, GL_COLOR_INDEX, GL_BITMAP, mask});
    if (c.list().execute) execution_table(c).PolygonStipple(c, mask);
}

namespace {

/// How many values a call of glMap reads; 0 if it will fail.
std::ptrdiff_t map_values(unsigned map, GLint ustride, GLint uorder, GLint vstride, GLint vorder) {
    if (map >= kEvaluatorMaps || uorder < 1 || vorder < 1 || uorder > kMaxEvaluatorOrder || vorder > kMaxEvaluatorOrder)
        return 0;
    if (ustride < 0 || vstride < 0) return 0;
    return static_cast<std::ptrdiff_t>(uorder - 1) * ustride + static_cast<std::ptrdiff_t>(vorder - 1) * vstride +
           evaluator_components(map);
}

}  // namespace

void Map1f(Context& c, GLenum target, GLfloat u1, GLfloat u2, GLint stride, GLint order, const GLfloat* points) {
    c.list().record(static_cast<std::uint16_t>(CommandId::Map1f), target, u1, u2, stride, order,
                    glapi::recorded_array(points, map_values(target - GL_MAP1_COLOR_4, stride, order, 0, 1)));
    if (c.list().execute) execution_table(c).Map1f(c, target, u1, u2, stride, order, points);
}

// As floats: that is what the points become anyway.
void Map1d(Context& c, GLenum target, GLdouble u1, GLdouble u2, GLint stride, GLint order, const GLdouble* points) {
    const auto count = points ? map_values(target - GL_MAP1_COLOR_4, stride, order, 0, 1) : 0;
    const std::vector<float> values(points, points + count);
    c.list().record(static_cast<std::uint16_t>(CommandId::Map1d), target, static_cast<float>(u1),
                    static_cast<float>(u2), stride, order, glapi::recorded_array(values.data(), count));
    if (c.list().execute) execution_table(c).Map1d(c, target, u1, u2, stride, order, points);
}

void Map2f(Context& c, GLenum target, GLfloat u1, GLfloat u2, GLint ustride, GLint uorder, GLfloat v1, GLfloat v2,
           GLint vstride, GLint vorder, const GLfloat* points) {
    c.list().record(
        static_cast<std::uint16_t>(CommandId::Map2f), target, u1, u2, ustride, uorder, v1, v2, vstride, vorder,
        glapi::recorded_array(points, map_values(target - GL_MAP2_COLOR_4, ustride, uorder, vstride, vorder)));
    if (c.list().execute) execution_table(c).Map2f(c, target, u1, u2, ustride, uorder, v1, v2, vstride, vorder, points);
}

void Map2d(Context& c, GLenum target, GLdouble u1, GLdouble u2, GLint ustride, GLint uorder, GLdouble v1, GLdouble v2,
           GLint vstride, GLint vorder, const GLdouble* points) {
    const auto count = points ? map_values(target - GL_MAP2_COLOR_4, ustride, uorder, vstride, vorder) : 0;
    const std::vector<float> values(points, points + count);
    c.list().record(static_cast<std::uint16_t>(CommandId::Map2d), target, static_cast<float>(u1),
                    static_cast<float>(u2), ustride, uorder, static_cast<float>(v1), static_cast<float>(v2), vstride,
                    vorder, glapi::recorded_array(values.data(), count));
    if (c.list().execute) execution_table(c).Map2d(c, target, u1, u2, ustride, uorder, v1, v2, vstride, vorder, points);
}

}  // namespace compile

namespace replay {

void TexImage1D(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::TexImage1D); }
void TexImage2D(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::TexImage2D); }
void TexImage3D(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::TexImage3D); }
void TexSubImage1D(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::TexSubImage1D); }
void TexSubImage2D(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::TexSubImage2D); }
void TexSubImage3D(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::TexSubImage3D); }
void DrawPixels(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::DrawPixels); }

void Bitmap(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::Bitmap); }
void PolygonStipple(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::PolygonStipple); }
void Map1f(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::Map1f); }
void Map1d(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::Map1f); }
void Map2f(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::Map2f); }
void Map2d(Context& c, std::span<const std::byte> payload) { call(c, payload, &GlTable::Map2f); }

}  // namespace replay
}  // namespace wall::client
