// SPDX-License-Identifier: MIT
// Which texture object a context's texture unit has at a target, and changing it. The application's thread.
#pragma once

#include <memory>
#include <vector>

#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/context.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

/// Id at a target of a unit: 0 is the default texture without content.
ClientName bound_id(const Context& c, unsigned unit, glapi::TextureTarget target);
void set_bound_id(Context& c, unsigned unit, glapi::TextureTarget target, ClientName id);

/// The object that the active unit has at a target for reading: null means the default texture without content. The
/// word (of the target, a face or a proxy) has been checked.
std::shared_ptr<Texture> bound_texture(Context& c, GLenum word);
std::shared_ptr<Texture> bound_texture_of(Context& c, unsigned unit, glapi::TextureTarget target);
/// The same for changing: what was drawn so far is sent off first, and a default texture comes into being.
std::shared_ptr<Texture> texture_to_change(Context& c, GLenum word);
/// A new object of the share group. Its mutex is held.
std::shared_ptr<Texture> make_texture(Context& c, GLuint name, glapi::TextureTarget target);
/// To be called after every change of a texture.
void touch(ShareGroup& share, Texture& texture);

/// Name 0 of a target: the id of the default texture, in every context that binds it; none: that has no content. The
/// share group's mutex is held.
ClientName default_id(ShareGroup& share, glapi::TextureTarget target);
/// Parameters of the textures that a context has bound, which glPushAttrib(GL_TEXTURE_BIT) saves too.
std::vector<SavedTexture> bound_texture_parameters(Context& c);
void restore_texture_parameters(Context& c, const std::vector<SavedTexture>& saved);

}  // namespace wall::client
