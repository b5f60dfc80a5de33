// SPDX-License-Identifier: MIT
#include "tileserver/execute/texture_commands.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "common/glapi/block_formats.h"
#include "tileserver/execute/image_check.h"

namespace wall::tileserver {
namespace {

constexpr std::int32_t kMaxTextureExtent = kMaxImageSide + 2;  // texels, with borders
constexpr std::int32_t kMaxTextureLevel = 16;
constexpr std::uint32_t kMaxSamples = 64;

bool sane_extent(const ImageExtent& extent) {
    return std::ranges::all_of(std::array{extent.width, extent.height, extent.depth},
                               [](std::int32_t side) { return side >= 0 && side <= kMaxTextureExtent; });
}

}  // namespace

Texture* TextureCommands::bind_to_edit(ClientName name, GLenum target) {
    const auto kind = texture_target(target);
    if (!kind || glapi::dimensions_of(glapi::info_of(*kind)) == 0) {
        execution_.refuse("no such target");
        return nullptr;
    }
    const auto made =
        execution_.session.objects.make<Texture>(Texture::key(name, *kind), execution_.node.driver, *kind);
    if (!made || (*made)->target() != *kind) {
        execution_.refuse(made ? "texture " + std::to_string(name.value) + " has another target"
                               : made.error().message);
        return nullptr;
    }
    Texture& texture = **made;
    if (!texture.own(execution_.node.shared)) execution_.refuse(too_much("texture memory"));
    if (texture.promise)
        execution_.node.shared.heard(texture.promise->key, execution_.session.asker(),
                                     std::chrono::steady_clock::now());
    execution_.node.driver.bind_texture_to_edit(*kind, texture.content().name());
    return &texture;
}

/// A driver refuses formats and sizes that no rule here knows of; the image is then the one of before.
template <class Define>
void TextureCommands::define_image(Texture& texture, GLenum target, std::int32_t level,
                                   const TextureContent::ImageFormat& format, Define&& define) {
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
    define();
    const unsigned errors = execution_.node.driver.drain_errors();
    execution_.session.work.gl_errors += errors;
    if (!texture.note_image(target, level, errors == 0 ? &format : nullptr))
        execution_.refuse(too_much("texture memory"));
}

void TextureCommands::TexImage(ClientName name, GLenum target, std::int32_t level, GLenum internal_format,
                               std::int32_t width, std::int32_t height, std::int32_t depth, std::int32_t border,
                               GLenum format, GLenum type, std::span<const std::byte> pixels) {
    if (!sane_extent({width, height, depth})) return execution_.refuse("absurd size");
    if (level < 0 || level > kMaxTextureLevel || border < 0 || border > 1)
        return execution_.refuse("no such level or border");
    const auto kind = texture_target(target);
    if (kind && glapi::info_of(*kind).images == 0) return execution_.refuse("no such target");
    if (!pixels.empty() && !image_fits(execution_, format, type, {width, height, depth}, pixels)) return;
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    const auto estimate = std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                          static_cast<std::uint64_t>(depth);
    if (!texture->affords_image(target, level, estimate)) return execution_.refuse(too_much("texture memory"));
    if (auto* hash = texture->hash())
        hash->TexImage(target, level, internal_format, width, height, depth, border, format, type, pixels);
    execution_.node.driver.neutral_pixel_transfer();
    const TextureContent::ImageFormat as{internal_format, format, type, false};
    define_image(*texture, target, level, as, [&] {
        upload_image(execution_.gl, texture->target(), target, level, as, {width, height, depth},
                     pixels.empty() ? nullptr : pixels.data(), border);
    });
}

void TextureCommands::TexSubImage(ClientName name, GLenum target, std::int32_t level, std::int32_t x, std::int32_t y,
                                  std::int32_t z, std::int32_t width, std::int32_t height, std::int32_t depth,
                                  GLenum format, GLenum type, std::span<const std::byte> pixels) {
    if (level < 0 || level > kMaxTextureLevel) return execution_.refuse("no such level");
    if (!image_fits(execution_, format, type, {width, height, depth}, pixels) || pixels.empty()) return;
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    if (auto* hash = texture->hash())
        hash->TexSubImage(target, level, x, y, z, width, height, depth, format, type, pixels);
    execution_.node.driver.neutral_pixel_transfer();
    const TextureTarget kind = texture->target();
    if (is_1d(kind)) execution_.gl.TexSubImage1D(target, level, x, width, format, type, pixels.data());
    else if (is_3d(kind))
        execution_.gl.TexSubImage3D(target, level, x, y, z, width, height, depth, format, type, pixels.data());
    else execution_.gl.TexSubImage2D(target, level, x, y, width, height, format, type, pixels.data());
}

void TextureCommands::TexCompressed(ClientName name, GLenum target, std::int32_t level, GLenum internal_format,
                                    std::int32_t width, std::int32_t height, std::int32_t depth,
                                    std::span<const std::byte> blocks) {
    if (!sane_extent({width, height, depth}) || level < 0 || level > kMaxTextureLevel)
        return execution_.refuse("absurd size");
    if (glapi::block_bytes(internal_format) == 0 ||
        blocks.size() != glapi::blocks_bytes(internal_format, width, height) * static_cast<std::size_t>(depth))
        return execution_.refuse("size does not fit the blocks");
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    if (!glapi::may_have_blocks(glapi::info_of(texture->target()), internal_format))
        return execution_.refuse("no such target");
    if (!texture->affords_image(target, level, blocks.size())) return execution_.refuse(too_much("texture memory"));
    if (auto* hash = texture->hash()) hash->TexCompressed(target, level, internal_format, width, height, depth, blocks);
    define_image(*texture, target, level, {internal_format, 0, 0, true}, [&] {
        const auto upload = texture->content().storage() ? upload_stored_blocks : upload_blocks;
        upload(execution_.gl, texture->target(), target, level, internal_format, {width, height, depth}, blocks);
    });
}

void TextureCommands::Compress(RequestId request, GLenum internal_format, std::int32_t width, std::int32_t height,
                               GLenum format, GLenum type, std::span<const std::byte> pixels) {
    if (width < 1 || height < 1 || width > kMaxTextureExtent || height > kMaxTextureExtent)
        return execution_.refuse("absurd size");
    if (glapi::block_bytes(internal_format) == 0) return execution_.refuse("no such compressed format");
    if (!image_fits(execution_, format, type, {width, height, 1}, pixels)) return;
    std::vector<std::byte> blocks(glapi::blocks_bytes(internal_format, width, height));
    execution_.node.driver.neutral_pixel_transfer();
    GLuint texture = 0;
    execution_.gl.CreateTextures(GL_TEXTURE_2D, 1, &texture);
    execution_.gl.TextureStorage2D(texture, 1, internal_format, width, height);
    execution_.gl.TextureSubImage2D(texture, 0, 0, 0, width, height, format, type, pixels.data());
    execution_.gl.GetCompressedTextureImage(texture, 0, static_cast<GLsizei>(blocks.size()), blocks.data());
    execution_.gl.DeleteTextures(1, &texture);
    execution_.output.reply(request, std::move(blocks));
}

void TextureCommands::TexParameter(ClientName name, GLenum target, GLenum pname, float p0, float p1, float p2,
                                   float p3) {
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    const std::array<float, 4> values = {p0, p1, p2, p3};
    texture->content().note_parameter(pname, values);
    if (auto* hash = texture->hash()) hash->TexParameter(target, pname, p0, p1, p2, p3);
    execution_.gl.TexParameterfv(target, pname, values.data());
}

void TextureCommands::TexBorderWhole(ClientName name, GLenum target, std::int32_t p0, std::int32_t p1, std::int32_t p2,
                                     std::int32_t p3) {
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    const std::array<GLint, 4> values = {p0, p1, p2, p3};
    texture->content().note_whole_border(values);
    if (auto* hash = texture->hash()) hash->TexBorderWhole(target, p0, p1, p2, p3);
    execution_.gl.TexParameterIiv(target, GL_TEXTURE_BORDER_COLOR, values.data());
}

void TextureCommands::TexImageSamples(ClientName name, GLenum target, std::uint32_t samples, GLenum internal_format,
                                      std::int32_t width, std::int32_t height, std::int32_t depth,
                                      std::uint32_t fixed_places) {
    const auto kind = texture_target(target);
    if (!kind || !glapi::info_of(*kind).samples) return execution_.refuse("no such target");
    if (!sane_extent({width, height, depth}) || samples < 1 || samples > kMaxSamples)
        return execution_.refuse("absurd size");
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    const auto estimate = std::uint64_t{4} * samples * static_cast<std::uint64_t>(width) *
                          static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(depth);
    if (!texture->affords_image(target, 0, estimate)) return execution_.refuse(too_much("texture memory"));
    if (auto* hash = texture->hash())
        hash->TexImageSamples(target, samples, internal_format, width, height, depth, fixed_places);
    const auto fixed = static_cast<GLboolean>(fixed_places != 0);
    const auto count = static_cast<GLsizei>(samples);
    define_image(*texture, target, 0, {internal_format, 0, 0, false}, [&] {
        if (glapi::info_of(*kind).layers != 0)
            execution_.gl.TexImage3DMultisample(target, count, internal_format, width, height, depth, fixed);
        else execution_.gl.TexImage2DMultisample(target, count, internal_format, width, height, fixed);
    });
}

// ---- shared content ----

void TextureCommands::ShareTexture(RequestId request, ClientName name, GLenum target, std::uint32_t own_name,
                                   std::span<const std::byte> key) {
    if (!bind_to_edit(name, target)) return;
    const bool own = own_name != 0;
    question_.ask(request, own, key, [this, name, target = *texture_target(target), own](auto have, const auto& asked) {
        const auto made =
            execution_.session.objects.make<Texture>(Texture::key(name, target), execution_.node.driver, target);
        if (!made) return execution_.refuse(made.error().message);
        Texture& texture = **made;
        if (have) adopt(texture, std::move(have));
        else texture.promise.emplace(Texture::Promise{asked, own ? std::nullopt : std::optional(glapi::ContentHash())});
    });
}

void TextureCommands::adopt(Texture& texture, std::shared_ptr<SharedContent> have) {
    auto content = content_as<TextureContent>(std::move(have));
    if (!content || content->target() != texture.target())
        return execution_.refuse("content is not what its name says");
    if (!texture.adopt(std::move(content))) execution_.refuse(too_much("texture memory"));
}

void TextureCommands::TexShared(ClientName name) {
    const auto found = execution_.session.objects.look_up<Texture>(Texture::key(name, TextureTarget::t2d));
    if (!found) return execution_.refuse(found.error().message);
    Texture* texture = *found;
    if (texture == nullptr || !texture->promise)
        return;  // the client did not wait for the answer, and that was: it is here
    auto promise = *std::exchange(texture->promise, {});
    if (promise.hash && promise.hash->finish() != promise.key)
        return execution_.refuse("content is not what its name says");
    auto held = content_as<TextureContent>(execution_.node.shared.store(promise.key, texture->shared()));
    if (held == texture->shared()) held->key = promise.key;
    else if (held && held->target() == texture->target()) adopt(*texture, std::move(held));
}

}  // namespace wall::tileserver
