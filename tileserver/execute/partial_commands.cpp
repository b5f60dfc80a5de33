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
constexpr std::uint32_t kMostNodes = 4096;
constexpr std::size_t kMostBands = 4096;  // of all layers, or of one node that composes

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

bool in_window(const geom::Rect& area, const SurfaceReplica& surface) {
    const auto width = static_cast<std::int32_t>(surface.where().window_width),
               height = static_cast<std::int32_t>(surface.where().window_height);
    return area.width > 0 && area.height > 0 && area.x >= 0 && area.y >= 0 && area.width <= width - area.x &&
           area.height <= height - area.y && std::int64_t{area.width} * area.height <= kMaxPartialPixels;
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
    std::vector<PartialLayers::One> wanted;
    for (const Receiver& to : receivers_of(bytes)) {
        const geom::Rect area{to.x, to.y, to.width, to.height};
        if (to.slot >= wire::kMaxTilesPerNode || !in_window(area, *surface))
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

/// As PartialSend and PartialCompose have them.
std::optional<std::vector<PartialCommands::Band>> PartialCommands::bands_of(std::span<const std::byte> bytes,
                                                                            const SurfaceReplica& surface) {
    struct Words {
        std::uint32_t layer, node, slot;
        geom::Rect area;
    };
    static_assert(sizeof(Words) == 7 * sizeof(std::uint32_t));
    if (bytes.size() % sizeof(Words) != 0 || bytes.size() / sizeof(Words) > kMostBands) {
        execution_.refuse("no whole number of bands, or too many");
        return std::nullopt;
    }
    std::vector<Words> words(bytes.size() / sizeof(Words));
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
    std::vector<Band> out;
    for (const auto& [layer, node, slot, area] : words) {
        if (!in_window(area, surface)) {
            execution_.refuse("a band of what is not in the window");
            return std::nullopt;
        }
        out.push_back({layer, NodeIndex(node), slot, area});
    }
    return out;
}

void PartialCommands::PartialSend(SurfaceId id, std::uint32_t sequence, std::uint32_t from, RequestId request,
                                  std::span<const std::byte> bytes) {
    const SurfaceReplica* const surface = known_surface(id);
    if (surface == nullptr) return;
    const auto bands = bands_of(bytes, *surface);
    if (!bands) return;
    const Timed timed(execution_.session.work.partial);
    execution_.node.driver.neutral_pixel_transfer();
    const NodeIndex self(from);
    const GLenum by = execution_.session.partials(id).merged_by();
    auto& layers = execution_.session.partials(id).all();
    for (const Band& band : *bands) {
        if (band.layer >= layers.size() || geom::intersect(band.area, layers[band.layer].area) != band.area)
            return execution_.refuse("a band that is in none of the layers");
        send(band.node, self, take_partial(layers[band.layer], band.area, {id, sequence, rank(), self, band.slot}, by));
    }
    for (auto& partial : layers) {
        if (bands->empty())
            send(partial.node, self,
                 take_partial(partial, partial.area, {id, sequence, rank(), self, partial.slot}, by));
        partial.drawn = false;
    }
    if (!request) return;
    const auto took = std::chrono::nanoseconds(Clock::now() - execution_.session.partials(id).opened());
    const auto count = static_cast<std::uint64_t>(took.count());
    const auto answer = std::as_bytes(std::span(&count, 1));
    execution_.output.reply(request, {answer.begin(), answer.end()});
}

void PartialCommands::send(NodeIndex to, NodeIndex self, std::vector<std::byte> message) {
    execution_.session.work.partial_bytes += message.size();
    if (to != self) return execution_.output.partial(to, std::move(message));
    if (execution_.node.partials == nullptr) return;
    if (const auto put = execution_.node.partials->put(execution_.session.id(), std::move(message)); !put)
        execution_.refuse(put.error().message);
}

/// What was not drawn to need not be read.
std::vector<std::byte> PartialCommands::take_partial(const PartialLayers::One& partial, const geom::Rect& area,
                                                     const PartialKey& key, GLenum by) const {
    PixelBlock block{.area = area, .top_row_first = false, .colors = {}, .depths = {}};
    if (partial.drawn) partial.layer->read_block(block);
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
    Merge merge{surface, sequence, by, {}, Clock::now(), {}, {}};
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

void PartialCommands::PartialCompose(SurfaceId surface, std::uint32_t sequence, GLenum by, std::uint32_t from,
                                     std::uint32_t nodes, std::span<const std::byte> parts) {
    const SurfaceReplica* const known = known_surface(surface);
    if (known == nullptr) return;
    if (!is_merge(by) || nodes > kMostNodes || nodes * sizeof(std::uint32_t) > parts.size())
        return execution_.refuse("a composition by nothing that is known, or of too many nodes");
    auto bands = bands_of(parts.subspan(nodes * sizeof(std::uint32_t)), *known);
    if (!bands) return;
    if (bands->empty()) return execution_.refuse("a composition of nothing");
    Merge merge{surface, sequence, by, {}, Clock::now(), std::move(*bands), NodeIndex(from)};
    for (const Band& band : merge.bands)
        for (std::size_t i = 0; i < nodes; ++i) {
            std::uint32_t node = 0;
            std::memcpy(&node, parts.data() + i * sizeof node, sizeof node);
            merge.keys.push_back({surface, sequence, rank(), NodeIndex(node), band.layer});
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
    if (box == nullptr) return;
    // Behind a composition what was composed elsewhere may be merged here.
    const std::uint32_t done = merge.bands.empty() ? merge.sequence : merge.sequence - 1;
    if (!merge.bands.empty()) compose_bands(merge);
    else if (SurfaceReplica* const surface = execution_.session.surface(merge.surface)) merge_layers(merge, *surface);
    box->close(execution_.session.id(), merge.surface, rank(), done);
}

void PartialCommands::merge_layers(const Merge& merge, SurfaceReplica& surface) {
    for (std::size_t first = 0, next = 0; first < merge.keys.size(); first = next) {
        while (next < merge.keys.size() && merge.keys[next].slot == merge.keys[first].slot) ++next;
        if (Layer* layer = surface.layer(merge.keys[first].slot))
            merge_into(*layer, std::span(merge.keys).subspan(first, next - first), merge.by);
    }
    execution_.targets_known = false;
}

std::optional<Partial> PartialCommands::take(const PartialKey& key) {
    Work& work = execution_.session.work;
    const auto message = execution_.node.partials->take(execution_.session.id(), key);
    if (!message) {
        ++work.partials_missed;
        log::warn("partial_missed session={} surface={} from={}", execution_.session.id().value, key.surface.value,
                  key.from.value);
        return std::nullopt;
    }
    auto partial = decode_partial(*message);
    if (!partial) {
        execution_.refuse(partial.error().message);
        return std::nullopt;
    }
    ++work.partials_merged;
    return std::move(*partial);
}

/// Those of one layer, in the order in which they were drawn.
void PartialCommands::merge_into(Layer& layer, std::span<const PartialKey> keys, GLenum by) {
    PixelBlock block;
    for (const PartialKey& key : keys) {
        const auto partial = take(key);
        if (!partial) continue;
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

void PartialCommands::compose_bands(const Merge& merge) {
    const std::size_t nodes = merge.keys.size() / merge.bands.size();
    for (std::size_t i = 0; i < merge.bands.size(); ++i)
        compose_band(merge.bands[i], std::span(merge.keys).subspan(i * nodes, nodes), merge);
}

/// Whoever shows it waits for it, also if there is nothing in it.
void PartialCommands::compose_band(const Band& band, std::span<const PartialKey> keys, const Merge& merge) {
    PixelBlock block{.area = band.area, .top_row_first = false, .colors = {}, .depths = {}};
    for (const PartialKey& key : keys) {
        const auto partial = take(key);
        if (!partial || partial->runs.empty() || partial->area != band.area) continue;
        if (block.colors.empty()) {
            block.colors.resize(block.pixels());
            block.depths.resize(block.pixels());
            block.top_row_first = partial->top_row_first;
        }
        if (!compose(*partial, merge.by, block))
            return execution_.refuse("a partial picture without what it is composed by");
    }
    send(band.node, merge.self,
         encode_partial({merge.surface, merge.sequence, rank(), merge.self, band.slot}, block, kNoCodec,
                        merge.by == GL_BLEND ? PartialPlanes::colors : PartialPlanes::colors_and_depths));
}

}  // namespace wall::tileserver
