// SPDX-License-Identifier: MIT
#include "client_lib/objects/es_formats.h"

#include <algorithm>
#include <iterator>

#include "common/glapi/block_formats.h"

namespace wall::client {
namespace {

/// Pixels of a texture whose internal format is `format`.
struct Row {
    GLenum format, type;
    GLint desktop_format;
};
constexpr Row kRows[] = {
    {GL_RGBA, GL_UNSIGNED_BYTE, GL_RGBA},
    {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, GL_RGBA},
    {GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, GL_RGBA},
    {GL_RGBA, GL_FLOAT, GL_RGBA32F},
    {GL_RGBA, GL_HALF_FLOAT, GL_RGBA16F},
    {GL_RGB, GL_UNSIGNED_BYTE, GL_RGB},
    {GL_RGB, GL_UNSIGNED_SHORT_5_6_5, GL_RGB},
    {GL_RGB, GL_FLOAT, GL_RGB32F},
    {GL_RGB, GL_HALF_FLOAT, GL_RGB16F},
    {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, GL_LUMINANCE_ALPHA},
    {GL_LUMINANCE_ALPHA, GL_FLOAT, GL_LUMINANCE_ALPHA32F_ARB},
    {GL_LUMINANCE_ALPHA, GL_HALF_FLOAT, GL_LUMINANCE_ALPHA16F_ARB},
    {GL_LUMINANCE, GL_UNSIGNED_BYTE, GL_LUMINANCE},
    {GL_LUMINANCE, GL_FLOAT, GL_LUMINANCE32F_ARB},
    {GL_LUMINANCE, GL_HALF_FLOAT, GL_LUMINANCE16F_ARB},
    {GL_ALPHA, GL_UNSIGNED_BYTE, GL_ALPHA},
    {GL_ALPHA, GL_FLOAT, GL_ALPHA32F_ARB},
    {GL_ALPHA, GL_HALF_FLOAT, GL_ALPHA16F_ARB},
    {GL_BGRA, GL_UNSIGNED_BYTE, GL_RGBA},  // EXT_texture_format_BGRA8888
    {GL_RED, GL_UNSIGNED_BYTE, GL_RED},    // EXT_texture_rg
    {GL_RED, GL_FLOAT, GL_R32F},
    {GL_RED, GL_HALF_FLOAT, GL_R16F},
    {GL_RG, GL_UNSIGNED_BYTE, GL_RG},
    {GL_RG, GL_FLOAT, GL_RG32F},
    {GL_RG, GL_HALF_FLOAT, GL_RG16F},
    {GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, GL_DEPTH_COMPONENT},  // OES_depth_texture
    {GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_DEPTH_COMPONENT},
    {GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, GL_DEPTH24_STENCIL8},  // OES_packed_depth_stencil
};

bool is_format(GLenum format) {
    return std::ranges::any_of(kRows, [&](const Row& row) { return row.format == format; });
}
bool is_type(GLenum type) {
    return std::ranges::any_of(kRows, [&](const Row& row) { return row.type == type; });
}

/// Which of red, green and blue; alpha.
struct Components {
    unsigned colors;
    bool alpha;
};
Components components_of(GLenum base) {
    switch (base) {
        case GL_RGBA: return {3, true};
        case GL_RGB: return {3, false};
        case GL_RG: return {2, false};
        case GL_LUMINANCE_ALPHA: return {1, true};
        case GL_ALPHA: return {0, true};
        default: return {1, false};
    }
}

}  // namespace

GLenum desktop_type(GLenum type) { return type == kHalfFloatOes ? GLenum{GL_HALF_FLOAT} : type; }

EsImage es_pixels(GLenum format, GLenum es_type) {
    const GLenum type = desktop_type(es_type);
    if (!is_format(format) || !is_type(type)) return {.error = GL_INVALID_ENUM};
    const auto* row =
        std::ranges::find_if(kRows, [&](const Row& each) { return each.format == format && each.type == type; });
    if (row == std::end(kRows)) return {.error = GL_INVALID_OPERATION};
    return {GL_NO_ERROR, row->desktop_format, type};
}

EsImage es_image(GLint internal_format, GLenum format, GLenum type) {
    const bool blocks = glapi::block_bytes(static_cast<GLenum>(internal_format)) != 0;
    if (!blocks && !is_format(static_cast<GLenum>(internal_format))) return {.error = GL_INVALID_VALUE};
    EsImage image = es_pixels(format, type);
    if (blocks) {  // EXT_texture_compression_s3tc: the driver compresses
        image.internal_format = internal_format;
        return image;
    }
    const bool bgra = internal_format == GL_RGBA && format == GL_BGRA;  // as Mesa, and APPLE_texture_format_BGRA8888
    if (image.error == GL_NO_ERROR && static_cast<GLenum>(internal_format) != format && !bgra)
        image.error = GL_INVALID_OPERATION;
    return image;
}

GLenum es_copy_error(GLenum internal_format, GLenum framebuffer_base) {
    switch (internal_format) {
        case GL_ALPHA:
        case GL_LUMINANCE:
        case GL_LUMINANCE_ALPHA:
        case GL_RED:
        case GL_RG:
        case GL_RGB:
        case GL_RGBA: break;
        default: return GL_INVALID_ENUM;
    }
    const Components wanted = components_of(internal_format), there = components_of(framebuffer_base);
    return wanted.colors > there.colors || (wanted.alpha && !there.alpha) ? GL_INVALID_OPERATION : GL_NO_ERROR;
}

// More than the two pairs that the specification has, as in Mesa.
bool es_can_read(GLenum format, GLenum type, bool floats) {
    if (es_pixels(format, type).error != GL_NO_ERROR || format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL)
        return false;
    const bool to_floats = type == GL_FLOAT || type == GL_HALF_FLOAT;
    return floats || !to_floats;
}

}  // namespace wall::client
