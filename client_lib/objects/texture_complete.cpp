// SPDX-License-Identifier: MIT
#include "client_lib/objects/texture_complete.h"

#include <algorithm>

namespace wall::client {
namespace {

struct Size {
    std::int32_t width, height, depth;
};

/// Whether a level is there, of that size and the base level's format, for all faces.
bool has_level(const Texture& texture, GLint number, const Size& size, GLint internal_format) {
    for (unsigned face = 0; face < glapi::face_count(texture.info); ++face) {
        const TextureLevel* level = texture.find_level(face, number);
        if (!level || level->width != size.width || level->height != size.height || level->depth != size.depth ||
            level->internal_format != internal_format)
            return false;
    }
    return true;
}

}  // namespace

bool has_complete_images(const Texture& texture) {
    const TexParameters& p = texture.parameters;
    const auto last_kept = static_cast<GLint>(texture.view.levels) - 1;
    const bool for_good = texture.immutable_levels != 0;
    const GLint first = for_good ? std::min(p.base_level, last_kept) : p.base_level;
    const TextureLevel* base = texture.find_level(0, first);
    if (!base || p.max_level < p.base_level) return false;
    Size size{base->width, base->height, base->depth};
    if (size.width == 0 || size.height == 0 || size.depth == 0) return false;
    if (texture.info.square && size.width != size.height) return false;
    if (!has_level(texture, first, size, base->internal_format)) return false;
    if (p.min_filter == GL_NEAREST || p.min_filter == GL_LINEAR || !texture.info.mipmaps) return true;
    const unsigned spatial = glapi::spatial_dimensions_of(texture.info);
    const GLint last = for_good ? std::min(p.max_level, last_kept) : p.max_level;
    for (GLint number = first + 1; number <= last; ++number) {
        if (size.width == 1 && (spatial < 2 || size.height == 1) && (spatial < 3 || size.depth == 1)) break;
        size.width = std::max(1, size.width / 2);
        if (spatial > 1) size.height = std::max(1, size.height / 2);
        if (spatial > 2) size.depth = std::max(1, size.depth / 2);
        if (!has_level(texture, number, size, base->internal_format)) return false;
    }
    return true;
}

}  // namespace wall::client
