// SPDX-License-Identifier: MIT
// glGetTexImage (OpenGL 1.2.1, 6.1.4) and glGetTextureSubImage (OpenGL 4.5, 8.11.4), answered from the shadow as the
// nodes' driver would, or by a node.
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "client_lib/context/drawn_texels.h"
#include "client_lib/context/named_objects.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/pixel_convert.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/small_floats.h"
#include "client_lib/objects/texture_formats.h"

namespace wall::client::api {
namespace {

/// What a texel of the base format is to the outside: missing components as 0, alpha as 1.
template <class Number>
void rebase(GLenum base, std::array<Number, 4>& p) {
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

/// How Mesa 22.3 makes texels of the program's.
struct Rounding {
    bool to_bytes;  ///< on the way to the program
    bool packed;    ///< from floats of all four components, which cuts floats of 16 bits, and takes a half upwards
};

/// Five and six bits become bytes by repeating their highest, not by rounding (Mesa's format_utils); eight have a way
/// of their own.
float quantized(float value, unsigned bits, const Rounding& rounding) {
    if (bits == 0 || bits > 16) return value;
    const auto most = static_cast<float>((1u << bits) - 1);
    const float scaled = std::clamp(value, 0.0f, 1.0f) * most;
    const auto number = static_cast<unsigned>(rounding.packed && bits != 8 ? std::lround(scaled) : std::lrint(scaled));
    if (rounding.to_bytes && (bits == 5 || bits == 6))
        return static_cast<float>(number << (8 - bits) | number >> (2 * bits - 8)) / 255.0f;
    return static_cast<float>(number) * (1.0f / most);
}

float quantized_signed(float value, unsigned bits, const Rounding& rounding) {
    if (bits == 0 || bits > 16) return value;
    const auto most = static_cast<float>((1u << (bits - 1)) - 1);
    const float scaled = std::clamp(value, -1.0f, 1.0f) * most;
    return (rounding.packed ? std::round(scaled) : std::rint(scaled)) * (1.0f / most);
}

/// What floats of a format keep of theirs.
void quantize_floats(const TextureFormat& format, unsigned bits, const Rounding& rounding, Rgba& p) {
    const bool one_exponent = format.internal_format == GL_RGB9_E5;
    if (one_exponent || format.internal_format == GL_R11F_G11F_B10F) {
        const Rgb kept = one_exponent ? from_shared_exponent(to_shared_exponent({p[0], p[1], p[2]}))
                                      : from_short_floats(to_short_floats({p[0], p[1], p[2]}));
        p = {kept[0], kept[1], kept[2], p[3]};
    } else if (bits == 16) {
        for (float& component : p)
            component = half_to_float(rounding.packed ? float_to_half_cut(component) : float_to_half(component));
    }
}

/// To the precision that the driver keeps.
void quantize(const TextureFormat& format, const ComponentBits& bits, const Rounding& rounding, Rgba& p) {
    const unsigned red = bits.red ? bits.red : bits.luminance ? bits.luminance : bits.intensity;
    if (format.component_type == GL_FLOAT)
        return quantize_floats(format, std::max<unsigned>(red, bits.alpha), rounding, p);
    const bool is_signed = format.component_type == GL_SIGNED_NORMALIZED;
    const unsigned sizes[4] = {red, bits.green, bits.blue, bits.alpha};
    for (unsigned i = 0; i < 4; ++i)
        p[i] = is_signed ? quantized_signed(p[i], sizes[i], rounding) : quantized(p[i], sizes[i], rounding);
}

bool readable(const TextureFormat& internal, GLenum format) {
    const bool depth = internal.base == GL_DEPTH_COMPONENT || internal.base == GL_DEPTH_STENCIL;
    if (format == GL_DEPTH_COMPONENT) return depth;
    if (format == GL_DEPTH_STENCIL) return internal.base == GL_DEPTH_STENCIL;
    if (format == GL_STENCIL_INDEX) return internal.base == GL_STENCIL_INDEX || internal.base == GL_DEPTH_STENCIL;
    if (internal.base == GL_STENCIL_INDEX) return false;
    return !depth && internal.whole() == glapi::is_integer_format(format);
}

std::size_t count_texels(const TextureLevel& level) {
    return static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
           static_cast<std::size_t>(level.depth);
}

std::vector<std::byte> decoded_slices(const TextureLevel& level) {
    std::vector<std::byte> texels;
    const std::size_t slice = blocks_bytes(level.internal_format, level.width, level.height);
    for (std::size_t z = 0; z < static_cast<std::size_t>(level.depth); ++z) {
        const auto part = decode_s3tc(level.internal_format, level.width, level.height,
                                      std::span(level.pixels).subspan(z * slice, slice));
        texels.insert(texels.end(), part.begin(), part.end());
    }
    return texels;
}

/// Of a level that the client has itself; of one without content, zeros.
std::vector<Rgba> level_texels(const TextureLevel& level) {
    const std::size_t count = count_texels(level);
    if (level.compressed) return to_rgba(GL_RGBA, GL_UNSIGNED_BYTE, decoded_slices(level), count);
    if (level.content == LevelContent::stored) return to_rgba(level.data_format, level.data_type, level.pixels, count);
    return std::vector<Rgba>(count, Rgba{});
}

/// A level that has been asked for. The share group's mutex is held.
struct Request {
    const TextureLevel& level;
    const TexelData* drawn;  ///< what a node has said; null: the client has it
    const TextureFormat& internal;
};

/// Whole numbers, as many bits of them as are kept.
std::vector<std::byte> whole_texels(const Request& request, GLenum format, GLenum type) {
    const TextureLevel& level = request.level;
    const ComponentBits& b = request.internal.bits;
    const std::array<unsigned, 4> bits{std::max({b.red, b.luminance, b.intensity}), b.green, b.blue, b.alpha};
    const bool is_signed = request.internal.component_type == GL_INT;
    std::vector<Whole> texels(count_texels(level), Whole{});
    if (request.drawn)
        texels = to_whole(request.drawn->format, request.drawn->type, request.drawn->bytes, texels.size());
    else if (level.content == LevelContent::stored)
        texels = to_whole(level.data_format, level.data_type, level.pixels, texels.size());
    for (Whole& texel : texels) {
        for (unsigned i = 0; i < 4; ++i) {
            if (bits[i] == 0) continue;
            const std::int64_t most = (std::int64_t{1} << (is_signed ? bits[i] - 1 : bits[i])) - 1;
            texel[i] = std::clamp(texel[i], is_signed ? -most - 1 : 0, most);
        }
        rebase(request.internal.base, texel);
    }
    return from_whole(format, type, texels);
}

std::vector<std::byte> color_texels(Context& c, const Request& request, GLenum format, GLenum type) {
    const TextureLevel& level = request.level;
    auto texels = request.drawn
                      ? to_rgba(request.drawn->format, request.drawn->type, request.drawn->bytes, count_texels(level))
                      : level_texels(level);
    if (format == GL_STENCIL_INDEX) {
        const GLenum came_as = request.drawn ? request.drawn->format : level.data_format;
        for (Rgba& texel : texels)
            if (came_as != GL_STENCIL_INDEX) texel[0] = came_as == GL_DEPTH_STENCIL ? texel[1] : 0;
    } else if (format != GL_DEPTH_COMPONENT && format != GL_DEPTH_STENCIL) {
        const ComponentBits bits = stored_bits(request.internal, level.format, level.type);
        const Rounding rounding{
            .to_bytes = type == GL_UNSIGNED_BYTE && format != GL_LUMINANCE && format != GL_LUMINANCE_ALPHA,
            .packed = level.data_format == GL_RGBA && level.data_type == GL_FLOAT};
        for (Rgba& texel : texels) {
            if (!level.compressed) quantize(request.internal, bits, rounding, texel);
            rebase(request.internal.base, texel);
        }
        if (transfer_matters(c.state, format)) transfer_colors(c.state, c.maps->pixel, texels);
    }
    return from_rgba(format, type, texels);  // luminance is red here, unlike in glReadPixels
}

/// Pixels that were asked for, without gaps.
struct Texels {
    glapi::ImageSize size;
    std::vector<std::byte> tight;
};

/// Of one image of a texture, which is bound to its target; one that is not there has no size. Nothing: there is an
/// error.
std::optional<Texels> texels_of(Context& c, const std::shared_ptr<Texture>& texture, GLenum image, GLint number,
                                const MemoryImage& wanted) {
    const GLenum format = wanted.format, type = wanted.type;
    compress_as_driver(c, image, number, "glGetTexImage");
    const auto drawn = drawn_texels(c, texture, face_of(image), number, "glGetTexImage");
    std::lock_guard lock(c.share().mutex);
    const TextureLevel* level = texture->find_level(face_of(image), number);
    const TextureFormat* internal = level ? find_texture_format(level->internal_format) : nullptr;
    if (!internal) return Texels{{0, 0, 0, texture->info.images}, {}};
    if (!readable(*internal, format)) return c.error(GL_INVALID_OPERATION), std::nullopt;
    const Request request{*level, drawn ? &*drawn : nullptr, *internal};
    return Texels{{level->width, level->height, level->depth, texture->info.images},
                  internal->whole() ? whole_texels(request, format, type) : color_texels(c, request, format, type)};
}

/// Into the program's memory, which has room for `room` bytes; nothing: it did not say.
void give(Context& c, const Texels& texels, GLenum format, GLenum type, std::optional<GLsizei> room, void* pixels) {
    const bool in_memory = c.state.local.pixel_pack_buffer == 0;
    if (room && in_memory) {
        const std::size_t needed = glapi::memory_bytes(pack_store(c.state), texels.size, format, type);
        if (*room < 0 || needed > static_cast<std::size_t>(*room)) return c.error(GL_INVALID_OPERATION);
    }
    if (texels.tight.empty()) return;
    if (const PackTarget to = image_target(c, {texels.size, format, type}, pixels))
        glapi::pack_image(pack_store(c.state), texels.size, format, type, texels.tight, to.get());
}

/// Whether a level can be read so at all; else there is an error.
bool check_level(Context& c, GLenum target, GLint number, GLenum format, GLenum type) {
    if (number < 0 || number >= level_count(c, target)) return c.error(GL_INVALID_VALUE), false;
    if (const GLenum error = glapi::format_type_error(format, type)) return c.error(error), false;
    if (format == GL_COLOR_INDEX) c.error(GL_INVALID_ENUM);
    return format != GL_COLOR_INDEX;
}

void get_image(Context& c, GLenum target, GLint number, const MemoryImage& wanted, std::optional<GLsizei> room,
               void* pixels) {
    const auto* info = image_target_of(target);
    if (!info || info->images == 0 || is_proxy(target)) return c.error(GL_INVALID_ENUM);
    if (!check_level(c, target, number, wanted.format, wanted.type)) return;
    const auto texture = bound_texture(c, target);
    if (!texture) return;
    c.flush_block();  // it may draw to the texture
    if (const auto texels = texels_of(c, texture, target, number, wanted))
        give(c, *texels, wanted.format, wanted.type, room, pixels);
}

/// A part of a level; of a cube map, the faces are slices.
struct Part {
    GLint x, y, z;
    GLsizei width, height, depth;
};

bool lies_in(const Part& part, const glapi::ImageSize& size) {
    const auto inside = [](GLint at, GLsizei count, GLint all) {
        return at >= 0 && count >= 0 && std::int64_t{at} + count <= all;
    };
    return inside(part.x, part.width, size.width) && inside(part.y, part.height, size.height) &&
           inside(part.z, part.depth, size.depth);
}

Texels cut_out(const Texels& all, const Part& part, const glapi::PixelLayout& layout) {
    Texels out{{part.width, part.height, part.depth, all.size.dimensions}, {}};
    const std::size_t row = glapi::row_bytes(layout, all.size.width), bytes = glapi::row_bytes(layout, part.width);
    out.tight.reserve(bytes * static_cast<std::size_t>(part.height) * static_cast<std::size_t>(part.depth));
    for (GLint z = part.z; z < part.z + part.depth; ++z)
        for (GLint y = part.y; y < part.y + part.height; ++y) {
            const auto line =
                static_cast<std::size_t>(z) * static_cast<std::size_t>(all.size.height) + static_cast<std::size_t>(y);
            const std::byte* at = all.tight.data() + line * row + layout.pixel_bytes * static_cast<std::size_t>(part.x);
            out.tight.insert(out.tight.end(), at, at + bytes);
        }
    return out;
}

/// A level of a texture by name, all faces behind one another; a cube map must have all six, and alike.
std::optional<Texels> level_of(Context& c, const NamedTexture& named, GLint number, const MemoryImage& wanted) {
    const glapi::TextureTargetInfo& info = named.texture()->info;
    if (info.samples || info.images == 0) return c.error(GL_INVALID_OPERATION), std::nullopt;
    if (!check_level(c, info.target, number, wanted.format, wanted.type)) return std::nullopt;
    if (info.first_face == 0) return texels_of(c, named.texture(), info.target, number, wanted);
    std::optional<Texels> all;
    for (unsigned face = 0; face < glapi::kCubeFaces; ++face) {
        auto one = texels_of(c, named.texture(), glapi::image_target(info, face), number, wanted);
        const bool alike = one && one->size.width > 0 &&
                           (!all || (one->size.width == all->size.width && one->size.height == all->size.height));
        if (!alike) return c.error(GL_INVALID_OPERATION), std::nullopt;
        if (!all) {
            all = std::move(one);
            all->size.dimensions = 3;
            continue;
        }
        all->tight.insert(all->tight.end(), one->tight.begin(), one->tight.end());
        ++all->size.depth;
    }
    return all;
}

}  // namespace

void GetTexImage(Context& c, GLenum target, GLint number, GLenum format, GLenum type, void* pixels) {
    get_image(c, target, number, {{}, format, type}, std::nullopt, pixels);
}

void GetnTexImage(Context& c, GLenum target, GLint number, GLenum format, GLenum type, GLsizei room, void* pixels) {
    get_image(c, target, number, {{}, format, type}, room, pixels);
}

void GetTextureImage(Context& c, GLuint name, GLint number, GLenum format, GLenum type, GLsizei room, void* pixels) {
    const NamedTexture named(c, name);
    if (!named) return;
    if (const auto texels = level_of(c, named, number, {{}, format, type}))
        give(c, *texels, format, type, room, pixels);
}

void GetTextureSubImage(Context& c, GLuint name, GLint number, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                        GLsizei depth, GLenum format, GLenum type, GLsizei room, void* pixels) {
    const NamedTexture named(c, name);
    if (!named) return;
    const auto texels = level_of(c, named, number, {{}, format, type});
    if (!texels) return;
    const Part part{x, y, z, width, height, depth};
    if (!lies_in(part, texels->size)) return c.error(GL_INVALID_VALUE);
    const auto layout = glapi::pixel_layout(format, type);
    if (!layout || layout->bitmap || width == 0 || height == 0 || depth == 0) return;
    give(c, cut_out(*texels, part, *layout), format, type, room, pixels);
}

}  // namespace wall::client::api
