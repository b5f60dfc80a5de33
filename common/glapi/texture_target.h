// SPDX-License-Identifier: MIT
// Which texture target a word of OpenGL's commands means: the target itself, one of its faces, or its proxy. What is
// known of each target is proto/gl/texture_targets.toml. Pure.
#pragma once

#include <optional>

#include "gen/glapi/texture_targets.gen.h"

namespace wall::glapi {

inline constexpr unsigned kCubeFaces = 6;

constexpr const TextureTargetInfo& info_of(TextureTarget target) {
    return kTextureTargetInfo[static_cast<std::size_t>(target)];
}
constexpr unsigned face_count(const TextureTargetInfo& info) { return info.first_face != 0 ? kCubeFaces : 1; }
/// Of its images, layers counted as one.
constexpr unsigned dimensions_of(const TextureTargetInfo& info) {
    return info.samples ? 2 + (info.layers != 0 ? 1u : 0u) : info.images;
}
/// Of them, those that are of the picture: what a mipmap halves.
constexpr unsigned spatial_dimensions_of(const TextureTargetInfo& info) {
    return dimensions_of(info) - (info.layers != 0 ? 1u : 0u);
}
/// The word for the images of a face; there is one face, 0, where images belong to the target itself.
constexpr GLenum image_target(const TextureTargetInfo& info, unsigned face) {
    return info.first_face != 0 ? info.first_face + face : info.target;
}

/// A word and the target that it belongs to.
struct TargetWord {
    enum class Means : std::uint8_t { object, face, proxy };
    const TextureTargetInfo* info;
    Means means = Means::object;
    unsigned face = 0;

    constexpr bool is_object() const { return means == Means::object; }
    constexpr bool is_proxy() const { return means == Means::proxy; }
    /// Whether commands of images take it: that of a target whose faces have them is not meant by them.
    constexpr bool has_images() const { return !is_object() || info->first_face == 0; }
};

/// Nothing: no word for a texture target.
constexpr std::optional<TargetWord> find_target_word(GLenum word) {
    if (word == 0) return std::nullopt;
    for (const TextureTargetInfo& info : kTextureTargetInfo) {
        if (word == info.target) return TargetWord{&info};
        if (word == info.proxy) return TargetWord{&info, TargetWord::Means::proxy};
        if (info.first_face != 0 && word >= info.first_face && word < info.first_face + kCubeFaces)
            return TargetWord{&info, TargetWord::Means::face, word - info.first_face};
    }
    return std::nullopt;
}

}  // namespace wall::glapi
