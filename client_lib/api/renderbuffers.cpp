// SPDX-License-Identifier: MIT
// Renderbuffer objects (OpenGL 4.6, 9.2.4 to 9.2.6). The order of the checks is Mesa's (fbobject.c).
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/limits.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/renderbuffer.h"

namespace wall::client::api {
namespace {

constexpr GLsizei kUsualSize = 16384;

/// OpenGL ES has storage of sized formats only (OpenGL ES 2.0, 4.4.3), and none that nothing could be drawn to.
bool is_es_storage(unsigned version, GLenum internal_format, const TextureFormat& format) {
    if (internal_format == GL_STENCIL_INDEX) return false;
    return (format.base == GL_STENCIL_INDEX || is_sized(format)) && es_is_drawn(version, format.answer);
}

GLsizei most_samples_of(Context& c, const TextureFormat& format) {
    if (!has_samples_of_integers(c.profile) && format.whole()) return 0;
    return static_cast<GLsizei>(limit_of(c.caps(), GL_MAX_SAMPLES, kUsualSamples));
}

void delete_renderbuffer(Context& c, GLuint name) {
    std::shared_ptr<Renderbuffer> renderbuffer;
    {
        std::lock_guard lock(c.share().mutex);
        renderbuffer = c.share().renderbuffers.erase(name);
    }
    if (!renderbuffer) return;
    if (c.framebuffers->renderbuffer == renderbuffer) c.framebuffers->renderbuffer = nullptr;
    detach_from_bound(c, *renderbuffer);
    renderbuffer->orphan = true;
    forget_orphan(c, *renderbuffer);
}

}  // namespace

void GenRenderbuffers(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    const GLuint first = c.share().renderbuffers.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; names && i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteRenderbuffers(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    c.flush_block();
    for (GLsizei i = 0; i < count; ++i)
        if (names[i] != 0) delete_renderbuffer(c, names[i]);
}

GLboolean IsRenderbuffer(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return name != 0 && c.share().renderbuffers.find(name) != nullptr;
}

// A name need not have been generated, as for framebuffers.
void BindRenderbuffer(Context& c, GLenum target, GLuint name) {
    if (target != GL_RENDERBUFFER) return c.error(GL_INVALID_ENUM);
    if (name == 0) return c.framebuffers->renderbuffer.reset();
    ShareGroup& share = c.share();
    std::lock_guard lock(share.mutex);
    auto renderbuffer = share.renderbuffers.find(name);
    if (!renderbuffer) {
        if (c.profile.core && !share.renderbuffers.known(name)) return c.error(GL_INVALID_OPERATION);
        renderbuffer = std::make_shared<Renderbuffer>(name);
        share.renderbuffers.put(name, renderbuffer);
        share.by_id[renderbuffer->id] = renderbuffer;
    }
    c.framebuffers->renderbuffer = std::move(renderbuffer);
}

void RenderbufferStorageMultisample(Context& c, GLenum target, GLsizei samples, GLenum internal_format, GLsizei width,
                                    GLsizei height) {
    if (target != GL_RENDERBUFFER) return c.error(GL_INVALID_ENUM);
    const auto renderbuffer = c.framebuffers->renderbuffer;
    if (!renderbuffer) return c.error(GL_INVALID_OPERATION);
    const TextureFormat* format = find_renderbuffer_format(internal_format);
    if (!format || (c.profile.is_es() && !is_es_storage(c.profile.es, internal_format, *format)))
        return c.error(GL_INVALID_ENUM);
    const auto most = static_cast<GLsizei>(limit_of(c.caps(), GL_MAX_RENDERBUFFER_SIZE, kUsualSize));
    if (width < 0 || width > most || height < 0 || height > most) return c.error(GL_INVALID_VALUE);
    const GLsizei most_samples = most_samples_of(c, *format);
    if (samples < 0) return c.error(GL_INVALID_VALUE);
    if (samples > most_samples) return c.error(GL_INVALID_OPERATION);  // GL_ARB_internalformat_query
    c.flush_block();
    c.before_change(renderbuffer->id);
    std::lock_guard lock(c.share().mutex);
    renderbuffer->define(rounded_samples(samples, most_samples), internal_format, static_cast<std::uint32_t>(width),
                         static_cast<std::uint32_t>(height));
    c.share().last_change.store(renderbuffer->latest(), std::memory_order_release);
}

void RenderbufferStorage(Context& c, GLenum target, GLenum internal_format, GLsizei width, GLsizei height) {
    RenderbufferStorageMultisample(c, target, 0, internal_format, width, height);
}

void GetRenderbufferParameteriv(Context& c, GLenum target, GLenum pname, GLint* value) {
    if (target != GL_RENDERBUFFER) return c.error(GL_INVALID_ENUM);
    const auto renderbuffer = c.framebuffers->renderbuffer;
    if (!renderbuffer) return c.error(GL_INVALID_OPERATION);
    std::lock_guard lock(c.share().mutex);
    ComponentBits bits{};
    if (const auto shape = shape_of(Attachment{.renderbuffer = renderbuffer})) bits = shape->bits;
    switch (pname) {
        case GL_RENDERBUFFER_WIDTH: *value = static_cast<GLint>(renderbuffer->width()); break;
        case GL_RENDERBUFFER_HEIGHT: *value = static_cast<GLint>(renderbuffer->height()); break;
        case GL_RENDERBUFFER_INTERNAL_FORMAT: *value = static_cast<GLint>(renderbuffer->internal_format()); break;
        case GL_RENDERBUFFER_RED_SIZE: *value = bits.red; break;
        case GL_RENDERBUFFER_GREEN_SIZE: *value = bits.green; break;
        case GL_RENDERBUFFER_BLUE_SIZE: *value = bits.blue; break;
        case GL_RENDERBUFFER_ALPHA_SIZE: *value = bits.alpha; break;
        case GL_RENDERBUFFER_DEPTH_SIZE: *value = bits.depth; break;
        case GL_RENDERBUFFER_STENCIL_SIZE: *value = bits.stencil; break;
        case GL_RENDERBUFFER_SAMPLES: *value = static_cast<GLint>(renderbuffer->samples()); break;
        default: c.error(GL_INVALID_ENUM);
    }
}

}  // namespace wall::client::api
