// SPDX-License-Identifier: MIT
// Texture objects: names, binding, parameters (OpenGL 1.2.1, 3.8.4 and 3.8.8). Images: tex_image.cpp, queries:
// tex_query.cpp.
#include <algorithm>
#include <bit>
#include <cmath>

#include "client_lib/context/context.h"
#include "client_lib/context/es_words.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/image_work.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/follow/session.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/texture_formats.h"
#include "common/glapi/block_formats.h"

namespace wall::client::api {
namespace {

/// Of GL_GLOBAL_TEXTURE_1D and its like (GL_WALLGL_global_texture, docs/parallel-programs.md); null: no such word.
const glapi::TextureTargetInfo* find_global_target(GLenum word) {
    const auto found = std::ranges::find_if(glapi::kTextureTargetInfo,
                                            [&](const auto& info) { return info.global != 0 && info.global == word; });
    return found == glapi::kTextureTargetInfo.end() ? nullptr : &*found;
}

bool valid_wrap(const glapi::TextureTargetInfo& target, GLenum mode) {
    switch (mode) {
        case GL_CLAMP:
        case GL_CLAMP_TO_EDGE:
        case GL_CLAMP_TO_BORDER: return true;
        case GL_REPEAT:
        case GL_MIRRORED_REPEAT:
        case GL_MIRROR_CLAMP_EXT:
        case GL_MIRROR_CLAMP_TO_EDGE:
        case GL_MIRROR_CLAMP_TO_BORDER_EXT: return target.repeats;
        default: return false;
    }
}

bool valid_min_filter(const glapi::TextureTargetInfo& target, GLenum filter) {
    if (filter == GL_NEAREST || filter == GL_LINEAR) return true;
    return target.mipmaps && filter >= GL_NEAREST_MIPMAP_NEAREST && filter <= GL_LINEAR_MIPMAP_LINEAR;
}

bool valid_swizzle(GLenum word) { return word == GL_ZERO || word == GL_ONE || (word >= GL_RED && word <= GL_ALPHA); }

/// Texels with several samples are fetched one by one: nothing filters them.
bool of_sampler(GLenum pname) {
    switch (pname) {
        case GL_TEXTURE_MIN_FILTER:
        case GL_TEXTURE_MAG_FILTER:
        case GL_TEXTURE_WRAP_S:
        case GL_TEXTURE_WRAP_T:
        case GL_TEXTURE_WRAP_R:
        case GL_TEXTURE_BORDER_COLOR:
        case GL_TEXTURE_MIN_LOD:
        case GL_TEXTURE_MAX_LOD:
        case GL_TEXTURE_LOD_BIAS:
        case GL_TEXTURE_COMPARE_MODE:
        case GL_TEXTURE_COMPARE_FUNC:
        case GL_TEXTURE_MAX_ANISOTROPY_EXT:
        case GL_TEXTURE_SRGB_DECODE_EXT: return true;
        default: return false;
    }
}

/// Parameters that are words, some of which OpenGL ES does not have.
bool takes_word(GLenum pname) {
    switch (pname) {
        case GL_TEXTURE_WRAP_S:
        case GL_TEXTURE_WRAP_T:
        case GL_TEXTURE_WRAP_R:
        case GL_TEXTURE_COMPARE_MODE: return true;
        default: return false;
    }
}

bool valid_compare(GLenum func) { return func >= GL_NEVER && func <= GL_ALWAYS; }

/// Whole numbers, depths and stencils are not averaged (Mesa's _mesa_is_valid_generate_texture_mipmap_internalformat
/// lets all else), nor are blocks that drivers only read. `es`: in OpenGL ES sized formats are only if they are drawn
/// to (OpenGL ES 3.0.6, 3.8.10).
bool may_have_mipmaps(const TextureLevel& base, unsigned es) {
    const TextureFormat* format = find_texture_format(base.internal_format);
    if (!format || format->whole() || format->base == GL_DEPTH_STENCIL || format->base == GL_STENCIL_INDEX)
        return false;
    if (glapi::is_only_given(static_cast<GLenum>(base.internal_format))) return false;
    return es == 0 || !is_sized(*format) ||
           (format->base != GL_DEPTH_COMPONENT && es_is_drawn(es, base.internal_format));
}

/// What glTexParameter asks for, checked: an error, or the parameters with the new value.
struct Change {
    GLenum error = GL_NO_ERROR;
    TexParameters value;
};

Change changed(const TexParameters& old, const glapi::TextureTargetInfo& target, GLenum pname, const GLfloat* params) {
    Change out{GL_NO_ERROR, old};
    TexParameters& p = out.value;
    const GLenum word = to_enum(params[0]);
    const GLint number = to_int(std::nearbyint(params[0]));
    const auto check = [&](bool good, GLenum error) {
        if (!good && out.error == GL_NO_ERROR) out.error = error;
    };
    switch (pname) {
        case GL_TEXTURE_MIN_FILTER: p.min_filter = word, check(valid_min_filter(target, word), GL_INVALID_ENUM); break;
        case GL_TEXTURE_MAG_FILTER:
            p.mag_filter = word, check(word == GL_NEAREST || word == GL_LINEAR, GL_INVALID_ENUM);
            break;
        case GL_TEXTURE_WRAP_S: p.wrap_s = word, check(valid_wrap(target, word), GL_INVALID_ENUM); break;
        case GL_TEXTURE_WRAP_T: p.wrap_t = word, check(valid_wrap(target, word), GL_INVALID_ENUM); break;
        case GL_TEXTURE_WRAP_R: p.wrap_r = word, check(valid_wrap(target, word), GL_INVALID_ENUM); break;
        case GL_TEXTURE_BORDER_COLOR: std::copy_n(params, 4, p.border_color.begin()), p.border_whole = false; break;
        case GL_TEXTURE_PRIORITY: p.priority = std::clamp(params[0], 0.0f, 1.0f); break;
        case GL_TEXTURE_MIN_LOD: p.min_lod = params[0]; break;
        case GL_TEXTURE_MAX_LOD: p.max_lod = params[0]; break;
        case GL_TEXTURE_LOD_BIAS: p.lod_bias = params[0]; break;
        case GL_TEXTURE_BASE_LEVEL:
            p.base_level = number, check(number >= 0, GL_INVALID_VALUE);
            if (!target.mipmaps) check(number == 0, GL_INVALID_OPERATION);
            break;
        case GL_TEXTURE_SWIZZLE_R:
        case GL_TEXTURE_SWIZZLE_G:
        case GL_TEXTURE_SWIZZLE_B:
        case GL_TEXTURE_SWIZZLE_A:
            p.swizzle[pname - GL_TEXTURE_SWIZZLE_R] = word, check(valid_swizzle(word), GL_INVALID_ENUM);
            break;
        case GL_TEXTURE_SRGB_DECODE_EXT:
            p.srgb_decode = word, check(word == GL_DECODE_EXT || word == GL_SKIP_DECODE_EXT, GL_INVALID_ENUM);
            break;
        case GL_TEXTURE_MAX_LEVEL: p.max_level = number, check(number >= 0, GL_INVALID_VALUE); break;
        case GL_GENERATE_MIPMAP: p.generate_mipmap = params[0] != 0; break;
        case GL_TEXTURE_MAX_ANISOTROPY_EXT:
            p.max_anisotropy = std::min(params[0], 16.0f), check(params[0] >= 1, GL_INVALID_VALUE);
            break;
        case GL_TEXTURE_CROP_RECT_OES:
            std::transform(params, params + 4, p.crop_rectangle.begin(), [](GLfloat side) { return to_int(side); });
            break;
        case GL_TEXTURE_COMPARE_MODE:
            p.compare_mode = word, check(word == GL_NONE || word == GL_COMPARE_R_TO_TEXTURE, GL_INVALID_ENUM);
            break;
        case GL_TEXTURE_COMPARE_FUNC: p.compare_func = word, check(valid_compare(word), GL_INVALID_ENUM); break;
        case GL_DEPTH_TEXTURE_MODE:
            p.depth_mode = word,
            check(word == GL_LUMINANCE || word == GL_INTENSITY || word == GL_ALPHA || word == GL_RED, GL_INVALID_ENUM);
            break;
        case GL_DEPTH_STENCIL_TEXTURE_MODE:
            p.depth_stencil_mode = word, check(word == GL_DEPTH_COMPONENT || word == GL_STENCIL_INDEX, GL_INVALID_ENUM);
            break;
        default: out.error = GL_INVALID_ENUM;
    }
    return out;
}

/// Storage for good has these levels and no others (OpenGL 4.2, 3.9.13).
void clamp_levels(TexParameters& p, GLenum pname, std::uint32_t levels) {
    const auto last = static_cast<GLint>(levels) - 1;
    if (pname == GL_TEXTURE_BASE_LEVEL) p.base_level = std::clamp(p.base_level, 0, last);
    if (pname == GL_TEXTURE_MAX_LEVEL) p.max_level = std::clamp(p.max_level, p.base_level, last);
}

void store_parameters(Context& c, GLenum target, GLenum pname, const TexParameters& before,
                      const TexParameters& after) {
    if (same_parameter(before, after, pname)) return;
    const auto texture = texture_to_change(c, target);
    std::lock_guard lock(c.share().mutex);
    texture->parameters = after;
    // Nodes are told of the first when it happens, of the others never.
    if (pname == GL_GENERATE_MIPMAP || pname == GL_TEXTURE_PRIORITY || pname == GL_TEXTURE_CROP_RECT_OES) return;
    texture->parameter_changed(pname);
    // Of storage for good, nodes are told of the last level that the first one allows.
    if (pname == GL_TEXTURE_BASE_LEVEL && texture->immutable_levels != 0)
        texture->parameter_changed(GL_TEXTURE_MAX_LEVEL);
    touch(c.share(), *texture);
}

template <class Whole>
void set_whole_border(Context& c, GLenum target, const Whole* params) {
    const auto* info = target_of(target);
    if (!info || info->samples || info->id == glapi::TextureTarget::buffer) return c.error(c.target_error);
    const auto current = bound_texture(c, target);
    const TexParameters before = current ? current->parameters : Texture(ClientName(), 0, info->id).parameters;
    TexParameters after = before;
    std::array<Whole, 4> words;
    std::copy_n(params, 4, words.begin());
    after.border_color = std::bit_cast<std::array<float, 4>>(words);
    after.border_whole = true;
    store_parameters(c, target, GL_TEXTURE_BORDER_COLOR, before, after);
}

}  // namespace

void GenTextures(Context& c, GLsizei n, GLuint* names) {
    if (n < 0) return c.error(GL_INVALID_VALUE);
    if (n == 0 || !names) return;
    std::lock_guard lock(c.share().mutex);
    const GLuint first = c.share().textures.reserve(static_cast<GLuint>(n));
    for (GLsizei i = 0; i < n; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteTextures(Context& c, GLsizei n, const GLuint* names) {
    if (n < 0) return c.error(GL_INVALID_VALUE);
    if (!names) return;
    c.flush_block();
    for (GLsizei i = 0; i < n; ++i) {
        if (names[i] == 0) continue;
        std::shared_ptr<Texture> texture;
        {
            std::lock_guard lock(c.share().mutex);
            texture = c.share().textures.erase(names[i]);
        }
        if (texture) forget_texture(c, texture);
    }
}

void BindTexture(Context& c, GLenum word, GLuint name) {
    const auto* plain = target_of(word);
    const auto* info = plain ? plain : find_global_target(word);
    if (!info) return c.error(GL_INVALID_ENUM);
    const glapi::TextureTarget target = info->id;
    ClientName id;
    {
        std::lock_guard lock(c.share().mutex);
        if (name == 0) {
            id = default_id(c.share(), target);
        } else {
            auto texture = c.share().textures.find(name);
            if (texture && texture->info.id != target) return c.error(GL_INVALID_OPERATION);
            if (!texture && c.profile.core && !c.share().textures.known(name)) return c.error(GL_INVALID_OPERATION);
            if (!texture) c.share().textures.put(name, texture = make_texture(c, name, target));
            texture->global |= plain == nullptr;
            auto& users = texture->bound_by;
            if (std::find(users.begin(), users.end(), c.id) == users.end()) users.push_back(c.id);
            id = texture->id;
        }
    }
    set_bound_id(c, c.active_texture(), target, id);
}

GLboolean IsTexture(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().textures.find(name) != nullptr;
}

GLboolean AreTexturesResident(Context& c, GLsizei n, const GLuint* names, GLboolean*) {
    if (n < 0) return c.error(GL_INVALID_VALUE), GLboolean{GL_FALSE};
    std::lock_guard lock(c.share().mutex);
    for (GLsizei i = 0; names && i < n; ++i)
        if (!c.share().textures.find(names[i])) return c.error(GL_INVALID_VALUE), GLboolean{GL_FALSE};
    return GL_TRUE;
}

// Priorities are remembered for glGetTexParameter; the nodes' drivers ignore them.
void PrioritizeTextures(Context& c, GLsizei n, const GLuint* names, const GLfloat* priorities) {
    if (n < 0) return c.error(GL_INVALID_VALUE);
    if (!names || !priorities) return;
    std::lock_guard lock(c.share().mutex);
    for (GLsizei i = 0; i < n; ++i)
        if (const auto texture = c.share().textures.find(names[i]))
            texture->parameters.priority = std::clamp(priorities[i], 0.0f, 1.0f);
}

void TexParameterfv(Context& c, GLenum target, GLenum pname, const GLfloat* params) {
    const auto* info = target_of(target);
    if (!info || info->id == glapi::TextureTarget::buffer) return c.error(c.target_error);
    if (info->samples && of_sampler(pname)) return c.error(c.target_error);
    if (pname == GL_TEXTURE_SWIZZLE_RGBA) {
        if (!std::all_of(params, params + 4, [](GLfloat word) { return valid_swizzle(to_enum(word)); }))
            return c.error(GL_INVALID_ENUM);
        for (unsigned i = 0; i < 4; ++i) TexParameterfv(c, target, GL_TEXTURE_SWIZZLE_R + i, params + i);
        return;
    }
    const bool wrap = pname == GL_TEXTURE_WRAP_S || pname == GL_TEXTURE_WRAP_T || pname == GL_TEXTURE_WRAP_R;
    if (pname == GL_TEXTURE_CROP_RECT_OES && !c.profile.is_es1()) return c.error(GL_INVALID_ENUM);
    if (is_removed(c, pname) || (wrap && is_removed(c, to_enum(params[0])))) return c.error(GL_INVALID_ENUM);
    if (c.profile.is_es() && takes_word(pname) && !is_es_word(c.profile.es, to_enum(params[0])))
        return c.error(GL_INVALID_ENUM);
    const auto current = bound_texture(c, target);
    const TexParameters before = current ? current->parameters : Texture(ClientName(), 0, info->id).parameters;
    Change change = changed(before, *info, pname, params);
    if (change.error != GL_NO_ERROR) return c.error(change.error);
    if (current && current->immutable_levels != 0) clamp_levels(change.value, pname, current->immutable_levels);
    store_parameters(c, target, pname, before, change.value);
}

void TexParameterIiv(Context& c, GLenum target, GLenum pname, const GLint* params) {
    if (pname == GL_TEXTURE_BORDER_COLOR) return set_whole_border(c, target, params);
    std::array<GLfloat, 4> values{};
    std::copy_n(params, pname == GL_TEXTURE_SWIZZLE_RGBA ? 4 : 1, values.begin());
    TexParameterfv(c, target, pname, values.data());
}

void TexParameterIuiv(Context& c, GLenum target, GLenum pname, const GLuint* params) {
    if (pname == GL_TEXTURE_BORDER_COLOR) return set_whole_border(c, target, params);
    std::array<GLfloat, 4> values{};
    std::copy_n(params, pname == GL_TEXTURE_SWIZZLE_RGBA ? 4 : 1, values.begin());
    TexParameterfv(c, target, pname, values.data());
}

void ActiveTexture(Context& c, GLenum unit) {
    if (unit - GL_TEXTURE0 >= kActiveTextures) return c.error(GL_INVALID_ENUM);
    c.set<glstate::el::active_texture>(0, unit);
}

void ClientActiveTexture(Context& c, GLenum unit) {
    if (unit - GL_TEXTURE0 >= kTextureCoords) return c.error(GL_INVALID_ENUM);
    c.set<glstate::el::client_active_texture>(0, unit);
}

void GenerateMipmap(Context& c, GLenum target) {
    const auto* info = target_of(target);
    if (!info || !info->mipmaps) return c.error(GL_INVALID_ENUM);
    const auto current = bound_texture(c, target);
    const TextureLevel* base = current ? current->find_level(0, current->parameters.base_level) : nullptr;
    if (!base || !may_have_mipmaps(*base, c.profile.es)) return c.error(GL_INVALID_OPERATION);
    const auto texture = texture_to_change(c, target);
    if (texture->view.origin) return make_view_mipmaps(c, texture);
    std::lock_guard lock(c.share().mutex);
    texture->mipmaps_generated();
    c.share().last_change.store(texture->stamp, std::memory_order_release);
}

}  // namespace wall::client::api
