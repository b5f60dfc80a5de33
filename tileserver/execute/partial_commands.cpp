// SPDX-License-Identifier: MIT
#include "tileserver/execute/partial_commands.h"

#include <bit>
#include <cstring>
#include <string>
#include <utility>

#include "common/log/log.h"
#include "common/wire/limits.h"
#include "tileserver/partials/partial_box.h"

namespace wall::tileserver {
namespace {

/// A node whose picture does not come by then is done without: it may be gone.
constexpr std::chrono::milliseconds kLongestWait{5000};

/// As PartialBegin has it.
struct Receiver {
    std::uint32_t node = 0, slot = 0;
    std::int32_t x = 0, y = 0, width = 0, height = 0;
};

std::vector<Receiver> receivers_of(std::span<const std::byte> bytes) {
    std::vector<Receiver> out(bytes.size() / sizeof(Receiver));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(Receiver));
    return out;
}

/// The depth that nothing lies behind, where nearer depths are those that pass.
std::uint32_t farthest(GLenum by) { return by == GL_GREATER || by == GL_GEQUAL ? 0 : 1; }

}  // namespace

SurfaceReplica* PartialCommands::known_surface(SurfaceId id) {
    SurfaceReplica* surface = execution_.session.surface(id);
    if (surface == nullptr) execution_.refuse("surface " + std::to_string(id.value) + " does not exist");
    return surface;
}

void PartialCommands::PartialBegin(SurfaceId id, GLenum by, std::span<const std::byte> bytes) {
    SurfaceReplica* surface = known_surface(id);
    if (surface == nullptr) return;
    if (!is_merge(by)) return execution_.refuse("a partial picture that nothing merges");
    if (bytes.size() % sizeof(Receiver) != 0 || bytes.size() / sizeof(Receiver) > wire::kTileSlots)
        return execution_.refuse("no whole number of receivers, or too many");
    const geom::Rect window{0, 0, static_cast<std::int32_t>(surface->where().window_width),
                            static_cast<std::int32_t>(surface->where().window_height)};
    std::vector<PartialLayers::One> wanted;
    for (const Receiver& to : receivers_of(bytes)) {
        const geom::Rect area{to.x, to.y, to.width, to.height};
        if (to.slot >= wire::kMaxTilesPerNode || to.width <= 0 || to.height <= 0 || to.x < 0 || to.y < 0 ||
            to.width > window.width - to.x || to.height > window.height - to.y ||
            std::int64_t{area.width} * area.height > kMaxPartialPixels)
            return execution_.refuse("a receiver of what is not in the window");
        wanted.push_back({NodeIndex(to.node), to.slot, area});
    }
    PartialLayers& partials = execution_.session.partials(id);
    if (!partials.open(*surface, by, std::move(wanted)))
        return execution_.refuse("more pixels than a session may have");
    for (const auto& partial : partials.all()) partial.layer->clear_to_depth(farthest(by));
    execution_.targets_known = false;
    execution_.node.driver.forget_target();
}

void PartialCommands::PartialSend(SurfaceId id, std::uint32_t sequence, std::uint32_t from, RequestId request) {
    if (known_surface(id) == nullptr) return;
    const Timed timed(execution_.session.work.partial);
    execution_.node.driver.neutral_pixel_transfer();
    const GLenum by = execution_.session.partials(id).merged_by();
    for (auto& partial : execution_.session.partials(id).all()) {
        auto message = take_partial(partial, {id, sequence, rank(), NodeIndex(from), partial.slot}, by);
        execution_.session.work.partial_bytes += message.size();
        if (partial.node != NodeIndex(from)) execution_.output.partial(partial.node, std::move(message));
        else if (execution_.node.partials != nullptr)
            if (const auto put = execution_.node.partials->put(execution_.session.id(), std::move(message)); !put)
                execution_.refuse(put.error().message);
    }
    if (!request) return;
    const auto took = std::chrono::nanoseconds(Clock::now() - execution_.session.partials(id).opened());
    const auto count = static_cast<std::uint64_t>(took.count());
    const auto bytes = std::as_bytes(std::span(&count, 1));
    execution_.output.reply(request, {bytes.begin(), bytes.end()});
}

