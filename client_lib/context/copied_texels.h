// SPDX-License-Identifier: MIT
// glCopyTexImage and glCopyTexSubImage out of a framebuffer object or window of which every node has all: each copies
// by itself, and what it has copied is drawn content (docs/framebuffers.md). The application's thread.
#pragma once

#include "client_lib/context/texture_image.h"
#include "client_lib/objects/texture_formats.h"

namespace wall::client {

/// Whether nodes can copy so: texels of what is read from, at `x` and `y`, into the image of a call that has been
/// checked, stored as `to` and `bits`. Its format and type are those of the copy. If not, the pixels come here first.
bool can_copy_on_nodes(Context& c, const ImageCall& call, const TextureFormat& to, const ComponentBits& bits, GLint x,
                       GLint y);

/// Copies so; the image is there, and the one above has said yes. No mutex is held.
void copy_on_nodes(Context& c, const ImageCall& call, GLint x, GLint y);

}  // namespace wall::client
