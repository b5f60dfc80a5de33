// SPDX-License-Identifier: MIT
// glCopyImageSubData (GL_ARB_copy_image; OpenGL 4.5, 18.3.3): texels as they are stored, from one image to another.
// What the client keeps it copies itself; what only nodes have every node copies (docs/framebuffers.md). The order of
// the checks is Mesa's (copyimage.c).
#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "client_lib/context/drawn_texels.h"
#include "client_lib/context/image_work.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture_complete.h"
#include "client_lib/objects/texture_view.h"
#include "client_lib/objects/view_formats.h"
#include "client_lib/process/log.h"

namespace wall::client::api {
namespace {

constexpr const char* kName = "glCopyImageSubData";

/// One of the two images, as the program names it, and what it is.
struct Side {
    GLuint name;
    GLenum target;
    WorkedImage image;
    GLint internal_format = 0;
    std::uint32_t samples = 0;
    GLsizei width = 0, height = 0, layers = 0;  ///< 0: there is no such image

    bool is_blocks() const { return blocks_format(internal_format) != 0; }
    /// Texels that go together.
    glapi::BlockSize unit() const { return is_blocks() ? block_size(internal_format) : glapi::BlockSize{1, 1}; }
};

const glapi::TextureTargetInfo* copied_target(GLenum word) {
    const auto* info = target_of(word);
    return info && info->id != glapi::TextureTarget::buffer ? info : nullptr;
}

GLenum find_renderbuffer(Context& c, Side& side) {
    std::lock_guard lock(c.share().mutex);
    auto found = c.share().renderbuffers.find(side.name);
    if (!found || side.image.level != 0) return GL_INVALID_VALUE;
    const TextureFormat* format = find_renderbuffer_format(found->internal_format());
    side.internal_format = format ? format->answer : 0;
    side.samples = found->samples();
    side.width = static_cast<GLsizei>(found->width());
    side.height = static_cast<GLsizei>(found->height());
    side.layers = 1;
    side.image.renderbuffer = std::move(found);
    return GL_NO_ERROR;
}

GLenum find_image(Context& c, Side& side, GLsizei depth) {
    std::lock_guard lock(c.share().mutex);
    auto found = c.share().textures.find(side.name);
    if (!found) return GL_INVALID_VALUE;
    if (!has_complete_images(*found)) return GL_INVALID_OPERATION;
    if (found->info.target != side.target) return GL_INVALID_ENUM;
    const bool faces = found->info.first_face != 0;
    if (faces && (side.image.z < 0 || side.image.z >= static_cast<GLint>(glapi::kCubeFaces))) return GL_INVALID_VALUE;
    const TextureLevel* level = found->find_level(0, side.image.level);
    for (GLint face = side.image.z; faces && face < side.image.z + depth; ++face)
        if (face >= static_cast<GLint>(glapi::kCubeFaces) ||
            !found->find_level(static_cast<unsigned>(face), side.image.level))
            return GL_INVALID_VALUE;
    if (!level) return GL_INVALID_VALUE;
    const bool rows = glapi::spatial_dimensions_of(found->info) == 1;
    side.internal_format = level->internal_format;
    side.samples = level->samples;
    side.width = level->width;
    side.height = rows ? 1 : level->height;
    side.layers = faces ? static_cast<GLsizei>(glapi::kCubeFaces) : rows ? level->height : level->depth;
    side.image.texture = std::move(found);
    return GL_NO_ERROR;
}

GLenum find(Context& c, Side& side, GLsizei depth) {
    if (side.name == 0) return GL_INVALID_VALUE;
    if (side.target == GL_RENDERBUFFER) return find_renderbuffer(c, side);
    return copied_target(side.target) ? find_image(c, side, depth) : GLenum{GL_INVALID_ENUM};
}

bool lies_inside(const Side& side, const WorkedSize& size) {
    const auto inside = [](GLint at, GLsizei count, GLsizei all) {
        return at >= 0 && count >= 0 && std::int64_t{at} + count <= all;
    };
    return inside(side.image.x, size.width, side.width) && inside(side.image.y, size.height, side.height) &&
           inside(side.image.z, size.depth, side.layers);
}

/// Of the part that is copied from; it may end with the image.
bool is_aligned(const Side& from, const WorkedSize& size) {
    const glapi::BlockSize unit = from.unit();
    return is_whole_blocks(from.image.x, size.width, from.width, unit.width) &&
           is_whole_blocks(from.image.y, size.height, from.height, unit.height);
}

/// What the part becomes in the other image: blocks count for as many texels there as they are made of here.
WorkedSize size_in(const Side& to, const Side& from, const WorkedSize& size) {
    const auto scaled = [](GLsizei texels, GLsizei by, GLsizei of) {
        return static_cast<GLsizei>(std::int64_t{texels} * by / of);
    };
    const glapi::BlockSize here = from.unit(), there = to.unit();
    return {scaled(size.width, there.width, here.width), scaled(size.height, there.height, here.height), size.depth};
}

GLenum part_error(const Side& from, const Side& to, const WorkedSize& size) {
    const glapi::BlockSize unit = to.unit();
    if (!is_aligned(from, size) || to.image.x % unit.width != 0 || to.image.y % unit.height != 0)
        return GL_INVALID_VALUE;
    if (!lies_inside(from, size) || !lies_inside(to, size_in(to, from, size))) return GL_INVALID_VALUE;
    return GL_NO_ERROR;
}

/// Where a layer of a texture's image lies: its face, and a box of that size in it.
struct Layer {
    unsigned face;
    TexBox box;
};
Layer layer_of(const WorkedImage& image, GLsizei width, GLsizei height, GLint layer) {
    const glapi::TextureTargetInfo& info = image.texture->info;
    const GLint z = image.z + layer;
    if (info.first_face != 0) return {static_cast<unsigned>(z), {image.x, image.y, 0, width, height, 1, 0}};
    if (glapi::spatial_dimensions_of(info) == 1) return {0, {image.x, z, 0, width, 1, 1, 0}};
    return {0, {image.x, image.y, z, width, height, 1, 0}};
}

/// Whether the client has the texels of all layers itself.
bool is_kept(Context& c, const Side& side, GLsizei depth) {
    if (side.image.renderbuffer || side.samples != 0) return false;
    Texture& texture = *side.image.texture;
    std::lock_guard lock(c.share().mutex);
    const bool faces = texture.info.first_face != 0;
    for (GLint face = faces ? side.image.z : 0; face < (faces ? side.image.z + depth : 1); ++face) {
        refresh_view(texture, static_cast<unsigned>(face), side.image.level);
        const TextureLevel* level = texture.find_level(static_cast<unsigned>(face), side.image.level);
        if (level && (texture.only_on_nodes(*level) || level->content == LevelContent::generated)) return false;
    }
    return true;
}

/// In which pixels texels go over: as they are in memory, or where nothing is reinterpreted, as they are kept.
PixelKind kind_of(const TextureLevel& level, bool same_format) {
    const ViewFormat* format = find_view_format(level.internal_format);
    if (format) return format->texels;
    if (same_format && level.content == LevelContent::stored) return {level.data_format, level.data_type};
    return exact_pixels(level);
}

/// What a layer of the source holds: texels or blocks. `drawn`: of the whole level, if a node has said it.
TexelData layer_texels(Context& c, const Side& from, const Layer& at, bool same_format,
                       const std::optional<TexelData>& drawn) {
    std::lock_guard lock(c.share().mutex);
    Texture& texture = *from.image.texture;
    refresh_view(texture, at.face, from.image.level);
    const TextureLevel& level = *texture.find_level(at.face, from.image.level);
    if (level.compressed) return {0, 0, cut_blocks(level, at.box)};
    const PixelKind kind = kind_of(level, same_format);
    if (!drawn && level.content != LevelContent::stored)
        return {kind.format, kind.type,
                std::vector<std::byte>(
                    glapi::image_bytes(kind.format, kind.type, at.box.width, at.box.height, 1).value_or(0))};
    if (!drawn) return {kind.format, kind.type, cut_texels(level, at.box, kind)};
    TextureLevel said;
    said.width = level.width, said.height = level.height, said.depth = level.depth;
    said.data_format = drawn->format, said.data_type = drawn->type;
    said.pixels = drawn->bytes;
    return {kind.format, kind.type, cut_texels(said, at.box, kind)};
}

void put_layer(Context& c, const Side& to, const Layer& at, TexelData data) {
    std::lock_guard lock(c.share().mutex);
    Texture& texture = *to.image.texture;
    const TextureLevel& level = *texture.find_level(at.face, to.image.level);
    if (level.compressed) return put_blocks(c.share(), texture, at.face, to.image.level, at.box, data.bytes);
    if (const ViewFormat* format = find_view_format(level.internal_format))
        data.format = format->texels.format, data.type = format->texels.type;
    put_texels(c.share(), texture, at.face, to.image.level, at.box, std::move(data));
}

/// Images whose formats are of blocks are such before blocks are taken or given.
void keep_blocks(Context& c, const Side& side, GLsizei depth) {
    if (!side.is_blocks()) return;
    for (GLint layer = 0; layer < depth; ++layer)
        keep_as_blocks(c, *side.image.texture, layer_of(side.image, 1, 1, layer).face, side.image.level, kName);
}

/// All texels of a level that only nodes have.
std::optional<TexelData> ask(Context& c, const Side& from, unsigned face) {
    if (from.is_blocks()) return std::nullopt;
    return drawn_texels(c, from.image.texture, face, from.image.level, kName);
}

void copy_here(Context& c, const Side& from, const Side& to, const WorkedSize& size) {
    keep_blocks(c, from, size.depth);
    keep_blocks(c, to, size.depth);
    before_texels_change(c, *to.image.texture);
    const WorkedSize there = size_in(to, from, size);
    std::vector<TexelData> layers;  // before any is written: the images may be one
    std::optional<TexelData> drawn;
    std::optional<unsigned> asked;
    for (GLint i = 0; i < size.depth; ++i) {
        const Layer at = layer_of(from.image, size.width, size.height, i);
        if (asked != at.face) drawn = ask(c, from, at.face);
        asked = at.face;
        layers.push_back(layer_texels(c, from, at, from.internal_format == to.internal_format, drawn));
    }
    for (GLint i = 0; i < size.depth; ++i)
        put_layer(c, to, layer_of(to.image, there.width, there.height, i),
                  std::move(layers[static_cast<std::size_t>(i)]));
}

void copy(Context& c, const Side& from, const Side& to, const WorkedSize& size) {
    if (size.width == 0 || size.height == 0 || size.depth == 0) return;
    const bool kept = is_kept(c, from, size.depth);
    if (to.image.texture && to.samples == 0 && from.image.texture && kept) return copy_here(c, from, to, size);
    if (!to.is_blocks()) return copy_images_on_nodes(c, from.image, to.image, size);
    if (from.image.texture && !from.is_blocks()) {
        complain_once("texels that were drawn were read back to be copied to blocks", "copied blocks");
        return copy_here(c, from, to, size);
    }
    complain_once("blocks that only nodes have were not copied", "blocks of mipmaps");
    c.error(GL_OUT_OF_MEMORY);
}

}  // namespace

void CopyImageSubData(Context& c, GLuint from_name, GLenum from_target, GLint from_level, GLint from_x, GLint from_y,
                      GLint from_z, GLuint to_name, GLenum to_target, GLint to_level, GLint to_x, GLint to_y,
                      GLint to_z, GLsizei width, GLsizei height, GLsizei depth) {
    Side from{from_name, from_target, {nullptr, nullptr, from_level, from_x, from_y, from_z}};
    Side to{to_name, to_target, {nullptr, nullptr, to_level, to_x, to_y, to_z}};
    c.flush_block();
    if (const GLenum error = find(c, from, depth)) return c.error(error);
    if (const GLenum error = find(c, to, depth)) return c.error(error);
    const WorkedSize size{width, height, depth};
    if (const GLenum error = part_error(from, to, size)) return c.error(error);
    if (!may_copy_texels(from.internal_format, to.internal_format, c.profile.es != 0) || from.samples != to.samples)
        return c.error(GL_INVALID_OPERATION);
    copy(c, from, to, size);
}

}  // namespace wall::client::api
