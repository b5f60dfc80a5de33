// SPDX-License-Identifier: MIT
#include "tileserver/render/session.h"

namespace wall::tileserver {

SurfaceReplica* SessionReplica::surface(SurfaceId id) {
    if (shares(id)) return group_->surface(id);
    const auto at = surfaces_.find(id);
    return at == surfaces_.end() ? nullptr : at->second.get();
}

SurfaceReplica* SessionReplica::create_surface(SurfaceId id, const SurfaceFormat& format) {
    driver_.forget_layer();
    if (shares(id)) return group_->open_surface(rank_, id, format);
    if (surfaces_.size() >= kMaxSurfaces && !surfaces_.contains(id)) return nullptr;
    auto& surface = surfaces_[id];
    surface = std::make_unique<SurfaceReplica>(driver_.gl(), driver_.flip_y(), format, pixels_);
    return surface.get();
}

void SessionReplica::destroy_surface(SurfaceId id) {
    if (shares(id)) return group_->close_surface(rank_, id);
    driver_.forget_layer();
    surfaces_.erase(id);
}

std::uint64_t SessionReplica::key(ClientName name, TextureTarget target) {
    return name ? name.value : std::uint64_t{1} << 32 | static_cast<std::uint64_t>(target);
}

Texture* SessionReplica::texture(ClientName name, TextureTarget target) {
    const auto at = textures_.find(key(name, target));
    return at == textures_.end() ? nullptr : &at->second;
}

Texture* SessionReplica::make_texture(ClientName name, TextureTarget target) {
    Texture* known = texture(name, target);
    if (known != nullptr) return known->content->target() == target ? known : nullptr;
    if (textures_.size() >= kMaxTextures) return nullptr;
    ++texture_version_;
    return &textures_.emplace(key(name, target), Texture{std::make_shared<TextureContent>(driver_, target), {}})
                .first->second;
}

void SessionReplica::delete_texture(ClientName name) {
    const auto at = textures_.find(name.value);
    if (!name || at == textures_.end()) return;
    texture_bytes_ -= at->second.content->bytes();
    textures_.erase(at);
    ++texture_version_;
}

bool SessionReplica::adopt(Texture& texture, std::shared_ptr<TextureContent> content) {
    texture_bytes_ += content->bytes() - texture.content->bytes();
    texture.content = std::move(content);
    ++texture_version_;
    return texture_bytes_ <= kMaxTextureBytes;
}

bool SessionReplica::affords(const Texture& texture, GLenum image_target, std::int32_t level,
                             std::uint64_t bytes) const {
    return texture_bytes_ - texture.content->image_bytes(image_target, level) + bytes <= kMaxTextureBytes;
}

void SessionReplica::account(Texture& texture, GLenum image_target, std::int32_t level,
                             const TextureContent::ImageFormat* format) {
    texture_bytes_ -= texture.content->bytes();
    texture.content->note_image(image_target, level, format);
    texture_bytes_ += texture.content->bytes();
}

}  // namespace wall::tileserver
