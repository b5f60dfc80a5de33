// SPDX-License-Identifier: MIT
#include "client_lib/follow/surfaces.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "client_lib/follow/draw_target.h"
#include "client_lib/process/log.h"
#include "client_lib/process/options.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

constexpr std::chrono::seconds kPlacementTimeout{2};

bool is_in_frame(const ClientSurface& surface) { return surface.drawn && surface.frame > 0; }

/// What was drawn for some is missing on others: tiles have changed, or who draws them.
bool others(std::span<const TargetLayer> before, std::span<const TargetLayer> now) {
    return !std::ranges::equal(before, now, [](const TargetLayer& a, const TargetLayer& b) {
        return a.node == b.node && a.slot == b.slot && a.pixels == b.pixels;
    });
}

std::optional<Extent> window_size(const ClientSurface& surface) {
    return surface.options.query_size ? surface.options.query_size() : std::nullopt;
}

/// How far the picture of a tile is from the program's own; a program that draws for two eyes itself has both.
geom::Parallax parallax_of(const ClientSurface& surface, geom::Eye eye) {
    if (!surface.stereo || surface.options.format.stereo || eye == geom::Eye::both) return {};
    const double screen =
        surface.stereo->screen > 0 ? static_cast<double>(surface.stereo->screen) : surface.views.distance.value();
    if (!(screen > 0)) return {};
    // Both eyes together are apart by `separation` of the window, which is two half widths.
    const float shift = eye == geom::Eye::left ? -surface.stereo->separation : surface.stereo->separation;
    return {shift, static_cast<float>(screen)};
}

/// What a tile shows of the window instead of `part` of the program's picture, if it does. (A window that covers only a
/// part of a tile that looks elsewhere lies there as on any other.)
std::optional<geom::EyeView> eye_view(const ClientSurface& surface, const TileInfo& tile, const geom::Rect& part) {
    geom::EyeView out{.parallax = parallax_of(surface, tile.eye)};
    if (part == tile.rect) out.elsewhere = tile.view;
    return out.elsewhere || out.parallax.shift != 0 ? std::optional(out) : std::nullopt;
}

TargetLayer view_layer(SurfaceLayout& layout, const TileInfo& tile, const geom::Rect& part, const geom::EyeView& view) {
    const geom::Rect& covers = view.elsewhere ? tile.rect : layout.rect;
    layout.views.push_back({view, static_cast<float>(layout.width) / static_cast<float>(covers.width),
                            static_cast<float>(layout.height) / static_cast<float>(covers.height)});
    const auto index = static_cast<std::uint32_t>(layout.views.size());
    if (view.elsewhere) return view_layer(layout, tile.node, tile.slot, index);
    TargetLayer out = tile_layer(layout, tile.node, tile.slot, part);
    out.view = index;
    return out;
}

}  // namespace

// ---- opening and closing ----

void Surfaces::open(ClientSurface& surface) {
    surface.opened = true;
    open_[surface.id] = &surface;
    const Extent size = window_size(surface).value_or(surface.options.size);
    surface.layout.width = std::max(1u, size.width);
    surface.layout.height = std::max(1u, size.height);
    if (!surface.options.visible) return apply_layout(surface, Placement{});
    control_.surface_open(surface.id,
                          {.width = surface.layout.width,
                           .height = surface.layout.height,
                           .title = surface.options.title,
                           .native = surface.options.native},
                          surface.options.messages);
    const auto placement = control_.wait_placement(surface.id, kPlacementTimeout);
    if (group_) surface.window = {surface.layout.width, surface.layout.height};
    else if (placement) take_place(surface, *placement);
}

void Surfaces::close(ClientSurface& surface) {
    surface.opened = false;
    open_.erase(surface.id);
    if (surface.options.visible) control_.surface_close(surface.id);
    for (auto& node : nodes_) {
        node->left_out.erase(surface.id);
        if (!node->alive() || node->surfaces.erase(surface.id) == 0) continue;
        glapi::pack::SurfaceDestroy(nodes_.batch(*node, node->batch_context), surface.id);
        nodes_.send(*node);
    }
}

// ---- where they lie ----

void Surfaces::take(const Placement& placement) {
    const auto found = open_.find(placement.surface);
    if (found == open_.end()) return;
    if (group_) found->second->coming.push_back(placement);
    else found->second->next = placement;
}

