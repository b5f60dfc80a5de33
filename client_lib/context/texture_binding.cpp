// SPDX-License-Identifier: MIT
#include "client_lib/context/texture_binding.h"

#include <algorithm>

#include "gen/glstate/texture_elements.gen.h"

namespace wall::client {
namespace {

// A default texture that has come into being gets an id in this context's bindings of name 0.
void adopt_default(Context& c, glapi::TextureTarget target, ClientName id) {
    for (unsigned unit = 0; unit < kTextureImageUnits; ++unit)
        if (!bound_id(c, unit, target)) set_bound_id(c, unit, target, id);
}

}  // namespace

ClientName bound_id(const Context& c, unsigned unit, glapi::TextureTarget target) {
    return ClientName((c.state.textures.*glstate::kTextureBindings[static_cast<std::size_t>(target)])[unit]);
}

void set_bound_id(Context& c, unsigned unit, glapi::TextureTarget target, ClientName id) {
    glstate::with_binding(target, [&]<class E>(E) { c.set<E>(unit, id.value); });
}

std::shared_ptr<Texture> bound_texture(Context& c, GLenum word) {
    return bound_texture_of(c, c.active_texture(), target_word(word)->info->id);
}

std::shared_ptr<Texture> bound_texture_of(Context& c, unsigned unit, glapi::TextureTarget target) {
    const ClientName id = bound_id(c, unit, target);
    std::lock_guard lock(c.share().mutex);
    if (!id) {
        const auto found = c.share().default_textures.find(target);
        return found == c.share().default_textures.end() ? nullptr : found->second;
    }
    return c.share().texture_of(id);
}

std::shared_ptr<Texture> make_texture(Context& c, GLuint name, glapi::TextureTarget target) {
    auto texture = std::make_shared<Texture>(next_object_id(), name, target);
    if (c.profile.core) {  // depths are red there, and nothing says so
        texture->parameters.depth_mode = GL_RED;
        texture->parameter_changed(GL_DEPTH_TEXTURE_MODE);
    }
    c.share().by_id[texture->id] = texture;
    return texture;
}

std::shared_ptr<Texture> texture_to_change(Context& c, GLenum word) {
    c.flush_block();
    const glapi::TextureTarget target = target_word(word)->info->id;
    if (auto texture = bound_texture(c, word)) {
        if (texture->is_default()) adopt_default(c, target, texture->id);
        c.before_change(texture->id);
        return texture;
    }
    std::shared_ptr<Texture> texture;
    {
        std::lock_guard lock(c.share().mutex);
        texture = make_texture(c, 0, target);
        c.share().default_textures[target] = texture;
    }
    adopt_default(c, target, texture->id);
    return texture;
}

void touch(ShareGroup& share, Texture& texture) {
    share.last_change.store(texture.stamp = next_stamp(), std::memory_order_release);
}

ClientName default_id(ShareGroup& share, glapi::TextureTarget target) {
    const auto found = share.default_textures.find(target);
    return found == share.default_textures.end() ? ClientName() : found->second->id;
}

std::vector<SavedTexture> bound_texture_parameters(Context& c) {
    std::vector<SavedTexture> saved;
    std::lock_guard lock(c.share().mutex);
    for (unsigned unit = 0; unit < kTextureImageUnits; ++unit)
        for (const auto& info : glapi::kTextureTargetInfo) {
            if (auto texture = c.share().texture_of(bound_id(c, unit, info.id)))
                saved.push_back({texture, texture->parameters});
        }
    return saved;
}

void restore_texture_parameters(Context& c, const std::vector<SavedTexture>& saved) {
    constexpr GLenum kSent[] = {GL_TEXTURE_BORDER_COLOR, GL_TEXTURE_MIN_FILTER,      GL_TEXTURE_MAG_FILTER,
                                GL_TEXTURE_WRAP_S,       GL_TEXTURE_WRAP_T,          GL_TEXTURE_WRAP_R,
                                GL_TEXTURE_MIN_LOD,      GL_TEXTURE_MAX_LOD,         GL_TEXTURE_LOD_BIAS,
                                GL_TEXTURE_BASE_LEVEL,   GL_TEXTURE_MAX_LEVEL,       GL_TEXTURE_MAX_ANISOTROPY_EXT,
                                GL_TEXTURE_COMPARE_MODE, GL_TEXTURE_COMPARE_FUNC,    GL_DEPTH_TEXTURE_MODE,
                                GL_TEXTURE_SWIZZLE_R,    GL_TEXTURE_SWIZZLE_G,       GL_TEXTURE_SWIZZLE_B,
                                GL_TEXTURE_SWIZZLE_A,    GL_TEXTURE_SRGB_DECODE_EXT, GL_DEPTH_STENCIL_TEXTURE_MODE};
    if (saved.empty()) return;
    c.flush_block();
    const auto differs = [&](const TexParameters& a, const TexParameters& b) {
        return std::ranges::any_of(kSent, [&](GLenum p) { return !same_parameter(a, b, p); });
    };
    for (const auto& [texture, parameters] : saved)
        if (differs(texture->parameters, parameters)) c.before_change(texture->id);
    std::lock_guard lock(c.share().mutex);
    for (const auto& [texture, parameters] : saved) {
        const TexParameters now = std::exchange(texture->parameters, parameters);
        for (const GLenum pname : kSent) {
            if (same_parameter(now, parameters, pname)) continue;
            texture->parameter_changed(pname);
            touch(c.share(), *texture);
        }
    }
}

}  // namespace wall::client
