// SPDX-License-Identifier: MIT
#include "tools/wallplay/windows.h"

#include <algorithm>
#include <utility>

#include "client_lib/follow/draw_target.h"
#include "common/recording/format.h"
#include "common/wire/limits.h"
#include "common/wire/whole_window.h"

namespace wall::wallplay {

using glapi::Op;

void Windows::Closer::operator()(client::ClientSurface* surface) const {
    session->close_surface(*surface);
    delete surface;
}

Result<void> Windows::take(const glstate::Command& command) {
    if (command.op == Op::SurfaceCreate) return create(command);
    if (command.op == Op::SurfacePlace) return place(command);
    if (command.op == Op::SurfaceDestroy) windows_.erase(SurfaceId(command.word(0)));
    return {};  // views are those of this wall's tiles
}

/// A segment says it anew: a window of that format stays.
Result<void> Windows::create(const glstate::Command& command) {
    const SurfaceId id(command.word(0));
    if (!id || (windows_.size() >= recording::kMostWindows && !windows_.contains(id)))
        return fail("more windows than a program may have");
    const auto byte = [&](std::size_t place) { return static_cast<std::uint8_t>(command.word(place)); };
    const client::SurfaceFormat format{.double_buffered = command.word(1) != 0,
                                       .alpha_bits = byte(2),
                                       .depth_bits = byte(3),
                                       .stencil_bits = byte(4),
                                       .accum_bits = byte(5),
                                       .samples = byte(6),
                                       .stereo = command.word(8) != 0};
    const bool srgb = command.word(7) != 0;
    const auto known = windows_.find(id);
    if (known != windows_.end() && known->second.format == format && known->second.srgb == srgb) return {};
    windows_.erase(id);
    windows_[id] = {.format = format, .srgb = srgb, .size = std::make_shared<client::Extent>(), .surface = {}};
    return {};
}

Result<void> Windows::place(const glstate::Command& command) {
    const auto found = windows_.find(SurfaceId(command.word(0)));
    const client::Extent size{command.word(2), command.word(3)};
    if (found == windows_.end()) return fail("a window is placed that was not created");
    constexpr std::uint32_t kMost = wire::kMaxSurfaceExtent;
    if (size.width == 0 || size.height == 0 || size.width > kMost || size.height > kMost)
        return fail("a window of " + std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels");
    Window& window = found->second;
    *window.size = size;
    if (!window.surface) open(window);
    if (command.word(8) == wire::kShownWholeWindow && session_.wholeness(*window.surface) == client::Wholeness::may_be)
        session_.draw_whole(*window.surface);
    return {};
}

void Windows::open(Window& window) {
    client::WindowMessages messages{.close = [wishes = wishes_] { return wishes->close = true; },
                                    .redraw = [wishes = wishes_] { wishes->redraw = true; }};
    client::SurfaceOptions options{.format = window.format,
                                   .visible = true,
                                   .size = *window.size,
                                   .query_size = [size = window.size] { return std::optional(*size); },
                                   .title = title_,
                                   .messages = std::move(messages)};
    window.surface = {new client::ClientSurface(client::next_window_id(), std::move(options)), Closer{&session_}};
    window.surface->srgb = window.srgb;
    session_.open_surface(*window.surface);
}

void Windows::begin_frames() {
    for (auto& [id, window] : windows_) {
        if (!window.surface || window.surface->drawn) continue;
        session_.begin_frame(*window.surface);
        window.surface->drawn = true;
    }
}

void Windows::drop_frames() {
    for (auto& [id, window] : windows_)
        if (window.surface) window.surface->drawn = false;
}

bool Windows::between_frames() const {
    return std::ranges::none_of(windows_,
                                [](const auto& entry) { return entry.second.surface && entry.second.surface->drawn; });
}

void Windows::swap_all(ContextId context) {
    for (auto& [id, window] : windows_)
        if (window.surface && window.surface->frame > 0) session_.swap(context, *window.surface);
}

void Windows::swap(ContextId context, SurfaceId recorded) {
    const auto found = windows_.find(recorded);
    if (found != windows_.end() && found->second.surface) session_.swap(context, *found->second.surface);
}

void Windows::describe_to(client::Node& node) const {
    for (const auto& [id, window] : windows_)
        if (window.surface) client::DrawTarget(*window.surface).describe_to(node);
}

NodeView Windows::view_for(const client::Node& node) const {
    const auto surface_of = [this](SurfaceId recorded) -> const client::ClientSurface* {
        const auto found = windows_.find(recorded);
        return found == windows_.end() ? nullptr : found->second.surface.get();
    };
    return {.surface =
                [surface_of](SurfaceId recorded) {
                    const auto* surface = surface_of(recorded);
                    return surface ? surface->id : SurfaceId();
                },
            .slots =
                [surface_of, index = node.index](SurfaceId recorded) {
                    std::uint64_t slots = 0;
                    if (const auto* surface = surface_of(recorded))
                        for (const auto& layer : surface->layout.layers)
                            if (layer.node == index) slots |= layer.bit();
                    return slots;
                }};
}

}  // namespace wall::wallplay