void Surfaces::begin_frame(ClientSurface& surface) {
    if (common(surface)) {
        report_window(surface);
        return adopt_agreed(surface);
    }
    if (is_in_frame(surface)) return;
    adopt_placement(surface);
    follow_window(surface);
    if (surface.drawn) return;
    if (surface.views.finish_frame() || recorded_otherwise(surface)) look_otherwise(surface);
    if (!options().cameras.empty() && surface.views.stays_flat())
        complain_once(
            "most of what is drawn goes through no uniform that WALLGL_CAMERA names and that holds a perspective: "
            "tiles that look elsewhere show the program flat",
            "camera");
}

void Surfaces::adopt_placements() {
    for (auto& [id, surface] : open_) adopt_placement(*surface);
}

bool Surfaces::in_frame() const {
    return std::ranges::any_of(open_, [](const auto& entry) { return is_in_frame(*entry.second); });
}

void Surfaces::place_anew() {
    for (auto& [id, surface] : open_) {
        surface->layout.layers.clear();  // no place of the old wall means anything
        surface->hidden.reset();
        surface->tiles.reset();
        ++surface->layout.version;
        if (surface->options.visible) surface->next = control_.wait_placement(id, kPlacementTimeout);
    }
    adopt_placements();
    place_off_wall();
}

/// And how it is shown to two eyes, of which apply_layout() alone changes nothing.
void Surfaces::take_place(ClientSurface& surface, const Placement& placement) {
    surface.stereo = placement.stereo;
    surface.views.measure(surface.stereo && !surface.options.format.stereo && surface.stereo->screen == 0);
    apply_layout(surface, placement);
}

void Surfaces::apply_layout(ClientSurface& surface, const Placement& placement) {
    SurfaceLayout& layout = surface.layout;
    layout.layers.clear();
    layout.views.clear();
    ++layout.version;
    layout.offscreen = !surface.options.visible;
    if (!layout.offscreen) layout.rect = placement.rect;
    if (surface.whole) return lay_whole(surface);
    if (layout.offscreen) {
        layout.rect = {0, 0, static_cast<int>(layout.width), static_cast<int>(layout.height)};
        for (auto& node : nodes_) {
            if (!node->alive() || node->records()) continue;
            layout.layers.push_back(whole_window(layout.width, layout.height, node->index));
            break;
        }
        return;
    }
    layout.rect = placement.rect;
    if (placement.tiles) surface.tiles = placement.tiles;
    if (!surface.tiles) return;
    surface.views.offered.clear();
    for (const TileInfo& tile : *surface.tiles) {
        nodes_.at(tile.node);  // also one that is not up
        const geom::Rect part = geom::intersect(tile.rect, layout.rect);
        if (part.empty()) continue;
        const auto view = common(surface) ? std::nullopt : eye_view(surface, tile, part);
        if (view) surface.views.offered.push_back(*view);
        layout.layers.push_back(view && surface.views.used ? view_layer(layout, tile, part, *view)
                                                           : tile_layer(layout, tile.node, tile.slot, part));
    }
    lay_recorded(surface);
    using Views = ControlLink::Views;
    control_.surface_views(surface.id, surface.views.offered.empty() ? Views::none
                                       : surface.views.used          ? Views::seen
                                                                     : Views::flat);
    lay_hidden(surface);
}

/// All of the window is seen by a node that records, as by a tile at 1:1 wherever the window lies.
void Surfaces::lay_recorded(ClientSurface& surface) {
    if (common(surface)) return;
    SurfaceLayout& layout = surface.layout;
    for (auto& node : nodes_)
        if (node->records() && node->alive()) layout.layers.push_back(tile_layer(layout, node->index, 0, layout.rect));
}

/// A recording has begun or ended since the surface was laid out.
bool Surfaces::recorded_otherwise(const ClientSurface& surface) const {
    if (common(surface) || !surface.options.visible || surface.whole || !surface.tiles) return false;
    const auto laid = [&](NodeIndex node) {
        return std::ranges::count(surface.layout.layers, node, &TargetLayer::node) > 0;
    };
    return std::ranges::any_of(nodes_,
                               [&](const auto& node) { return node->records() && laid(node->index) != node->alive(); });
}

/// Through the views of tiles, or at their parts of the picture, as surface.views says now.
void Surfaces::look_otherwise(ClientSurface& surface) {
    Placement same;
    same.rect = surface.layout.rect;
    apply_layout(surface, same);
    control_.ask_to_redraw(surface.id);
}

void Surfaces::lay_hidden(ClientSurface& surface) {
    if (surface.tiles) hidden_.lay(surface, *surface.tiles);
}

