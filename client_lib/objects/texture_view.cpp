// SPDX-License-Identifier: MIT
#include "client_lib/objects/texture_view.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "client_lib/objects/pixel_convert.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/small_floats.h"
#include "client_lib/objects/view_formats.h"
#include "common/glapi/image.h"

namespace wall::client {
namespace {

/// Which coordinate of an image counts layers.
enum class LayersIn : std::uint8_t { nothing, faces, rows, slices };

LayersIn layers_in(const glapi::TextureTargetInfo& info) {
    if (info.first_face != 0) return LayersIn::faces;
    if (info.layers == 0) return LayersIn::nothing;
    return glapi::spatial_dimensions_of(info) == 1 ? LayersIn::rows : LayersIn::slices;
}

/// One layer of a box of a view: by its number in the view.
KeptPart kept_layer(const Texture& view, GLint level, TexBox part, std::int32_t layer) {
    const auto all = static_cast<std::int32_t>(view.view.first_layer) + layer;
    KeptPart kept{part, 0, level + static_cast<GLint>(view.view.first_level), part};
    const LayersIn from = layers_in(view.info);
    if (from == LayersIn::rows) kept.box.y = 0;
    if (from == LayersIn::slices) kept.box.z = 0;
    switch (layers_in(view.view.origin->info)) {
        case LayersIn::nothing: break;
        case LayersIn::faces: kept.face = static_cast<unsigned>(all); break;
        case LayersIn::rows: kept.box.y = all; break;
        case LayersIn::slices: kept.box.z = all; break;
    }
    return kept;
}

std::size_t texels_in(const TexBox& box) {
    return static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height) *
           static_cast<std::size_t>(box.depth);
}

/// As the driver stores them: halves are cut off, not rounded (get_tex_image.cpp).
std::vector<Rgba> as_halves(std::vector<Rgba> texels) {
    for (Rgba& texel : texels)
        for (float& component : texel) component = half_to_float(float_to_half_cut(component));
    return texels;
}

/// The kind that an image's texels are gathered in for a view of it, of the keeper and of the view.
struct Kinds {
    PixelKind kept, seen;
};
Kinds kinds_of(const TextureLevel& kept, GLint seen_as) {
    const ViewFormat *of = find_view_format(kept.internal_format), *as = find_view_format(seen_as);
    if (of && as) return {of->texels, as->texels};
    const PixelKind own =
        kept.content == LevelContent::stored ? PixelKind{kept.data_format, kept.data_type} : exact_pixels(kept);
    return {own, own};
}

/// Puts tight texels into a box of an image of as large ones.
void paste(std::vector<std::byte>& image, std::int32_t width, std::int32_t height, const TexBox& box,
           std::size_t texel_bytes, const std::vector<std::byte>& from) {
    const std::size_t row = texel_bytes * static_cast<std::size_t>(width),
                      bytes = texel_bytes * static_cast<std::size_t>(box.width);
    const std::byte* at = from.data();
    for (std::int32_t z = box.z; z < box.z + box.depth; ++z)
        for (std::int32_t y = box.y; y < box.y + box.height; ++y, at += bytes) {
            const auto line =
                static_cast<std::size_t>(z) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y);
            std::memcpy(image.data() + line * row + texel_bytes * static_cast<std::size_t>(box.x), at, bytes);
        }
}

/// What the parts of an image are together: one that only nodes have makes all of it such.
LevelContent content_of(const Texture& origin, const std::vector<KeptPart>& parts) {
    LevelContent all = LevelContent::none;
    for (const KeptPart& part : parts) {
        const TextureLevel* level = origin.find_level(part.face, part.level);
        if (!level) continue;
        if (origin.only_on_nodes(*level)) return LevelContent::drawn;
        if (level->content != LevelContent::none) all = level->content;
    }
    return all;
}

void gather_texels(const Texture& origin, TextureLevel& image, const std::vector<KeptPart>& parts) {
    for (const KeptPart& part : parts) {
        const TextureLevel* kept = origin.find_level(part.face, part.level);
        if (!kept || kept->content != LevelContent::stored) continue;
        const Kinds kinds = kinds_of(*kept, image.internal_format);
        const std::size_t texel = glapi::image_bytes(kinds.seen.format, kinds.seen.type, 1, 1, 1).value_or(0);
        if (image.pixels.empty()) {
            image.data_format = kinds.seen.format, image.data_type = kinds.seen.type;
            image.pixels.resize(texel * texels_in({0, 0, 0, image.width, image.height, image.depth}));
        }
        auto texels = cut_texels(*kept, part.box, kinds.kept);
        if (kinds.seen.format != image.data_format || kinds.seen.type != image.data_type)  // faces may differ
            texels = converted_texels(kinds.seen, std::move(texels), texels_in(part.box),
                                      {image.data_format, image.data_type});
        paste(image.pixels, image.width, image.height, part.part,
              glapi::image_bytes(image.data_format, image.data_type, 1, 1, 1).value_or(0), texels);
    }
}

void gather_blocks(const Texture& origin, TextureLevel& image, const std::vector<KeptPart>& parts) {
    const std::size_t slice = blocks_bytes(image.internal_format, image.width, image.height);
    image.pixels.resize(slice * static_cast<std::size_t>(image.depth));
    for (const KeptPart& part : parts) {
        const TextureLevel* kept = origin.find_level(part.face, part.level);
        if (!kept || !kept->compressed) continue;
        const auto blocks = cut_blocks(*kept, part.box);
        std::memcpy(image.pixels.data() + slice * static_cast<std::size_t>(part.part.z), blocks.data(), blocks.size());
    }
}

}  // namespace

