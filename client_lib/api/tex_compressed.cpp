// SPDX-License-Identifier: MIT
// Compressed texture images (OpenGL 2.1, 3.8.3): the S3TC formats, kept and sent as they come. An image that comes as
// pixels is compressed by each node; when the program asks for its blocks or gives some, one node is asked what its
// driver makes of it. Formats for one and three dimensions there are none.
#include <algorithm>
#include <cstring>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/s3tc.h"
#include "client_lib/objects/texture_formats.h"

namespace wall::client::api {
namespace {

constexpr std::size_t kMostAsked = 16u << 20;  // bytes of pixels in one question

bool legal_target(GLenum target) {
    const auto* info = image_target_of(target);
    return info && info->blocks;
}

struct Image {
    GLenum target;
    GLint level, format;
    GLsizei width, height, bytes;
};

GLenum image_error(Context& c, const Image& image, GLint border) {
    if (!legal_target(image.target) || s3tc_block_bytes(image.format) == 0) return GL_INVALID_ENUM;
    const GLint levels = level_count(c, image.target);
    if (image.level < 0 || image.level >= levels || border != 0 || image.width < 0 || image.height < 0)
        return GL_INVALID_VALUE;
    const GLint most = std::max(1, 1 << (levels - 1) >> image.level);
    if (image.width > most || image.height > most) return GL_INVALID_VALUE;
    if (image_target_of(image.target)->square && image.width != image.height) return GL_INVALID_VALUE;
    const std::size_t bytes = s3tc_bytes(image.format, image.width, image.height);
    return image.bytes < 0 || static_cast<std::size_t>(image.bytes) != bytes ? GL_INVALID_VALUE : GL_NO_ERROR;
}

TextureLevel described(const Image& image) {
    TextureLevel level;
    level.internal_format = image.format;
    level.width = image.width;
    level.height = image.height;
    level.depth = 1;
    level.compressed = true;
    return level;
}

GLenum sub_image_error(const TextureLevel& level, const Image& part, GLint x, GLint y) {
    if (!level.compressed || level.internal_format != part.format) return GL_INVALID_OPERATION;
    const auto inside = [](GLint at, GLsizei size, GLint all) {
        return at >= 0 && size >= 0 && std::int64_t{at} + size <= all;
    };
    if (!inside(x, part.width, level.width) || !inside(y, part.height, level.height)) return GL_INVALID_VALUE;
    if (!is_whole_blocks(x, part.width, level.width) || !is_whole_blocks(y, part.height, level.height))
        return GL_INVALID_OPERATION;
    return static_cast<std::size_t>(part.bytes) == s3tc_bytes(part.format, part.width, part.height) ? GL_NO_ERROR
                                                                                                    : GL_INVALID_VALUE;
}

void copy_blocks(TextureLevel& level, const Image& part, GLint x, GLint y, const std::byte* from) {
    const std::size_t row = s3tc_bytes(level.internal_format, level.width, kS3tcBlock),
                      part_row = s3tc_bytes(part.format, part.width, kS3tcBlock);
    const std::size_t left = s3tc_bytes(part.format, x, kS3tcBlock);
    for (GLsizei done = 0; done < part.height; done += kS3tcBlock, from += part_row)
        std::memcpy(level.pixels.data() + static_cast<std::size_t>((y + done) / kS3tcBlock) * row + left, from,
                    part_row);
}

/// What a node's driver makes of an image; nothing if none answers. A large one is asked for in rows of blocks.
std::optional<std::vector<std::byte>> compressed(Context& c, const Image& image, const TexelData& data,
                                                 const char* function) {
    const auto layout = glapi::pixel_layout(data.format, data.type);
    if (!layout) return std::nullopt;
    const std::size_t row = glapi::row_bytes(*layout, image.width);
    const auto most = static_cast<GLsizei>(std::max<std::size_t>(kMostAsked / row / kS3tcBlock, 1)) * kS3tcBlock;
    std::vector<std::byte> blocks;
    for (GLsizei y = 0; y < image.height; y += most) {
        const GLsizei height = std::min(most, image.height - y);
        const auto pixels =
            std::span(data.bytes).subspan(static_cast<std::size_t>(y) * row, static_cast<std::size_t>(height) * row);
        const auto answer = ask_one_node(c, function, [&](wire::PackBuffer& buffer, RequestId request) {
            glapi::pack::Compress(buffer, request, static_cast<GLenum>(image.format), image.width, height, data.format,
                                  data.type, pixels);
        });
        if (!answer || answer->bytes.size() != s3tc_bytes(image.format, image.width, height)) return std::nullopt;
        blocks.insert(blocks.end(), answer->bytes.begin(), answer->bytes.end());
    }
    return blocks;
}

}  // namespace
}  // namespace wall::client::api

