// SPDX-License-Identifier: MIT
#include "tileserver/execute/image_check.h"

#include <string>

#include "common/glapi/image.h"

namespace wall::tileserver {

bool image_fits(Execution& execution, GLenum format, GLenum type, const ImageExtent& extent,
                std::span<const std::byte> pixels) {
    const auto bytes = glapi::image_bytes(format, type, extent.width, extent.height, extent.depth);
    if (!bytes) execution.refuse("no such format, type or size");
    else if (*bytes != pixels.size())
        execution.refuse("image has " + std::to_string(pixels.size()) + " bytes, expected " + std::to_string(*bytes));
    return !execution.refused();
}

}  // namespace wall::tileserver
