// SPDX-License-Identifier: MIT
// Images of textures for shaders (OpenGL 4.2, 3.9.20; glBindImageTextures: OpenGL 4.4, 8.26).
#include "common/glapi/image_units.h"

#include <memory>
#include <mutex>
#include <optional>

#include "client_lib/context/context.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

constexpr glstate::ImageUnit kNoImage{0, 0, 0, 0, GL_READ_ONLY, GL_R8};

std::shared_ptr<Texture> texture_of(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().textures.find(name);
}

bool has_layers(const Texture& texture) {
    return texture.info.layers != 0 || texture.info.first_face != 0 || texture.info.images == 3;
}

/// Layers of what has none are not looked at.
void bind(Context& c, GLuint unit, const std::shared_ptr<Texture>& texture, glstate::ImageUnit image) {
    c.memory->any = true;
    image.texture = texture ? texture->id.value : 0;
    if (!texture || !has_layers(*texture)) image.layered = image.layer = 0;
    c.set<el::image_unit>(unit, image);
}

/// As a whole, to be read and written, as it is stored; nothing: it has no image that a shader can take.
std::optional<glstate::ImageUnit> whole_image(Context& c, const Texture& texture) {
    std::lock_guard lock(c.share().mutex);
    const bool of_buffer = texture.info.id == glapi::TextureTarget::buffer;
    const TextureLevel* level = of_buffer ? nullptr : texture.find_level(0, 0);
    if (!of_buffer && (level == nullptr || level->width == 0 || level->height == 0 || level->depth == 0)) return {};
    const auto format = of_buffer ? texture.part.internal_format : static_cast<GLenum>(level->internal_format);
    if (!glapi::is_image_unit_format(format)) return {};
    return glstate::ImageUnit{0, 0, 1, 0, GL_READ_WRITE, format};
}

}  // namespace

void BindImageTexture(Context& c, GLuint unit, GLuint name, GLint level, GLboolean layered, GLint layer, GLenum access,
                      GLenum format) {
    if (unit >= el::image_unit::count || level < 0 || layer < 0) return c.error(GL_INVALID_VALUE);
    if (!glapi::is_image_access(access) || !glapi::is_image_unit_format(format)) return c.error(GL_INVALID_VALUE);
    const auto texture = name != 0 ? texture_of(c, name) : nullptr;
    if (name != 0 && !texture) return c.error(GL_INVALID_VALUE);
    if (texture && c.profile.is_es() && texture->immutable_levels == 0 &&
        texture->info.id != glapi::TextureTarget::buffer)
        return c.error(GL_INVALID_OPERATION);
    bind(c, unit, texture, {0, level, layered != GL_FALSE, layer, access, format});
}

// Each unit for itself: an error leaves the others bound.
void BindImageTextures(Context& c, GLuint first, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    if (first > el::image_unit::count || static_cast<GLuint>(count) > el::image_unit::count - first)
        return c.error(GL_INVALID_OPERATION);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        if (!names || names[i] == 0) {
            bind(c, first + i, nullptr, kNoImage);
            continue;
        }
        const auto texture = texture_of(c, names[i]);
        const auto image = texture ? whole_image(c, *texture) : std::nullopt;
        if (image) bind(c, first + i, texture, *image);
        else c.error(GL_INVALID_OPERATION);
    }
}

}  // namespace wall::client::api
