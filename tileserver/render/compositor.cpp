// SPDX-License-Identifier: MIT
#include "tileserver/render/compositor.h"

#include <algorithm>

namespace wall::tileserver {
namespace {

std::string to_rgb(const std::uint8_t* rgba, std::size_t pixels) {
    std::string rgb(pixels * 3, '\0');
    char* to = rgb.data();
    for (std::size_t i = 0; i < pixels; ++i, to += 3, rgba += 4) {
        to[0] = static_cast<char>(rgba[0]);
        to[1] = static_cast<char>(rgba[1]);
        to[2] = static_cast<char>(rgba[2]);
    }
    return rgb;
}

}  // namespace

Compositor::~Compositor() {
    for (auto& [slot, target] : targets_) release(target);
    gl_.DeleteFramebuffers(1, &source_);
    for (const Readback& readback : readbacks_) {
        gl_.DeleteSync(readback.done);
        gl_.DeleteBuffers(1, &readback.buffer);
    }
}

void Compositor::set_background(std::uint32_t rgb) {
    for (unsigned i = 0; i < 3; ++i) background_[i] = static_cast<float>(rgb >> (16 - 8 * i) & 0xff) / 255.0f;
    ++node_.damage;
}

void Compositor::set_stacking(std::vector<StackEntry> bottom_first) {
    stacking_ = std::move(bottom_first);
    ++node_.damage;
}

const Tile* Compositor::tile(std::uint32_t slot) const {
    const auto at = std::find_if(node_.tiles.begin(), node_.tiles.end(), [slot](const Tile& t) { return t.slot == slot; });
    return at == node_.tiles.end() ? nullptr : &*at;
}

void Compositor::release(TileTarget& target) {
    gl_.DeleteFramebuffers(1, &target.framebuffer);
    gl_.DeleteTextures(1, &target.texture);
    target = TileTarget{};
}

Compositor::TileTarget& Compositor::target(const Tile& tile) {
    TileTarget& target = targets_[tile.slot];
    if (target.texture != 0 && target.rect == tile.rect) return target;
    release(target);
    target.rect = tile.rect;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &target.texture);
    gl_.TextureStorage2D(target.texture, 1, GL_RGBA8, tile.rect.width, tile.rect.height);
    gl_.CreateFramebuffers(1, &target.framebuffer);
    gl_.NamedFramebufferTexture(target.framebuffer, GL_COLOR_ATTACHMENT0, target.texture, 0);
    return target;
}

void Compositor::compose(TileTarget& target, std::uint32_t slot, SessionId only) {
    if (target.composed == node_.damage && target.only == only) return;
    target.composed = node_.damage;
    target.only = only;
    node_.driver.disable_scissor();
    gl_.ClearTexImage(target.texture, 0, GL_RGBA, GL_FLOAT, background_.data());
    for (const StackEntry& entry : stacking_) {
        if (only && entry.session != only) continue;
        const Surface* surface = find_(entry);
        const Layer* layer = surface != nullptr ? surface->layer(slot) : nullptr;
        if (layer != nullptr) draw_layer(target, *layer);
    }
}

void Compositor::draw_layer(const TileTarget& target, const Layer& layer) {
    // The tile's texture has its top row first.
    if (source_ == 0) gl_.CreateFramebuffers(1, &source_);
    gl_.NamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, layer.front(), 0);
    const geom::Rect& area = layer.geometry().area;
    const std::int32_t x = area.x - target.rect.x, y = area.y - target.rect.y;
    const std::int32_t first = layer.top_row_first() ? 0 : area.height, last = area.height - first;
    gl_.BlitNamedFramebuffer(source_, target.framebuffer, 0, first, area.width, last, x, y, x + area.width, y + area.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.NamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, 0, 0);
}

void Compositor::request(std::uint32_t request, std::uint32_t slot, SessionId session) {
    const Tile* wanted = tile(slot);
    if (wanted == nullptr) {
        refused_.push_back({request, 0, 0, {}, "this node has no tile in slot " + std::to_string(slot)});
        return;
    }
    TileTarget& picture = target(*wanted);
    compose(picture, slot, session);
    Readback readback{request, {0, 0, picture.rect.width, picture.rect.height}, 0, nullptr};
    node_.driver.neutral_pixel_transfer();
    node_.driver.forget_layer();
    gl_.CreateBuffers(1, &readback.buffer);
    gl_.NamedBufferStorage(readback.buffer, GLsizeiptr{4} * picture.rect.width * picture.rect.height, nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer);
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, readback.buffer);
    gl_.ReadPixels(0, 0, picture.rect.width, picture.rect.height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    readback.done = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl_.Flush();
    readbacks_.push_back(readback);
}

Picture Compositor::finish(const Readback& readback) {
    Picture picture{readback.request, static_cast<std::uint32_t>(readback.size.width), static_cast<std::uint32_t>(readback.size.height), {}, {}};
    const std::size_t pixels = std::size_t{picture.width} * picture.height;
    const auto* rgba = static_cast<const std::uint8_t*>(gl_.MapNamedBufferRange(readback.buffer, 0, static_cast<GLsizeiptr>(pixels * 4), GL_MAP_READ_BIT));
    if (rgba != nullptr)
        picture.rgb = to_rgb(rgba, pixels);
    else
        picture.error = "the driver did not give the pixels";
    gl_.UnmapNamedBuffer(readback.buffer);
    gl_.DeleteBuffers(1, &readback.buffer);
    gl_.DeleteSync(readback.done);
    return picture;
}

std::vector<Picture> Compositor::collect(bool wait) {
    std::vector<Picture> pictures = std::exchange(refused_, {});
    constexpr GLuint64 kLongest = 5'000'000'000;  // ns
    while (!readbacks_.empty()) {
        const GLenum state = gl_.ClientWaitSync(readbacks_.front().done, GL_SYNC_FLUSH_COMMANDS_BIT, wait ? kLongest : 0);
        if (state == GL_TIMEOUT_EXPIRED && !wait) break;
        pictures.push_back(finish(readbacks_.front()));
        readbacks_.pop_front();
    }
    return pictures;
}

}  // namespace wall::tileserver