std::vector<KeptPart> kept_parts(const Texture& texture, unsigned face, GLint level, const TexBox& box) {
    if (!texture.view.origin) return {{box, face, level, box}};
    std::vector<KeptPart> parts;
    switch (layers_in(texture.info)) {
        case LayersIn::nothing: parts.push_back(kept_layer(texture, level, box, 0)); break;
        case LayersIn::faces: parts.push_back(kept_layer(texture, level, box, static_cast<std::int32_t>(face))); break;
        case LayersIn::rows:
            for (std::int32_t y = box.y; y < box.y + box.height; ++y)
                parts.push_back(kept_layer(texture, level, {box.x, y, box.z, box.width, 1, box.depth, 0}, y));
            break;
        case LayersIn::slices:
            for (std::int32_t z = box.z; z < box.z + box.depth; ++z)
                parts.push_back(kept_layer(texture, level, {box.x, box.y, z, box.width, box.height, 1, 0}, z));
            break;
    }
    return parts;
}

std::uint32_t layer_count(const Texture& texture) {
    const TextureLevel* first = texture.find_level(0, 0);
    switch (layers_in(texture.info)) {
        case LayersIn::nothing: return 1;
        case LayersIn::faces: return glapi::kCubeFaces;
        case LayersIn::rows: return first ? static_cast<std::uint32_t>(first->height) : 0;
        case LayersIn::slices: return first ? static_cast<std::uint32_t>(first->depth) : 0;
    }
    return 1;
}

void describe_view(Texture& view, GLint internal_format) {
    const Texture& origin = *view.view.origin;
    const TextureFormat* format = find_texture_format(internal_format);
    const PixelKind kind = format ? exact_pixels(*format, format->bits) : PixelKind{GL_RGBA, GL_UNSIGNED_BYTE};
    const auto layers = static_cast<std::int32_t>(view.view.layers);
    const bool rows = layers_in(origin.info) == LayersIn::rows;
    for (GLint number = 0; number < static_cast<GLint>(view.view.levels); ++number) {
        const TextureLevel* kept = origin.find_level(0, number + static_cast<GLint>(view.view.first_level));
        if (!kept) return;
        TextureLevel image;
        image.internal_format = internal_format;
        image.width = kept->width;
        image.height = rows ? 1 : kept->height;
        image.depth = layers_in(origin.info) == LayersIn::nothing ? kept->depth : 1;
        if (layers_in(view.info) == LayersIn::rows) image.height = layers;
        if (layers_in(view.info) == LayersIn::slices) image.depth = layers;
        image.format = kind.format, image.type = kind.type;
        image.samples = kept->samples;
        image.fixed_places = kept->fixed_places;
        image.compressed = kept->compressed;
        image.stamp = view.view.stamp;
        for (unsigned face = 0; face < glapi::face_count(view.info); ++face) view.level_at(face, number) = image;
    }
}

void refresh_view(Texture& texture, unsigned face, GLint level) {
    if (!texture.view.origin) return;
    TextureLevel* const image = texture.find_level(face, level);
    if (!image || image->samples != 0) return;
    const Texture& origin = *texture.view.origin;
    const auto parts = kept_parts(texture, face, level, {0, 0, 0, image->width, image->height, image->depth, 0});
    image->pixels.clear();
    image->content = content_of(origin, parts);
    if (image->content != LevelContent::stored) return;
    if (image->compressed) gather_blocks(origin, *image, parts);
    else gather_texels(origin, *image, parts);
}

std::vector<std::byte> converted_texels(const PixelKind& from, std::vector<std::byte> bytes, std::size_t count,
                                        const PixelKind& to) {
    if (from.format == to.format && from.type == to.type) return bytes;
    if (glapi::is_integer_format(to.format))
        return from_whole(to.format, to.type, to_whole(from.format, from.type, bytes, count));
    auto texels = to_rgba(from.format, from.type, bytes, count);
    return from_rgba(to.format, to.type, to.type == GL_HALF_FLOAT ? as_halves(std::move(texels)) : texels);
}

std::vector<std::byte> cut_texels(const TextureLevel& level, const TexBox& box, const PixelKind& kind) {
    const std::size_t texel = glapi::image_bytes(level.data_format, level.data_type, 1, 1, 1).value_or(0);
    const std::size_t row = texel * static_cast<std::size_t>(level.width),
                      bytes = texel * static_cast<std::size_t>(box.width);
    std::vector<std::byte> out;
    out.reserve(texel * texels_in(box));
    for (std::int32_t z = box.z; z < box.z + box.depth; ++z)
        for (std::int32_t y = box.y; y < box.y + box.height; ++y) {
            const auto line =
                static_cast<std::size_t>(z) * static_cast<std::size_t>(level.height) + static_cast<std::size_t>(y);
            const std::byte* at = level.pixels.data() + line * row + texel * static_cast<std::size_t>(box.x);
            out.insert(out.end(), at, at + bytes);
        }
    return converted_texels({level.data_format, level.data_type}, std::move(out), texels_in(box), kind);
}

std::vector<std::byte> cut_blocks(const TextureLevel& level, const TexBox& box) {
    const auto row_of = [&](std::int32_t width) { return row_of_blocks_bytes(level.internal_format, width); };
    const std::size_t slice = blocks_bytes(level.internal_format, level.width, level.height);
    const std::size_t row = row_of(level.width), wanted = row_of(box.width);
    const std::int32_t side = block_size(level.internal_format).height;
    std::vector<std::byte> out;
    for (std::int32_t z = box.z; z < box.z + box.depth; ++z)
        for (std::int32_t y = box.y; y < box.y + box.height; y += side) {
            const std::byte* at = level.pixels.data() + slice * static_cast<std::size_t>(z) +
                                  row * static_cast<std::size_t>(y / side) + row_of(box.x);
            out.insert(out.end(), at, at + wanted);
        }
    return out;
}

}  // namespace wall::client
