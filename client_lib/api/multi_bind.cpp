// SPDX-License-Identifier: MIT
// Several textures and samplers at once (GL_ARB_multi_bind; OpenGL 4.4), and a texture of whatever target to a unit
// (OpenGL 4.5). What is wrong with one name leaves the others alone. Buffers: indexed_buffers.cpp,
// vertex_attributes.cpp.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>

#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

/// All targets of a unit have their default textures again.
void bind_defaults(Context& c, unsigned unit) {
    for (const auto& info : glapi::kTextureTargetInfo) {
        ClientName id;
        {
            std::lock_guard lock(c.share().mutex);
            id = default_id(c.share(), info.id);
        }
        set_bound_id(c, unit, info.id, id);
    }
}

/// False: it is no texture.
bool bind_to_unit(Context& c, unsigned unit, GLuint name) {
    if (name == 0) return bind_defaults(c, unit), true;
    std::shared_ptr<Texture> texture;
    {
        std::lock_guard lock(c.share().mutex);
        texture = c.share().textures.find(name);
        if (!texture) return false;
        auto& users = texture->bound_by;
        if (std::ranges::find(users, c.id) == users.end()) users.push_back(c.id);
    }
    set_bound_id(c, unit, texture->info.id, texture->id);
    return true;
}

/// Whether so many places from the first on are there; else GL_INVALID_OPERATION.
bool check_places(Context& c, GLuint first, GLsizei count, unsigned places) {
    if (count < 0) return c.error(GL_INVALID_VALUE), false;
    const bool there = std::uint64_t{first} + static_cast<std::uint64_t>(count) <= places;
    if (!there) c.error(GL_INVALID_OPERATION);
    return there;
}

}  // namespace

void BindTextureUnit(Context& c, GLuint unit, GLuint name) {
    if (unit >= kTextureImageUnits) return c.error(GL_INVALID_VALUE);
    if (!bind_to_unit(c, unit, name)) c.error(GL_INVALID_OPERATION);
}

void BindTextures(Context& c, GLuint first, GLsizei count, const GLuint* names) {
    if (!check_places(c, first, count, kTextureImageUnits)) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i)
        if (!bind_to_unit(c, first + i, names ? names[i] : 0)) c.error(GL_INVALID_OPERATION);
}

void BindSamplers(Context& c, GLuint first, GLsizei count, const GLuint* names) {
    if (!check_places(c, first, count, glstate::el::sampler_binding::count)) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) BindSampler(c, first + i, names ? names[i] : 0);
}

}  // namespace wall::client::api
