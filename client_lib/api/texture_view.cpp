// SPDX-License-Identifier: MIT
// glTextureView (GL_ARB_texture_view; OpenGL 4.5, 8.18). The order of the checks is Mesa's (textureview.c).
#include <algorithm>
#include <memory>
#include <mutex>

#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture_formats.h"
#include "client_lib/objects/texture_view.h"
#include "client_lib/objects/view_formats.h"

namespace wall::client::api {
namespace {

/// Whether images of the one target may be those of the other (OpenGL 4.5, table 8.21): what differs are layers.
bool may_show(const glapi::TextureTargetInfo& origin, const glapi::TextureTargetInfo& view) {
    const unsigned spatial = glapi::spatial_dimensions_of(origin);
    const bool same_images = spatial == glapi::spatial_dimensions_of(view) && origin.samples == view.samples &&
                             origin.repeats == view.repeats;
    const bool has_layers = origin.layers != 0 || origin.first_face != 0;
    return spatial != 0 && same_images && (has_layers || !view.square);
}

struct Request {
    GLuint name;
    GLenum target, internal_format;
    GLuint first_level, levels, first_layer, layers;
};

/// Null, and an error: there is no such texture, or it has no storage for good.
std::shared_ptr<Texture> origin_named(Context& c, GLuint name) {
    std::shared_ptr<Texture> origin;
    {
        std::lock_guard lock(c.share().mutex);
        if (name != 0) origin = c.share().textures.find(name);
    }
    if (!origin) return c.error(GL_INVALID_VALUE), nullptr;
    if (origin->immutable_levels == 0) return c.error(GL_INVALID_OPERATION), nullptr;
    return origin;
}

/// Whether a name is generated and belongs to no texture yet.
GLenum name_error(Context& c, GLuint name) {
    if (name == 0) return GL_INVALID_VALUE;
    std::lock_guard lock(c.share().mutex);
    const bool unused = c.share().textures.known(name) && !c.share().textures.find(name);
    return unused ? GL_NO_ERROR : GL_INVALID_OPERATION;
}

/// Of the number of layers, as far as there are so many.
GLenum cube_error(const glapi::TextureTargetInfo& target, GLuint layers) {
    if (!target.square) return GL_NO_ERROR;
    const bool fits = target.first_face != 0 ? layers == glapi::kCubeFaces : layers % glapi::kCubeFaces == 0;
    return fits ? GL_NO_ERROR : GL_INVALID_VALUE;
}

/// Whether the target may have images of that size and so many layers.
GLenum shape_error(Context& c, const Texture& origin, const glapi::TextureTargetInfo& target, const Request& request,
                   GLuint layers) {
    const TextureLevel* first = origin.find_level(0, static_cast<GLint>(request.first_level));
    if (!first) return GL_INVALID_OPERATION;
    ImageCall image;
    image.target = glapi::image_target(target, 0);
    image.width = first->width;
    const bool rows = glapi::spatial_dimensions_of(target) == 1;
    image.height = rows ? static_cast<GLsizei>(layers) : first->height;
    image.depth = target.layers != 0 ? static_cast<GLsizei>(layers) : first->depth;
    if (!legal_size(c, image)) return GL_INVALID_OPERATION;
    const bool layered = target.layers != 0 || target.first_face != 0;
    return layered || request.layers == 1 ? GL_NO_ERROR : GL_INVALID_VALUE;
}

/// The origin's levels become what its views can share, here and on the nodes.
void share_storage(Context& c, Texture& keeper) {
    const GLint levels = static_cast<GLint>(keeper.view.levels);
    if (blocks_format(keeper.faces[0][0].internal_format) != 0)
        for (unsigned face = 0; face < glapi::face_count(keeper.info); ++face)
            for (GLint level = 0; level < levels; ++level) keep_as_blocks(c, keeper, face, level, "glTextureView");
    std::lock_guard lock(c.share().mutex);
    if (keeper.storage_stamp != 0) return;
    keeper.storage_stamp = next_stamp();
    touch(c.share(), keeper);
}

void make_view(Context& c, const std::shared_ptr<Texture>& origin, const glapi::TextureTargetInfo& target,
               const Request& request, GLuint levels, GLuint layers) {
    const auto keeper = origin->view.origin ? origin->view.origin : origin;
    before_texels_change(c, *keeper);
    share_storage(c, *keeper);
    std::lock_guard lock(c.share().mutex);
    const auto view = make_texture(c, request.name, target.id);
    view->view = {keeper, origin->view.first_level + request.first_level,
                  levels, origin->view.first_layer + request.first_layer,
                  layers, next_stamp()};
    view->immutable_levels = origin->immutable_levels;
    describe_view(*view, static_cast<GLint>(request.internal_format));
    ++keeper->views;
    c.share().textures.put(request.name, view);
    touch(c.share(), *view);
}

void view_texture(Context& c, GLuint origin_name, const Request& request) {
    const auto origin = origin_named(c, origin_name);
    if (!origin) return;
    if (const GLenum error = name_error(c, request.name)) return c.error(error);
    const auto* target = target_of(request.target);
    if (!target || !may_show(origin->info, *target)) return c.error(GL_INVALID_OPERATION);
    if (request.first_level >= origin->view.levels || request.first_layer >= origin->view.layers)
        return c.error(GL_INVALID_VALUE);
    const GLint of = origin->faces[0][0].internal_format, as = static_cast<GLint>(request.internal_format);
    if (!may_view(of, as)) return c.error(GL_INVALID_OPERATION);
    const GLuint levels = std::min(request.levels, origin->view.levels - request.first_level),
                 layers = std::min(request.layers, origin->view.layers - request.first_layer);
    if (const GLenum error = cube_error(*target, layers)) return c.error(error);
    if (levels == 0 || layers == 0) return c.error(GL_INVALID_OPERATION);
    if (const GLenum error = shape_error(c, *origin, *target, request, layers)) return c.error(error);
    make_view(c, origin, *target, request, levels, layers);
}

}  // namespace

void TextureView(Context& c, GLuint texture, GLenum target, GLuint origin, GLenum internal_format, GLuint first_level,
                 GLuint levels, GLuint first_layer, GLuint layers) {
    view_texture(c, origin, {texture, target, internal_format, first_level, levels, first_layer, layers});
}

}  // namespace wall::client::api
