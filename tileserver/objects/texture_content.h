// SPDX-License-Identifier: MIT
// A texture of the driver and what it was defined with, which is enough to make a copy of it. Several sessions may hold
// the same one as long as none changes it (ContentStore). Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "common/glapi/content_hash.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/image_extent.h"
#include "tileserver/objects/shared_content.h"

namespace wall::tileserver {

class TextureContent final : public SharedContent {
public:
    static constexpr ObjectKind kKind = ObjectKind::texture;

    TextureContent(Driver& driver, TextureTarget target);
    /// Of a texture that is a part of what another one has storage of: levels and layers (cube maps' faces are such).
    struct Part {
        GLenum internal_format = 0;
        GLuint first_level = 0, levels = 0, first_layer = 0, layers = 0;
        bool operator==(const Part&) const = default;
    };
    TextureContent(Driver& driver, TextureTarget target, const TextureContent& origin, const Part& part);
    ~TextureContent() override;

    GLuint name() const { return name_; }
    TextureTarget target() const { return target_; }
    std::uint64_t bytes() const { return bytes_; }  ///< of all images, by estimate

    /// As the command had it that defined an image; the driver's choice of storage depends on all of it.
    struct ImageFormat {
        GLenum internal_format = 0, format = 0, type = 0;
        bool compressed = false;  ///< blocks of `internal_format`
    };
    /// Notes what the driver has of an image (of an image target, such as a cube map's face, and a level) after a
    /// definition, with the texture bound to be edited. `format`: of the definition; null: the driver refused it.
    void note_image(GLenum image_target, std::int32_t level, const ImageFormat* format);
    /// Of one image, by estimate.
    std::uint64_t image_bytes(GLenum image_target, std::int32_t level) const;
    void note_parameter(GLenum pname, const std::array<float, 4>& value) {
        parameters_[pname] = value;
        if (pname == GL_TEXTURE_BORDER_COLOR) whole_border_.reset();
    }
    /// The border colour of whole numbers, instead of any of before.
    void note_whole_border(const std::array<GLint, 4>& value) { whole_border_ = value; }
    /// Makes the levels behind one of it, `last` at most, whichever levels the parameters let be sampled. Without that
    /// one there is nothing to make.
    void make_mipmaps(std::int32_t base, std::int32_t last);

    /// All levels, for good; of cube maps `depth` is 1, of others it counts layers, too.
    struct Storage {
        GLenum internal_format = 0;
        GLsizei levels = 0, samples = 0;  ///< samples 0: one a texel
        ImageExtent extent;
        bool fixed_places = false;
        GLuint layers(TextureTarget target) const;
    };
    /// Such storage in place of the images that there are, which are copied into it; a driver that refuses it leaves
    /// all as it is. Once only.
    void store(const Storage& storage);
    /// Nothing: it has no such storage, or it is a part of another one's.
    const std::optional<Storage>& storage() const { return storage_; }
    /// Whether it is that part of that texture.
    bool shows(const TextureContent& origin, const Part& part) const {
        return part_ && origin_ == origin.name_ && *part_ == part;
    }

    /// The same texture with an image of that size, and anything in it. Null: it has not just one image of the format
    /// that it was defined with, or the driver refuses it.
    std::shared_ptr<TextureContent> sized(GLsizei width, GLsizei height) const;
    /// The same texture again, copied by the driver.
    std::shared_ptr<TextureContent> copy() const;

    std::optional<glapi::ContentKey> key;  ///< its name in the node's store

private:
    struct Image {
        ImageFormat format;
        std::uint64_t bytes = 0;  ///< estimate
    };
    bool has_level(std::int32_t level) const;
    bool make_storage(GLuint name, const Storage& storage) const;
    void copy_levels(GLuint to) const;
    void set_parameters(GLuint name) const;
    void copy_image(GLenum image_target, std::int32_t level, const ImageFormat& format, const TextureContent& to) const;

    Driver& driver_;
    const TextureTarget target_;
    GLuint name_ = 0;
    std::map<std::pair<GLenum, std::int32_t>, Image> images_;
    std::map<GLenum, std::array<float, 4>> parameters_;
    std::optional<std::array<GLint, 4>> whole_border_;
    struct Mipmaps {
        std::int32_t base, last;
    };
    std::optional<Mipmaps> made_;  // the latest that the driver made
    std::optional<Storage> storage_;
    std::optional<Part> part_;
    GLuint origin_ = 0;  // the driver's texture that it is that part of
    std::uint64_t bytes_ = 0;
};

/// Defines an image of the bound texture. `pixels`: null for no content.
void upload_image(const Gl& gl, TextureTarget target, GLenum image_target, GLint level,
                  const TextureContent::ImageFormat& format, const ImageExtent& extent, const void* pixels,
                  GLint border = 0);

/// The same of a compressed one; of storage for good, whose image is there.
void upload_stored_blocks(const Gl& gl, TextureTarget target, GLenum image_target, GLint level, GLenum internal_format,
                          const ImageExtent& extent, std::span<const std::byte> blocks);
/// The same of a compressed one.
void upload_blocks(const Gl& gl, TextureTarget target, GLenum image_target, GLint level, GLenum internal_format,
                   const ImageExtent& extent, std::span<const std::byte> blocks);

}  // namespace wall::tileserver
