// SPDX-License-Identifier: MIT
// What a session does for the parts of windows that no tile shows (hidden_part.h): their commands are kept, and sent
// when somebody looks.
#include <algorithm>
#include <utility>

#include "client_lib/context/context.h"
#include "client_lib/context/share_group.h"
#include "client_lib/follow/hidden_part.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/geometry/select.h"
#include "client_lib/objects/maps.h"
#include "client_lib/process/options.h"
#include "common/glstate/pack_sink.h"
#include "common/wire/limits.h"

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
bool cannot_be_kept(const Context& c, const ClientSurface& surface) {
    const GLenum buffer = c.state.window.draw_buffer;
    const bool front = buffer != GL_BACK && buffer != GL_BACK_LEFT && buffer != GL_NONE;
    return (surface.options.format.double_buffered && front) || c.maps->stamp != 0;
}

/// A clear of all of the buffers that count, whatever was in them.
bool clears_whole(const Context& c, const HiddenPart& part, GLbitfield mask) {
    const ClientSurface& surface = *c.draw_surface();
    const SurfaceFormat& format = surface.options.format;
    const auto& s = c.state;
    const GLenum buffer = s.window.draw_buffer;
    const bool back = buffer == GL_BACK || buffer == GL_BACK_LEFT;
    if (s.window.scissor_enabled || (format.double_buffered ? !back : buffer == GL_NONE)) return false;
    if (!(mask & GL_COLOR_BUFFER_BIT) || s.color_buffer.color_mask != glstate::ColorMask{1, 1, 1, 1}) return false;
    const bool depth = (mask & GL_DEPTH_BUFFER_BIT) != 0 && s.depth_stencil.depth_mask;
    const bool stencil = (mask & GL_STENCIL_BUFFER_BIT) != 0 && (s.depth_stencil.stencil_mask[0] & 0xff) == 0xff;
    const bool accum = (mask & GL_ACCUM_BUFFER_BIT) != 0;
    return (depth || !part.depth_matters) && (stencil || !part.stencil_matters) && (accum || !part.accum_matters);
}

}  // namespace

// ---- which part, and where ----

void ClientSession::lay_hidden_part(ClientSurface& surface) {
    SurfaceLayout& layout = surface.layout;
    std::erase_if(layout.targets, [](const Target& t) { return t.slot == wire::kOffscreenSlot; });
    std::vector<geom::Rect> shown;
    for (const TileInfo& tile : tiles_)
        if (node_at(tile.node).alive()) shown.push_back(tile.rect);
    const geom::Rect around = uncovered(layout.rect, shown);
    const auto before = surface.hidden ? std::optional(surface.hidden->target.node) : std::nullopt;
    const auto node = node_for_hidden(surface, before);
    if (around.empty() || !node || group_ || options().shown_only) {
        surface.hidden.reset();
        return;
    }
    if (!surface.hidden) surface.hidden = std::make_unique<HiddenPart>();
    HiddenPart& part = *surface.hidden;
    if (before && before != node) part.forget();  // what it needs was told to another node
    if (part.width != layout.width || part.height != layout.height) part.forget();  // another layer
    part.width = layout.width;
    part.height = layout.height;
    part.target = make_target(layout, {*node, wire::kOffscreenSlot, layout.rect, {}}, around);
    part.everything =
        std::ranges::none_of(shown, [&](const geom::Rect& tile) { return geom::overlaps(tile, layout.rect); });
    if (part.drawn) layout.targets.push_back(part.target);
}

/// The same as before if it is still there; else one that shows the window, because it has the window's objects.
std::optional<NodeIndex> ClientSession::node_for_hidden(const ClientSurface& surface, std::optional<NodeIndex> before) {
    if (before && node_of(*before).alive()) return before;
    for (const Target& target : surface.layout.targets)
        if (node_of(target).alive()) return target.node;
    for (const auto& node : nodes_)
        if (node->alive()) return node->index;
    return std::nullopt;
}

/// A node came or went. What it held of a window, or what was kept for it, is gone.
void ClientSession::lay_hidden_parts() {
    for (auto& [id, surface] : surfaces_)
        if (!surface->layout.offscreen) lay_hidden_part(*surface);
}

// ---- keeping ----

Node* ClientSession::begin_keeping(Context& context, const std::optional<PixelRect>& box) {
    ClientSurface& surface = *context.draw_surface();
    HiddenPart& part = *surface.hidden;
    const auto& tests = context.state.depth_stencil;
    part.depth_matters = part.depth_matters || tests.depth_test || surface.depth_images;
    part.stencil_matters = part.stencil_matters || tests.stencil_test || surface.depth_images;
    if (part.drawn || context.select->layout || (box && !box->overlaps(part.target.area))) return nullptr;
    if (!node_of(part.target).takes(surface.id)) return nullptr;
    if (cannot_be_kept(context, surface) || part.bytes() > kMostKeptBytes) {
        show_hidden(surface);
        return nullptr;
    }
    part.now.turn_to(context);
    part.now.follower.index = part.target.node;
    return &part.now.follower;
}

