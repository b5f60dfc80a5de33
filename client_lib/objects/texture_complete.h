// SPDX-License-Identifier: MIT
// Whether a texture's images fit together (OpenGL 4.5, 8.17). Pure; the share group's mutex is held.
#pragma once

#include "client_lib/objects/texture.h"

namespace wall::client {

/// Whether its images are such that it can be sampled by its own filters, whatever their format: all levels if those
/// take mipmaps, else the base level.
bool has_complete_images(const Texture& texture);

}  // namespace wall::client