namespace wall::client {

GLint blocks_format(GLint internal_format) {
    const TextureFormat* format = find_texture_format(internal_format);
    return format && s3tc_block_bytes(format->answer) != 0 ? format->answer : 0;
}

void compress_as_driver(Context& c, GLenum target, GLint number) {
    const auto texture = bound_texture(c, target);
    api::Image image{target, number, 0, 0, 0, 0};
    TexelData data;
    {
        std::lock_guard lock(c.share().mutex);
        const TextureLevel* level = texture ? texture->find_level(face_of(target), number) : nullptr;
        if (!level || level->compressed || level->content == LevelContent::generated || level->width == 0 ||
            level->height == 0)
            return;
        image.format = blocks_format(level->internal_format);
        if (image.format == 0) return;
        image.width = level->width, image.height = level->height;
        if (level->content == LevelContent::stored) data = {level->data_format, level->data_type, level->pixels};
        else
            data = {GL_RGBA, GL_UNSIGNED_BYTE,
                    std::vector<std::byte>(std::size_t{4} * static_cast<std::size_t>(level->width) *
                                           static_cast<std::size_t>(level->height))};
    }
    auto blocks = api::compressed(c, image, data, "glGetCompressedTexImage");
    if (!blocks) return;
    c.flush_block();
    std::lock_guard lock(c.share().mutex);
    TextureLevel& level = *texture->find_level(face_of(target), number);
    level = api::described(image);
    level.pixels = std::move(*blocks);
    level.content = LevelContent::stored;
    level.stamp = next_stamp();
    touch(c.share(), *texture);
}

bool change_blocks(Context& c, const ImageCall& call, const TexelData& data) {
    const auto texture = texture_to_change(c, call.target);
    const GLint format = texture->find_level(face_of(call.target), call.level)->internal_format;
    const api::Image part{call.target, call.level, format, call.width, call.height, 0};
    const auto blocks = api::compressed(c, part, data, "glTexSubImage2D");
    if (!blocks) return false;
    std::lock_guard lock(c.share().mutex);
    TextureLevel& level = *texture->find_level(face_of(call.target), call.level);
    api::copy_blocks(level, part, call.x, call.y, blocks->data());
    level.stamp = next_stamp();
    generate_if_asked(*texture, call.level);
    touch(c.share(), *texture);
    return true;
}

}  // namespace wall::client

namespace wall::client::api {

void CompressedTexImage2D(Context& c, GLenum target, GLint number, GLenum internal, GLsizei width, GLsizei height,
                          GLint border, GLsizei bytes, const void* data) {
    const Image image{target, number, static_cast<GLint>(internal), width, height, bytes};
    const GLenum error = image_error(c, image, border);
    if (is_proxy(target) && legal_target(target)) {
        c.maps->proxies[{target, number}] = error == GL_NO_ERROR ? described(image) : TextureLevel{};
        return;
    }
    if (error != GL_NO_ERROR) return c.error(error);
    const auto* from = static_cast<const std::byte*>(unpack_source(c, data, static_cast<std::size_t>(bytes)));
    if (!from && c.state.local.pixel_unpack_buffer) return;
    const auto texture = texture_to_change(c, target);
    std::lock_guard lock(c.share().mutex);
    TextureLevel& level = texture->level_at(face_of(target), number);
    level = described(image);
    level.pixels.resize(static_cast<std::size_t>(bytes));
    if (from) std::copy(from, from + bytes, level.pixels.begin());
    level.content = LevelContent::stored;
    level.stamp = next_stamp();
    generate_if_asked(*texture, number);
    touch(c.share(), *texture);
}

void CompressedTexSubImage2D(Context& c, GLenum target, GLint number, GLint x, GLint y, GLsizei width, GLsizei height,
                             GLenum format, GLsizei bytes, const void* data) {
    if (is_proxy(target) || !legal_target(target) || s3tc_block_bytes(static_cast<GLint>(format)) == 0)
        return c.error(GL_INVALID_ENUM);
    if (number < 0 || number >= level_count(c, target) || bytes < 0) return c.error(GL_INVALID_VALUE);
    const Image part{target, number, static_cast<GLint>(format), width, height, bytes};
    compress_as_driver(c, target, number);
    const auto texture = bound_texture(c, target);
    const TextureLevel* level = texture ? texture->find_level(face_of(target), number) : nullptr;
    if (const GLenum error = level ? sub_image_error(*level, part, x, y) : GLenum{GL_INVALID_OPERATION})
        return c.error(error);
    const auto* from = static_cast<const std::byte*>(unpack_source(c, data, static_cast<std::size_t>(bytes)));
    if (!from || bytes == 0) return;
    const auto changed = texture_to_change(c, target);
    std::lock_guard lock(c.share().mutex);
    TextureLevel& to = *changed->find_level(face_of(target), number);
    copy_blocks(to, part, x, y, from);
    to.stamp = next_stamp();
    generate_if_asked(*changed, number);
    touch(c.share(), *changed);
}

void GetCompressedTexImage(Context& c, GLenum target, GLint number, void* pixels) {
    if (is_proxy(target) || !image_target_of(target)) return c.error(GL_INVALID_ENUM);
    if (number < 0 || number >= level_count(c, target)) return c.error(GL_INVALID_VALUE);
    compress_as_driver(c, target, number);
    const auto texture = bound_texture(c, target);
    const TextureLevel* level = texture ? texture->find_level(face_of(target), number) : nullptr;
    if (!level || !level->compressed) return c.error(GL_INVALID_OPERATION);
    if (const PackTarget to = pack_target(c, pixels, level->pixels.size()))
        std::memcpy(to.get(), level->pixels.data(), level->pixels.size());
}

// No format is for them.
void CompressedTexImage1D(Context& c, GLenum, GLint, GLenum, GLsizei, GLint, GLsizei, const void*) {
    c.error(GL_INVALID_ENUM);
}
void CompressedTexImage3D(Context& c, GLenum, GLint, GLenum, GLsizei, GLsizei, GLsizei, GLint, GLsizei, const void*) {
    c.error(GL_INVALID_ENUM);
}
void CompressedTexSubImage1D(Context& c, GLenum, GLint, GLint, GLsizei, GLenum, GLsizei, const void*) {
    c.error(GL_INVALID_ENUM);
}
void CompressedTexSubImage3D(Context& c, GLenum, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLsizei,
                             const void*) {
    c.error(GL_INVALID_ENUM);
}

}  // namespace wall::client::api
