// SPDX-License-Identifier: MIT
#include "tileserver/execute/surface_commands.h"

#include <cstring>
#include <string>
#include <utility>

#include "common/wire/whole_window.h"
#include "tileserver/execute/say_to_group.h"
#include "tileserver/session/limits.h"

namespace wall::tileserver {

SurfaceReplica* SurfaceCommands::known_surface(SurfaceId id) {
    SurfaceReplica* surface = execution_.session.surface(id);
    if (surface == nullptr) execution_.refuse("surface " + std::to_string(id.value) + " does not exist");
    return surface;
}

void SurfaceCommands::SurfaceCreate(SurfaceId surface, std::uint32_t double_buffered, std::uint32_t alpha_bits,
                                    std::uint32_t depth_bits, std::uint32_t stencil_bits, std::uint32_t accum_bits,
                                    std::uint32_t samples, std::uint32_t srgb, std::uint32_t stereo) {
    constexpr std::uint32_t kMostSamples = 64;
    if (!surface) return execution_.refuse("surface 0 is none");
    if (samples > kMostSamples) return execution_.refuse("no pixel has so many samples");
    if (samples != 0 && accum_bits != 0) return execution_.refuse("no such window has an accumulation buffer");
    execution_.targets_known = false;
    const LayerFormat layer{.double_buffered = double_buffered != 0,
                            .alpha = alpha_bits != 0,
                            .depth = depth_bits != 0,
                            .stencil = stencil_bits != 0,
                            .samples = samples,
                            .srgb = srgb != 0};
    if (execution_.session.create_surface(surface, {layer, accum_bits != 0, stereo != 0}) != nullptr) return;
    execution_.refuse(execution_.session.shares(surface)
                          ? "the members of the parallel program have windows of different formats"
                          : "too many surfaces");
}

void SurfaceCommands::SurfacePlace(SurfaceId id, std::uint32_t layout_version, std::uint32_t window_width,
                                   std::uint32_t window_height, std::int32_t x, std::int32_t y, std::uint32_t width,
                                   std::uint32_t height, std::uint32_t offscreen) {
    SurfaceReplica* surface = known_surface(id);
    if (surface == nullptr) return;
    constexpr std::uint32_t kMost = wire::kMaxSurfaceExtent;
    if (window_width > kMost || window_height > kMost || width > kMost || height > kMost)
        return execution_.refuse("larger than a surface may be");
    constexpr std::int32_t kFarthest = 1 << 24;  // canvas pixels
    if (x < -kFarthest || x > kFarthest || y < -kFarthest || y > kFarthest)
        return execution_.refuse("far off any canvas");
    if (window_width == 0 || window_height == 0) return execution_.refuse("an empty window");
    if (offscreen > wire::kShownWholeWindow) return execution_.refuse("no such kind of place");
    const geom::Rect rect{x, y, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)};
    const tileserver::SurfacePlace place{layout_version,
                                         window_width,
                                         window_height,
                                         rect,
                                         offscreen == wire::kOnlyWholeWindow,
                                         offscreen == wire::kAlsoWholeWindow,
                                         offscreen == wire::kShownWholeWindow};
    if (execution_.session.shares(id) && surface->where().window_width != 0) {
        if (surface->where() == place) return;
        if (layout_version <= surface->where().layout_version)
            return execution_.refuse("the members of the parallel program draw for different places");
    }
    execution_.node.driver.disable_scissor();
    if (surface->is_seen_at_once(place)) ++execution_.node.damage;
    if (!surface->place(place, execution_.node.tiles)) execution_.refuse("more pixels than a session may have");
}

void SurfaceCommands::SurfaceViews(SurfaceId id, std::span<const std::byte> bytes) {
    SurfaceReplica* surface = known_surface(id);
    if (surface == nullptr) return;
    constexpr std::size_t kEach = sizeof(std::uint32_t) + sizeof(geom::EyeViewValues);
    if (bytes.size() % kEach != 0) return execution_.refuse("no whole number of views");
    SurfaceReplica::Views views;
    for (std::size_t at = 0; at < bytes.size(); at += kEach) {
        std::uint32_t slot = 0;
        geom::EyeViewValues values;
        std::memcpy(&slot, bytes.data() + at, sizeof slot);
        std::memcpy(values.data(), bytes.data() + at + sizeof slot, sizeof values);
        if (slot >= wire::kTileSlots) return execution_.refuse("a view of no tile");
        const auto view = geom::eye_view_of_values(values);
        if (const auto* wrong = std::get_if<const char*>(&view))
            return execution_.refuse(std::string("a view has ") + *wrong);
        views[slot] = std::get<geom::EyeView>(view);
    }
    surface->look(std::move(views));
}

void SurfaceCommands::SurfaceDestroy(SurfaceId id) {
    execution_.session.destroy_surface(id);
    execution_.targets_known = false;
    ++execution_.node.damage;
}

void SurfaceCommands::Bind(SurfaceId draw_surface, SurfaceId read_surface) {
    execution_.context->draw = draw_surface;
    execution_.context->read = read_surface;
    execution_.targets_known = false;
}

void SurfaceCommands::ContextDestroy(ContextId context) {
    if (context == execution_.context_id) {
        execution_.session.context(execution_.context_id) =
            SoftContext{};  // the batch goes on in it; an empty one costs nothing
        return;
    }
    execution_.session.destroy_context(context);
}

void SurfaceCommands::Swap(SurfaceId id, std::uint32_t frame) {
    SurfaceReplica* surface = known_surface(id);
    if (surface == nullptr) return;
    if (execution_.session.shares(id))
        return say_to_group(execution_, [=](GroupSync& sync, Rank rank) { return sync.swap(rank, id, frame); });
    const bool at_once = !surface->on_tiles() || execution_.node.shows_at_once(execution_.session.id(), id);
    finish_frame(execution_.node, execution_.session.work, *surface, frame, at_once);
    execution_.output.frame_rendered(id, frame);
}

void SurfaceCommands::SwapOffscreen(SurfaceId window) {
    SurfaceReplica* surface = known_surface(window);
    if (surface == nullptr) return;
    surface->swap_offscreen();
    execution_.node.driver.forget_target();
}

void SurfaceCommands::present(SurfaceId id, std::uint32_t frame) {
    SurfaceReplica* surface = execution_.session.surface(id);
    if (surface == nullptr || !surface->waiting_frame() ||
        static_cast<std::int32_t>(frame - *surface->waiting_frame()) < 0)
        return;
    surface->show_frame();
    execution_.node.driver.forget_target();
    ++execution_.node.damage;
}

}  // namespace wall::tileserver
