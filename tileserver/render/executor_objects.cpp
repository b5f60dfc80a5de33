// SPDX-License-Identifier: MIT
// Textures, evaluator and pixel maps. Render thread.
#include <cmath>
#include <cstring>
#include <utility>

#include "common/glapi/image.h"
#include "common/glapi/s3tc.h"
#include "tileserver/render/executor.h"
#include "tileserver/render/limits.h"

namespace wall::tileserver {
namespace {

std::vector<float> floats(std::span<const std::byte> bytes) {
    std::vector<float> out(bytes.size() / sizeof(float));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(float));
    return out;
}

}  // namespace

bool Executor::check_image(GLenum format, GLenum type, std::int32_t width, std::int32_t height, std::int32_t depth,
                           std::span<const std::byte> pixels) {
    const auto bytes = glapi::image_bytes(format, type, width, height, depth);
    if (!bytes) refuse("no such format, type or size");
    else if (*bytes != pixels.size())
        refuse("image has " + std::to_string(pixels.size()) + " bytes, expected " + std::to_string(*bytes));
    return !refused();
}

// ---- textures ----

Texture* Executor::bind_for_upload(ClientName name, GLenum target) {
    const auto kind = texture_target(target);
    if (!kind || glapi::info_of(*kind).images == 0) {
        refuse("no such target");
        return nullptr;
    }
    Texture* texture = session_.make_texture(name, *kind);
    if (texture == nullptr) {
        refuse("texture " + std::to_string(name.value) + " has another target, or there are too many");
        return nullptr;
    }
    if (texture->content.use_count() > 1) {
        if (!session_.adopt(*texture, texture->content->copy())) refuse("more texture memory than a session may have");
    } else if (const auto key = std::exchange(texture->content->key, {})) {
        node_.textures.forget(*key, *texture->content);
    }
    if (texture->promise)
        node_.textures.heard(texture->promise->key, session_.asker(), std::chrono::steady_clock::now());
    node_.driver.bind_texture_to_edit(*kind, texture->content->name());
    return texture;
}

/// A driver refuses formats and sizes that no rule here knows of; the image is then the one of before.
template <class Define>
void Executor::define_image(Texture& texture, GLenum target, std::int32_t level,
                            const TextureContent::ImageFormat& format, Define&& define) {
    session_.work.gl_errors += node_.driver.drain_errors();
    define();
    const unsigned errors = node_.driver.drain_errors();
    session_.work.gl_errors += errors;
    session_.account(texture, target, level, errors == 0 ? &format : nullptr);
}

void Executor::TexImage(ClientName name, GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width,
                        std::int32_t height, std::int32_t depth, std::int32_t border, GLenum format, GLenum type,
                        std::span<const std::byte> pixels) {
    if (width < 0 || height < 0 || depth < 0 || width > kMaxTextureExtent || height > kMaxTextureExtent ||
        depth > kMaxTextureExtent)
        return refuse("absurd size");
    if (level < 0 || level > kMaxTextureLevel || border < 0 || border > 1) return refuse("no such level or border");
    if (!pixels.empty() && !check_image(format, type, width, height, depth, pixels)) return;
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    const auto estimate = std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                          static_cast<std::uint64_t>(depth);
    if (!session_.affords(*texture, target, level, estimate))
        return refuse("more texture memory than a session may have");
    if (auto* hash = texture->hash())
        hash->TexImage(target, level, internal_format, width, height, depth, border, format, type, pixels);
    node_.driver.neutral_pixel_transfer();
    const TextureContent::ImageFormat as{internal_format, format, type, false};
    define_image(*texture, target, level, as, [&] {
        upload_image(gl_, texture->content->target(), target, level, as, {width, height, depth},
                     pixels.empty() ? nullptr : pixels.data(), border);
    });
}

void Executor::TexSubImage(ClientName name, GLenum target, std::int32_t level, std::int32_t x, std::int32_t y,
                           std::int32_t z, std::int32_t width, std::int32_t height, std::int32_t depth, GLenum format,
                           GLenum type, std::span<const std::byte> pixels) {
    if (level < 0 || level > kMaxTextureLevel) return refuse("no such level");
    if (!check_image(format, type, width, height, depth, pixels) || pixels.empty()) return;
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    if (auto* hash = texture->hash())
        hash->TexSubImage(target, level, x, y, z, width, height, depth, format, type, pixels);
    node_.driver.neutral_pixel_transfer();
    const TextureTarget kind = texture->content->target();
    if (is_1d(kind)) gl_.TexSubImage1D(target, level, x, width, format, type, pixels.data());
    else if (is_3d(kind)) gl_.TexSubImage3D(target, level, x, y, z, width, height, depth, format, type, pixels.data());
    else gl_.TexSubImage2D(target, level, x, y, width, height, format, type, pixels.data());
}

