// SPDX-License-Identifier: MIT
// What a program does not need any more (GL_ARB_invalidate_subdata; OpenGL 4.6, 6.5, 8.20 and 17.4.4; OpenGL ES 3.0,
// 4.5; GL_EXT_discard_framebuffer). These are hints, of which nothing is made: what is drawn again needs no clearing.
// The order of the checks is Mesa's (fbobject.c, texobj.c, bufferobj.c).
#include <cstdint>

#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"

namespace wall::client::api {
namespace {

/// A buffer of a window by the name that these commands have for it.
bool is_window_buffer(const Context& c, GLenum word) {
    if (word == GL_COLOR || word == GL_DEPTH || word == GL_STENCIL) return true;
    if (c.profile.is_es()) return false;
    if (word >= GL_FRONT_LEFT && word <= GL_BACK_RIGHT) return true;
    return !c.profile.core && (word == GL_ACCUM || (word >= GL_AUX0 && word <= GL_AUX3));
}

GLenum attachment_error(GLenum point) {
    if (point == GL_DEPTH_STENCIL_ATTACHMENT || glstate::attachment_place(point)) return GL_NO_ERROR;
    const bool color = point >= GL_COLOR_ATTACHMENT0 && point <= GL_COLOR_ATTACHMENT0 + 31;
    return color ? GL_INVALID_OPERATION : GL_INVALID_ENUM;
}

void invalidate_framebuffer(Context& c, GLenum target, GLsizei count, const GLenum* points) {
    const auto* binding = framebuffer_binding(c, target);
    if (!binding) return c.error(GL_INVALID_ENUM);
    if (count < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < count; ++i) {
        const GLenum window_error = is_window_buffer(c, points[i]) ? GL_NO_ERROR : GL_INVALID_ENUM;
        if (const GLenum error = *binding ? attachment_error(points[i]) : window_error) return c.error(error);
    }
}

std::shared_ptr<Texture> texture_named(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return name == 0 ? nullptr : c.share().textures.find(name);
}

/// Null, and an error: no such texture, or it cannot have that level.
std::shared_ptr<Texture> texture_with(Context& c, GLuint name, GLint level) {
    auto texture = texture_named(c, name);
    if (texture && level >= 0 && level < level_count(c, texture->info.target)) return texture;
    c.error(GL_INVALID_VALUE);
    return nullptr;
}

bool lies_inside(GLint at, GLsizei size, GLint all) { return at >= 0 && size >= 0 && std::int64_t{at} + size <= all; }

/// A range of a buffer that may go, or the `whole` of it; nothing of what is mapped may.
void invalidate_buffer(Context& c, GLuint name, GLintptr offset, GLsizeiptr length, bool whole) {
    std::lock_guard lock(c.share().mutex);
    const auto buffer = name == 0 ? nullptr : c.share().buffers.find(name);
    if (!buffer) return c.error(GL_INVALID_VALUE);
    const auto have = static_cast<GLsizeiptr>(buffer->size());
    if (!whole && (offset < 0 || length < 0 || offset > have || length > have - offset))
        return c.error(GL_INVALID_VALUE);
    if (!buffer->blocked()) return;
    const ByteRange mapped = buffer->mapping()->range;
    const auto begin = static_cast<std::size_t>(offset), end = begin + static_cast<std::size_t>(length);
    if (whole || (begin < mapped.end && end > mapped.begin)) c.error(GL_INVALID_OPERATION);
}

}  // namespace

void InvalidateFramebuffer(Context& c, GLenum target, GLsizei count, const GLenum* points) {
    invalidate_framebuffer(c, target, count, points);
}

void InvalidateSubFramebuffer(Context& c, GLenum target, GLsizei count, const GLenum* points, GLint, GLint,
                              GLsizei width, GLsizei height) {
    if (framebuffer_binding(c, target) && (width < 0 || height < 0)) return c.error(GL_INVALID_VALUE);
    invalidate_framebuffer(c, target, count, points);
}

void DiscardFramebufferEXT(Context& c, GLenum target, GLsizei count, const GLenum* points) {
    invalidate_framebuffer(c, target, count, points);
}

void InvalidateTexImage(Context& c, GLuint name, GLint level) { texture_with(c, name, level); }

void InvalidateTexSubImage(Context& c, GLuint name, GLint number, GLint x, GLint y, GLint z, GLsizei width,
                           GLsizei height, GLsizei depth) {
    const auto texture = texture_with(c, name, number);
    if (!texture) return;
    std::lock_guard lock(c.share().mutex);
    const TextureLevel* level = texture->find_level(0, number);
    const GLint faces = static_cast<GLint>(glapi::face_count(texture->info));
    const GLint all_depth = level && texture->info.first_face != 0 ? faces : level ? level->depth : 0;
    if (!lies_inside(x, width, level ? level->width : 0) || !lies_inside(y, height, level ? level->height : 0) ||
        !lies_inside(z, depth, all_depth))
        c.error(GL_INVALID_VALUE);
}

void InvalidateBufferData(Context& c, GLuint name) { invalidate_buffer(c, name, 0, 0, true); }
void InvalidateBufferSubData(Context& c, GLuint name, GLintptr offset, GLsizeiptr length) {
    invalidate_buffer(c, name, offset, length, false);
}

}  // namespace wall::client::api
