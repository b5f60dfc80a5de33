// SPDX-License-Identifier: MIT
#include "tileserver/render/compositor.h"

#include <algorithm>

#include "common/log/log.h"

namespace wall::tileserver {
namespace {

std::uint32_t at_most(std::uint32_t wanted, std::int32_t limit) {
    const auto most = static_cast<std::uint32_t>(limit);
    return wanted == 0 ? most : std::min(wanted, most);
}

}  // namespace

Compositor::~Compositor() {
    for (auto& [slot, target] : targets_) release(target);
    for (auto& [slot, pattern] : patterns_) release(pattern.on_output);
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
    if (stacking_ == bottom_first) return;  // walld says it with other things, too
    stacking_ = std::move(bottom_first);
    ++node_.damage;
}

void Compositor::set_pattern(std::uint32_t slot, std::shared_ptr<const TestPattern> pattern) {
    auto& of_slot = patterns_[slot];
    release(of_slot.on_output);
    of_slot.what = std::move(pattern);
    if (!of_slot.what) patterns_.erase(slot);
    ++node_.damage;
}

void Compositor::tiles_changed() {
    while (!patterns_.empty()) set_pattern(patterns_.begin()->first, nullptr);
    for (auto at = targets_.begin(); at != targets_.end();) {
        if (tile(at->first) != nullptr) {
            ++at;
            continue;
        }
        release(at->second);
        output_pass_.forget(at->first);
        at = targets_.erase(at);
    }
}

void Compositor::draw_pattern(const TileTarget& target, const TestPattern& pattern) const {
    const auto pixels = pattern_pixels(pattern, target.rect);
    node_.driver.neutral_pixel_transfer();
    gl_.TextureSubImage2D(target.texture, 0, 0, 0, target.rect.width, target.rect.height, GL_RGBA, GL_UNSIGNED_BYTE,
                          pixels.data());
}

const Tile* Compositor::tile(std::uint32_t slot) const {
    const auto at =
        std::find_if(node_.tiles.begin(), node_.tiles.end(), [slot](const Tile& t) { return t.slot == slot; });
    return at == node_.tiles.end() ? nullptr : &*at;
}

void Compositor::release(TileTarget& target) const {
    if (target.texture == 0) return;
    gl_.DeleteFramebuffers(1, &target.framebuffer);
    node_.driver.forget_texture(target.texture);
    gl_.DeleteTextures(1, &target.texture);
    target = TileTarget{};
}

Compositor::TileTarget Compositor::make_target(const geom::Rect& rect) const {
    TileTarget target;
    target.rect = rect;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &target.texture);
    gl_.TextureStorage2D(target.texture, 1, GL_RGBA8, rect.width, rect.height);
    gl_.CreateFramebuffers(1, &target.framebuffer);
    gl_.NamedFramebufferTexture(target.framebuffer, GL_COLOR_ATTACHMENT0, target.texture, 0);
    return target;
}

Compositor::TileTarget& Compositor::target(const Tile& tile) {
    TileTarget& target = targets_[tile.slot];
    if (target.texture != 0 && target.rect == tile.rect) return target;
    release(target);
    return target = make_target(tile.rect);
}

/// A part of the picture, halved until one linear step is left, so that every pixel counts. Nothing is done where it
/// has that size.
Compositor::TileTarget Compositor::scaled(const PictureTexture& picture, geom::Rect part, std::int32_t width,
                                          std::int32_t height) const {
    TileTarget out;
    while (part.width != width || part.height != height) {
        const geom::Rect size{0, 0, std::max(width, (part.width + 1) / 2), std::max(height, (part.height + 1) / 2)};
        TileTarget to = make_target(size);
        gl_.BlitNamedFramebuffer(out.texture != 0 ? out.framebuffer : picture.framebuffer, to.framebuffer, part.x,
                                 part.y, part.right(), part.bottom(), 0, 0, size.width, size.height,
                                 GL_COLOR_BUFFER_BIT, GL_LINEAR);
        release(out);
        out = to;
        part = size;
    }
    return out;
}

PictureTexture Compositor::as_it_is(const TileTarget& target) {
    return {target.texture, target.framebuffer, target.rect.width, target.rect.height, target.version};
}

