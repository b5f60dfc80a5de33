// SPDX-License-Identifier: MIT
// glPixelStore's values of a context as common/glapi/image.h takes them, and the memory they apply to.
#pragma once

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/context.h"
#include "common/glapi/image.h"

namespace wall::client {

glapi::PixelStore unpack_store(const glstate::State& state);
glapi::PixelStore pack_store(const glstate::State& state);

/// An image in the application's memory, or in a buffer object if one is bound.
struct MemoryImage {
    glapi::ImageSize size;
    GLenum format, type;
};
/// Where the pixels are that an image command reads or writes; null if there are none, or with an error if they reach
/// over the buffer's end.
const void* image_source(Context& c, const MemoryImage& image, const void* pixels);
PackTarget image_target(Context& c, const MemoryImage& image, void* pixels);

}  // namespace wall::client
