// SPDX-License-Identifier: MIT
// Surfaces, contexts and frames. Render thread.
#include "common/wire/whole_window.h"
#include "tileserver/render/executor.h"
#include "tileserver/render/limits.h"

namespace wall::tileserver {

SurfaceReplica* Executor::known_surface(SurfaceId id) {
    SurfaceReplica* surface = session_.surface(id);
    if (surface == nullptr) refuse("surface " + std::to_string(id.value) + " does not exist");
    return surface;
}

void Executor::Sync(RequestId request) {
    {
        const Timed timed(session_.work.render);
        gl_.Finish();
    }
    output_.reply(request, {});
}

void Executor::SurfaceCreate(SurfaceId surface, std::uint32_t double_buffered, std::uint32_t alpha_bits,
                             std::uint32_t depth_bits, std::uint32_t stencil_bits, std::uint32_t accum_bits,
                             std::uint32_t) {
    if (!surface) return refuse("surface 0 is none");
    surfaces_known_ = false;
    const LayerFormat layer{double_buffered != 0, alpha_bits != 0, depth_bits != 0, stencil_bits != 0};
    if (session_.create_surface(surface, {layer, accum_bits != 0}) != nullptr) return;
    refuse(session_.shares(surface) ? "the members of the parallel program have windows of different formats"
                                    : "too many surfaces");
}

void Executor::SurfacePlace(SurfaceId id, std::uint32_t layout_version, std::uint32_t window_width,
                            std::uint32_t window_height, std::int32_t x, std::int32_t y, std::uint32_t width,
                            std::uint32_t height, std::uint32_t offscreen) {
    SurfaceReplica* surface = known_surface(id);
    if (surface == nullptr) return;
    constexpr std::uint32_t kMost = wire::kMaxSurfaceExtent;
    if (window_width > kMost || window_height > kMost || width > kMost || height > kMost)
        return refuse("larger than a surface may be");
    constexpr std::int32_t kFarthest = 1 << 24;  // canvas pixels
    if (x < -kFarthest || x > kFarthest || y < -kFarthest || y > kFarthest) return refuse("far off any canvas");
    if (window_width == 0 || window_height == 0) return refuse("an empty window");
    if (offscreen > wire::kAlsoWholeWindow) return refuse("no such kind of place");
    const geom::Rect rect{x, y, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)};
    const tileserver::SurfacePlace place{layout_version,
                                         window_width,
                                         window_height,
                                         rect,
                                         offscreen == wire::kOnlyWholeWindow,
                                         offscreen == wire::kAlsoWholeWindow};
    if (session_.shares(id) && surface->where().window_width != 0) {
        if (surface->where() == place) return;
        if (layout_version <= surface->where().layout_version)
            return refuse("the members of the parallel program draw for different places");
    }
    node_.driver.forget_layer();
    node_.driver.disable_scissor();
    ++node_.damage;
    if (!surface->place(place, node_.tiles)) refuse("more pixels than a session may have");
}

void Executor::SurfaceDestroy(SurfaceId id) {
    session_.destroy_surface(id);
    surfaces_known_ = false;
    ++node_.damage;
}

void Executor::Bind(SurfaceId draw_surface, SurfaceId read_surface) {
    context_->draw = draw_surface;
    context_->read = read_surface;
    surfaces_known_ = false;
}

void Executor::ContextDestroy(ContextId context) {
    if (context == context_id_) {
        session_.context(context_id_) = SoftContext{};  // the batch goes on in it; an empty one costs nothing
        return;
    }
    session_.destroy_context(context);
}

void Executor::Swap(SurfaceId id, std::uint32_t frame) {
    SurfaceReplica* surface = known_surface(id);
    if (surface == nullptr) return;
    if (session_.shares(id))
        return say_to_group([=](GroupSync& sync, Rank rank) { return sync.swap(rank, id, frame); });
    const bool at_once = !surface->on_tiles() || node_.shows_at_once(session_.id(), id);
    finish_frame(node_, session_.work, *surface, frame, at_once);
    output_.frame_rendered(id, frame);
}

void Executor::SwapOffscreen(SurfaceId window) {
    SurfaceReplica* surface = known_surface(window);
    if (surface == nullptr) return;
    surface->swap_offscreen();
    node_.driver.forget_layer();
}

void Executor::present(SurfaceId id, std::uint32_t frame) {
    SurfaceReplica* surface = session_.surface(id);
    if (surface == nullptr || !surface->waiting_frame() ||
        static_cast<std::int32_t>(frame - *surface->waiting_frame()) < 0)
        return;
    surface->show_frame();
    node_.driver.forget_layer();
    ++node_.damage;
}

}  // namespace wall::tileserver
