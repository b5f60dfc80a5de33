// SPDX-License-Identifier: MIT
// Objects that a command names instead of taking what is bound (GL_ARB_direct_state_access; OpenGL 4.5). While one of
// these lives, the object is bound where the command for bound objects looks for it; then all is bound as before, and
// states have the value ids that they had, so that nothing is compared or sent because of it. commands.toml says which
// commands are done so (`named`). Each is false, and GL_INVALID_OPERATION is set, where there is no such object. The
// context's thread.
#pragma once

#include <cstdint>
#include <memory>

#include "client_lib/context/context.h"
#include "client_lib/objects/framebuffer.h"
#include "client_lib/objects/renderbuffer.h"
#include "client_lib/objects/texture.h"

namespace wall::client {

class NamedBuffer {
public:
    NamedBuffer(Context& c, GLuint name);
    ~NamedBuffer();
    NamedBuffer(const NamedBuffer&) = delete;
    explicit operator bool() const { return bound_; }
    static constexpr GLenum target() { return GL_COPY_WRITE_BUFFER; }

private:
    Context& c_;
    bool bound_ = false;
    std::uint32_t before_ = 0;
};

class NamedTexture {
public:
    NamedTexture(Context& c, GLuint name);
    ~NamedTexture();
    NamedTexture(const NamedTexture&) = delete;
    explicit operator bool() const { return texture_ != nullptr; }
    GLenum target() const { return texture_->info.target; }
    const std::shared_ptr<Texture>& texture() const { return texture_; }

private:
    Context& c_;
    std::shared_ptr<Texture> texture_;
    unsigned unit_ = 0;
    ClientName before_;
    std::uint64_t id_before_ = 0, id_meanwhile_ = 0;  ///< of the states' values
};

/// The same where the command is about one image: a cube map's first face.
class NamedImage : public NamedTexture {
public:
    using NamedTexture::NamedTexture;
    GLenum target() const;
};

/// Name 0: the window's own. Bound to be drawn to and read from.
class NamedFramebuffer {
public:
    NamedFramebuffer(Context& c, GLuint name);
    ~NamedFramebuffer();
    NamedFramebuffer(const NamedFramebuffer&) = delete;
    explicit operator bool() const { return bound_; }
    static constexpr GLenum target() { return GL_FRAMEBUFFER; }

private:
    Context& c_;
    bool bound_ = false;
    std::shared_ptr<Framebuffer> draw_, read_;  ///< before
};

class NamedRenderbuffer {
public:
    NamedRenderbuffer(Context& c, GLuint name);
    ~NamedRenderbuffer();
    NamedRenderbuffer(const NamedRenderbuffer&) = delete;
    explicit operator bool() const { return bound_; }
    static constexpr GLenum target() { return GL_RENDERBUFFER; }

private:
    Context& c_;
    bool bound_ = false;
    std::shared_ptr<Renderbuffer> before_;
};

/// Name 0 is one in compatibility contexts.
class NamedVertexArray {
public:
    NamedVertexArray(Context& c, GLuint name);
    ~NamedVertexArray();
    NamedVertexArray(const NamedVertexArray&) = delete;
    explicit operator bool() const { return bound_; }

private:
    Context& c_;
    bool bound_ = false;
    GLuint before_ = 0;
};

}  // namespace wall::client
