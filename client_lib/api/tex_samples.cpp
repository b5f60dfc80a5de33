// SPDX-License-Identifier: MIT
// Textures whose texels have several samples (OpenGL 3.2, 3.9.3). They are drawn to and fetched from; no pixels go in
// or out. The order of the checks is Mesa's (teximage.c).
#include "client_lib/context/limits.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/texture_formats.h"
#include "client_lib/objects/texture_view.h"

namespace wall::client::api {
namespace {

/// What several samples may be kept of.
bool renderable(const Context& c, const TextureFormat* format) {
    if (!format || format->use != ImageUse::drawn || format->internal_format <= 4) return false;
    return !c.profile.is_es() || es_is_drawn(c.profile.es, format->answer);
}

GLsizei most_samples(Context& c, const TextureFormat& format) {
    const bool depth = format.base == GL_DEPTH_COMPONENT || format.base == GL_DEPTH_STENCIL;
    const GLenum limit = depth            ? GL_MAX_DEPTH_TEXTURE_SAMPLES
                         : format.whole() ? GL_MAX_INTEGER_SAMPLES
                                          : GL_MAX_COLOR_TEXTURE_SAMPLES;
    return static_cast<GLsizei>(limit_of(c.caps(), limit, kUsualSamples));
}

/// `for_good`: as glTexStorage does.
void define_samples(Context& c, const ImageCall& call, GLsizei samples, GLboolean fixed_places, bool for_good) {
    if (samples < 1 || (for_good && (call.width < 1 || call.height < 1 || call.depth < 1)))
        return c.error(GL_INVALID_VALUE);
    const auto* info = image_target_of(call.target);
    if (!info || !info->samples || glapi::dimensions_of(*info) != call.dimensions) return c.error(c.target_error);
    const TextureFormat* format = find_texture_format(call.internal_format);
    if (for_good && (!format || !is_sized(*format))) return c.error(GL_INVALID_ENUM);
    // OpenGL ES 3.1, 8.8; OpenGL 4.5, 8.8.
    if (!renderable(c, format)) return c.error(c.profile.is_es() ? GL_INVALID_ENUM : GL_INVALID_OPERATION);
    const GLsizei most = most_samples(c, *format);
    const bool allowed = samples <= most, fits = legal_size(c, call);
    TextureLevel level;
    level.internal_format = call.internal_format;
    level.width = call.width, level.height = call.height, level.depth = call.depth;
    level.format = GL_RGBA, level.type = GL_UNSIGNED_BYTE;
    level.samples = allowed ? rounded_samples(samples, most) : 0;
    level.fixed_places = fixed_places != GL_FALSE;
    level.stamp = next_stamp();
    if (is_proxy(call.target)) {
        c.maps->proxies[{call.target, 0}] = allowed && fits ? level : TextureLevel{};
        return;
    }
    if (!allowed || is_immutable(c, call.target)) return c.error(GL_INVALID_OPERATION);
    if (!fits) return c.error(GL_INVALID_VALUE);
    const auto texture = texture_to_change(c, call.target);
    if (for_good && texture->is_default()) return c.error(GL_INVALID_OPERATION);
    std::lock_guard lock(c.share().mutex);
    texture->level_at(0, 0) = level;
    if (for_good) {
        texture->immutable_levels = texture->view.levels = 1;
        texture->view.layers = layer_count(*texture);
    }
    touch(c.share(), *texture);
}

}  // namespace

void TexImage2DMultisample(Context& c, GLenum target, GLsizei samples, GLenum internal, GLsizei width, GLsizei height,
                           GLboolean fixed_places) {
    ImageCall call;
    call.dimensions = 2, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width, call.height = height;
    define_samples(c, call, samples, fixed_places, false);
}

void TexImage3DMultisample(Context& c, GLenum target, GLsizei samples, GLenum internal, GLsizei width, GLsizei height,
                           GLsizei depth, GLboolean fixed_places) {
    ImageCall call;
    call.dimensions = 3, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width, call.height = height, call.depth = depth;
    define_samples(c, call, samples, fixed_places, false);
}

void TexStorage2DMultisample(Context& c, GLenum target, GLsizei samples, GLenum internal, GLsizei width, GLsizei height,
                             GLboolean fixed_places) {
    ImageCall call;
    call.dimensions = 2, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width, call.height = height;
    define_samples(c, call, samples, fixed_places, true);
}

void TexStorage3DMultisample(Context& c, GLenum target, GLsizei samples, GLenum internal, GLsizei width, GLsizei height,
                             GLsizei depth, GLboolean fixed_places) {
    ImageCall call;
    call.dimensions = 3, call.target = target, call.internal_format = static_cast<GLint>(internal);
    call.width = width, call.height = height, call.depth = depth;
    define_samples(c, call, samples, fixed_places, true);
}

}  // namespace wall::client::api
