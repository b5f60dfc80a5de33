// SPDX-License-Identifier: MIT
#include "tileserver/objects/texture.h"

#include <utility>

namespace wall::tileserver {

Texture::Texture(ObjectAccount& account, Driver& driver, TextureTarget target)
    : ObjectOf(account), content_(std::make_shared<TextureContent>(driver, target)) {}

bool Texture::adopt(std::shared_ptr<TextureContent> content) {
    content_ = std::move(content);
    renamed();
    return has_content(content_->bytes());
}

bool Texture::own(SharedContents& shared) {
    if (content_.use_count() > 1) return adopt(content_->copy());
    if (const auto key = std::exchange(content_->key, {})) shared.forget(*key, *content_);
    return true;
}

bool Texture::enlarge(std::int32_t width, std::int32_t height) {
    constexpr std::uint64_t kTexelBytes = 4;  // by estimate
    const std::uint64_t bytes = kTexelBytes * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (kept_ || !affords(bytes, 0)) return false;
    auto larger = content_->sized(width, height);
    if (!larger) return false;
    kept_ = std::exchange(content_, std::move(larger));
    renamed();
    if (has_content(kept_->bytes() + content_->bytes())) return true;
    restore();
    return false;
}

void Texture::restore() {
    if (!kept_) return;
    content_ = std::exchange(kept_, nullptr);
    renamed();
    static_cast<void>(has_content(content_->bytes()));  // less than before
}

bool Texture::store(const TextureContent::Storage& storage) {
    content_->store(storage);
    renamed();
    return has_content(content_->bytes());
}

bool Texture::show(Driver& driver, const Texture& origin, const TextureContent::Part& part) {
    if (content_->shows(*origin.content_, part)) return true;
    return adopt(std::make_shared<TextureContent>(driver, target(), *origin.content_, part));
}

bool Texture::affords_image(GLenum image_target, std::int32_t level, std::uint64_t bytes) const {
    return affords(bytes, content_->image_bytes(image_target, level));
}

bool Texture::note_image(GLenum image_target, std::int32_t level, const TextureContent::ImageFormat* format) {
    content_->note_image(image_target, level, format);
    renamed();  // framebuffers that it belongs to may have another size
    return has_content(content_->bytes());
}

}  // namespace wall::tileserver
