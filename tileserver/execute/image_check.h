// SPDX-License-Identifier: MIT
// Whether the pixels of a command are an image of its size. Render thread.
#pragma once

#include <span>

#include "tileserver/driver/image_extent.h"
#include "tileserver/execute/execution.h"

namespace wall::tileserver {

/// False: the command has been refused.
[[nodiscard]] bool image_fits(Execution& execution, GLenum format, GLenum type, const ImageExtent& extent,
                              std::span<const std::byte> pixels);

}  // namespace wall::tileserver
