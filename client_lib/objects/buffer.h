// SPDX-License-Identifier: MIT
// Buffer objects: their content lives in the client, whose vertex arrays and pixel transfers read it.
// Guarded by the share group's mutex.
#pragma once

#include <cstdint>
#include <vector>

#include "common/glapi/gl_types.h"

namespace wall::client {

struct Buffer {
    Buffer(std::uint32_t own_id, GLuint own_name) : id(own_id), name(own_name) {}
    const std::uint32_t id;  ///< in state elements and client arrays
    const GLuint name;       ///< the application's

    std::vector<std::byte> content;
    GLenum usage = GL_STATIC_DRAW;
    GLenum access = GL_READ_WRITE;  ///< of the latest glMapBuffer
    bool mapped = false;
    std::uint64_t stamp = 0;  ///< of the latest change
};

}  // namespace wall::client
