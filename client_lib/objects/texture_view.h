// SPDX-License-Identifier: MIT
// Views of textures (glTextureView; OpenGL 4.5, 8.18): the origin keeps all texels, whichever texture they come
// through, and a view's own images hold them only while they are read. Layers are counted over faces, rows of
// one-dimensional arrays or slices, whichever a target has. The share group's mutex is held.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client_lib/objects/texture.h"

namespace wall::client {

/// A part of a texture's image and where its texels are kept.
struct KeptPart {
    TexBox part;  ///< in the image
    unsigned face = 0;
    GLint level = 0;
    TexBox box;  ///< in the keeper's image, of the same size
};

/// Whose images keep the texels of a texture: its own, or its origin's.
inline Texture& keeper_of(Texture& texture) { return texture.view.origin ? *texture.view.origin : texture; }
/// The parts of a box of an image (`face`, `level`), layer by layer where the texture is a view.
std::vector<KeptPart> kept_parts(const Texture& texture, unsigned face, GLint level, const TexBox& box);

/// Layers that a texture's images have: those of an array, a cube map's faces, else 1.
std::uint32_t layer_count(const Texture& texture);
/// Makes the images that a view of that target and format has: `view.view` says which part of its origin it is.
void describe_view(Texture& view, GLint internal_format);
/// Before an image of a texture is read: if it is a view's, it has what its origin has there.
void refresh_view(Texture& texture, unsigned face, GLint level);

/// Texels of the one kind as those of the other; nothing comes between whose texels are stored alike. `count` of them.
std::vector<std::byte> converted_texels(const PixelKind& from, std::vector<std::byte> bytes, std::size_t count,
                                        const PixelKind& to);
/// A box of a level that has pixels, tight, in a kind.
std::vector<std::byte> cut_texels(const TextureLevel& level, const TexBox& box, const PixelKind& kind);
/// Blocks of a box of a level that has some, of whole blocks.
std::vector<std::byte> cut_blocks(const TextureLevel& level, const TexBox& box);

}  // namespace wall::client
