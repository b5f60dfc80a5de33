// SPDX-License-Identifier: MIT
// Textures, runs, evaluator and pixel maps. Render thread.
#include <cmath>
#include <cstring>
#include <utility>

#include "common/glapi/image.h"
#include "common/wire/batch.h"
#include "tileserver/render/executor.h"
#include "tileserver/render/limits.h"

namespace wall::tileserver {
namespace {

constexpr std::int32_t kMaxTextureExtent = 16384 + 2;  // texels, with borders
constexpr std::int32_t kMaxLevel = 16;

std::vector<float> floats(std::span<const std::byte> bytes) {
    std::vector<float> out(bytes.size() / sizeof(float));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(float));
    return out;
}

/// The client has applied pixel transfer to the texels that it sends.
const glstate::State& neutral_state() {
    static const glstate::State state;
    return state;
}

/// Of 4x4 texels; 0: not one of the formats.
std::size_t s3tc_block_bytes(GLenum format) {
    if (format == GL_COMPRESSED_RGB_S3TC_DXT1_EXT || format == GL_COMPRESSED_RGBA_S3TC_DXT1_EXT) return 8;
    return format == GL_COMPRESSED_RGBA_S3TC_DXT3_EXT || format == GL_COMPRESSED_RGBA_S3TC_DXT5_EXT ? 16 : 0;
}

bool is_1d(TextureTarget target) { return target == TextureTarget::t1d; }
bool is_3d(TextureTarget target) {
    return target == TextureTarget::t3d || target == TextureTarget::t2d_array || target == TextureTarget::cube_map_array;
}

}  // namespace

bool Executor::check_image(GLenum format, GLenum type, std::int32_t width, std::int32_t height, std::int32_t depth, std::span<const std::byte> pixels) {
    const auto bytes = glapi::image_bytes(format, type, width, height, depth);
    if (!bytes)
        refuse("no such format, type or size");
    else if (*bytes != pixels.size())
        refuse("image has " + std::to_string(pixels.size()) + " bytes, expected " + std::to_string(*bytes));
    return !refused();
}

// ---- textures ----

Texture* Executor::bind_for_upload(std::uint32_t name, GLenum target) {
    const TextureTarget kind = texture_target(target);
    if (kind == TextureTarget::kCount || kind == TextureTarget::buffer || kind == TextureTarget::t2d_multisample) {
        refuse("no such target");
        return nullptr;
    }
    Texture* texture = session_.make_texture(ClientName(name), kind);
    if (texture == nullptr) {
        refuse("texture " + std::to_string(name) + " has another target, or there are too many");
        return nullptr;
    }
    node_.driver.bind_texture_to_edit(kind, texture->driver.value);
    return texture;
}

void Executor::TexImage(std::uint32_t name, GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width, std::int32_t height,
                        std::int32_t depth, std::int32_t border, GLenum format, GLenum type, std::span<const std::byte> pixels) {
    if (width < 0 || height < 0 || depth < 0 || width > kMaxTextureExtent || height > kMaxTextureExtent || depth > kMaxTextureExtent) return refuse("absurd size");
    if (level < 0 || level > kMaxLevel || border < 0 || border > 1) return refuse("no such level or border");
    if (!pixels.empty() && !check_image(format, type, width, height, depth, pixels)) return;
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    const auto estimate = std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(depth);
    if (!session_.account(*texture, target, level, estimate)) return refuse("more texture memory than a session may have");
    node_.driver.sync_pixel_transfer(neutral_state());
    const void* data = pixels.empty() ? nullptr : pixels.data();
    const auto internal = static_cast<GLint>(internal_format);
    if (is_1d(texture->target))
        gl_.TexImage1D(target, level, internal, width, border, format, type, data);
    else if (is_3d(texture->target))
        gl_.TexImage3D(target, level, internal, width, height, depth, border, format, type, data);
    else
        gl_.TexImage2D(target, level, internal, width, height, border, format, type, data);
}

void Executor::TexSubImage(std::uint32_t name, GLenum target, std::int32_t level, std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t width,
                           std::int32_t height, std::int32_t depth, GLenum format, GLenum type, std::span<const std::byte> pixels) {
    if (level < 0 || level > kMaxLevel) return refuse("no such level");
    if (!check_image(format, type, width, height, depth, pixels) || pixels.empty()) return;
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    node_.driver.sync_pixel_transfer(neutral_state());
    if (is_1d(texture->target))
        gl_.TexSubImage1D(target, level, x, width, format, type, pixels.data());
    else if (is_3d(texture->target))
        gl_.TexSubImage3D(target, level, x, y, z, width, height, depth, format, type, pixels.data());
    else
        gl_.TexSubImage2D(target, level, x, y, width, height, format, type, pixels.data());
}

