// SPDX-License-Identifier: MIT
// What every node of a session does with images that it holds, so that their content need not travel: copies of texels
// (glCopyImageSubData) and mipmaps of views. The content is the nodes' alone from then on (docs/framebuffers.md). The
// application's thread; no mutex is held.
#pragma once

#include <cstdint>
#include <memory>

#include "client_lib/context/context.h"
#include "client_lib/objects/renderbuffer.h"
#include "client_lib/objects/texture.h"

namespace wall::client {

/// An image by what it belongs to, one of both; layers as OpenGL counts them there (glCopyImageSubData).
struct WorkedImage {
    std::shared_ptr<Texture> texture;
    std::shared_ptr<Renderbuffer> renderbuffer;
    GLint level = 0, x = 0, y = 0, z = 0;

    GLenum target() const { return texture ? texture->info.target : GLenum{GL_RENDERBUFFER}; }
    std::shared_ptr<const Object> object() const;
};

struct WorkedSize {
    GLsizei width = 0, height = 0, depth = 0;  ///< texels of what is copied from
};

/// Copies texels as they are stored; the arguments have been checked.
void copy_images_on_nodes(Context& c, const WorkedImage& from, const WorkedImage& to, const WorkedSize& size);

/// Makes the levels behind the base level of a view.
void make_view_mipmaps(Context& c, const std::shared_ptr<Texture>& view);

}  // namespace wall::client
