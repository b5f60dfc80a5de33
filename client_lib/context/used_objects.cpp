// SPDX-License-Identifier: MIT
#include "client_lib/context/used_objects.h"

#include "client_lib/context/context.h"
#include "client_lib/context/share_group.h"
#include "client_lib/objects/maps.h"

namespace wall::client {
namespace {

namespace el = glstate::el;
using Use = std::function<void(const Object&)>;

template <class E>
void adopt_default(glstate::State& state, ClientName id) {
    for (unsigned unit = 0; unit < E::count; ++unit)
        if (E::ref(state, unit) == 0) glstate::assign<E>(state, unit, id.value);
}

/// Name 0 of a target stands for the default texture that has got content since it was bound: through another context
/// of the group, or before glPopAttrib.
void adopt_default(glstate::State& state, const Texture& texture) {
    switch (texture.target) {
        case GL_TEXTURE_1D: return adopt_default<el::texture_binding_1d>(state, texture.id);
        case GL_TEXTURE_2D: return adopt_default<el::texture_binding_2d>(state, texture.id);
        case GL_TEXTURE_3D: return adopt_default<el::texture_binding_3d>(state, texture.id);
        case GL_TEXTURE_CUBE_MAP: return adopt_default<el::texture_binding_cube_map>(state, texture.id);
        default: return adopt_default<el::texture_binding_rectangle>(state, texture.id);
    }
}

/// Ids of the textures of fixed function. Targets that are not enabled cannot matter.
template <class UseId>
void for_each_enabled(const glstate::State& state, UseId&& use) {
    const auto& enabled = state.texture_units;
    const auto& bound = state.textures;
    for (unsigned unit = 0; unit < kTextureUnits; ++unit) {
        if (enabled.texture_1d_enabled[unit]) use(bound.texture_binding_1d[unit]);
        if (enabled.texture_2d_enabled[unit]) use(bound.texture_binding_2d[unit]);
        if (enabled.texture_3d_enabled[unit]) use(bound.texture_binding_3d[unit]);
        if (enabled.texture_cube_map_enabled[unit]) use(bound.texture_binding_cube_map[unit]);
        if (enabled.texture_rectangle_enabled[unit]) use(bound.texture_binding_rectangle[unit]);
    }
}

/// The same of a program's samplers.
template <class UseId>
void for_each_sampled(const glstate::State& state, const Executable& executable, UseId&& use) {
    const auto& bound = state.textures;
    executable.for_each_sampler([&](std::uint32_t unit, GLenum target) {
        if (unit >= kTextureUnits) return;
        switch (target) {
            case GL_TEXTURE_1D: return use(bound.texture_binding_1d[unit]);
            case GL_TEXTURE_2D: return use(bound.texture_binding_2d[unit]);
            case GL_TEXTURE_3D: return use(bound.texture_binding_3d[unit]);
            case GL_TEXTURE_CUBE_MAP: return use(bound.texture_binding_cube_map[unit]);
            default: return use(bound.texture_binding_rectangle[unit]);
        }
    });
}

}  // namespace

void for_each_used(Context& context, const Use& use) {
    ShareGroup& share = context.share();
    context.maps->for_each(use);
    std::lock_guard lock(share.mutex);
    for (const auto& [target, texture] : share.default_textures) adopt_default(context.state, *texture);
    const auto use_bound = [&](std::uint32_t id) {
        if (const auto found = share.by_id.find(ClientName(id)); found != share.by_id.end()) use(*found->second);
    };
    for_each_enabled(context.state, use_bound);
    if (!context.program) return;
    use(*context.program);
    for_each_sampled(context.state, *context.program->executable, use_bound);
}

UseStamp use_stamp(const Context& context) {
    using glstate::Category;
    const auto& ids = context.state.ids;
    return {.texture_units = ids[static_cast<std::size_t>(Category::texture_units)],
            .textures = ids[static_cast<std::size_t>(Category::textures)],
            .objects = ids[static_cast<std::size_t>(Category::objects)],
            .shared = context.share().last_change.load(std::memory_order_acquire),
            .maps = context.maps->stamp};
}

}  // namespace wall::client
