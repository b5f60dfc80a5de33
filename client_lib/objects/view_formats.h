// SPDX-License-Identifier: MIT
// Which internal formats may stand for the same memory: of textures and their views (OpenGL 4.5, table 8.22), and of
// images between which texels are copied as they are stored (table 18.4). Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "client_lib/objects/texture_formats.h"

namespace wall::client {

/// Formats of one class have texels, or blocks, of one size that mean something else.
enum class ViewClass : std::uint8_t {
    bits_8,
    bits_16,
    bits_24,
    bits_32,
    bits_48,
    bits_64,
    bits_96,
    bits_128,
    rgtc1_red,
    rgtc2_rg,
    s3tc_dxt1_rgb,
    s3tc_dxt1_rgba,
    s3tc_dxt3_rgba,
    s3tc_dxt5_rgba,
};

struct ViewFormat {
    GLint internal_format;
    ViewClass view_class;
    PixelKind texels;  ///< pixels that are the texels in memory; of blocks 0
};

/// Null: only the same format stands for the memory of one of this.
const ViewFormat* find_view_format(GLint internal_format);
/// Whether a texture of the one format may have a view of the other.
bool may_view(GLint of, GLint as);
/// Whether texels, or blocks in place of them, may be copied from an image of the one format to one of the other. `es`:
/// in OpenGL ES, where ETC2 and EAC have rows in the table, too.
bool may_copy_texels(GLint from, GLint to, bool es);

}  // namespace wall::client
