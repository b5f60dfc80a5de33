// SPDX-License-Identifier: MIT
// Textures whose texels are a buffer's (OpenGL 3.1, 3.8.6; GL_ARB_texture_buffer_range). The order of the checks is
// Mesa's (teximage.c).
#include <algorithm>

#include "client_lib/context/forget_objects.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/texture_formats.h"

namespace wall::client::api {
namespace {

// OpenGL 4.0, table 3.15 (three components: GL_ARB_texture_buffer_object_rgb32), and GL_ARB_texture_buffer_object's.
constexpr GLenum kFormats[] = {GL_R8,      GL_R16,     GL_R16F,    GL_R32F,     GL_R8I,     GL_R16I,    GL_R32I,
                               GL_R8UI,    GL_R16UI,   GL_R32UI,   GL_RG8,      GL_RG16,    GL_RG16F,   GL_RG32F,
                               GL_RG8I,    GL_RG16I,   GL_RG32I,   GL_RG8UI,    GL_RG16UI,  GL_RG32UI,  GL_RGB32F,
                               GL_RGB32I,  GL_RGB32UI, GL_RGBA8,   GL_RGBA16,   GL_RGBA16F, GL_RGBA32F, GL_RGBA8I,
                               GL_RGBA16I, GL_RGBA32I, GL_RGBA8UI, GL_RGBA16UI, GL_RGBA32UI};
constexpr GLenum kCompatibilityFormats[] = {
    GL_ALPHA8,
    GL_ALPHA16,
    GL_ALPHA16F_ARB,
    GL_ALPHA32F_ARB,
    GL_ALPHA8I_EXT,
    GL_ALPHA16I_EXT,
    GL_ALPHA32I_EXT,
    GL_ALPHA8UI_EXT,
    GL_ALPHA16UI_EXT,
    GL_ALPHA32UI_EXT,
    GL_LUMINANCE8,
    GL_LUMINANCE16,
    GL_LUMINANCE16F_ARB,
    GL_LUMINANCE32F_ARB,
    GL_LUMINANCE8I_EXT,
    GL_LUMINANCE16I_EXT,
    GL_LUMINANCE32I_EXT,
    GL_LUMINANCE8UI_EXT,
    GL_LUMINANCE16UI_EXT,
    GL_LUMINANCE32UI_EXT,
    GL_LUMINANCE8_ALPHA8,
    GL_LUMINANCE16_ALPHA16,
    GL_LUMINANCE_ALPHA16F_ARB,
    GL_LUMINANCE_ALPHA32F_ARB,
    GL_LUMINANCE_ALPHA8I_EXT,
    GL_LUMINANCE_ALPHA16I_EXT,
    GL_LUMINANCE_ALPHA32I_EXT,
    GL_LUMINANCE_ALPHA8UI_EXT,
    GL_LUMINANCE_ALPHA16UI_EXT,
    GL_LUMINANCE_ALPHA32UI_EXT,
    GL_INTENSITY8,
    GL_INTENSITY16,
    GL_INTENSITY16F_ARB,
    GL_INTENSITY32F_ARB,
    GL_INTENSITY8I_EXT,
    GL_INTENSITY16I_EXT,
    GL_INTENSITY32I_EXT,
    GL_INTENSITY8UI_EXT,
    GL_INTENSITY16UI_EXT,
    GL_INTENSITY32UI_EXT,
};

bool is_format_of_buffers(const Context& c, GLenum format) {
    return std::ranges::find(kFormats, format) != std::end(kFormats) ||
           (!c.profile.core && std::ranges::find(kCompatibilityFormats, format) != std::end(kCompatibilityFormats));
}

/// Name 0: none. Null: there is an error, or it is name 0.
std::shared_ptr<Buffer> buffer_named(Context& c, GLuint name) {
    if (name == 0) return nullptr;
    auto buffer = [&] {
        std::lock_guard lock(c.share().mutex);
        return c.share().buffers.find(name);
    }();
    if (!buffer) c.error(GL_INVALID_OPERATION);
    return buffer;
}

/// Of a target and a format that are ones of buffers.
void attach(Context& c, Texture::BufferPart part) {
    const auto texture = texture_to_change(c, GL_TEXTURE_BUFFER);
    {
        std::lock_guard lock(c.share().mutex);
        std::swap(texture->part, part);
        touch(c.share(), *texture);
    }
    if (part.buffer) forget_unused(c, std::move(part.buffer));
}

bool may_be_attached(Context& c, GLenum target, GLenum internal) {
    const bool may = target == GL_TEXTURE_BUFFER && is_format_of_buffers(c, internal);
    if (!may) c.error(GL_INVALID_ENUM);
    return may;
}

}  // namespace

void TexBuffer(Context& c, GLenum target, GLenum internal, GLuint name) {
    if (!may_be_attached(c, target, internal)) return;
    auto buffer = buffer_named(c, name);
    if (name != 0 && !buffer) return;
    attach(c, {std::move(buffer), internal, 0, 0});
}

void TexBufferRange(Context& c, GLenum target, GLenum internal, GLuint name, GLintptr offset, GLsizeiptr bytes) {
    if (!may_be_attached(c, target, internal)) return;
    if (name == 0) return attach(c, {nullptr, internal, 0, 0});
    auto buffer = buffer_named(c, name);
    if (!buffer) return;
    const std::size_t size = [&] {
        std::lock_guard lock(c.share().mutex);
        return buffer->size();
    }();
    const auto alignment = static_cast<GLintptr>(limit_of(c.caps(), GL_TEXTURE_BUFFER_OFFSET_ALIGNMENT, 1));
    const bool within = offset >= 0 && bytes > 0 && static_cast<std::size_t>(offset) <= size &&
                        static_cast<std::size_t>(bytes) <= size - static_cast<std::size_t>(offset);
    if (!within || (alignment > 1 && offset % alignment != 0)) return c.error(GL_INVALID_VALUE);
    attach(c, {std::move(buffer), internal, static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(bytes)});
}

}  // namespace wall::client::api
