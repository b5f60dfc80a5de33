// SPDX-License-Identifier: MIT
// Queries of textures (OpenGL 1.2.1, 6.1.3 and 6.1.4), answered from the shadow as the nodes' driver would.
#include <algorithm>
#include <cmath>

#include "client_lib/context/drawn_texels.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/texture_formats.h"

namespace wall::client::api {
namespace {

GLint level_value(const TextureLevel& level, const TextureFormat& format, GLenum pname, bool& known) {
    const ComponentBits bits = stored_bits(format, level.format, level.type);
    const auto type_of = [&](unsigned size) { return static_cast<GLint>(size ? format.component_type : 0); };
    switch (pname) {
        case GL_TEXTURE_WIDTH: return level.width;
        case GL_TEXTURE_HEIGHT: return level.height;
        case GL_TEXTURE_DEPTH: return level.depth;
        case GL_TEXTURE_BORDER: return 0;  // dropped when the image came
        case GL_TEXTURE_INTERNAL_FORMAT: return format.answer;
        case GL_TEXTURE_RED_SIZE: return bits.red;
        case GL_TEXTURE_GREEN_SIZE: return bits.green;
        case GL_TEXTURE_BLUE_SIZE: return bits.blue;
        case GL_TEXTURE_ALPHA_SIZE: return bits.alpha;
        case GL_TEXTURE_LUMINANCE_SIZE: return bits.luminance;
        case GL_TEXTURE_INTENSITY_SIZE: return bits.intensity;
        case GL_TEXTURE_DEPTH_SIZE: return bits.depth;
        case GL_TEXTURE_STENCIL_SIZE: return bits.stencil;
        case GL_TEXTURE_RED_TYPE: return type_of(bits.red);
        case GL_TEXTURE_GREEN_TYPE: return type_of(bits.green);
        case GL_TEXTURE_BLUE_TYPE: return type_of(bits.blue);
        case GL_TEXTURE_ALPHA_TYPE: return type_of(bits.alpha);
        case GL_TEXTURE_COMPRESSED: return format.compressed;
        case GL_TEXTURE_COMPRESSED_IMAGE_SIZE:
            return static_cast<GLint>(s3tc_bytes(format.answer, level.width, level.height));
        default: known = false; return 0;
    }
}

/// What a level that was never defined answers.
GLint undefined_value(GLenum pname, bool& known) {
    static constexpr TextureFormat kNone{};
    static const TextureLevel level;
    const GLint value = level_value(level, kNone, pname, known);
    return pname == GL_TEXTURE_INTERNAL_FORMAT ? GL_RGBA : value;
}

template <class Out>
void get_level(Context& c, GLenum target, GLint number, GLenum pname, Out* out) {
    if (!image_target_of(target)) return c.error(GL_INVALID_ENUM);
    if (number < 0 || number >= level_count(c, target)) return c.error(GL_INVALID_VALUE);
    bool known = true;
    GLint value = 0;
    const auto answer = [&](const TextureLevel* level) {
        const TextureFormat* format = level && level->defined() ? find_texture_format(level->internal_format) : nullptr;
        value = format ? level_value(*level, *format, pname, known) : undefined_value(pname, known);
    };
    if (is_proxy(target)) {
        const auto found = c.maps->proxies.find({target, number});
        answer(found == c.maps->proxies.end() ? nullptr : &found->second);
        if (value == GL_RGBA && pname == GL_TEXTURE_INTERNAL_FORMAT &&
            (found == c.maps->proxies.end() || !found->second.defined()))
            value = 0;
    } else {
        const auto texture = bound_texture(c, target);
        std::lock_guard lock(c.share().mutex);
        answer(texture ? texture->find_level(face_of(target), number) : nullptr);
    }
    if (!known) return c.error(GL_INVALID_ENUM);
    *out = static_cast<Out>(value);
}

/// 1 for a value, 4 for the border colour, 0 if there is no such parameter.
unsigned parameter_size(GLenum pname) {
    switch (pname) {
        case GL_TEXTURE_BORDER_COLOR: return 4;
        case GL_TEXTURE_MIN_FILTER:
        case GL_TEXTURE_MAG_FILTER:
        case GL_TEXTURE_WRAP_S:
        case GL_TEXTURE_WRAP_T:
        case GL_TEXTURE_WRAP_R:
        case GL_TEXTURE_PRIORITY:
        case GL_TEXTURE_MIN_LOD:
        case GL_TEXTURE_MAX_LOD:
        case GL_TEXTURE_LOD_BIAS:
        case GL_TEXTURE_BASE_LEVEL:
        case GL_TEXTURE_MAX_LEVEL:
        case GL_TEXTURE_MAX_ANISOTROPY_EXT:
        case GL_TEXTURE_COMPARE_MODE:
        case GL_TEXTURE_COMPARE_FUNC:
        case GL_DEPTH_TEXTURE_MODE:
        case GL_GENERATE_MIPMAP:
        case GL_TEXTURE_RESIDENT: return 1;
        default: return 0;
    }
}

GLint normalized_int(float value) {
    return static_cast<GLint>(std::lrint(2147483647.0 * std::clamp(static_cast<double>(value), -1.0, 1.0)));
}

template <class Out>
void get_parameter(Context& c, GLenum target, GLenum pname, Out* out) {
    const auto* info = target_of(target);
    if (!info) return c.error(GL_INVALID_ENUM);
    const unsigned count = parameter_size(pname);
    if (count == 0) return c.error(GL_INVALID_ENUM);
    const auto texture = bound_texture(c, target);
    const auto value =
        pname == GL_TEXTURE_RESIDENT
            ? std::array<float, 4>{1}
            : parameter_value(texture ? texture->parameters : Texture(ClientName(), 0, info->id).parameters, pname);
    constexpr bool kInteger = std::is_same_v<Out, GLint>;
    const bool fraction = pname == GL_TEXTURE_BORDER_COLOR || pname == GL_TEXTURE_PRIORITY;
    for (unsigned i = 0; i < count; ++i) {
        if (kInteger && fraction) out[i] = static_cast<Out>(normalized_int(value[i]));
        else if (kInteger) out[i] = static_cast<Out>(std::lrint(value[i]));
        else out[i] = static_cast<Out>(value[i]);
    }
}

// ---- glGetTexImage ----

/// What a texel of the base format is to the outside: missing components as 0, alpha as 1.
void rebase(GLenum base, Rgba& p) {
    switch (base) {
        case GL_ALPHA: p = {0, 0, 0, p[3]}; break;
        case GL_LUMINANCE: p = {p[0], 0, 0, 1}; break;
        case GL_LUMINANCE_ALPHA: p = {p[0], 0, 0, p[3]}; break;
        case GL_INTENSITY: p = {p[0], 0, 0, 1}; break;
        case GL_RED: p = {p[0], 0, 0, 1}; break;
        case GL_RG: p = {p[0], p[1], 0, 1}; break;
        case GL_RGB: p[3] = 1; break;
        default: break;
    }
}

/// `to_bytes`: five and six bits become eight by repeating their highest, not by rounding (Mesa's format_utils).
float quantized(float value, unsigned bits, bool to_bytes) {
    if (bits == 0 || bits > 16) return value;
    const auto most = static_cast<float>((1u << bits) - 1);
    const auto number = static_cast<unsigned>(std::lrint(std::clamp(value, 0.0f, 1.0f) * most));
    if (to_bytes && (bits == 5 || bits == 6))
        return static_cast<float>(number << (8 - bits) | number >> (2 * bits - 8)) / 255.0f;
    return static_cast<float>(number) / most;
}

/// To the precision that the driver keeps.
void quantize(const TextureFormat& format, const ComponentBits& bits, bool to_bytes, Rgba& p) {
    if (format.component_type == GL_FLOAT || format.component_type == GL_SIGNED_NORMALIZED) return;
    const unsigned red = bits.red ? bits.red : bits.luminance ? bits.luminance : bits.intensity;
    const unsigned sizes[4] = {red, bits.green, bits.blue, bits.alpha};
    for (unsigned i = 0; i < 4; ++i) p[i] = quantized(p[i], sizes[i], to_bytes);
}

bool readable(GLenum base, GLenum format) {
    const bool depth = base == GL_DEPTH_COMPONENT || base == GL_DEPTH_STENCIL;
    if (format == GL_DEPTH_COMPONENT) return depth;
    if (format == GL_DEPTH_STENCIL) return base == GL_DEPTH_STENCIL;
    return format != GL_STENCIL_INDEX && !depth;
}

/// A mipmap that only the nodes have, computed here by a box filter.
std::vector<Rgba> halved(const std::vector<Rgba>& from, const TextureLevel& size, const TextureLevel& to) {
    std::vector<Rgba> out;
    out.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height) *
                static_cast<std::size_t>(to.depth));
    const auto at = [&](GLint x, GLint y, GLint z) -> const Rgba& {
        x = std::min(x, size.width - 1), y = std::min(y, size.height - 1), z = std::min(z, size.depth - 1);
        return from[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size.height) +
                     static_cast<std::size_t>(y)) *
                        static_cast<std::size_t>(size.width) +
                    static_cast<std::size_t>(x)];
    };
    for (GLint z = 0; z < to.depth; ++z)
        for (GLint y = 0; y < to.height; ++y)
            for (GLint x = 0; x < to.width; ++x) {
                Rgba sum{};
                for (unsigned corner = 0; corner < 8; ++corner) {
                    const Rgba& p = at(2 * x + (corner & 1), 2 * y + (corner >> 1 & 1), 2 * z + (corner >> 2));
                    for (unsigned i = 0; i < 4; ++i) sum[i] += p[i] / 8;
                }
                out.push_back(sum);
            }
    return out;
}

