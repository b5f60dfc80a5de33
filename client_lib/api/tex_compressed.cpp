// SPDX-License-Identifier: MIT
// Compressed texture images (OpenGL 3.0, 3.9.3): formats of blocks, kept and sent as they come. An image that comes as
// pixels is compressed by each node; when the program asks for its blocks or gives some, one node is asked what its
// driver makes of it. Formats for one and three dimensions there are none.
#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/named_objects.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/block_store.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/palette_image.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/texture_formats.h"
#include "client_lib/objects/texture_view.h"

namespace wall::client::api {
namespace {

constexpr std::size_t kMostAsked = 16u << 20;  // bytes of pixels in one question

struct Image {
    GLenum target;
    GLint level, format;
    GLsizei width, height, depth = 1, bytes = 0;
    unsigned dimensions = 2;  ///< of the command
};

struct Place {
    GLint x, y, z = 0;
};

/// Of a target that a command of so many dimensions can have, in a format.
GLenum target_error(const Image& image) {
    const auto* info = image_target_of(image.target);
    if (block_bytes(image.format) == 0 || !info || info->images != image.dimensions) return GL_INVALID_ENUM;
    if (glapi::may_have_blocks(*info, static_cast<GLenum>(image.format))) return GL_NO_ERROR;
    return glapi::spatial_dimensions_of(*info) == 3 ? GL_INVALID_OPERATION : GL_INVALID_ENUM;
}

std::size_t all_bytes(const Image& image) {
    return blocks_bytes(image.format, image.width, image.height) * static_cast<std::size_t>(image.depth);
}

GLenum image_error(Context& c, const Image& image, GLint border) {
    if (const GLenum error = target_error(image)) return error;
    const GLint levels = level_count(c, image.target);
    if (image.level < 0 || image.level >= levels || border != 0) return GL_INVALID_VALUE;
    ImageCall call;
    call.target = image.target, call.level = image.level;
    call.width = image.width, call.height = image.height, call.depth = image.depth;
    if (!legal_size(c, call)) return GL_INVALID_VALUE;
    return image.bytes < 0 || static_cast<std::size_t>(image.bytes) != all_bytes(image) ? GL_INVALID_VALUE
                                                                                        : GL_NO_ERROR;
}

/// What a program gives or is given.
BlockImage in_memory(const Image& image) {
    return {image.format, {image.width, image.height, image.depth, image.dimensions}};
}

/// The blocks that a program gives, without gaps; empty, and maybe an error: there are none.
std::vector<std::byte> given_blocks(Context& c, const Image& image, const void* data) {
    const glapi::PixelStore store = unpack_store(c.state);
    const BlockImage blocks = in_memory(image);
    const auto* from = static_cast<const std::byte*>(unpack_source(c, data, block_memory_bytes(store, blocks)));
    return from ? unpack_blocks(store, blocks, from) : std::vector<std::byte>();
}

TextureLevel described(const Image& image) {
    TextureLevel level;
    level.internal_format = image.format;
    level.width = image.width;
    level.height = image.height;
    level.depth = image.depth;
    level.compressed = true;
    return level;
}

GLenum sub_image_error(const TextureLevel& level, const Image& part, const Place& at) {
    if (!level.compressed || level.internal_format != part.format) return GL_INVALID_OPERATION;
    const auto inside = [](GLint from, GLsizei size, GLint all) {
        return from >= 0 && size >= 0 && std::int64_t{from} + size <= all;
    };
    if (!inside(at.x, part.width, level.width) || !inside(at.y, part.height, level.height) ||
        !inside(at.z, part.depth, level.depth))
        return GL_INVALID_VALUE;
    const auto block = block_size(part.format);
    if (!is_whole_blocks(at.x, part.width, level.width, block.width) ||
        !is_whole_blocks(at.y, part.height, level.height, block.height))
        return GL_INVALID_OPERATION;
    return static_cast<std::size_t>(part.bytes) == all_bytes(part) ? GL_NO_ERROR : GL_INVALID_VALUE;
}

void copy_blocks(TextureLevel& level, const Image& part, const Place& at, const std::byte* from) {
    const std::size_t slice = blocks_bytes(level.internal_format, level.width, level.height),
                      row = row_of_blocks_bytes(level.internal_format, level.width),
                      part_row = row_of_blocks_bytes(part.format, part.width);
    const std::size_t left = row_of_blocks_bytes(part.format, at.x);
    const GLsizei side = block_size(part.format).height;
    for (GLsizei z = 0; z < part.depth; ++z)
        for (GLsizei done = 0; done < part.height; done += side, from += part_row)
            std::memcpy(level.pixels.data() + static_cast<std::size_t>(at.z + z) * slice +
                            static_cast<std::size_t>((at.y + done) / side) * row + left,
                        from, part_row);
}

/// What a node's driver makes of an image; nothing if none answers. It is asked slice by slice, for a large one in rows
/// of blocks.
std::optional<std::vector<std::byte>> compressed(Context& c, const Image& image, const TexelData& data,
                                                 const char* function) {
    const auto layout = glapi::pixel_layout(data.format, data.type);
    if (!layout) return std::nullopt;
    const std::size_t row = glapi::row_bytes(*layout, image.width);
    const auto most = static_cast<GLsizei>(std::max<std::size_t>(kMostAsked / row / kBlockSide, 1)) * kBlockSide;
    std::vector<std::byte> blocks;
    for (GLsizei line = 0; line < image.height * image.depth;) {
        const GLsizei height = std::min(most, image.height - line % image.height);
        const auto pixels =
            std::span(data.bytes).subspan(static_cast<std::size_t>(line) * row, static_cast<std::size_t>(height) * row);
        line += height;
        const auto answer = ask_one_node(c, function, [&](wire::PackBuffer& buffer, RequestId request) {
            glapi::pack::Compress(buffer, request, static_cast<GLenum>(image.format), image.width, height, data.format,
                                  data.type, pixels);
        });
        if (!answer || answer->bytes.size() != blocks_bytes(image.format, image.width, height)) return std::nullopt;
        blocks.insert(blocks.end(), answer->bytes.begin(), answer->bytes.end());
    }
    return blocks;
}

}  // namespace
}  // namespace wall::client::api

