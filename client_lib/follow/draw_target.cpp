// SPDX-License-Identifier: MIT
#include "client_lib/follow/draw_target.h"

#include <mutex>
#include <utility>

#include "client_lib/follow/hidden_part.h"
#include "common/wire/whole_window.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

/// What a node is told of the layer of the whole window.
std::uint32_t whole_window_of(const Node& node, const ClientSurface& surface) {
    if (surface.layout.offscreen) return wire::kOnlyWholeWindow;
    if (surface.whole) return wire::kShownWholeWindow;
    return surface.hidden && surface.hidden->layer.node == node.index ? wire::kAlsoWholeWindow : wire::kTilesOnly;
}

/// Those of the node's tiles, for the place that comes behind them: each is a tile's slot and values_of() its view.
void pack_views(Node& node, const ClientSurface& surface) {
    if (surface.layout.views.empty()) return;
    std::vector<std::byte> bytes;
    const auto add = [&](const auto& value) {
        const auto raw = std::as_bytes(std::span(&value, 1));
        bytes.insert(bytes.end(), raw.begin(), raw.end());
    };
    for (const TargetLayer& layer : surface.layout.layers) {
        if (layer.view == 0 || layer.node != node.index) continue;
        add(layer.slot);
        add(geom::values_of(surface.layout.views[layer.view - 1].view));
    }
    if (!bytes.empty()) glapi::pack::SurfaceViews(node.batch, surface.id, bytes);
}

}  // namespace

const SurfaceFormat& DrawTarget::format() const {
    static constexpr SurfaceFormat kNothingPromised{.depth_bits = 0, .stencil_bits = 0, .accum_bits = 0};
    return surface_ ? surface_->options.format : kNothingPromised;
}

bool DrawTarget::encodes_srgb() const { return surface_ && surface_->srgb.value_or(false); }

Extent DrawTarget::size() const {
    if (objects_) return {objects_->width(), objects_->height()};
    return {surface_->layout.width, surface_->layout.height};
}

void DrawTarget::describe_to(Node& node) const {
    if (!surface_) return;
    const SurfaceLayout& layout = surface_->layout;
    const auto known = node.surfaces.find(surface_->id);
    if (known == node.surfaces.end()) {
        const SurfaceFormat& f = format();
        glapi::pack::SurfaceCreate(node.batch, surface_->id, f.double_buffered, f.alpha_bits, f.depth_bits,
                                   f.stencil_bits, f.accum_bits, f.samples, encodes_srgb(), f.stereo);
    } else if (known->second == layout.version) {
        return;
    }
    pack_views(node, *surface_);
    glapi::pack::SurfacePlace(node.batch, surface_->id, layout.version, layout.width, layout.height, layout.rect.x,
                              layout.rect.y, static_cast<std::uint32_t>(layout.rect.width),
                              static_cast<std::uint32_t>(layout.rect.height), whole_window_of(node, *surface_));
    node.surfaces[surface_->id] = layout.version;
}

void DrawTarget::bind_to(Node& node) const {
    describe_to(node);
    glapi::pack::Bind(node.batch, surface_->id, surface_->id);
}

void DrawTarget::note_content(ShareGroup& share) const {
    if (!objects_) return;
    std::lock_guard lock(share.mutex);
    objects_->note_drawn();
    share.has_drawn.store(true, std::memory_order_relaxed);
}

/// All draw the same, so one counts: the first that does.
bool DrawTarget::counts_samples_on(const Node& node) const {
    if (!objects_ && (!surface_ || !surface_->whole)) return true;
    const auto same = layers();
    return same.empty() || same.front().node == node.index;
}

void bind_targets(Node& node, Mirror& mirror, const DrawTarget& draw, const DrawTarget& read) {
    draw.describe_to(node);
    if (read.surface_ != draw.surface_) read.describe_to(node);
    const SurfaceId to = draw.surface_ ? draw.surface_->id : mirror.draw_surface,
                    from = read.surface_ ? read.surface_->id : mirror.read_surface;
    if (mirror.draw_surface != to || mirror.read_surface != from) glapi::pack::Bind(node.batch, to, from);
    mirror.draw_surface = to;
    mirror.read_surface = from;
    const Mirror::Objects objects{draw.object(), read.object(), draw.counts_samples_on(node)};
    if (std::exchange(mirror.targets, objects) != objects)
        glapi::pack::BindTargets(node.batch, objects.draw, objects.read, objects.counts);
}

}  // namespace wall::client
