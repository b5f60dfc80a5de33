// SPDX-License-Identifier: MIT
// glDrawBuffers (OpenGL 4.6, 17.4.1).
#include <algorithm>
#include <array>

#include "client_lib/context/framebuffer_binding.h"

namespace wall::client::api {
namespace {

using glstate::kColorAttachments;

/// OpenGL 2.1, table 4.5: names of single buffers only.
bool names_one(GLenum buffer) {
    return buffer == GL_NONE || buffer == GL_BACK || (buffer >= GL_FRONT_LEFT && buffer <= GL_BACK_RIGHT);
}

bool names_attachment(GLenum buffer) { return buffer >= GL_COLOR_ATTACHMENT0 && buffer <= GL_COLOR_ATTACHMENT0 + 31; }

using Buffers = std::array<GLenum, kColorAttachments>;

/// Those of a framebuffer object; each may be named once.
GLenum attachments_error(const Buffers& buffers) {
    for (unsigned i = 0; i < buffers.size(); ++i) {
        if (buffers[i] == GL_NONE) continue;
        if (names_one(buffers[i])) return GL_INVALID_OPERATION;
        if (!names_attachment(buffers[i])) return GL_INVALID_ENUM;
        if (buffers[i] >= GL_COLOR_ATTACHMENT0 + kColorAttachments) return GL_INVALID_OPERATION;
        for (unsigned j = 0; j < i; ++j)
            if (buffers[j] == buffers[i]) return GL_INVALID_OPERATION;
    }
    return GL_NO_ERROR;
}

/// OpenGL ES has a window's one buffer by one name, and each colour has a place of its own (EXT_draw_buffers; OpenGL
/// ES 3.0, 4.2.1).
GLenum es_error(const Buffers& buffers, GLsizei count, bool window) {
    if (window && (count != 1 || (buffers[0] != GL_NONE && buffers[0] != GL_BACK))) return GL_INVALID_OPERATION;
    for (unsigned i = 0; !window && i < buffers.size(); ++i)
        if (buffers[i] != GL_NONE && buffers[i] != GL_COLOR_ATTACHMENT0 + i) return GL_INVALID_OPERATION;
    return GL_NO_ERROR;
}

}  // namespace

// A window has one fragment colour; those that follow it must go nowhere.
void DrawBuffers(Context& c, GLsizei count, const GLenum* words) {
    if (count < 0 || count > static_cast<GLsizei>(kColorAttachments)) return c.error(GL_INVALID_VALUE);
    Buffers buffers{};
    std::copy_n(words, count, buffers.begin());
    if (c.profile.is_es()) {
        const bool window = c.framebuffers->draw == nullptr;
        if (const GLenum error = es_error(buffers, count, window)) return c.error(error);
        const bool single = window && c.draw_target() && !c.draw_target().format().double_buffered;
        if (window) return DrawBuffer(c, single && buffers[0] == GL_BACK ? GLenum{GL_FRONT} : buffers[0]);
    }
    if (const auto framebuffer = c.framebuffers->draw) {
        if (const GLenum error = attachments_error(buffers)) return c.error(error);
        return change_framebuffer(c, *framebuffer, [&](Framebuffer& f) { f.set_draw_buffers(buffers); });
    }
    for (const GLenum buffer : buffers)
        if (!names_one(buffer)) return c.error(names_attachment(buffer) ? GL_INVALID_OPERATION : GL_INVALID_ENUM);
    for (unsigned i = 1; i < buffers.size(); ++i)
        if (buffers[i] != GL_NONE) return c.error(GL_INVALID_OPERATION);
    DrawBuffer(c, buffers[0]);
}

}  // namespace wall::client::api