namespace wall::client {

GLint blocks_format(GLint internal_format) {
    const TextureFormat* format = find_texture_format(internal_format);
    return format && block_bytes(format->answer) != 0 ? format->answer : 0;
}

void store_empty_blocks(Context& c, const ImageCall& call) {
    const api::Image image{.target = call.target,
                           .level = call.level,
                           .format = call.internal_format,
                           .width = call.width,
                           .height = call.height,
                           .depth = call.depth};
    const auto texture = texture_to_change(c, call.target);
    std::lock_guard lock(c.share().mutex);
    TextureLevel& level = texture->level_at(face_of(call.target), call.level);
    level = api::described(image);
    level.pixels.resize(api::all_bytes(image));
    level.content = LevelContent::stored;
    level.stamp = next_stamp();
    touch(c.share(), *texture);
}

void compress_as_driver(Context& c, GLenum target, GLint number, const char* function) {
    if (const auto texture = bound_texture(c, target)) keep_as_blocks(c, *texture, face_of(target), number, function);
}

void keep_as_blocks(Context& c, Texture& texture, unsigned face, GLint number, const char* function) {
    api::Image image{.target = glapi::image_target(texture.info, face), .level = number};
    TexelData data;
    {
        std::lock_guard lock(c.share().mutex);
        const TextureLevel* level = texture.find_level(face, number);
        if (!level || level->compressed || level->content == LevelContent::generated || level->width == 0 ||
            level->height == 0)
            return;
        image.format = blocks_format(level->internal_format);
        if (image.format == 0) return;
        image.width = level->width, image.height = level->height, image.depth = level->depth;
        if (level->content == LevelContent::stored) data = {level->data_format, level->data_type, level->pixels};
        else
            data = {GL_RGBA, GL_UNSIGNED_BYTE,
                    std::vector<std::byte>(std::size_t{4} * static_cast<std::size_t>(level->width) *
                                           static_cast<std::size_t>(level->height) *
                                           static_cast<std::size_t>(level->depth))};
    }
    auto blocks = api::compressed(c, image, data, function);
    if (!blocks) return;
    c.flush_block();
    std::lock_guard lock(c.share().mutex);
    TextureLevel& level = *texture.find_level(face, number);
    level = api::described(image);
    level.pixels = std::move(*blocks);
    level.content = LevelContent::stored;
    level.stamp = next_stamp();
    touch(c.share(), texture);
}

void put_blocks(ShareGroup& share, Texture& texture, unsigned face, GLint number, const TexBox& box,
                std::span<const std::byte> blocks) {
    const auto parts = kept_parts(texture, face, number, box);
    const std::size_t bytes = blocks.size() / parts.size();
    Texture& keeper = keeper_of(texture);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const TexBox& to = parts[i].box;
        TextureLevel* const level = keeper.find_level(parts[i].face, parts[i].level);
        if (!level || !level->compressed) continue;
        const api::Image part{.target = 0,
                              .level = parts[i].level,
                              .format = level->internal_format,
                              .width = to.width,
                              .height = to.height,
                              .depth = to.depth};
        api::copy_blocks(*level, part, {to.x, to.y, to.z}, blocks.subspan(i * bytes, bytes).data());
        level->stamp = next_stamp();
    }
    touch(share, keeper);
}

