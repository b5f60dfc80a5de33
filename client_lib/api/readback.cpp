// SPDX-License-Identifier: MIT
// glReadPixels: one of the few commands that must wait (OpenGL 1.2.1, 4.3.2).
#include <algorithm>

#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/readback.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/pixel_convert.h"

namespace wall::client::api {
namespace {

bool source_exists(Context& c, GLenum format) {
    if (!c.read_target()) return false;
    switch (format) {
        case GL_DEPTH_COMPONENT: return has_depth(c, true);
        case GL_STENCIL_INDEX: return has_stencil(c, true);
        case GL_DEPTH_STENCIL: return has_depth(c, true) && has_stencil(c, true);
        case GL_COLOR_INDEX: return false;
        default: {
            const TextureFormat* colors = read_color_format(c);
            return colors && colors->whole() == glapi::is_integer_format(format);
        }
    }
}

/// Of the depth that is read from. Null: there is none.
const TextureFormat* read_depth_format(Context& c) {
    static constexpr TextureFormat kWindow{.base = GL_DEPTH_STENCIL, .component_type = GL_UNSIGNED_NORMALIZED};
    if (!c.framebuffers->read) return &kWindow;
    std::lock_guard lock(c.share().mutex);
    const auto shape = c.framebuffers->read->depth_shape();
    return shape ? shape->format : nullptr;
}

/// What of a framebuffer OpenGL ES gives out.
bool may_read_kind(Context& c, GLenum format, GLenum type) {
    const bool depth = format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL;
    if (format == GL_STENCIL_INDEX) return type == GL_UNSIGNED_BYTE;
    const TextureFormat* from = depth ? read_depth_format(c) : read_color_format(c);
    return from && es_can_read(format, type, *from);
}

/// Rows of whole bytes, the first pixel in the highest bit, of one byte a pixel.
std::vector<std::byte> to_bits(const std::vector<std::byte>& pixels, const PixelBox& box) {
    const std::size_t row = (static_cast<std::size_t>(box.width) + 7) / 8;
    std::vector<std::byte> bits(row * static_cast<std::size_t>(box.height));
    for (std::int32_t y = 0; y < box.height; ++y)
        for (std::int32_t x = 0; x < box.width; ++x) {
            const auto value =
                pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(box.width) + static_cast<std::size_t>(x)];
            if ((value & std::byte{1}) != std::byte{0})
                bits[static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x) / 8] |=
                    static_cast<std::byte>(0x80 >> (x % 8));
        }
    return bits;
}

bool has_ten_bits(GLenum format, GLenum type) {
    return !glapi::is_integer_format(format) &&
           (type == GL_UNSIGNED_INT_10_10_10_2 || type == GL_UNSIGNED_INT_2_10_10_10_REV);
}

/// What the nodes are asked for. Mesa makes ten bits of eight out of a framebuffer object otherwise than out of a
/// window.
GLenum gathered_type(GLenum format, GLenum type) {
    return type == GL_BITMAP ? GL_UNSIGNED_BYTE : has_ten_bits(format, type) ? GL_FLOAT : type;
}

}  // namespace

// What lies outside the window is not written (Mesa's way; OpenGL leaves it undefined).
void ReadPixels(Context& c, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* pixels) {
    if (width < 0 || height < 0) return c.error(GL_INVALID_VALUE);
    if (c.profile.is_es()) type = desktop_type(type);
    if (c.profile.is_es() && format == GL_DEPTH_COMPONENT && type == GL_UNSIGNED_INT_24_8)
        type = GL_UNSIGNED_INT;  // GL_NV_read_depth: the same 24 bits, and nothing said of the others
    if (const GLenum error = glapi::format_type_error(format, type)) return c.error(error);
    if (!may_read_pixels(c)) return;
    if (c.profile.is_es() && !may_read_kind(c, format, type)) return c.error(GL_INVALID_OPERATION);
    if (!source_exists(c, format)) return c.error(GL_INVALID_OPERATION);
    const PixelBox box = clip_to_window(c, {x, y, width, height});
    if (box.empty()) return;
    const PackTarget to = image_target(c, {{width, height}, format, type}, pixels);
    if (!to) return;
    glapi::PixelStore store = pack_store(c.state);
    if (store.row_length == 0) store.row_length = width;
    store.skip_pixels += box.x - x;
    store.skip_rows += box.y - y;
    auto tight = gather_pixels(c, box, format, gathered_type(format, type), "glReadPixels");
    if (type == GL_BITMAP) tight = to_bits(tight, box);
    if (has_ten_bits(format, type))
        tight = from_rgba(format, type,
                          to_rgba(format, GL_FLOAT, tight,
                                  static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height)));
    glapi::pack_image(store, {box.width, box.height}, format, type, tight, to.get());
}

void ReadnPixels(Context& c, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, GLsizei room,
                 void* pixels) {
    const bool plausible = width >= 0 && height >= 0 && glapi::format_type_error(format, type) == GL_NO_ERROR;
    if (plausible && c.state.local.pixel_pack_buffer == 0) {
        const std::size_t needed = glapi::memory_bytes(pack_store(c.state), {width, height}, format, type);
        if (room < 0 || needed > static_cast<std::size_t>(room)) return c.error(GL_INVALID_OPERATION);
    }
    ReadPixels(c, x, y, width, height, format, type, pixels);
}

// What happens to a node's GPU is the node's: the program's context goes on.
GLenum GetGraphicsResetStatus(Context&) { return GL_NO_ERROR; }

}  // namespace wall::client::api
