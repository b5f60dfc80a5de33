// SPDX-License-Identifier: MIT
// The calls that define a texture's images, as values (api/tex_image.cpp). The application's thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/texture.h"
#include "common/glapi/image.h"

namespace wall::client {

/// Parameters of glTexImage, glTexSubImage and the copying ones.
struct ImageCall {
    unsigned dimensions = 2;
    GLenum target = 0;
    GLint level = 0;
    GLint internal_format = 0, border = 0;  ///< of glTexImage
    GLint x = 0, y = 0, z = 0;              ///< of glTexSubImage
    GLsizei width = 0, height = 1, depth = 1;
    GLenum format = 0, type = 0;
    const void* pixels = nullptr;
    glapi::PixelStore store;
    bool unsized_depth = false;  ///< of OpenGL ES: it is one, and its size was left open
};

/// Tight pixels in client memory.
struct TexelData {
    GLenum format = 0, type = 0;
    std::vector<std::byte> bytes;
};

/// GL_GENERATE_MIPMAP: after a change of a level, with the share group's mutex held.
void generate_if_asked(Texture& texture, GLint level);

/// How many levels a texture may have of the target that this word, which has been checked, belongs to.
GLint level_count(Context& c, GLenum target);

/// Whether the texture of that target, which has been checked, has all its levels for good.
bool is_immutable(Context& c, GLenum target);

/// Whether an image of that size may be at that level of its target.
bool legal_size(Context& c, const ImageCall& call);

/// glTexImage and glTexSubImage with their checks.
void define_image(Context& c, ImageCall call);
void define_sub_image(Context& c, ImageCall call);
/// The same of pixels that are not held against what OpenGL ES takes of a program (glClearTexImage).
void change_sub_image(Context& c, ImageCall call);
GLenum sub_image_error(Context& c, const ImageCall& call);

/// The same after the checks, with pixels as they are to be stored.
void store_level(Context& c, const ImageCall& call, TexelData data);
void change_level(Context& c, const ImageCall& call, TexelData data);

/// Tight pixels, as they are to be stored, in place of a box of an image (`face`, `level`) that is not kept as blocks;
/// of a view, where they are kept. What was drawn has been sent off. The share group's mutex is held.
void put_texels(ShareGroup& share, Texture& texture, unsigned face, GLint level, const TexBox& box, TexelData data);
/// Before an object is changed that is named and not bound: what was drawn so far is sent off. No mutex is held.
void before_texels_change(Context& c, const Texture& texture);

// ---- blocks (api/tex_compressed.cpp) ----

/// put_texels() of whole blocks, of an image that is kept as such.
void put_blocks(ShareGroup& share, Texture& texture, unsigned face, GLint level, const TexBox& box,
                std::span<const std::byte> blocks);
/// Images of such a format that no pixels were made blocks of yet are kept as blocks from now on.
void keep_as_blocks(Context& c, Texture& texture, unsigned face, GLint level, const char* function);

/// store_level() of blocks that are zeros, of a format that nodes take no pixels for.
void store_empty_blocks(Context& c, const ImageCall& call);

/// What an image of this internal format is compressed to; 0: to nothing that is known here.
GLint blocks_format(GLint internal_format);
/// A level that came as pixels and that the nodes compress becomes what a node's driver makes of it: from now on it is
/// kept and sent as blocks. Nothing happens to any other, or if no node answers.
/// Counted as a round trip of `function`.
void compress_as_driver(Context& c, GLenum target, GLint level, const char* function);
/// change_level() of such a level: the new pixels are compressed by a node. False: no node answers.
bool change_blocks(Context& c, const ImageCall& call, const TexelData& data);

}  // namespace wall::client
