// SPDX-License-Identifier: MIT
// Queries of textures (OpenGL 1.2.1, 6.1.3), answered from the shadow as the nodes' driver would. glGetTexImage:
// get_tex_image.cpp.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "client_lib/context/param_commands.h"
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
        case GL_TEXTURE_LUMINANCE_TYPE: return type_of(bits.luminance);
        case GL_TEXTURE_INTENSITY_TYPE: return type_of(bits.intensity);
        case GL_TEXTURE_DEPTH_TYPE: return type_of(bits.depth);
        case GL_TEXTURE_SHARED_SIZE: return format.internal_format == GL_RGB9_E5 ? 5 : 0;
        case GL_TEXTURE_SAMPLES: return static_cast<GLint>(level.samples);
        case GL_TEXTURE_FIXED_SAMPLE_LOCATIONS: return level.fixed_places || level.samples == 0;
        case GL_TEXTURE_COMPRESSED: return format.compressed();
        case GL_TEXTURE_COMPRESSED_IMAGE_SIZE:
            return static_cast<GLint>(blocks_bytes(format.answer, level.width, level.height));
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

/// Of a texture whose texels are a buffer's.
GLint buffer_value(const Texture::BufferPart& part, GLenum pname, bool& known) {
    const TextureFormat& format = *find_texture_format(static_cast<GLint>(part.internal_format));
    const ComponentBits& bits = format.bits;
    const int texel = (bits.red + bits.green + bits.blue + bits.alpha + bits.luminance + bits.intensity) / 8;
    const auto texels = part.size() / static_cast<std::uint32_t>(std::max(texel, 1));
    TextureLevel level;
    level.width = static_cast<std::int32_t>(texels);
    level.height = level.depth = 1;
    switch (pname) {
        case GL_TEXTURE_BUFFER_DATA_STORE_BINDING: return part.buffer ? static_cast<GLint>(part.buffer->name) : 0;
        case GL_TEXTURE_BUFFER_OFFSET: return static_cast<GLint>(part.offset);
        case GL_TEXTURE_BUFFER_SIZE: return static_cast<GLint>(part.size());
        default: return level_value(level, format, pname, known);
    }
}

template <class Out>
void get_level(Context& c, GLenum target, GLint number, GLenum pname, Out* out) {
    if (!image_target_of(target) || is_removed(c, pname)) return c.error(GL_INVALID_ENUM);
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
        if (target == GL_TEXTURE_BUFFER)
            value = buffer_value(texture ? texture->part : Texture::BufferPart(), pname, known);
        else answer(texture ? texture->find_level(face_of(target), number) : nullptr);
    }
    if (!known) return c.error(GL_INVALID_ENUM);
    *out = static_cast<Out>(value);
}

/// 1 for a value, 4 for the border colour, 0 if there is no such parameter.
unsigned parameter_size(GLenum pname) {
    switch (pname) {
        case GL_TEXTURE_BORDER_COLOR:
        case GL_TEXTURE_SWIZZLE_RGBA:
        case GL_TEXTURE_CROP_RECT_OES: return 4;
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
        case GL_DEPTH_STENCIL_TEXTURE_MODE:
        case GL_TEXTURE_SWIZZLE_R:
        case GL_TEXTURE_SWIZZLE_G:
        case GL_TEXTURE_SWIZZLE_B:
        case GL_TEXTURE_SWIZZLE_A:
        case GL_TEXTURE_SRGB_DECODE_EXT:
        case GL_GENERATE_MIPMAP:
        case GL_TEXTURE_RESIDENT: return 1;
        default: return 0;
    }
}

GLint normalized_int(float value) {
    return static_cast<GLint>(std::lrint(2147483647.0 * std::clamp(static_cast<double>(value), -1.0, 1.0)));
}

/// A border colour as it was given, to the bit.
template <class Whole>
void get_whole_border(Context& c, GLenum target, Whole* out) {
    const auto* info = target_of(target);
    if (!info || info->id == glapi::TextureTarget::buffer) return c.error(GL_INVALID_ENUM);
    const auto texture = bound_texture(c, target);
    const auto border = texture ? texture->parameters.border_color : std::array<float, 4>{};
    std::ranges::copy(std::bit_cast<std::array<Whole, 4>>(border), out);
}

/// Which part of a storage the texture is; nothing: the word asks for something else. Null: a texture without content.
std::optional<std::uint32_t> view_value(const Texture* texture, GLenum pname) {
    const Texture::View view = texture ? texture->view : Texture::View();
    switch (pname) {
        case GL_TEXTURE_VIEW_MIN_LEVEL: return view.first_level;
        case GL_TEXTURE_VIEW_NUM_LEVELS: return view.levels;
        case GL_TEXTURE_VIEW_MIN_LAYER: return view.first_layer;
        case GL_TEXTURE_VIEW_NUM_LAYERS: return view.layers;
        default: return std::nullopt;
    }
}

template <class Out>
void get_parameter(Context& c, GLenum target, GLenum pname, Out* out) {
    const auto* info = target_of(target);
    if (!info || info->id == glapi::TextureTarget::buffer || is_removed(c, pname)) return c.error(GL_INVALID_ENUM);
    const auto texture = bound_texture(c, target);
    const std::uint32_t immutable = texture ? texture->immutable_levels : 0;
    if (pname == GL_TEXTURE_IMMUTABLE_FORMAT) return void(*out = static_cast<Out>(immutable != 0));
    if (pname == GL_TEXTURE_IMMUTABLE_LEVELS) return void(*out = static_cast<Out>(immutable));
    if (const auto part = view_value(texture.get(), pname)) return void(*out = static_cast<Out>(*part));
    if (pname == GL_IMAGE_FORMAT_COMPATIBILITY_TYPE)
        return void(*out = static_cast<Out>(GL_IMAGE_FORMAT_COMPATIBILITY_BY_SIZE));
    const unsigned count = parameter_size(pname);
    if (count == 0 || (pname == GL_TEXTURE_CROP_RECT_OES && !c.profile.is_es1())) return c.error(GL_INVALID_ENUM);
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

void GetTexParameterIiv(Context& c, GLenum target, GLenum pname, GLint* params) {
    if (pname == GL_TEXTURE_BORDER_COLOR) get_whole_border(c, target, params);
    else get_parameter(c, target, pname, params);
}
void GetTexParameterIuiv(Context& c, GLenum target, GLenum pname, GLuint* params) {
    if (pname == GL_TEXTURE_BORDER_COLOR) return get_whole_border(c, target, params);
    get_parameter(c, target, pname, reinterpret_cast<GLint*>(params));
}

}  // namespace wall::client::api