std::vector<Rgba> level_texels(Texture& texture, unsigned face, GLint number) {
    const TextureLevel& level = *texture.find_level(face, number);
    const std::size_t count = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
                              static_cast<std::size_t>(level.depth);
    if (level.compressed)
        return to_rgba(GL_RGBA, GL_UNSIGNED_BYTE,
                       decode_s3tc(level.internal_format, level.width, level.height, level.pixels), count);
    if (level.content == LevelContent::stored) return to_rgba(level.data_format, level.data_type, level.pixels, count);
    if (level.content == LevelContent::generated && texture.find_level(face, number - 1))
        return halved(level_texels(texture, face, number - 1), *texture.find_level(face, number - 1), level);
    return std::vector<Rgba>(count, Rgba{});
}

}  // namespace

void GetTexLevelParameterfv(Context& c, GLenum target, GLint level, GLenum pname, GLfloat* params) {
    get_level(c, target, level, pname, params);
}
void GetTexLevelParameteriv(Context& c, GLenum target, GLint level, GLenum pname, GLint* params) {
    get_level(c, target, level, pname, params);
}
void GetTexParameterfv(Context& c, GLenum target, GLenum pname, GLfloat* params) {
    get_parameter(c, target, pname, params);
}
void GetTexParameteriv(Context& c, GLenum target, GLenum pname, GLint* params) {
    get_parameter(c, target, pname, params);
}

