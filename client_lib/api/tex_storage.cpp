// SPDX-License-Identifier: MIT
// Textures that get all their levels at once, for good (GL_ARB_texture_storage; OpenGL 4.2, 3.9.16). The order of the
// checks is Mesa's (texstorage.c).
#include <algorithm>

#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/texture_formats.h"
#include "client_lib/objects/texture_view.h"
#include "common/glapi/block_formats.h"

namespace wall::client::api {
namespace {

/// Whether a target is one for the command of so many dimensions, by its own word or its proxy's.
bool legal_target(const ImageCall& call) {
    const auto word = target_word(call.target);
    return word && word->info->images == call.dimensions && (word->is_object() || word->is_proxy());
}

/// The size of the next level.
void halve(ImageCall& call) {
    const unsigned spatial = glapi::spatial_dimensions_of(*target_word(call.target)->info);
    call.width = std::max(1, call.width / 2);
    if (spatial > 1) call.height = std::max(1, call.height / 2);
    if (spatial > 2) call.depth = std::max(1, call.depth / 2);
    ++call.level;
}

GLsizei most_levels(const ImageCall& call) {
    GLsizei levels = 1;
    for (ImageCall level = call; levels < static_cast<GLsizei>(kTextureLevels); ++levels) {
        const ImageCall before = level;
        halve(level);
        if (level.width == before.width && level.height == before.height && level.depth == before.depth) break;
    }
    return levels;
}

void define_proxy(Context& c, ImageCall call, GLsizei levels, bool fits) {
    for (GLsizei i = 0; i < levels; ++i, halve(call)) {
        TextureLevel level;
        level.internal_format = call.internal_format;
        level.width = call.width, level.height = call.height, level.depth = call.depth;
        level.format = call.format, level.type = call.type;
        c.maps->proxies[{call.target, call.level}] = fits ? level : TextureLevel{};
    }
}

void define_storage(Context& c, ImageCall call, GLsizei levels) {
    if (!legal_target(call)) return c.error(c.target_error);
    const TextureFormat* format = find_texture_format(call.internal_format);
    if (!format || !is_sized(*format)) return c.error(GL_INVALID_ENUM);
    if (call.width < 1 || call.height < 1 || call.depth < 1 || levels < 1) return c.error(GL_INVALID_VALUE);
    if (levels > level_count(c, call.target) || levels > most_levels(call)) return c.error(GL_INVALID_OPERATION);
    if (format->compressed() &&
        !glapi::may_have_blocks(*target_word(call.target)->info, static_cast<GLenum>(format->answer)))
        return c.error(GL_INVALID_OPERATION);
    const bool depth = format->base == GL_DEPTH_COMPONENT || format->base == GL_DEPTH_STENCIL ||
                       format->base == GL_STENCIL_INDEX,
               volume = glapi::spatial_dimensions_of(*target_word(call.target)->info) == 3;
    if (depth && volume) return c.error(GL_INVALID_OPERATION);
    const PixelKind kind = exact_pixels(*format, format->bits);
    call.format = kind.format, call.type = kind.type;
    if (is_proxy(call.target)) return define_proxy(c, call, levels, legal_size(c, call));
    const auto texture = bound_texture(c, call.target);
    if (!texture || texture->is_default() || texture->immutable_levels != 0) return c.error(GL_INVALID_OPERATION);
    if (!legal_size(c, call)) return c.error(GL_INVALID_VALUE);
    const glapi::TextureTargetInfo& info = texture->info;
    const bool ends_early = levels < most_levels(call);
    for (GLsizei i = 0; i < levels; ++i, halve(call))
        for (unsigned face = 0; face < glapi::face_count(info); ++face) {
            ImageCall image = call;
            image.target = glapi::image_target(info, face);
            if (glapi::is_only_given(static_cast<GLenum>(call.internal_format))) store_empty_blocks(c, image);
            else store_level(c, image, {call.format, call.type, {}});
        }
    std::lock_guard lock(c.share().mutex);
    texture->immutable_levels = texture->view.levels = static_cast<std::uint32_t>(levels);
    texture->view.layers = layer_count(*texture);
    if (!ends_early) return;
    texture->parameter_changed(GL_TEXTURE_MAX_LEVEL);  // nodes' textures end with their last level by it
    touch(c.share(), *texture);
}

}  // namespace

void TexStorage1D(Context& c, GLenum target, GLsizei levels, GLenum internal, GLsizei width) {
    ImageCall call;
    call.dimensions = 1, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width;
    define_storage(c, call, levels);
}

void TexStorage2D(Context& c, GLenum target, GLsizei levels, GLenum internal, GLsizei width, GLsizei height) {
    ImageCall call;
    call.dimensions = 2, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width, call.height = height;
    define_storage(c, call, levels);
}

void TexStorage3D(Context& c, GLenum target, GLsizei levels, GLenum internal, GLsizei width, GLsizei height,
                  GLsizei depth) {
    ImageCall call;
    call.dimensions = 3, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width, call.height = height, call.depth = depth;
    define_storage(c, call, levels);
}

}  // namespace wall::client::api