wire::PackBuffer& ClientSession::prepare_kept(Context& context, const Needs& needs) {
    KeptFrame& frame = context.draw_surface()->hidden->now;
    Node& follower = frame.follower;
    Mirror& mirror = *frame.mirror;
    note_used(follower, mirror, context, follower.batch);
    if (follower.batch_context != frame.started && !frame.starts.contains(context.id)) {
        mirror.state = context.state;
        frame.starts.try_emplace(context.id, KeptFrame::Start{context.state, context.share_pointer()});
    }
    frame.started = follower.batch_context;
    KeptSink sink{frame};
    constexpr auto kCurrent = glstate::mask_of(glstate::Category::current);
    const auto categories = categories_to_send(needs, mirror.state, context.state);
    if (categories & kCurrent) diff_current(mirror.state, context.state, needs, sink);
    glstate::diff(categories & ~kCurrent, mirror.state, context.state, sink);
    return follower.batch;
}

void ClientSession::clear_hidden(Context& context, std::uint32_t mask) {
    packing([&] {
        ClientSurface* surface = context.draw_surface();
        if (!surface || !surface->hidden || !clears_whole(context, *surface->hidden, mask)) return;
        HiddenPart& part = *surface->hidden;
        const bool ends_frame = !surface->options.format.double_buffered;  // there is no other end
        if (part.drawn && ends_frame && ++part.quiet >= kQuietFrames) rest_hidden(*surface);
        if (part.drawn) return;
        part.now.restart(true);
    });
}

/// Before the swap is packed.
void ClientSession::finish_hidden_frame(ClientSurface& surface) {
    HiddenPart* part = surface.hidden.get();
    if (!part || part->drawn) return;
    part->finish();
    if (!part->too_much()) return;
    show_hidden(surface);  // its last frame is in front there; the swap to come leaves that as it is
}

/// After it.
void ClientSession::note_hidden_frame(ClientSurface& surface, bool whole) {
    HiddenPart* part = surface.hidden.get();
    if (part && part->drawn && ++part->quiet >= kQuietFrames && whole) rest_hidden(surface);
}

void ClientSession::rest_hidden(ClientSurface& surface) {
    surface.hidden->drawn = false;
    std::erase_if(surface.layout.targets, [](const Target& t) { return t.slot == wire::kOffscreenSlot; });
}

// ---- showing ----

void ClientSession::show_hidden(ClientSurface& surface) {
    HiddenPart& part = *surface.hidden;
    part.drawn = true;
    part.quiet = 0;
    surface.layout.targets.push_back(part.target);
    Node& node = node_of(part.target);
    if (!node.takes(surface.id)) return part.forget();
    for (KeptFrame& frame : part.finished) {
        send_kept(node, surface, frame);
        glapi::pack::SwapOffscreen(node.batch, surface.id);
    }
    part.now.seal();
    send_kept(node, surface, part.now);
    part.forget();
}

void ClientSession::send_kept(Node& node, ClientSurface& surface, KeptFrame& frame) {
    describe_surface(node, surface);
    for (const auto& [context, start] : frame.starts)
        bring_noted(*this, node, *start.share, frame.follower.object_stamps, node.batch);
    for (KeptFrame::Stretch& stretch : frame.stretches) {
        wire::PackBuffer& buffer = batch(node, stretch.context);
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

void ClientSession::look_at_hidden(ClientSurface& surface, const geom::Rect& box) {
    packing([&] {
        if (!surface.hidden || geom::intersect(box, surface.hidden->target.pixels).empty()) return;
        surface.hidden->quiet = 0;
        if (!surface.hidden->drawn) show_hidden(surface);
    });
}

void ClientSession::count_hidden_samples() {
    packing([&] {
        for (auto& [id, surface] : surfaces_) {
            if (!surface->hidden || !surface->hidden->everything) continue;
            surface->hidden->quiet = 0;
            if (!surface->hidden->drawn) show_hidden(*surface);
        }
    });
}

void ClientSession::accumulate_hidden(ClientSurface& surface) {
    packing([&] {
        if (!surface.hidden) return;
        surface.hidden->accum_matters = true;
        surface.hidden->quiet = 0;
        if (!surface.hidden->drawn) show_hidden(surface);
    });
}

void ClientSession::before_object_changes(ClientName object) {
    packing([&] {
        const auto uses = [&](const KeptFrame& frame) { return frame.follower.object_stamps.contains(object); };
        for (auto& [id, surface] : surfaces_) {
            HiddenPart* part = surface->hidden.get();
            if (!part || part->drawn) continue;
            const bool in_finished = std::ranges::any_of(part->finished, uses);
            // The frame before this one is forgotten where this one clears all of it, as that one did.
            const bool over =
                part->finished.size() == 1 && part->finished[0].whole && (part->now.empty() || part->now.whole);
            if (uses(part->now) || (in_finished && !over)) show_hidden(*surface);
            else if (in_finished) part->finished.clear();
        }
    });
}

void ClientSession::before_context_goes(ContextId context) {
    for (auto& [id, surface] : surfaces_) {
        HiddenPart* part = surface->hidden.get();
        if (!part || part->drawn) continue;
        const auto drew = [&](const KeptFrame& frame) { return frame.starts.contains(context); };
        if (drew(part->now) || std::ranges::any_of(part->finished, drew)) show_hidden(*surface);
    }
}

}  // namespace wall::client