/// A layer of the window's size on every node; those of nodes that are not there are not drawn in.
void Surfaces::lay_whole(ClientSurface& surface) {
    SurfaceLayout& layout = surface.layout;
    if (layout.offscreen) layout.rect = {0, 0, static_cast<int>(layout.width), static_cast<int>(layout.height)};
    surface.hidden.reset();
    surface.views = {};
    layout.views.clear();
    layout.layers.clear();
    for (auto& node : nodes_)
        if (node->alive()) layout.layers.push_back(whole_window(layout.width, layout.height, node->index));
}

Wholeness Surfaces::wholeness(const ClientSurface& surface) const {
    if (surface.whole) return Wholeness::is;
    const auto alive = std::ranges::count_if(nodes_, [](const auto& node) { return node->alive(); });
    if (alive == 1 && surface.layout.layers.size() == 1 && surface.layout.views.empty() && !surface.hidden)
        return Wholeness::is;
    return common(surface) ? Wholeness::cannot_be : Wholeness::may_be;
}

bool Surfaces::everywhere(const ClientSurface& surface) const {
    if (surface.whole) return true;
    const SurfaceLayout& layout = surface.layout;
    const int width = static_cast<int>(layout.width), height = static_cast<int>(layout.height);
    return wholeness(surface) == Wholeness::is && layout.rect.width == width && layout.rect.height == height &&
           layout.layers.front().pixels == geom::Rect{0, 0, width, height};
}

void Surfaces::draw_whole(ClientSurface& surface) {
    surface.whole = true;
    ++surface.layout.version;
    lay_whole(surface);
}

void Surfaces::place_off_wall() {
    for (auto& [id, surface] : open_)
        if (surface->whole) lay_whole(*surface);
        else if (!surface->layout.offscreen) lay_hidden(*surface);
    for (auto& [id, surface] : open_) {
        const auto& layers = surface->layout.layers;
        if (surface->layout.offscreen && (layers.empty() || !nodes_[layers.front()].alive()))
            apply_layout(*surface, {});
    }
}

void Surfaces::ask_to_redraw() {
    for (const auto& [id, surface] : open_)
        if (!surface->layout.offscreen && surface->frame > 0) control_.ask_to_redraw(id);
}

void Surfaces::follow_window(ClientSurface& surface) {
    const auto size = window_size(surface);
    if (!size || !size->width || !size->height ||
        (size->width == surface.layout.width && size->height == surface.layout.height))
        return;
    surface.layout.width = size->width;
    surface.layout.height = size->height;
    control_.surface_resize(surface.id, size->width, size->height);
    surface.next = control_.wait_placement(surface.id, kPlacementTimeout);
    adopt_placement(surface);
    if (surface.frame > 0) control_.ask_to_redraw(surface.id);
}

// Only between two frames, so that none mixes two layouts. What the last frame shows was drawn for the old one.
void Surfaces::adopt_placement(ClientSurface& surface) {
    if (!surface.next || is_in_frame(surface)) return;
    const Placement placement = *std::exchange(surface.next, std::nullopt);
    const auto before = surface.layout.layers;
    const bool moved = placement.rect != surface.layout.rect || placement.stereo != surface.stereo;
    take_place(surface, placement);
    control_.surface_adopted(surface.id, placement.layout_version, surface.frame + 1, kPlacementTimeout);
    const bool drawn_elsewhere = moved || others(before, surface.layout.layers);
    if (drawn_elsewhere && (surface.frame > 0 || !surface.options.format.double_buffered))
        control_.ask_to_redraw(surface.id);
}

// ---- of a parallel program ----

void Surfaces::adopt_agreed(ClientSurface& surface) {
    auto& coming = surface.coming;
    while (!coming.empty() && coming.front().from_frame <= surface.frame + 1) {
        const Placement placement = std::move(coming.front());
        coming.pop_front();
        // The lock stays held: what another thread drew meanwhile would miss nodes that other members' frames have.
        nodes_.connect_and_wait(placement.nodes);
        const auto before = surface.layout.layers;
        const bool moved = placement.rect != surface.layout.rect;
        surface.layout.width = placement.width;
        surface.layout.height = placement.height;
        apply_layout(surface, placement);
        surface.layout.version = placement.layout_version;
        if ((moved || others(before, surface.layout.layers)) && surface.frame > 0) control_.ask_to_redraw(surface.id);
    }
    if (!coming.empty())
        control_.ask_to_redraw(surface.id);  // a program that draws only when asked comes to that frame, too
}

/// The window is as large as rank 0 has it.
void Surfaces::report_window(ClientSurface& surface) {
    const auto size = window_size(surface);
    if (group_->rank != 0 || !size || !size->width || !size->height ||
        (size->width == surface.window.width && size->height == surface.window.height))
        return;
    surface.window = *size;
    control_.surface_resize(surface.id, size->width, size->height);
}

}  // namespace wall::client