/// None: the output shows one eye, or the node has not been told of the other.
PictureTexture Compositor::of_right_eye(const geom::TileOutput& output, const TileTarget& of_left) {
    const Tile* right = output.stereo == geom::StereoLayout::none ? nullptr : tile(output.right_slot);
    if (right == nullptr || right->rect != of_left.rect) return {};
    TileTarget& whole = target(*right);
    compose(whole, right->slot, of_left.only);
    return as_it_is(whole);
}

PictureTexture Compositor::as_output_shows(const Tile& tile, const TileTarget& target) {
    const PictureTexture canvas = as_it_is(target);
    if (const auto found = patterns_.find(tile.slot); found != patterns_.end() && found->second.what->on_output) {
        auto& [what, drawn] = found->second;
        const geom::Rect size{0, 0, tile.output ? tile.output->width : tile.rect.width,
                              tile.output ? tile.output->height : tile.rect.height};
        if (drawn.texture == 0 || drawn.rect != size) {
            release(drawn);
            drawn = make_target(size);
            draw_pattern(drawn, *what);
        }
        return {drawn.texture, drawn.framebuffer, size.width, size.height, target.version};
    }
    if (!tile.output) return canvas;
    auto shown = output_pass_.show(tile.slot, tile.output, canvas, of_right_eye(*tile.output, target));
    if (shown) return *shown;
    if (!std::exchange(told_of_failure_, true))
        log::error("output_as_it_is reason={}", log::quoted(shown.error().message));
    return canvas;
}

void Compositor::compose(TileTarget& target, std::uint32_t slot, const StackEntry& only) {
    if (target.composed == node_.damage && target.only == only) return;
    target.composed = node_.damage;
    target.only = only;
    const auto found = patterns_.find(slot);
    const bool hidden = found != patterns_.end() && !found->second.what->on_output && !only.session;
    const auto pattern = hidden ? found->second.what : nullptr;
    if (pattern && target.pattern == pattern) return;  // whatever the programs behind it do
    target.version = ++compositions_;
    target.pattern = pattern;
    if (pattern) return draw_pattern(target, *pattern);
    const Tile* shown = tile(slot);
    node_.driver.disable_scissor();
    gl_.ClearTexImage(target.texture, 0, GL_RGBA, GL_FLOAT, background_.data());
    for (const StackEntry& entry : stacking_) {
        if (only.session && entry.session != only.session) continue;
        if (only.surface && entry.surface != only.surface) continue;
        const SurfaceReplica* surface = find_(entry);
        const Layer* layer = surface != nullptr ? surface->shown_layer(*shown) : nullptr;
        if (layer != nullptr) draw_layer(target, *layer);
        else if (const Layer* whole = surface != nullptr ? surface->shown_whole_layer(shown->eye) : nullptr)
            draw_whole(target, *whole, surface->where().rect);
    }
}

void Compositor::draw_layer(const TileTarget& target, const Layer& layer) {
    // The tile's texture has its top row first.
    if (source_ == 0) gl_.CreateFramebuffers(1, &source_);
    gl_.NamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, layer.front(), 0);
    const geom::Rect& area = layer.geometry().area;
    const std::int32_t x = area.x - target.rect.x, y = area.y - target.rect.y;
    const std::int32_t first = layer.top_row_first() ? 0 : area.height, last = area.height - first;
    gl_.BlitNamedFramebuffer(source_, target.framebuffer, 0, first, area.width, last, x, y, x + area.width,
                             y + area.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.NamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, 0, 0);
}

void Compositor::draw_whole(const TileTarget& target, const Layer& layer, const geom::Rect& place) {
    if (!geom::overlaps(target.rect, place)) return;
    if (source_ == 0) gl_.CreateFramebuffers(1, &source_);
    gl_.NamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, layer.front(), 0);
    const geom::Rect& area = layer.geometry().area;
    const std::int32_t x = place.x - target.rect.x, y = place.y - target.rect.y;
    const std::int32_t first = layer.top_row_first() ? 0 : area.height, last = area.height - first;
    const bool same_size = area.width == place.width && area.height == place.height;
    gl_.BlitNamedFramebuffer(source_, target.framebuffer, 0, first, area.width, last, x, y, x + place.width,
                             y + place.height, GL_COLOR_BUFFER_BIT, same_size ? GL_NEAREST : GL_LINEAR);
    gl_.NamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, 0, 0);
}