/// What was not drawn to need not be read.
std::vector<std::byte> PartialCommands::take_partial(PartialLayers::One& partial, const PartialKey& key,
                                                     GLenum by) const {
    PixelBlock block{.area = partial.area, .top_row_first = false, .colors = {}, .depths = {}};
    if (std::exchange(partial.drawn, false)) partial.layer->read_block(block);
    return encode_partial(key, block, kNoCodec,
                          by == GL_BLEND ? PartialPlanes::colors : PartialPlanes::colors_and_depths);
}

void PartialCommands::PieceRange(std::uint32_t first, std::uint32_t behind) {
    if (first >= behind) return execution_.refuse("a range of no pieces");
    execution_.pieces = {first, behind};
}

void PartialCommands::PartialMerge(SurfaceId surface, std::uint32_t sequence, GLenum by, std::uint32_t slots_low,
                                   std::uint32_t slots_high, std::span<const std::byte> nodes) {
    if (known_surface(surface) == nullptr) return;
    if (!is_merge(by) || nodes.size() % sizeof(std::uint32_t) != 0)
        return execution_.refuse("a merge by nothing that is known, or of no whole number of nodes");
    Merge merge{surface, sequence, by, {}, Clock::now()};
    for (auto slots = std::uint64_t{slots_high} << 32 | slots_low; slots != 0; slots &= slots - 1)
        for (std::size_t at = 0; at < nodes.size(); at += sizeof(std::uint32_t)) {
            std::uint32_t node = 0;
            std::memcpy(&node, nodes.data() + at, sizeof node);
            merge.keys.push_back(
                {surface, sequence, rank(), NodeIndex(node), static_cast<std::uint32_t>(std::countr_zero(slots))});
        }
    merge_ = std::move(merge);
    go_on();
}

bool PartialCommands::waits() const {
    if (!merge_ || execution_.node.partials == nullptr) return false;
    return !execution_.node.partials->has(execution_.session.id(), merge_->keys) &&
           Clock::now() < merge_->begun + kLongestWait;
}

void PartialCommands::go_on() {
    if (waits()) return;
    const Merge merge = *std::exchange(merge_, std::nullopt);
    Work& work = execution_.session.work;
    work.partial_wait += Clock::now() - merge.begun;
    const Timed timed(work.partial);
    PartialBox* const box = execution_.node.partials;
    SurfaceReplica* surface = execution_.session.surface(merge.surface);
    for (std::size_t first = 0, next = 0; first < merge.keys.size() && surface != nullptr; first = next) {
        while (next < merge.keys.size() && merge.keys[next].slot == merge.keys[first].slot) ++next;
        Layer* layer = surface->layer(merge.keys[first].slot);
        if (layer != nullptr && box != nullptr)
            merge_into(*layer, std::span(merge.keys).subspan(first, next - first), merge.by);
    }
    if (box != nullptr) box->close(execution_.session.id(), merge.surface, rank(), merge.sequence);
    execution_.targets_known = false;
}

/// Those of one layer, in the order in which they were drawn.
void PartialCommands::merge_into(Layer& layer, std::span<const PartialKey> keys, GLenum by) {
    Work& work = execution_.session.work;
    PixelBlock block;
    for (const PartialKey& key : keys) {
        const auto message = execution_.node.partials->take(execution_.session.id(), key);
        if (!message) {
            ++work.partials_missed;
            log::warn("partial_missed session={} surface={} from={}", execution_.session.id().value, key.surface.value,
                      key.from.value);
            continue;
        }
        const auto partial = decode_partial(*message);
        if (!partial) return execution_.refuse(partial.error().message);
        ++work.partials_merged;
        const geom::Rect held = layer.geometry().pixels();
        if (partial->runs.empty() || layer.geometry().scaled() || geom::intersect(partial->area, held) != partial->area)
            continue;
        if (block.area != partial->area) {
            if (!block.colors.empty()) layer.write_block(block);
            execution_.node.driver.neutral_pixel_transfer();
            block.area = partial->area;
            layer.read_block(block);
        }
        if (!merge(*partial, by, block)) return execution_.refuse("a partial picture without what it is merged by");
    }
    if (!block.colors.empty()) layer.write_block(block);
}

}  // namespace wall::tileserver
