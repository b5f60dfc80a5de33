// SPDX-License-Identifier: MIT
// Texels that only the nodes have, because they drew them (DESIGN, section 4: drawn content), made mipmaps of them, or
// can decode them. The application's thread.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/context/texture_image.h"

namespace wall::client {

/// All texels of a level, from a node; 0 where none answers. Nothing: the client has them itself, or there is no such
/// level. Counted as round trips of `function`.
std::optional<TexelData> drawn_texels(Context& c, const std::shared_ptr<Texture>& texture, unsigned face, GLint number,
                                      const char* function);

}  // namespace wall::client