bool change_blocks(Context& c, const ImageCall& call, const TexelData& data) {
    const auto texture = texture_to_change(c, call.target);
    const GLint format = texture->find_level(face_of(call.target), call.level)->internal_format;
    const api::Image part{.target = call.target,
                          .level = call.level,
                          .format = format,
                          .width = call.width,
                          .height = call.height,
                          .depth = call.depth};
    const auto blocks = api::compressed(c, part, data, "glTexSubImage2D");
    if (!blocks) return false;
    if (texture->view.origin) c.before_change(texture->view.origin->id);
    std::lock_guard lock(c.share().mutex);
    put_blocks(c.share(), *texture, face_of(call.target), call.level,
               {call.x, call.y, call.z, call.width, call.height, call.depth, 0}, *blocks);
    generate_if_asked(*texture, call.level);
    touch(c.share(), *texture);
    return true;
}

}  // namespace wall::client

namespace wall::client::api {
namespace {

void define_blocks(Context& c, const Image& image, GLint border, const void* data) {
    const GLenum error = image_error(c, image, border);
    if (is_proxy(image.target) && target_error(image) == GL_NO_ERROR) {
        c.maps->proxies[{image.target, image.level}] = error == GL_NO_ERROR ? described(image) : TextureLevel{};
        return;
    }
    if (error != GL_NO_ERROR) return c.error(error);
    if (is_immutable(c, image.target)) return c.error(GL_INVALID_OPERATION);
    if (const GLenum wrong = block_store_error(unpack_store(c.state), image.dimensions)) return c.error(wrong);
    const auto bytes = static_cast<std::size_t>(image.bytes);
    auto blocks = given_blocks(c, image, data);
    if (blocks.size() != bytes && c.state.local.pixel_unpack_buffer) return;
    const auto texture = texture_to_change(c, image.target);
    std::lock_guard lock(c.share().mutex);
    TextureLevel& level = texture->level_at(face_of(image.target), image.level);
    level = described(image);
    level.pixels = std::move(blocks);
    level.pixels.resize(bytes);
    level.content = LevelContent::stored;
    level.stamp = next_stamp();
    generate_if_asked(*texture, image.level);
    touch(c.share(), *texture);
}

void define_sub_blocks(Context& c, const Image& part, const Place& at, const void* data) {
    if (is_proxy(part.target)) return c.error(GL_INVALID_ENUM);
    if (const GLenum error = target_error(part)) return c.error(error);
    if (part.level < 0 || part.level >= level_count(c, part.target) || part.bytes < 0) return c.error(GL_INVALID_VALUE);
    compress_as_driver(c, part.target, part.level, "glCompressedTexSubImage");
    const auto texture = bound_texture(c, part.target);
    const TextureLevel* level = texture ? texture->find_level(face_of(part.target), part.level) : nullptr;
    if (const GLenum error = level ? sub_image_error(*level, part, at) : GLenum{GL_INVALID_OPERATION})
        return c.error(error);
    if (const GLenum wrong = block_store_error(unpack_store(c.state), part.dimensions)) return c.error(wrong);
    const auto blocks = given_blocks(c, part, data);
    if (blocks.empty()) return;
    const auto changed = texture_to_change(c, part.target);
    if (changed->view.origin) c.before_change(changed->view.origin->id);
    std::lock_guard lock(c.share().mutex);
    put_blocks(c.share(), *changed, face_of(part.target), part.level,
               {at.x, at.y, at.z, part.width, part.height, part.depth, 0}, blocks);
    generate_if_asked(*changed, part.level);
    touch(c.share(), *changed);
}

/// What OpenGL has for a format that only OpenGL ES names: decoders of ETC2 read ETC1 (OpenGL 4.3, C.1.1).
GLenum format_of_blocks(const Context& c, GLenum internal) {
    return internal == GL_ETC1_RGB8_OES && c.profile.is_es() ? GLenum{GL_COMPRESSED_RGB8_ETC2} : internal;
}

/// The arguments of glCompressedTexImage2D that palettes are given by.
struct PaletteImage {
    GLenum target;
    GLsizei width, height, bytes;
    const void* data;
};

/// Levels of it are images of texels from then on, as in Mesa. `last`: 0, or the number of the last level, negative.
void define_palette_images(Context& c, const PaletteFormat& format, const PaletteImage& image, GLint last,
                           GLint border) {
    const auto* from = static_cast<const std::byte*>(image.data);
    if (image.target != GL_TEXTURE_2D) return c.error(GL_INVALID_ENUM);
    const GLint levels = level_count(c, image.target);
    if (last > 0 || last <= -levels || image.width < 0 || image.height < 0 || border != 0)
        return c.error(GL_INVALID_VALUE);
    ImageCall call;
    call.target = image.target, call.width = image.width, call.height = image.height, call.depth = 1;
    const auto count = static_cast<unsigned>(-last) + 1;
    if (!legal_size(c, call) || image.bytes < 0 ||
        static_cast<std::size_t>(image.bytes) != palette_image_bytes(format, image.width, image.height, count))
        return c.error(GL_INVALID_VALUE);
    for (unsigned level = 0; level < count; ++level) {
        call.level = static_cast<GLint>(level);
        call.width = size_of_level(image.width, level), call.height = size_of_level(image.height, level);
        call.format = format.colors.format, call.type = format.colors.type;
        call.internal_format = static_cast<GLint>(call.format);
        call.store.alignment = 1;
        std::vector<std::byte> texels;
        if (from)
            texels =
                palette_texels(format, image.width, image.height, level, {from, static_cast<std::size_t>(image.bytes)});
        call.pixels = from ? texels.data() : nullptr;
        define_image(c, call);
    }
}

}  // namespace

void CompressedTexImage2D(Context& c, GLenum target, GLint level, GLenum internal, GLsizei width, GLsizei height,
                          GLint border, GLsizei bytes, const void* data) {
    if (const auto palette = c.profile.is_es1() ? palette_format(internal) : std::nullopt) {
        const PaletteImage image{target, width, height, bytes, data};
        return define_palette_images(c, *palette, image, level, border);
    }
    internal = format_of_blocks(c, internal);
    define_blocks(c, {target, level, static_cast<GLint>(internal), width, height, 1, bytes, 2}, border, data);
}
void CompressedTexImage3D(Context& c, GLenum target, GLint level, GLenum internal, GLsizei width, GLsizei height,
                          GLsizei depth, GLint border, GLsizei bytes, const void* data) {
    define_blocks(c, {target, level, static_cast<GLint>(internal), width, height, depth, bytes, 3}, border, data);
}
void CompressedTexSubImage2D(Context& c, GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                             GLenum format, GLsizei bytes, const void* data) {
    format = format_of_blocks(c, format);
    define_sub_blocks(c, {target, level, static_cast<GLint>(format), width, height, 1, bytes, 2}, {x, y, 0}, data);
}
void CompressedTexSubImage3D(Context& c, GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                             GLsizei height, GLsizei depth, GLenum format, GLsizei bytes, const void* data) {
    define_sub_blocks(c, {target, level, static_cast<GLint>(format), width, height, depth, bytes, 3}, {x, y, z}, data);
}

namespace {

/// The blocks of one image of what is bound. Null, and an error: there are none.
const TextureLevel* blocks_of(Context& c, GLenum target, GLint number) {
    if (number < 0 || number >= level_count(c, target)) return c.error(GL_INVALID_VALUE), nullptr;
    compress_as_driver(c, target, number, "glGetCompressedTexImage");
    const auto texture = bound_texture(c, target);
    if (texture) {
        std::lock_guard lock(c.share().mutex);
        refresh_view(*texture, face_of(target), number);
    }
    const TextureLevel* level = texture ? texture->find_level(face_of(target), number) : nullptr;
    if (level && level->compressed) return level;
    c.error(GL_INVALID_OPERATION);
    return nullptr;
}

/// Whether all blocks of a level are there.
bool has_all_blocks(const TextureLevel& level) {
    return level.pixels.size() >=
           blocks_bytes(level.internal_format, level.width, level.height) * static_cast<std::size_t>(level.depth);
}

/// Into the program's memory, which has room for `room` bytes; nothing: it did not say. `blocks` are all of the image.
void give(Context& c, const BlockImage& image, std::span<const std::byte> blocks, std::optional<GLsizei> room,
          void* pixels) {
    const glapi::PixelStore store = pack_store(c.state);
    if (const GLenum error = block_store_error(store, image.size.dimensions)) return c.error(error);
    const std::size_t reach = block_memory_bytes(store, image);
    if (room && c.state.local.pixel_pack_buffer == 0 && (*room < 0 || reach > static_cast<std::size_t>(*room)))
        return c.error(GL_INVALID_OPERATION);
    if (const PackTarget to = pack_target(c, pixels, reach))
        pack_blocks(store, image, blocks, static_cast<std::byte*>(to.get()));
}

void get_blocks(Context& c, GLenum target, GLint number, std::optional<GLsizei> room, void* pixels) {
    const auto* info = image_target_of(target);
    if (is_proxy(target) || !info) return c.error(GL_INVALID_ENUM);
    const TextureLevel* level = blocks_of(c, target, number);
    if (!level || !has_all_blocks(*level)) return;
    give(c, {level->internal_format, {level->width, level->height, level->depth, info->images}}, level->pixels, room,
         pixels);
}

struct BlockPart {
    GLint x, y, z;
    GLsizei width, height, depth;
};

/// Whole blocks, but at the level's end.
bool are_whole_blocks(const BlockPart& part, const TextureLevel& level) {
    const auto block = block_size(level.internal_format);
    return is_whole_blocks(part.x, part.width, level.width, block.width) &&
           is_whole_blocks(part.y, part.height, level.height, block.height);
}

void append(std::vector<std::byte>& out, const TextureLevel& level, const BlockPart& part, GLint slice) {
    const auto blocks = cut_blocks(level, {part.x, part.y, slice, part.width, part.height, 1, 0});
    out.insert(out.end(), blocks.begin(), blocks.end());
}

/// Faces that are not alike are no cube.
bool are_alike(const TextureLevel& a, const TextureLevel& b) {
    return a.width == b.width && a.height == b.height && a.internal_format == b.internal_format;
}

/// Of a texture by name; the faces of a cube map are slices.
void get_named_blocks(Context& c, GLuint name, GLint number, const std::optional<BlockPart>& wanted, GLsizei room,
                      void* pixels) {
    const NamedTexture named(c, name);
    if (!named) return;
    const glapi::TextureTargetInfo& info = named.texture()->info;
    if (info.images == 0 || info.samples) return c.error(GL_INVALID_OPERATION);
    const bool cube = info.first_face != 0;
    const TextureLevel* const first = blocks_of(c, cube ? info.first_face : info.target, number);
    if (!first) return;
    const TextureLevel* level = first;
    const GLint slices = cube ? static_cast<GLint>(glapi::kCubeFaces) : level->depth;
    const BlockPart part = wanted.value_or(BlockPart{0, 0, 0, level->width, level->height, slices});
    const auto inside = [](GLint at, GLsizei count, GLint all) {
        return at >= 0 && count >= 0 && std::int64_t{at} + count <= all;
    };
    if (!inside(part.x, part.width, level->width) || !inside(part.y, part.height, level->height) ||
        !inside(part.z, part.depth, slices))
        return c.error(GL_INVALID_VALUE);
    if (!are_whole_blocks(part, *level)) return c.error(GL_INVALID_VALUE);
    std::vector<std::byte> blocks;
    for (GLint z = part.z; z < part.z + part.depth; ++z) {
        if (cube) level = blocks_of(c, glapi::image_target(info, static_cast<unsigned>(z)), number);
        if (!level) return;
        if (!are_alike(*level, *first) || !has_all_blocks(*level)) return c.error(GL_INVALID_OPERATION);
        append(blocks, *level, part, cube ? 0 : z);
    }
    const unsigned dimensions = cube ? 3u : info.images;
    give(c, {first->internal_format, {part.width, part.height, part.depth, dimensions}}, blocks, room, pixels);
}

}  // namespace

void GetCompressedTexImage(Context& c, GLenum target, GLint number, void* pixels) {
    get_blocks(c, target, number, std::nullopt, pixels);
}
void GetnCompressedTexImage(Context& c, GLenum target, GLint number, GLsizei room, void* pixels) {
    get_blocks(c, target, number, room, pixels);
}
void GetCompressedTextureImage(Context& c, GLuint name, GLint number, GLsizei room, void* pixels) {
    get_named_blocks(c, name, number, std::nullopt, room, pixels);
}
void GetCompressedTextureSubImage(Context& c, GLuint name, GLint number, GLint x, GLint y, GLint z, GLsizei width,
                                  GLsizei height, GLsizei depth, GLsizei room, void* pixels) {
    get_named_blocks(c, name, number, BlockPart{x, y, z, width, height, depth}, room, pixels);
}

// No format is for them.
void CompressedTexImage1D(Context& c, GLenum, GLint, GLenum, GLsizei, GLint, GLsizei, const void*) {
    c.error(GL_INVALID_ENUM);
}
void CompressedTexSubImage1D(Context& c, GLenum, GLint, GLint, GLsizei, GLenum, GLsizei, const void*) {
    c.error(GL_INVALID_ENUM);
}

}  // namespace wall::client::api
