// SPDX-License-Identifier: MIT
// glDrawBuffers for the default framebuffer, which has one fragment colour (GL_MAX_DRAW_BUFFERS is 1).
#include "client_lib/context/context.h"

namespace wall::client::api {
namespace {

constexpr GLsizei kDrawBuffers = 1;

/// OpenGL 2.1, table 4.5: names of single buffers only.
bool names_one(GLenum buffer) {
    return buffer == GL_NONE || buffer == GL_BACK || (buffer >= GL_FRONT_LEFT && buffer <= GL_BACK_RIGHT);
}

}  // namespace

void DrawBuffers(Context& c, GLsizei count, const GLenum* buffers) {
    if (count < 0 || count > kDrawBuffers) return c.error(GL_INVALID_VALUE);
    const GLenum buffer = count == 0 ? GLenum{GL_NONE} : buffers[0];
    if (!names_one(buffer)) return c.error(GL_INVALID_ENUM);
    DrawBuffer(c, buffer);
}

}  // namespace wall::client::api
