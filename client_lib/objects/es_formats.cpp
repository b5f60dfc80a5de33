// SPDX-License-Identifier: MIT
#include "client_lib/objects/es_formats.h"

#include <algorithm>
#include <iterator>

#include "client_lib/objects/es_kind.h"
#include "common/glapi/block_formats.h"
#include "gen/client_lib/es_images.gen.h"

namespace wall::client {
namespace {

template <class Member>
bool any_has(Member EsImageRow::*member, Member value) {
    return std::ranges::any_of(kEsImages, [&](const EsImageRow& row) { return row.*member == value; });
}

/// Of OpenGL ES 1.1, or of the later versions.
bool is_of(const EsImageRow& row, unsigned version) { return row.first == is_first_es(version); }

bool has_format(unsigned version, GLenum internal_format) {
    return std::ranges::any_of(kEsImages, [&](const EsImageRow& row) {
        return is_of(row, version) && row.internal_format == internal_format;
    });
}

/// The first row of a version with these pixels that `fits`; without one the error.
template <class Fits>
EsImage find_image(unsigned version, GLenum format, GLenum es_type, Fits&& fits) {
    const GLenum type = desktop_type(es_type);
    if (!any_has(&EsImageRow::format, format) || !any_has(&EsImageRow::type, type)) return {.error = GL_INVALID_ENUM};
    const auto* row = std::ranges::find_if(kEsImages, [&](const EsImageRow& each) {
        return is_of(each, version) && each.format == format && each.type == type && fits(each);
    });
    if (row == std::end(kEsImages)) return {.error = GL_INVALID_OPERATION};
    return {GL_NO_ERROR, row->desktop_format, type};
}

bool is_of_blocks(GLint internal_format) { return glapi::block_bytes(static_cast<GLenum>(internal_format)) != 0; }

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

/// A component that both have has other bits in one than in the other.
bool differs_in_bits(const ComponentBits& a, const ComponentBits& b) {
    const auto differ = [](unsigned one, unsigned other) { return one != 0 && other != 0 && one != other; };
    return differ(a.red, b.red) || differ(a.green, b.green) || differ(a.blue, b.blue) || differ(a.alpha, b.alpha);
}

bool is_float_depth(const TextureFormat& format) { return format.component_type == GL_FLOAT; }

/// Of components of so many bits.
GLenum type_of_words(GLenum component_type, unsigned bits) {
    if (component_type == GL_FLOAT) return bits == 16 ? GL_HALF_FLOAT : GL_FLOAT;
    const bool is_signed = component_type == GL_INT || component_type == GL_SIGNED_NORMALIZED;
    if (bits == 32) return is_signed ? GL_INT : GL_UNSIGNED_INT;
    if (bits == 16) return is_signed ? GL_SHORT : GL_UNSIGNED_SHORT;
    return is_signed ? GL_BYTE : GL_UNSIGNED_BYTE;
}

}  // namespace

GLenum desktop_type(GLenum type) { return type == kHalfFloatOes ? GLenum{GL_HALF_FLOAT} : type; }

EsImage es_image(unsigned version, GLint internal_format, GLenum format, GLenum type) {
    if (is_of_blocks(internal_format)) {  // EXT_texture_compression_s3tc: the driver compresses
        EsImage image = find_image(version, format, type, [](const EsImageRow&) { return true; });
        image.internal_format = internal_format;
        return image;
    }
    const auto word = static_cast<GLenum>(internal_format);
    if (!has_format(version, word)) return {.error = GL_INVALID_VALUE};
    return find_image(version, format, type, [&](const EsImageRow& row) { return row.internal_format == word; });
}

EsImage es_pixels(unsigned version, GLint internal_format, GLenum format, GLenum type) {
    const bool blocks = is_of_blocks(internal_format);
    return find_image(version, format, type,
                      [&](const EsImageRow& row) { return blocks || row.desktop_format == internal_format; });
}

bool es_is_drawn(unsigned version, GLint internal_format) {
    return std::ranges::any_of(kEsDrawn, [&](const EsDrawnRow& row) {
        return row.internal_format == static_cast<GLenum>(internal_format) &&
               row.since <= std::max(version, kFirstShaderEs);
    });
}

// Of formats without sizes nothing but the components is looked at.
GLenum es_copy_error(unsigned version, GLenum internal_format, const TextureFormat& from, GLenum base) {
    const TextureFormat* to = find_texture_format(static_cast<GLint>(internal_format));
    if (!to || !has_format(version, internal_format)) return GL_INVALID_ENUM;
    const bool colors = to->base != GL_DEPTH_COMPONENT && to->base != GL_DEPTH_STENCIL;
    const Components wanted = components_of(to->base), there = components_of(base);
    if (!colors || internal_format == GL_RGB9_E5) return GL_INVALID_OPERATION;
    if (wanted.colors > there.colors || (wanted.alpha && !there.alpha)) return GL_INVALID_OPERATION;
    if (!is_sized(*to)) return GL_NO_ERROR;
    const bool converted = to->component_type != from.component_type || to->srgb != from.srgb;
    return converted || differs_in_bits(to->bits, from.bits) ? GL_INVALID_OPERATION : GL_NO_ERROR;
}

PixelKind es_read_kind(const TextureFormat& from) {
    switch (from.internal_format) {
        case GL_RGB565: return {GL_RGB, GL_UNSIGNED_SHORT_5_6_5};
        case GL_RGBA4: return {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4};
        case GL_RGB10_A2: return {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV};
        case GL_RGB10_A2UI: return {GL_RGBA_INTEGER, GL_UNSIGNED_INT_2_10_10_10_REV};
        case GL_R11F_G11F_B10F: return {GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV};
        default: break;
    }
    const bool words_of_two = from.component_type == GL_SIGNED_NORMALIZED || from.internal_format == GL_RG16;
    const bool one = from.base == GL_RED, two = from.base == GL_RG && !words_of_two;  // as Mesa
    const GLenum words = type_of_words(from.component_type, from.bits.red);
    if (from.whole())
        return {one ? GLenum{GL_RED_INTEGER} : two ? GLenum{GL_RG_INTEGER} : GLenum{GL_RGBA_INTEGER}, words};
    return {one ? GLenum{GL_RED} : two ? GLenum{GL_RG} : GLenum{GL_RGBA}, words};
}

/// What every context gives of colours (OpenGL ES 3.2, 16.1.2).
PixelKind always_read(const TextureFormat& from) {
    if (from.whole()) return {GL_RGBA_INTEGER, from.component_type};
    return {GL_RGBA, from.component_type == GL_FLOAT ? GLenum{GL_FLOAT} : GLenum{GL_UNSIGNED_BYTE}};
}

bool es_can_read(GLenum format, GLenum type, const TextureFormat& from) {
    const PixelKind kind = es_read_kind(from);
    switch (format) {
        case GL_DEPTH_COMPONENT:
            return is_float_depth(from) ? type == GL_FLOAT : type == GL_UNSIGNED_SHORT || type == GL_UNSIGNED_INT;
        case GL_DEPTH_STENCIL:
            return type == (is_float_depth(from) ? GL_FLOAT_32_UNSIGNED_INT_24_8_REV : GL_UNSIGNED_INT_24_8);
        case GL_STENCIL_INDEX: return type == GL_UNSIGNED_BYTE;
        case GL_BGRA: return type == GL_UNSIGNED_BYTE && kind.format == GL_RGBA;
        default: break;
    }
    const auto is = [&](const PixelKind& given) { return format == given.format && type == given.type; };
    const bool normalized = !from.whole() && from.component_type != GL_FLOAT;
    return is(kind) || (normalized && is({GL_RGBA, type_of_words(from.component_type, from.bits.red)})) ||
           (from.component_type != GL_SIGNED_NORMALIZED && is(always_read(from)));
}

}  // namespace wall::client