void Executor::TexCompressed(ClientName name, GLenum target, std::int32_t level, GLenum internal_format,
                             std::int32_t width, std::int32_t height, std::span<const std::byte> blocks) {
    if (width < 0 || height < 0 || width > kMaxTextureExtent || height > kMaxTextureExtent || level < 0 ||
        level > kMaxTextureLevel)
        return refuse("absurd size");
    if (glapi::s3tc_block_bytes(internal_format) == 0 ||
        blocks.size() != glapi::s3tc_bytes(internal_format, width, height))
        return refuse("size does not fit the blocks");
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    if (!glapi::info_of(texture->content->target()).blocks) return refuse("no such target");
    if (!session_.affords(*texture, target, level, blocks.size()))
        return refuse("more texture memory than a session may have");
    if (auto* hash = texture->hash()) hash->TexCompressed(target, level, internal_format, width, height, blocks);
    define_image(*texture, target, level, {internal_format, 0, 0, true}, [&] {
        gl_.CompressedTexImage2D(target, level, internal_format, width, height, 0, static_cast<GLsizei>(blocks.size()),
                                 blocks.data());
    });
}

void Executor::Compress(RequestId request, GLenum internal_format, std::int32_t width, std::int32_t height,
                        GLenum format, GLenum type, std::span<const std::byte> pixels) {
    if (width < 1 || height < 1 || width > kMaxTextureExtent || height > kMaxTextureExtent)
        return refuse("absurd size");
    if (glapi::s3tc_block_bytes(internal_format) == 0) return refuse("no such compressed format");
    if (!check_image(format, type, width, height, 1, pixels)) return;
    std::vector<std::byte> blocks(glapi::s3tc_bytes(internal_format, width, height));
    node_.driver.neutral_pixel_transfer();
    GLuint texture = 0;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &texture);
    gl_.TextureStorage2D(texture, 1, internal_format, width, height);
    gl_.TextureSubImage2D(texture, 0, 0, 0, width, height, format, type, pixels.data());
    gl_.GetCompressedTextureImage(texture, 0, static_cast<GLsizei>(blocks.size()), blocks.data());
    gl_.DeleteTextures(1, &texture);
    output_.reply(request, std::move(blocks));
}

void Executor::TexParameter(ClientName name, GLenum target, GLenum pname, float p0, float p1, float p2, float p3) {
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    const std::array<float, 4> values = {p0, p1, p2, p3};
    texture->content->note_parameter(pname, values);
    if (auto* hash = texture->hash()) hash->TexParameter(target, pname, p0, p1, p2, p3);
    gl_.TexParameterfv(target, pname, values.data());
}

void Executor::TexDelete(ClientName name) { session_.delete_texture(name); }

// ---- maps ----

void Executor::Map1(GLenum target, float u1, float u2, std::int32_t order, std::span<const std::byte> points) {
    const std::size_t i = evaluator_index(target, false);
    if (i >= kEvaluatorMaps || order < 1 || order > kMaxEvalOrder || u1 == u2) return refuse("no such map");
    if (points.size() != sizeof(float) * evaluator_components(i) * static_cast<std::size_t>(order))
        return refuse("points do not fit the order");
    context_->maps.map1[i] = {glstate::next_value_id(), u1, u2, 0, 1, order, 1, floats(points)};
    context_->maps.any_evaluator = true;
}

void Executor::Map2(GLenum target, float u1, float u2, std::int32_t uorder, float v1, float v2, std::int32_t vorder,
                    std::span<const std::byte> points) {
    const std::size_t i = evaluator_index(target, true);
    if (i >= kEvaluatorMaps || uorder < 1 || uorder > kMaxEvalOrder || vorder < 1 || vorder > kMaxEvalOrder ||
        u1 == u2 || v1 == v2)
        return refuse("no such map");
    if (points.size() !=
        sizeof(float) * evaluator_components(i) * static_cast<std::size_t>(uorder) * static_cast<std::size_t>(vorder))
        return refuse("points do not fit the orders");
    context_->maps.map2[i] = {glstate::next_value_id(), u1, u2, v1, v2, uorder, vorder, floats(points)};
    context_->maps.any_evaluator = true;
}

void Executor::PixelMap(GLenum map, std::span<const std::byte> values) {
    const std::size_t i = pixel_map_index(map);
    if (i >= kPixelMaps || values.empty() || values.size() % sizeof(float) != 0 ||
        values.size() / sizeof(float) > kMaxPixelMapTable)
        return refuse("no such map");
    context_->maps.pixel[i] = {glstate::next_value_id(), floats(values)};
    context_->maps.any_pixel = true;
}

}  // namespace wall::tileserver
