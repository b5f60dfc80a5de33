// SPDX-License-Identifier: MIT
// One texel everywhere: in a buffer (GL_ARB_clear_buffer_object; OpenGL 4.3, 6.2.1) and in a texture
// (GL_ARB_clear_texture; OpenGL 4.4, 8.21). Both are changes of content that is kept here.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/captured_content.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/named_objects.h"
#include "client_lib/context/own_framebuffer.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/pixel_convert.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture_formats.h"
#include "common/glapi/image.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

// ---- buffers ----

/// How the texels of a buffer lie (OpenGL 4.3, table 8.15).
struct BufferFormat {
    GLenum internal, format, type;
};
constexpr BufferFormat kBufferFormats[] = {
    {GL_R8, GL_RED, GL_UNSIGNED_BYTE},
    {GL_R16, GL_RED, GL_UNSIGNED_SHORT},
    {GL_R16F, GL_RED, GL_HALF_FLOAT},
    {GL_R32F, GL_RED, GL_FLOAT},
    {GL_R8I, GL_RED_INTEGER, GL_BYTE},
    {GL_R16I, GL_RED_INTEGER, GL_SHORT},
    {GL_R32I, GL_RED_INTEGER, GL_INT},
    {GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE},
    {GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT},
    {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT},
    {GL_RG8, GL_RG, GL_UNSIGNED_BYTE},
    {GL_RG16, GL_RG, GL_UNSIGNED_SHORT},
    {GL_RG16F, GL_RG, GL_HALF_FLOAT},
    {GL_RG32F, GL_RG, GL_FLOAT},
    {GL_RG8I, GL_RG_INTEGER, GL_BYTE},
    {GL_RG16I, GL_RG_INTEGER, GL_SHORT},
    {GL_RG32I, GL_RG_INTEGER, GL_INT},
    {GL_RG8UI, GL_RG_INTEGER, GL_UNSIGNED_BYTE},
    {GL_RG16UI, GL_RG_INTEGER, GL_UNSIGNED_SHORT},
    {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT},
    {GL_RGB32F, GL_RGB, GL_FLOAT},
    {GL_RGB32I, GL_RGB_INTEGER, GL_INT},
    {GL_RGB32UI, GL_RGB_INTEGER, GL_UNSIGNED_INT},
    {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
    {GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT},
    {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT},
    {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    {GL_RGBA8I, GL_RGBA_INTEGER, GL_BYTE},
    {GL_RGBA16I, GL_RGBA_INTEGER, GL_SHORT},
    {GL_RGBA32I, GL_RGBA_INTEGER, GL_INT},
    {GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE},
    {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT},
    {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
};

bool are_colors(GLenum format) {
    return format != GL_DEPTH_COMPONENT && format != GL_STENCIL_INDEX && format != GL_DEPTH_STENCIL &&
           format != GL_COLOR_INDEX;
}

constexpr glapi::ImageSize kOneTexel{1, 1, 1, 2};

/// One texel in the program's memory, as it lies in a buffer of that format; null: zeros.
std::vector<std::byte> texel_of(const BufferFormat& to, GLenum format, GLenum type, const void* data) {
    const auto bytes = glapi::image_bytes(to.format, to.type, 1, 1, 1).value_or(0);
    if (!data) return std::vector<std::byte>(bytes);
    const auto tight = glapi::unpack_image({.alignment = 1}, kOneTexel, format, type, data);
    if (format == to.format && type == to.type) return tight;
    return glapi::is_integer_format(format) ? from_whole(to.format, to.type, to_whole(format, type, tight, 1))
                                            : from_rgba(to.format, to.type, to_rgba(format, type, tight, 1));
}

/// `size`: nothing: to the buffer's end.
void clear_buffer(Context& c, GLenum target, GLenum internal, GLintptr offset, std::optional<GLsizeiptr> size,
                  GLenum format, GLenum type, const void* data) {
    const auto id = bound_buffer_id(c, target);
    if (!id) return c.error(GL_INVALID_ENUM);
    Buffer* buffer = buffer_of(c, *id);
    if (!buffer) return c.error(GL_INVALID_VALUE);  // as the extension says, and Mesa
    const auto* to = std::ranges::find(kBufferFormats, internal, &BufferFormat::internal);
    if (to == std::end(kBufferFormats)) return c.error(GL_INVALID_ENUM);
    if (glapi::is_integer_format(format) != glapi::is_integer_format(to->format)) return c.error(GL_INVALID_OPERATION);
    if (!are_colors(format) || glapi::format_type_error(format, type) != GL_NO_ERROR)
        return c.error(GL_INVALID_VALUE);  // as Mesa
    const auto texel = texel_of(*to, format, type, data);
    const auto step = static_cast<GLsizeiptr>(texel.size());
    fetch_captured(c, *id, "glClearBufferData");
    before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    const auto have = static_cast<GLsizeiptr>(buffer->size());
    if (offset < 0 || offset > have || size.value_or(0) < 0 || size.value_or(0) > have - offset)
        return c.error(GL_INVALID_VALUE);
    const GLsizeiptr bytes = size.value_or(have);
    if (offset % step != 0 || bytes % step != 0) return c.error(GL_INVALID_VALUE);
    const auto first = static_cast<std::size_t>(offset), all = static_cast<std::size_t>(bytes);
    if (buffer->blocked({first, first + all})) return c.error(GL_INVALID_OPERATION);
    if (all == 0) return;
    std::vector<std::byte> content(all);
    for (std::size_t at = 0; at < all; at += texel.size()) std::memcpy(&content[at], texel.data(), texel.size());
    buffer->write({first, first + all}, content.data());
}

// ---- textures ----

/// What is cleared of a level: of a cube map, the faces are slices. Nothing: all of it.
struct Part {
    GLint x, y, z;
    GLsizei width, height, depth;
};

/// Of one texel of depth and stencil.
GLint stencil_of(GLenum type, std::span<const std::byte> texel) {
    std::uint32_t word = 0;
    const std::size_t at = type == GL_FLOAT_32_UNSIGNED_INT_24_8_REV ? sizeof word : 0;
    if (texel.size() >= at + sizeof word) std::memcpy(&word, &texel[at], sizeof word);
    return static_cast<GLint>(word & 0xff);
}

/// Pixels come from memory, whatever is bound for others.
class FromMemory {
public:
    explicit FromMemory(Context& c) : c_(c), before_(std::exchange(c.state.local.pixel_unpack_buffer, 0)) {}
    ~FromMemory() { c_.state.local.pixel_unpack_buffer = before_; }
    FromMemory(const FromMemory&) = delete;

private:
    Context& c_;
    const std::uint32_t before_;
};

void fill(Context& c, GLenum image, GLint number, const Part& part, GLenum format, GLenum type, const void* data) {
    const auto texel_bytes = glapi::image_bytes(format, type, 1, 1, 1).value_or(0);
    const auto all = glapi::image_bytes(format, type, part.width, part.height, part.depth);
    if (!all || texel_bytes == 0) return c.error(GL_OUT_OF_MEMORY);
    std::vector<std::byte> pixels(*all);
    for (std::size_t at = 0; data && at < *all; at += texel_bytes)
        std::memcpy(&pixels[at], data, std::min(texel_bytes, *all - at));
    ImageCall call;
    call.dimensions = target_word(image)->info->first_face != 0 ? 2 : target_word(image)->info->images;
    call.target = image;
    call.level = number;
    call.x = part.x, call.y = part.y, call.z = part.z;
    call.width = part.width, call.height = part.height, call.depth = part.depth;
    call.format = format, call.type = type;
    call.pixels = pixels.data();
    call.store.alignment = 1;
    change_sub_image(c, call);
}

/// What a texture of several samples a texel holds was drawn, so it is cleared as what is drawn to. Slice by slice.
void clear_samples(Context& c, const std::shared_ptr<Texture>& texture, const TextureFormat& internal, const Part& part,
                   GLenum format, GLenum type, const void* data) {
    const auto tight = data ? glapi::unpack_image({.alignment = 1}, kOneTexel, format, type, data)
                            : std::vector<std::byte>(glapi::image_bytes(format, type, 1, 1, 1).value_or(0));
    const bool stencil = internal.base == GL_DEPTH_STENCIL, depth = stencil || internal.base == GL_DEPTH_COMPONENT;
    const unsigned place = depth ? glstate::kColorAttachments : 0;
    const Instead<el::scissor_enabled> in_part(c, 1);
    const Instead<el::scissor> box(c, {part.x, part.y, part.width, part.height});
    const Instead<el::color_mask> colors(c, {255, 255, 255, 255});
    const Instead<el::depth_mask> depths(c, 1);
    const Instead<el::stencil_mask> stencils(c, 0xff);
    const Instead<el::rasterizer_discard> drawn(c, 0);
    OwnFramebuffer framebuffer(c, GL_DRAW_FRAMEBUFFER);
    framebuffer.bind();
    for (GLint z = part.z; z < part.z + part.depth; ++z) {
        const Attachment slice{.texture = texture, .target = texture->info.target, .layer = z};
        change_framebuffer(c, *framebuffer, [&](Framebuffer& to) {
            to.attach(place, slice);
            if (stencil) to.attach(place + 1, slice);
        });
        if (internal.whole()) {
            const Whole value = to_whole(format, type, tight, 1)[0];
            std::array<GLuint, 4> words;
            std::ranges::transform(value, words.begin(), [](std::int64_t n) { return static_cast<GLuint>(n); });
            if (internal.component_type == GL_INT)
                ClearBufferiv(c, GL_COLOR, 0, reinterpret_cast<GLint*>(words.data()));
            else ClearBufferuiv(c, GL_COLOR, 0, words.data());
            continue;
        }
        const Rgba value = to_rgba(format, type, tight, 1)[0];
        if (!depth) ClearBufferfv(c, GL_COLOR, 0, value.data());
        else if (!stencil) ClearBufferfv(c, GL_DEPTH, 0, value.data());
        else ClearBufferfi(c, GL_DEPTH_STENCIL, 0, value[0], stencil_of(type, tight));
    }
}

void clear_texture(Context& c, GLuint name, GLint number, const std::optional<Part>& wanted, GLenum format, GLenum type,
                   const void* data) {
    if (name == 0) return c.error(GL_INVALID_OPERATION);
    const NamedTexture named(c, name);
    if (!named) return;
    const glapi::TextureTargetInfo& info = named.texture()->info;
    if (info.id == glapi::TextureTarget::buffer) return c.error(GL_INVALID_OPERATION);
    const bool cube = info.first_face != 0;
    const TextureLevel* level = named.texture()->find_level(0, number);
    if (!level || !level->defined() || number < 0) return c.error(GL_INVALID_OPERATION);
    const TextureFormat* internal = find_texture_format(level->internal_format);
    if (!internal || internal->compressed()) return c.error(GL_INVALID_OPERATION);
    const GLint slices = cube ? static_cast<GLint>(glapi::kCubeFaces) : level->depth;
    const Part part = wanted.value_or(Part{0, 0, 0, level->width, level->height, slices});
    const auto inside = [](GLint at, GLsizei count, GLint all) {
        return at >= 0 && count >= 0 && std::int64_t{at} + count <= all;
    };
    if (!inside(part.x, part.width, level->width) || !inside(part.y, part.height, level->height) ||
        !inside(part.z, part.depth, slices))
        return c.error(GL_INVALID_OPERATION);
    if (const GLenum error = glapi::format_type_error(format, type)) return c.error(error);
    if (are_colors(internal->base) ? !are_colors(format) : format != internal->base)
        return c.error(GL_INVALID_OPERATION);
    if (glapi::is_integer_format(format) != internal->whole()) return c.error(GL_INVALID_OPERATION);
    if (info.samples) return clear_samples(c, named.texture(), *internal, part, format, type, data);
    const FromMemory from_memory(c);
    if (!cube) return fill(c, info.target, number, part, format, type, data);
    for (GLint face = part.z; face < part.z + part.depth; ++face)
        fill(c, glapi::image_target(info, static_cast<unsigned>(face)), number,
             {part.x, part.y, 0, part.width, part.height, 1}, format, type, data);
}

}  // namespace

void ClearBufferData(Context& c, GLenum target, GLenum internal, GLenum format, GLenum type, const void* data) {
    clear_buffer(c, target, internal, 0, std::nullopt, format, type, data);
}

void ClearBufferSubData(Context& c, GLenum target, GLenum internal, GLintptr offset, GLsizeiptr size, GLenum format,
                        GLenum type, const void* data) {
    clear_buffer(c, target, internal, offset, size, format, type, data);
}

void ClearTexImage(Context& c, GLuint name, GLint level, GLenum format, GLenum type, const void* data) {
    clear_texture(c, name, level, std::nullopt, format, type, data);
}

void ClearTexSubImage(Context& c, GLuint name, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                      GLsizei depth, GLenum format, GLenum type, const void* data) {
    clear_texture(c, name, level, Part{x, y, z, width, height, depth}, format, type, data);
}

}  // namespace wall::client::api
