// SPDX-License-Identifier: MIT
// glPushAttrib and glPopAttrib (OpenGL 1.2.1, 6.1.11). What a bit saves is a column of proto/gl/state.toml. A saved
// level is a copy of the whole state: cheaper than picking values, and its value ids tell at glPopAttrib which
// categories have not changed.
#pragma once

#include <memory>
#include <vector>

#include "client_lib/context/vertex_bindings.h"
#include "client_lib/objects/texture.h"
#include "common/glapi/gl_types.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

inline constexpr std::size_t kAttributeStackLimit = 16;

/// A texture's parameters, which glPushAttrib(GL_TEXTURE_BIT) saves of those that are bound.
struct SavedTexture {
    std::shared_ptr<Texture> texture;
    TexParameters parameters;
};

struct SavedAttributes {
    GLbitfield mask = 0;
    glstate::State state;
    std::vector<SavedTexture> textures;             ///< of GL_TEXTURE_BIT
    std::unique_ptr<VertexBindings> bindings = {};  ///< of GL_CLIENT_VERTEX_ARRAY_BIT; null: the arrays have their own
};

struct AttributeStacks {
    std::vector<std::unique_ptr<SavedAttributes>> server,
        client;  ///< glPushAttrib's, glPushClientAttrib's; oldest first
};

/// Gives a category of `state` the value id that it has in `other`, if the content is the same.
void unify_value_ids(glstate::State& state, const glstate::State& other);

}  // namespace wall::client
