// SPDX-License-Identifier: MIT
// A texture of a session: the content that it has, alone or together with other sessions, and while the content is
// coming under a name, what has come of it. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "tileserver/driver/driver.h"
#include "tileserver/objects/object_table.h"
#include "tileserver/objects/texture_content.h"

namespace wall::tileserver {

inline constexpr std::int32_t kMaxImageSide = 16384;  ///< texels of any image but for borders

class Texture final : public ObjectOf<ObjectKind::texture> {
public:
    /// With nothing in it.
    Texture(ObjectAccount& account, Driver& driver, TextureTarget target);

    /// Name 0 is the default texture of its target.
    static ObjectKey key(ClientName name, TextureTarget target) {
        return name ? ObjectKey(name) : ObjectKey::default_object(kKind, static_cast<std::uint32_t>(target));
    }

    TextureContent& content() const { return *content_; }
    const std::shared_ptr<TextureContent>& shared() const { return content_; }  ///< the same, to be held by others
    TextureTarget target() const { return content_->target(); }
    /// It is that content from now on, which other sessions may hold, too. False: more memory than a session may have.
    [[nodiscard]] bool adopt(std::shared_ptr<TextureContent> content);
    /// Before it changes: what other sessions hold stays as it is, and nobody new is given it. False: as adopt().
    [[nodiscard]] bool own(SharedContents& shared);
    /// All its levels as one storage (TextureContent::store). False: as adopt().
    [[nodiscard]] bool store(const TextureContent::Storage& storage);
    /// It is that part of a texture that has storage, from now on. False: as adopt().
    [[nodiscard]] bool show(Driver& driver, const Texture& origin, const TextureContent::Part& part);
    /// It has another content with an image of that size from now on, and anything in it, until it is restored. False:
    /// TextureContent::sized() gives none, or more memory than a session may have.
    [[nodiscard]] bool enlarge(std::int32_t width, std::int32_t height);
    /// It is as it was before.
    void restore();
    /// Whether the session may have `bytes` for that image, instead of what it has for it now.
    bool affords_image(GLenum image_target, std::int32_t level, std::uint64_t bytes) const;
    /// Notes what the driver has of one image after a definition (TextureContent::note_image). False: as adopt().
    [[nodiscard]] bool note_image(GLenum image_target, std::int32_t level, const TextureContent::ImageFormat* format);

    /// While its definition comes that was promised under a name: what has come.
    struct Promise {
        glapi::ContentKey key;
        std::optional<glapi::ContentHash> hash;  ///< of a name that says what the content is
    };
    std::optional<Promise> promise;
    /// Null: nothing is checked.
    glapi::ContentHash* hash() { return promise && promise->hash ? &*promise->hash : nullptr; }

private:
    std::shared_ptr<TextureContent> content_;  // never null
    std::shared_ptr<TextureContent> kept_;     // while it is enlarged: as it was before
};

}  // namespace wall::tileserver
