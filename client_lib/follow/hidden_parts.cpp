// SPDX-License-Identifier: MIT
#include "client_lib/follow/hidden_parts.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "client_lib/follow/object_sender.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/process/options.h"
#include "common/glstate/draw_buffers.h"
#include "common/glstate/pack_sink.h"

namespace wall::client {
namespace {

/// Changed values in full: a kept command cannot refer to what the node will remember when it is sent.
struct KeptSink {
    KeptFrame& frame;
    template <class E>
    void set(unsigned i, const typename E::type& v) {
        const std::uint32_t id = E::id + i;
        if constexpr (sizeof v == glstate::ValueHistory::kValueBytes) {
            frame.matrices.push_back({id, frame.follower.batch.operand_bytes() + sizeof id});
        } else if constexpr (sizeof v == sizeof(std::uint32_t)) {
            std::uint32_t word;
            std::memcpy(&word, &v, sizeof word);
            if (word <= 0xffff) return glapi::pack::StateSmall(frame.follower.batch, id | word << 16);
        }
        glapi::pack_state(frame.follower.batch, id, &v, sizeof v);
    }
};

/// Whether commands of the context go past a swap, or need what is not kept with them.
bool cannot_be_kept(const DrawSource& source) {
    const GLenum buffer = source.state.window.draw_buffer;
    const bool front = buffer != GL_NONE && !glstate::names_back_only(buffer);
    return (!source.draw.shows_at_once() && front) || source.used.maps != 0;
}

/// A clear of all of the buffers that count, whatever was in them.
bool clears_whole(const DrawSource& source, const HiddenPart& part, GLbitfield mask) {
    const SurfaceFormat& format = source.draw.format();
    const auto& s = source.state;
    const GLenum buffer = s.window.draw_buffer;
    const bool back = buffer == GL_BACK || (!format.stereo && buffer == GL_BACK_LEFT);
    if (s.window.scissor_enabled || (format.double_buffered ? !back : buffer == GL_NONE)) return false;
    if (!(mask & GL_COLOR_BUFFER_BIT) || !glstate::writes_all_channels(s)) return false;
    const bool depth = (mask & GL_DEPTH_BUFFER_BIT) != 0 && s.depth_stencil.depth_mask;
    const bool stencil = (mask & GL_STENCIL_BUFFER_BIT) != 0 && (s.depth_stencil.stencil_mask[0] & 0xff) == 0xff;
    const bool accum = (mask & GL_ACCUM_BUFFER_BIT) != 0;
    return (depth || !part.depth_matters) && (stencil || !part.stencil_matters) && (accum || !part.accum_matters);
}

/// The tile shows the window through a view, and no part of its picture.
bool looks_elsewhere(const SurfaceLayout& layout, const TileInfo& tile) {
    return std::ranges::any_of(layout.layers, [&](const TargetLayer& layer) {
        return layer.view != 0 && layer.node == tile.node && layer.slot == tile.slot;
    });
}

}  // namespace

// ---- which part, and where ----

void HiddenParts::lay(ClientSurface& surface, std::span<const TileInfo> tiles) {
    SurfaceLayout& layout = surface.layout;
    std::erase_if(layout.layers, std::mem_fn(&TargetLayer::is_whole_window));
    std::vector<geom::Rect> shown;
    for (const TileInfo& tile : tiles)
        if (nodes_[tile.node].alive() && !looks_elsewhere(layout, tile)) shown.push_back(tile.rect);
    const geom::Rect around = uncovered(layout.rect, shown);
    const auto before = surface.hidden ? std::optional(surface.hidden->layer.node) : std::nullopt;
    const auto node = node_for(surface, before);
    if (around.empty() || !node || parallel() || options().shown_only) {
        surface.hidden.reset();
        return;
    }
    if (!surface.hidden) surface.hidden = std::make_unique<HiddenPart>();
    HiddenPart& part = *surface.hidden;
    if (before && before != node) part.forget();  // what it needs was told to another node
    if (part.width != layout.width || part.height != layout.height) part.forget();  // another layer
    part.width = layout.width;
    part.height = layout.height;
    part.layer = whole_window(layout, *node, around);
    part.everything =
        std::ranges::none_of(shown, [&](const geom::Rect& tile) { return geom::overlaps(tile, layout.rect); });
    if (part.drawn) layout.layers.push_back(part.layer);
}

/// The same as before if it is still there; else one that shows the window, because it has the window's objects.
std::optional<NodeIndex> HiddenParts::node_for(const ClientSurface& surface, std::optional<NodeIndex> before) {
    if (before && nodes_[*before].alive()) return before;
    for (const TargetLayer& layer : surface.layout.layers)
        if (nodes_[layer].alive() && !nodes_[layer].records()) return layer.node;
    for (const auto& node : nodes_)
        if (node->alive() && !node->records()) return node->index;
    return std::nullopt;
}

// ---- keeping ----

KeptFrame* HiddenParts::begin_keeping(const DrawSource& source, const std::optional<PixelRect>& box) {
    ClientSurface* const surface = source.draw.with_hidden_part();
    if (!surface) return nullptr;
    HiddenPart& part = *surface->hidden;
    const auto& tests = source.state.depth_stencil;
    part.depth_matters = part.depth_matters || tests.depth_test || surface->depth_images;
    part.stencil_matters = part.stencil_matters || tests.stencil_test || surface->depth_images;
    if (part.drawn || (box && !box->overlaps(part.layer.area))) return nullptr;
    if (!source.draw.goes_to(nodes_[part.layer])) return nullptr;
    if (cannot_be_kept(source) || part.bytes() > kMostKeptBytes) {
        show(*surface);
        return nullptr;
    }
    part.now.turn_to(source.id);
    part.now.layer = part.layer;
    return &part.now;
}

wire::PackBuffer& HiddenParts::prepare(KeptFrame& frame, const DrawSource& source, const Needs& needs) {
    Node& follower = frame.follower;
    Mirror& mirror = *frame.mirror;
    note_used(follower, mirror, source, follower.batch);
    if (follower.batch_context != frame.started && !frame.starts.contains(source.id)) {
        mirror.state = source.state;
        frame.starts.try_emplace(source.id, KeptFrame::Start{source.state, source.share});
    }
    frame.started = follower.batch_context;
    KeptSink sink{frame};
    constexpr auto kCurrent = glstate::mask_of(glstate::Category::current);
    const auto categories = categories_to_send(needs, mirror.state, source.state);
    if (categories & kCurrent) diff_current(mirror.state, source.state, needs, sink);
    glstate::diff_lazily(categories & ~kCurrent, mirror.state, source.state, sink);
    return follower.batch;
}

void HiddenParts::before_clear(const DrawSource& source, std::uint32_t mask) {
    ClientSurface* const surface = source.draw.with_hidden_part();
    if (!surface || !clears_whole(source, *surface->hidden, mask)) return;
    HiddenPart& part = *surface->hidden;
    const bool ends_frame = source.draw.shows_at_once();  // there is no other end
    if (part.drawn && ends_frame && ++part.quiet >= kQuietFrames) rest(*surface);
    if (part.drawn) return;
    part.now.restart(true);
}

/// Before the swap is packed.
void HiddenParts::finish_frame(ClientSurface& surface) {
    HiddenPart* part = surface.hidden.get();
    if (!part || part->drawn) return;
    part->finish();
    if (!part->too_much()) return;
    show(surface);  // its last frame is in front there; the swap to come leaves that as it is
}

/// After it.
void HiddenParts::note_frame(ClientSurface& surface, bool whole) {
    HiddenPart* part = surface.hidden.get();
    if (part && part->drawn && ++part->quiet >= kQuietFrames && whole) rest(surface);
}

void HiddenParts::forget() {
    for (auto& [id, surface] : surfaces_)
        if (surface->hidden) surface->hidden->forget();
}

void HiddenParts::rest(ClientSurface& surface) {
    surface.hidden->drawn = false;
    std::erase_if(surface.layout.layers, std::mem_fn(&TargetLayer::is_whole_window));
}

// ---- showing ----

void HiddenParts::show(ClientSurface& surface) {
    HiddenPart& part = *surface.hidden;
    part.drawn = true;
    part.quiet = 0;
    surface.layout.layers.push_back(part.layer);
    Node& node = nodes_[part.layer];
    if (!DrawTarget(surface).goes_to(node)) return part.forget();
    for (KeptFrame& frame : part.finished) {
        send_kept(node, surface, frame);
        glapi::pack::SwapOffscreen(node.batch, surface.id);
    }
    part.now.seal();
    send_kept(node, surface, part.now);
    part.forget();
}

void HiddenParts::send_kept(Node& node, ClientSurface& surface, KeptFrame& frame) {
    DrawTarget(surface).describe_to(node);
    for (const auto& [context, start] : frame.starts)
        bring_noted(nodes_, node, *start.share, frame.follower.object_stamps, node.batch);
    for (KeptFrame::Stretch& stretch : frame.stretches) {
        wire::PackBuffer& buffer = nodes_.batch(node, stretch.context);
        Mirror& mirror = node.mirrors[stretch.context];
        if (mirror.draw_surface != surface.id) {
            mirror.draw_surface = surface.id;
            if (!mirror.read_surface) mirror.read_surface = surface.id;
            glapi::pack::Bind(buffer, mirror.draw_surface, mirror.read_surface);
        }
        if (const auto start = frame.starts.extract(stretch.context)) {
            glstate::PackSink sink{buffer, mirror.history};
            glstate::diff(glstate::kSentCategories, mirror.state, start.mapped().state, sink);
        }
        buffer.append(stretch.commands, {}, stretch.commands.mark());
        for (const auto& [element, operand] : stretch.matrices)
            mirror.history.add(element, stretch.commands.operand_at(operand));
        mirror.state = frame.follower.mirrors[stretch.context].state;
    }
    for (auto& [id, mirror] : node.mirrors) mirror.used = {};  // programs hold the frame's uniform values
}

void HiddenParts::before_reading(const DrawTarget& target, const geom::Rect& box) {
    ClientSurface* const surface = target.with_hidden_part();
    if (!surface || geom::intersect(box, surface->hidden->layer.pixels).empty()) return;
    surface->hidden->quiet = 0;
    if (!surface->hidden->drawn) show(*surface);
}

void HiddenParts::before_counting_samples() {
    for (auto& [id, surface] : surfaces_) {
        if (!surface->hidden || !surface->hidden->everything) continue;
        surface->hidden->quiet = 0;
        if (!surface->hidden->drawn) show(*surface);
    }
}

void HiddenParts::before_accumulating(const DrawTarget& target) {
    ClientSurface* const surface = target.with_hidden_part();
    if (!surface) return;
    surface->hidden->accum_matters = true;
    surface->hidden->quiet = 0;
    if (!surface->hidden->drawn) show(*surface);
}

void HiddenParts::before_drawing_to(const DrawSource& source) {
    if (std::ranges::none_of(surfaces_, [](const auto& entry) { return entry.second->hidden != nullptr; })) return;
    std::vector<ClientName> images;
    {
        std::lock_guard lock(source.share->mutex);
        const auto note = [&](const Object& image) { images.push_back(image.id); };
        source.draw.for_each_image(note);
        source.objects.for_each_written(note);
    }
    for (const ClientName image : images) before_object_changes(image);
}

void HiddenParts::before_object_changes(ClientName object) {
    const auto uses = [&](const KeptFrame& frame) { return frame.follower.object_stamps.contains(object); };
    for (auto& [id, surface] : surfaces_) {
        HiddenPart* part = surface->hidden.get();
        if (!part || part->drawn) continue;
        const bool in_finished = std::ranges::any_of(part->finished, uses);
        // The frame before this one is forgotten where this one clears all of it, as that one did.
        const bool over =
            part->finished.size() == 1 && part->finished[0].whole && (part->now.empty() || part->now.whole);
        if (uses(part->now) || (in_finished && !over)) show(*surface);
        else if (in_finished) part->finished.clear();
    }
}

void HiddenParts::before_context_goes(ContextId context) {
    for (auto& [id, surface] : surfaces_) {
        HiddenPart* part = surface->hidden.get();
        if (!part || part->drawn) continue;
        const auto drew = [&](const KeptFrame& frame) { return frame.starts.contains(context); };
        if (drew(part->now) || std::ranges::any_of(part->finished, drew)) show(*surface);
    }
}

}  // namespace wall::client