void GetTexImage(Context& c, GLenum target, GLint number, GLenum format, GLenum type, void* pixels) {
    if (!image_target_of(target) || is_proxy(target)) return c.error(GL_INVALID_ENUM);
    if (number < 0 || number >= level_count(c, target)) return c.error(GL_INVALID_VALUE);
    if (const GLenum error = glapi::format_type_error(format, type)) return c.error(error);
    if (format == GL_COLOR_INDEX || format == GL_STENCIL_INDEX) return c.error(GL_INVALID_ENUM);
    const auto texture = bound_texture(c, target);
    if (!texture) return;
    compress_as_driver(c, target, number);
    const auto drawn = drawn_texels(c, texture, face_of(target), number, "glGetTexImage");
    std::vector<std::byte> tight;
    glapi::ImageSize size;
    {
        std::lock_guard lock(c.share().mutex);
        const TextureLevel* level = texture->find_level(face_of(target), number);
        const TextureFormat* internal = level ? find_texture_format(level->internal_format) : nullptr;
        if (!internal) return;
        if (!readable(internal->base, format)) return c.error(GL_INVALID_OPERATION);
        size = {level->width, level->height, level->depth, image_target_of(target)->images};
        auto texels = drawn ? *drawn : level_texels(*texture, face_of(target), number);
        if (format != GL_DEPTH_COMPONENT && format != GL_DEPTH_STENCIL) {
            const ComponentBits bits = stored_bits(*internal, level->format, level->type);
            const bool to_bytes = type == GL_UNSIGNED_BYTE && format != GL_LUMINANCE && format != GL_LUMINANCE_ALPHA;
            for (Rgba& texel : texels) {
                if (!level->compressed) quantize(*internal, bits, to_bytes, texel);
                rebase(internal->base, texel);
            }
            if (transfer_matters(c.state, format)) transfer_colors(c.state, c.maps->pixel, texels);
        }
        tight = from_rgba(format, type, texels);  // luminance is red here, unlike in glReadPixels
    }
    if (const PackTarget to = image_target(c, {size, format, type}, pixels))
        glapi::pack_image(pack_store(c.state), size, format, type, tight, to.get());
}

}  // namespace wall::client::api
