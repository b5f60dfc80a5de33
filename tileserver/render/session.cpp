// SPDX-License-Identifier: MIT
#include "tileserver/render/session.h"

namespace wall::tileserver {

Session::~Session() {
    for (auto& [key, texture] : textures_) release(texture);
    for (auto& [id, run] : runs) driver_.gl().DeleteLists(run.list, 1);
    driver_.forget_layer();
}

Surface* Session::surface(SurfaceId id) {
    const auto at = surfaces_.find(id);
    return at == surfaces_.end() ? nullptr : at->second.get();
}

Surface* Session::create_surface(SurfaceId id, const SurfaceFormat& format) {
    driver_.forget_layer();
    if (surfaces_.size() >= kMaxSurfaces && !surfaces_.contains(id)) return nullptr;
    auto& surface = surfaces_[id];
    surface = std::make_unique<Surface>(driver_.gl(), driver_.flip_y(), format, pixels_);
    return surface.get();
}

void Session::destroy_surface(SurfaceId id) {
    driver_.forget_layer();
    surfaces_.erase(id);
}

std::uint64_t Session::key(ClientName name, TextureTarget target) {
    return name ? name.value : std::uint64_t{1} << 32 | static_cast<std::uint64_t>(target);
}

Texture* Session::texture(ClientName name, TextureTarget target) {
    const auto at = textures_.find(key(name, target));
    return at == textures_.end() ? nullptr : &at->second;
}

Texture* Session::make_texture(ClientName name, TextureTarget target) {
    Texture* known = texture(name, target);
    if (known != nullptr) return known->target == target ? known : nullptr;
    if (target == TextureTarget::kCount || textures_.size() >= kMaxTextures) return nullptr;
    GLuint made = 0;
    driver_.gl().CreateTextures(gl_target(target), 1, &made);
    ++texture_version_;
    return &textures_.emplace(key(name, target), Texture{DriverName(made), target, {}}).first->second;
}

void Session::release(Texture& texture) {
    driver_.forget_texture(texture.driver.value);
    driver_.gl().DeleteTextures(1, &texture.driver.value);
    for (const auto& [image, bytes] : texture.image_bytes) texture_bytes_ -= bytes;
}

void Session::delete_texture(ClientName name) {
    const auto at = textures_.find(name.value);
    if (!name || at == textures_.end()) return;
    release(at->second);
    textures_.erase(at);
    ++texture_version_;
}

bool Session::account(Texture& texture, GLenum target, std::int32_t level, std::uint64_t bytes) {
    auto& known = texture.image_bytes[{target, level}];
    texture_bytes_ += bytes - known;
    known = bytes;
    return texture_bytes_ <= kMaxTextureBytes;
}

}  // namespace wall::tileserver