void Executor::TexCompressed(std::uint32_t name, GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width, std::int32_t height,
                             std::span<const std::byte> blocks) {
    if (width < 0 || height < 0 || width > kMaxTextureExtent || height > kMaxTextureExtent || level < 0 || level > kMaxLevel) return refuse("absurd size");
    const std::size_t block = s3tc_block_bytes(internal_format);
    const auto across = [](std::int32_t texels) { return (static_cast<std::size_t>(texels) + 3) / 4; };
    if (block == 0 || blocks.size() != across(width) * across(height) * block) return refuse("size does not fit the blocks");
    Texture* texture = bind_for_upload(name, target);
    if (texture == nullptr) return;
    if (!session_.account(*texture, target, level, blocks.size())) return refuse("more texture memory than a session may have");
    if (texture->target != TextureTarget::t2d && texture->target != TextureTarget::cube_map) return refuse("no such target");
    gl_.CompressedTexImage2D(target, level, internal_format, width, height, 0, static_cast<GLsizei>(blocks.size()), blocks.data());
}

void Executor::TexParameter(std::uint32_t name, GLenum target, GLenum pname, float p0, float p1, float p2, float p3) {
    if (bind_for_upload(name, target) == nullptr) return;
    const std::array<float, 4> values = {p0, p1, p2, p3};
    gl_.TexParameterfv(target, pname, values.data());
}

void Executor::TexDelete(std::uint32_t name) { session_.delete_texture(ClientName(name)); }

// ---- runs ----

void Executor::RunDefine(std::uint32_t id, std::uint32_t commands, std::uint32_t operand_bytes, std::span<const std::byte> content) {
    const std::size_t room = wire::padded4(commands);
    if (operand_bytes > wire::kMaxFramePayload || commands > wire::kMaxFramePayload || content.size() != room + operand_bytes)
        return refuse("content does not fit its sizes");
    const auto opcodes = content.subspan(room - commands, commands);
    for (const std::byte op : opcodes)
        if (std::to_integer<std::size_t>(op) >= glapi::kOpCount || glapi::kOpGroups[std::to_integer<std::size_t>(op)] != glapi::OpGroup::geometry)
            return refuse("a run holds geometry only");
    RunDelete(id);
    session_.run_bytes += content.size();
    if (session_.run_bytes > kMaxRunBytes) return refuse("more runs than a session may have");
    session_.runs[id] = compile_run(opcodes, content.subspan(room));
}

Run Executor::compile_run(std::span<const std::byte> opcodes, std::span<const std::byte> operands) {
    Run run;
    run.bytes = wire::padded4(opcodes.size()) + operands.size();
    run.list = gl_.GenLists(1);
    gl_.NewList(run.list, GL_COMPILE);
    trail_.clear();
    draws_ = true;  // into the list
    const auto done = glapi::decode_run(opcodes, operands, *this);
    draws_ = false;
    if (std::exchange(in_begin_, false)) {
        gl_.End();
        refuse("a run ends between Begin and End");
    }
    gl_.EndList();
    run.trail = trail_;
    trail_.clear();
    if (!done && !refused()) refuse("run: " + done.error().message);
    return run;
}

void Executor::RunDelete(std::uint32_t id) {
    const auto at = session_.runs.find(id);
    if (at == session_.runs.end()) return;
    session_.run_bytes -= at->second.bytes;
    gl_.DeleteLists(at->second.list, 1);
    session_.runs.erase(at);
}

// ---- maps ----

void Executor::Map1(GLenum target, float u1, float u2, std::int32_t order, std::span<const std::byte> points) {
    const std::size_t i = evaluator_index(target, false);
    if (i >= kEvaluatorMaps || order < 1 || order > kMaxEvalOrder || u1 == u2) return refuse("no such map");
    if (points.size() != sizeof(float) * evaluator_components(i) * static_cast<std::size_t>(order)) return refuse("points do not fit the order");
    context_->maps.map1[i] = {glstate::next_value_id(), u1, u2, 0, 1, order, 1, floats(points)};
    context_->maps.any_evaluator = true;
}

void Executor::Map2(GLenum target, float u1, float u2, std::int32_t uorder, float v1, float v2, std::int32_t vorder, std::span<const std::byte> points) {
    const std::size_t i = evaluator_index(target, true);
    if (i >= kEvaluatorMaps || uorder < 1 || uorder > kMaxEvalOrder || vorder < 1 || vorder > kMaxEvalOrder || u1 == u2 || v1 == v2) return refuse("no such map");
    if (points.size() != sizeof(float) * evaluator_components(i) * static_cast<std::size_t>(uorder) * static_cast<std::size_t>(vorder))
        return refuse("points do not fit the orders");
    context_->maps.map2[i] = {glstate::next_value_id(), u1, u2, v1, v2, uorder, vorder, floats(points)};
    context_->maps.any_evaluator = true;
}

void Executor::PixelMap(GLenum map, std::span<const std::byte> values) {
    const std::size_t i = pixel_map_index(map);
    if (i >= kPixelMaps || values.empty() || values.size() % sizeof(float) != 0 || values.size() / sizeof(float) > kMaxPixelMapTable) return refuse("no such map");
    context_->maps.pixel[i] = {glstate::next_value_id(), floats(values)};
    context_->maps.any_pixel = true;
}

}  // namespace wall::tileserver
