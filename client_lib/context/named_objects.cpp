// SPDX-License-Identifier: MIT
#include "client_lib/context/named_objects.h"

#include <mutex>
#include <utility>

#include "client_lib/context/buffer_use.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

constexpr auto kTextures = static_cast<std::size_t>(glstate::Category::textures);

/// Null, and the error is set: there is none of that name.
template <class T>
std::shared_ptr<T> shared_object(Context& c, const NameTable<T>& table, GLuint name) {
    std::shared_ptr<T> found;
    if (name != 0) {
        std::lock_guard lock(c.share().mutex);
        found = table.find(name);
    }
    if (!found) c.error(GL_INVALID_OPERATION);
    return found;
}

}  // namespace

// Nodes know nothing of this binding.
NamedBuffer::NamedBuffer(Context& c, GLuint name) : c_(c), before_(c.state.local.copy_write_buffer) {
    auto buffer = shared_object(c, c.share().buffers, name);
    if (!buffer) return;
    const ClientName id = buffer->id;
    c.buffers->by_id.try_emplace(id, std::move(buffer));
    c.state.local.copy_write_buffer = id.value;
    bound_ = true;
}

NamedBuffer::~NamedBuffer() { c_.state.local.copy_write_buffer = before_; }

NamedTexture::NamedTexture(Context& c, GLuint name)
    : c_(c), texture_(shared_object(c, c.share().textures, name)), unit_(c.active_texture()) {
    if (!texture_) return;
    c.target_error = GL_INVALID_OPERATION;
    before_ = bound_id(c, unit_, texture_->info.id);
    id_before_ = c.state.ids[kTextures];
    set_bound_id(c, unit_, texture_->info.id, texture_->id);
    id_meanwhile_ = c.state.ids[kTextures];
}

NamedTexture::~NamedTexture() {
    c_.target_error = GL_INVALID_ENUM;
    if (!texture_ || before_ == texture_->id) return;
    const bool only_this = c_.state.ids[kTextures] == id_meanwhile_;
    set_bound_id(c_, unit_, texture_->info.id, before_);
    if (only_this) c_.state.ids.take(kTextures, id_before_);
}

GLenum NamedImage::target() const {
    const glapi::TextureTargetInfo& info = texture()->info;
    return info.first_face != 0 ? info.first_face : info.target;
}

NamedFramebuffer::NamedFramebuffer(Context& c, GLuint name)
    : c_(c), draw_(c.framebuffers->draw), read_(c.framebuffers->read) {
    auto framebuffer = name != 0 ? c.framebuffers->names.find(name) : nullptr;
    bound_ = name == 0 || framebuffer;
    if (!bound_) {
        c.error(GL_INVALID_OPERATION);
        return;
    }
    bind_framebuffer(c, GL_FRAMEBUFFER, std::move(framebuffer));
}

NamedFramebuffer::~NamedFramebuffer() {
    if (!bound_) return;
    bind_framebuffer(c_, GL_DRAW_FRAMEBUFFER, std::move(draw_));
    bind_framebuffer(c_, GL_READ_FRAMEBUFFER, std::move(read_));
}

NamedRenderbuffer::NamedRenderbuffer(Context& c, GLuint name) : c_(c), before_(c.framebuffers->renderbuffer) {
    auto renderbuffer = shared_object(c, c.share().renderbuffers, name);
    if (!renderbuffer) return;
    c.framebuffers->renderbuffer = std::move(renderbuffer);
    bound_ = true;
}

NamedRenderbuffer::~NamedRenderbuffer() {
    if (bound_) c_.framebuffers->renderbuffer = std::move(before_);
}

NamedVertexArray::NamedVertexArray(Context& c, GLuint name)
    : c_(c), before_(c.state.vertex_arrays.vertex_array_object) {
    VertexArrayObjects& objects = *c.vertex_array_objects;
    bound_ = name == 0 ? !c.profile.core : objects.exists(name);
    if (bound_) objects.bind(c.state, name);
    else c.error(GL_INVALID_OPERATION);
}

NamedVertexArray::~NamedVertexArray() {
    if (bound_) c_.vertex_array_objects->bind(c_.state, before_);
}

}  // namespace wall::client