std::optional<PictureTexture> Compositor::output(std::uint32_t slot) {
    const Tile* wanted = tile(slot);
    if (wanted == nullptr) return {};
    TileTarget& whole = target(*wanted);
    compose(whole, slot, {});
    return as_output_shows(*wanted, whole);
}

void Compositor::request(const PictureRequest& request) {
    const Tile* wanted = tile(request.slot);
    if (wanted == nullptr) {
        refused_.push_back({request, 0, 0, {}, "this node has no tile in slot " + std::to_string(request.slot)});
        return;
    }
    const bool as_output = request.output && wanted->output;
    const geom::Rect whole = as_output ? geom::Rect{0, 0, wanted->output->width, wanted->output->height}
                                       : geom::Rect{0, 0, wanted->rect.width, wanted->rect.height},
                     crop = request.crop.empty() ? whole : geom::intersect(request.crop, whole);
    if (crop.empty()) {
        refused_.push_back({request, 0, 0, {}, "the tile is smaller than the part of it that is wanted"});
        return;
    }
    TileTarget& composed = target(*wanted);
    compose(composed, request.slot, {request.session, request.surface});
    node_.driver.disable_scissor();
    const PictureTexture picture = request.output ? as_output_shows(*wanted, composed) : as_it_is(composed);
    const auto width = static_cast<std::int32_t>(at_most(request.width, crop.width));
    const auto height = static_cast<std::int32_t>(at_most(request.height, crop.height));
    TileTarget small = scaled(picture, crop, width, height);
    const bool as_it_is = small.texture == 0;
    read_back(request, as_it_is ? picture.framebuffer : small.framebuffer,
              as_it_is ? crop : geom::Rect{0, 0, width, height});
    release(small);
}

void Compositor::read_back(const PictureRequest& request, GLuint framebuffer, const geom::Rect& part) {
    const std::size_t bytes =
        std::size_t{4} * static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height);
    Readback readback{request,
                      static_cast<std::uint32_t>(part.width),
                      static_cast<std::uint32_t>(part.height),
                      0,
                      nullptr,
                      budget_.hold(bytes)};
    node_.driver.neutral_pixel_transfer();
    node_.driver.forget_target();
    gl_.CreateBuffers(1, &readback.buffer);
    gl_.NamedBufferStorage(readback.buffer, static_cast<GLsizeiptr>(bytes), nullptr,
                           GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, readback.buffer);
    gl_.ReadPixels(part.x, part.y, part.width, part.height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    readback.done = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl_.Flush();
    readbacks_.push_back(std::move(readback));
}

Picture Compositor::finish(const Readback& readback) {
    Picture picture{readback.request, readback.width, readback.height, {}, {}, readback.hold};
    const std::size_t bytes = std::size_t{4} * picture.width * picture.height;
    const auto* rgba = static_cast<const std::byte*>(
        gl_.MapNamedBufferRange(readback.buffer, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT));
    if (rgba != nullptr) picture.rgba.assign(rgba, rgba + bytes);
    else picture.error = "the driver did not give the pixels";
    gl_.UnmapNamedBuffer(readback.buffer);
    gl_.DeleteBuffers(1, &readback.buffer);
    gl_.DeleteSync(readback.done);
    return picture;
}

std::vector<Picture> Compositor::collect(bool wait) {
    std::vector<Picture> pictures = std::exchange(refused_, {});
    constexpr GLuint64 kLongest = 5'000'000'000;  // ns
    while (!readbacks_.empty() && (wait || pictures.size() < kMostAtOnce)) {
        const GLenum state =
            gl_.ClientWaitSync(readbacks_.front().done, GL_SYNC_FLUSH_COMMANDS_BIT, wait ? kLongest : 0);
        if (state == GL_TIMEOUT_EXPIRED && !wait) break;
        pictures.push_back(finish(readbacks_.front()));
        readbacks_.pop_front();
    }
    return pictures;
}

}  // namespace wall::tileserver
