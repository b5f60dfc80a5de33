// SPDX-License-Identifier: MIT
#include "client_lib/follow/session.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "client_lib/context/context.h"
#include "client_lib/follow/block_sender.h"
#include "client_lib/follow/hidden_part.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/link/pacing.h"
#include "client_lib/process/log.h"
#include "client_lib/process/options.h"
#include "client_lib/process/process.h"
#include "common/glstate/pack_sink.h"
#include "common/wire/limits.h"
#include "common/wire/whole_window.h"

namespace wall::client {
namespace {

constexpr auto kRetryPause =
    std::chrono::seconds(10);  // a program that asks for every frame must not wait for every frame
constexpr std::chrono::milliseconds kStartLimit{2500};  // for all nodes together; each attempt has a limit of its own
constexpr std::chrono::milliseconds kTakeUpLimit{100};  // a node that is there answers sooner; others come later
constexpr int kFinishMs = 500;                          // what is queued when the program ends
constexpr int kEndMarginMs = 1500;                      // for the rest of the end
constexpr std::chrono::seconds kPlacementTimeout{2};
constexpr int kReplyTimeoutMs = 10000;  // a readback behind a long frame of a software renderer
constexpr std::uint32_t kDiffSample =
    61;  // one difference in so many is timed: two looks at the clock cost more than comparing equal contexts
constexpr std::size_t kBatchBytes =
    256 << 10;  // sent when it reaches this: large enough to be cheap, small enough to overlap

}  // namespace

Target make_target(const SurfaceLayout& layout, const TileInfo& tile, const geom::Rect& part) {
    const float sx = static_cast<float>(layout.width) / static_cast<float>(layout.rect.width);
    const float sy = static_cast<float>(layout.height) / static_cast<float>(layout.rect.height);
    const auto height = static_cast<float>(layout.height);
    Target target;
    target.node = tile.node;
    target.slot = tile.slot;
    target.area = {static_cast<float>(part.x - layout.rect.x) * sx,
                   height - static_cast<float>(part.bottom() - layout.rect.y) * sy,
                   static_cast<float>(part.right() - layout.rect.x) * sx,
                   height - static_cast<float>(part.y - layout.rect.y) * sy};
    const int x0 = static_cast<int>(std::floor(target.area.x0)), y0 = static_cast<int>(std::floor(target.area.y0));
    target.pixels = {x0, y0, static_cast<int>(std::ceil(target.area.x1)) - x0,
                     static_cast<int>(std::ceil(target.area.y1)) - y0};
    return target;
}

SurfaceId next_window_id() {
    static std::atomic<std::uint32_t> last{0};
    if (!parallel()) return next_surface_id();
    const auto number = ++last;
    return SurfaceId(number <= wire::kMaxSharedSurfaces ? number : 0);
}

namespace {

/// Never destroyed: the application may still draw while it exits.
struct OnlySession {
    std::mutex mutex;
    std::shared_ptr<ClientSession> session;  ///< stays when the last context goes: SDL makes a probe context first
    std::optional<std::chrono::steady_clock::time_point> failed_at;
    static OnlySession& get() {
        static auto* only = new OnlySession();
        return *only;
    }
};

}  // namespace

std::shared_ptr<ClientSession> ClientSession::get_if_open() {
    if (in_forked_child()) return nullptr;
    std::lock_guard lock(OnlySession::get().mutex);
    return OnlySession::get().session;
}

std::shared_ptr<ClientSession> ClientSession::get() {
    if (in_forked_child()) return nullptr;
    auto& only = OnlySession::get();
    std::lock_guard lock(only.mutex);
    if (only.session) return only.session;
    if (only.failed_at && std::chrono::steady_clock::now() - *only.failed_at < kRetryPause) return nullptr;
    auto control = ControlLink::open(Hello::from_environment());
    if (!control) {
        complain_once(control.error().message);
        only.failed_at = std::chrono::steady_clock::now();
        return nullptr;
    }
    only.session.reset(new ClientSession(std::move(*control)));
    at_process_end(
        [] {
            if (const auto session = get_if_open()) session->finish();
        },
        parallel() ? kLeaveLimitMs + kEndMarginMs : kFinishMs + kEndMarginMs);
    return only.session;
}

ClientSession::ClientSession(std::unique_ptr<ControlLink> control)
    : control_(std::move(control)), sort_scratch_(std::make_unique<SortScratch>()) {
    if (group_) control_->on_end([this](const std::string& why) { transport_.give_up_all(why); });
    std::unique_lock lock(mutex_);
    adopt(control_->welcome());
    wait_for_attempts(lock, kStartLimit);
}

// The first welcome, or that of a walld that came back. A node that has the session under the ticket that it has given
// before goes on with its stream; what the others have of it is gone.
void ClientSession::adopt(const Welcome& welcome) {
    const bool goes_on = id_ == welcome.session;
    bool anew = false;
    id_ = welcome.session;
    tiles_ = welcome.tiles;
    for (const TileInfo& tile : tiles_) node_at(tile.node);  // also those that are not up
    for (const NodeInfo& info : welcome.nodes) {
        Node& node = node_at(info.node);
        const bool same = goes_on && node.alive() && node.info.ticket == info.ticket;
        node.info = info;
        if (same) continue;
        connect(node);
        anew = true;
    }
    if (anew) redraw();
}

ClientSession::~ClientSession() { finish(); }

void ClientSession::finish() {
    if (group_) return leave_group();
    {
        std::lock_guard lock(mutex_);
        for (auto& node : nodes_)
            if (node->alive()) send(*node);
    }
    transport_.drain(kFinishMs);
}

// A new stream is a node at time zero: whatever it needs is sent when it needs it.
/// Programs that draw only when asked are asked.
void ClientSession::redraw() {
    for (const auto& [id, surface] : surfaces_)
        if (!surface->layout.offscreen && surface->frame > 0) control_->ask_to_redraw(id);
}

void ClientSession::open_surface(ClientSurface& surface) {
    std::unique_lock lock(mutex_);
    if (surface.opened) return;
    surface.opened = true;
    surfaces_[surface.id] = &surface;
    const Extent size =
        surface.options.query_size ? surface.options.query_size().value_or(surface.options.size) : surface.options.size;
    surface.layout.width = std::max(1u, size.width);
    surface.layout.height = std::max(1u, size.height);
    if (!surface.options.visible) return apply_layout(surface, Placement{});
    control_->surface_open(surface.id, surface.layout.width, surface.layout.height, surface.options.title,
                           surface.options.messages);
    const auto placement = control_->wait_placement(surface.id, kPlacementTimeout);
    if (group_) {
        surface.window = {surface.layout.width, surface.layout.height};
        take_events();
        adopt_agreed(surface);
    } else if (placement) {
        apply_layout(surface, *placement);
    }
}

void ClientSession::close_surface(ClientSurface& surface) {
    std::lock_guard lock(mutex_);
    if (!surface.opened) return;
    surface.opened = false;
    surfaces_.erase(surface.id);
    if (surface.options.visible) control_->surface_close(surface.id);
    for (auto& node : nodes_) {
        node->left_out.erase(surface.id);
        if (!node->alive() || node->surfaces.erase(surface.id) == 0) continue;
        glapi::pack::SurfaceDestroy(batch(*node, node->batch_context), surface.id);
        send(*node);
    }
}

void ClientSession::apply_layout(ClientSurface& surface, const Placement& placement) {
    SurfaceLayout& layout = surface.layout;
    layout.targets.clear();
    ++layout.version;
    layout.offscreen = !surface.options.visible;
    if (layout.offscreen) {
        layout.rect = {0, 0, static_cast<int>(layout.width), static_cast<int>(layout.height)};
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            layout.targets.push_back(
                make_target(layout, TileInfo{node->index, wire::kOffscreenSlot, layout.rect, {}}, layout.rect));
            break;
        }
        return;
    }
    layout.rect = placement.rect;
    for (const TileInfo& tile : tiles_) {
        const geom::Rect part = geom::intersect(tile.rect, layout.rect);
        if (!part.empty()) layout.targets.push_back(make_target(layout, tile, part));
    }
    lay_hidden_part(surface);
}

/// Pbuffers whose node is gone go to another one, and so do those that had none; so do the hidden parts of windows.
void ClientSession::place_off_wall() {
    lay_hidden_parts();
    for (auto& [id, surface] : surfaces_) {
        const auto& targets = surface->layout.targets;
        if (surface->layout.offscreen && (targets.empty() || !node_of(targets.front()).alive()))
            apply_layout(*surface, {});
    }
}

void ClientSession::begin_frame(ClientSurface& surface) {
    std::unique_lock lock(mutex_);
    take_events();
    wait_for_attempts(lock, kTakeUpLimit);
    if (common(surface)) {
        report_window(surface);
        return adopt_agreed(surface);
    }
    if (in_frame(surface)) return;
    adopt_placement(surface);
    follow_window(surface);
}

void ClientSession::follow_window(ClientSurface& surface) {
    const auto size = surface.options.query_size ? surface.options.query_size() : std::nullopt;
    if (!size || !size->width || !size->height ||
        (size->width == surface.layout.width && size->height == surface.layout.height))
        return;
    surface.layout.width = size->width;
    surface.layout.height = size->height;
    control_->surface_resize(surface.id, size->width, size->height);
    surface.next = control_->wait_placement(surface.id, kPlacementTimeout);
    adopt_placement(surface);
    if (surface.frame > 0) control_->ask_to_redraw(surface.id);
}

// Only between two frames, so that none mixes two layouts. What the last frame shows was drawn for the old one.
void ClientSession::adopt_placement(ClientSurface& surface) {
    if (!surface.next || in_frame(surface)) return;
    const Placement placement = *std::exchange(surface.next, std::nullopt);
    const bool moved = placement.rect != surface.layout.rect;
    apply_layout(surface, placement);
    control_->surface_adopted(surface.id, placement.layout_version, surface.frame + 1, kPlacementTimeout);
    if (moved && (surface.frame > 0 || !surface.options.format.double_buffered)) control_->ask_to_redraw(surface.id);
}

void ClientSession::take_events() {
    auto events = control_->take_events();
    if (events.reconnected) adopt(*events.reconnected);
    for (const NodeInfo& info : events.node_changes) {
        if (group_ && info.up) continue;  // comes with a placement
        Node& node = node_slot(info);
        connect(node);
        place_off_wall();
    }
    for (const auto& node : nodes_) keep_connected(*node);
    for (const Placement& placement : events.placements) {
        const auto found = surfaces_.find(placement.surface);
        if (found == surfaces_.end()) continue;
        if (group_) found->second->coming.push_back(placement);
        else found->second->next = placement;
    }
    for (auto& [id, surface] : surfaces_) adopt_placement(*surface);
}

wire::PackBuffer& ClientSession::batch(Node& node, ContextId context) {
    if (node.batch_context != context || node.batch.bytes() > kBatchBytes) send(node);
    node.batch_context = context;
    return node.batch;
}

void ClientSession::send(Node& node) {
    if (node.batch.empty()) return;
    if (node.alive()) {
        stats().add_node(node.index, NodeCounter::batches, 1);
        node.stream->send(node.batch_context, std::exchange(node.batch, wire::PackBuffer()));
        transport_.wake();
    }
    node.batch.clear();
}

/// What a node is told of the layer of the whole window.
static std::uint32_t whole_window_of(const Node& node, const ClientSurface& surface) {
    if (surface.layout.offscreen) return wire::kOnlyWholeWindow;
    return surface.hidden && surface.hidden->target.node == node.index ? wire::kAlsoWholeWindow : wire::kTilesOnly;
}

void ClientSession::describe_surface(Node& node, ClientSurface& surface) {
    const SurfaceLayout& layout = surface.layout;
    const auto known = node.surfaces.find(surface.id);
    if (known == node.surfaces.end()) {
        const SurfaceFormat& f = surface.options.format;
        glapi::pack::SurfaceCreate(node.batch, surface.id, f.double_buffered, f.alpha_bits, f.depth_bits,
                                   f.stencil_bits, f.accum_bits, f.samples);
    } else if (known->second == layout.version) {
        return;
    }
    glapi::pack::SurfacePlace(node.batch, surface.id, layout.version, layout.width, layout.height, layout.rect.x,
                              layout.rect.y, static_cast<std::uint32_t>(layout.rect.width),
                              static_cast<std::uint32_t>(layout.rect.height), whole_window_of(node, surface));
    node.surfaces[surface.id] = layout.version;
}

wire::PackBuffer& ClientSession::prepare(Node& node, Context& context, const Needs& needs) {
    wire::PackBuffer& buffer = batch(node, context.id);
    Mirror& mirror = node.mirrors[context.id];
    const std::size_t start = buffer.bytes();
    ClientSurface& draw = *context.draw_surface();
    ClientSurface& read = *context.read_surface();
    draw.drawn = true;
    describe_surface(node, draw);
    if (&read != &draw) describe_surface(node, read);
    if (mirror.draw_surface != draw.id || mirror.read_surface != read.id) {
        glapi::pack::Bind(buffer, draw.id, read.id);
        mirror.draw_surface = draw.id;
        mirror.read_surface = read.id;
    }
    const std::size_t surface_bytes = buffer.bytes() - start;
    const std::size_t object_bytes = bring_up_to_date(*this, node, context, buffer);
    const std::size_t state_start = buffer.bytes();
    const bool sampled = ++prepared_ % kDiffSample == 0;
    const auto diff_start = sampled ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
    glstate::PackSink sink{buffer, mirror.history};
    constexpr auto kCurrent = glstate::mask_of(glstate::Category::current);
    const auto categories = categories_to_send(needs, mirror.state, context.state);
    if (categories & kCurrent) diff_current(mirror.state, context.state, needs, sink);
    glstate::diff(categories & ~kCurrent, mirror.state, context.state, sink);
    if (sampled) stats().add_diff_time(kDiffSample * (std::chrono::steady_clock::now() - diff_start));
    count_objects(node, object_bytes);
    count_state(node, buffer.bytes() - state_start + surface_bytes);
    return buffer;
}

void ClientSession::submit_block(Context& context) {
    packing([&] { BlockSender(*this, context, *sort_scratch_).run(); });
}

void ClientSession::distrust_nodes() {
    for (auto& node : nodes_) {
        if (!node->alive()) continue;
        node->stream->give_up("out of memory");  // short enough to need none
        node->batch.clear();
    }
    for (auto& [id, surface] : surfaces_)
        if (surface->hidden) surface->hidden->forget();
}

void ClientSession::swap(Context* context, ClientSurface& surface) {
    if (context) context->flush_block();
    bool whole_frames = false;
    {
        std::lock_guard lock(mutex_);
        whole_frames = std::exchange(surface.cleared, false);
        finish_hidden_frame(surface);
        ++surface.frame;
        surface.drawn = false;
        for (const NodeIndex index : swap_nodes(surface)) {
            Node& node = node_of(index);
            if (!node.takes(surface.id)) continue;
            auto& buffer = batch(node, context ? context->id : node.batch_context);
            describe_surface(node, surface);
            glapi::pack::Swap(buffer, surface.id, surface.frame);
            send(node);
        }
        note_hidden_frame(surface, whole_frames);
        count_frame();
    }
    if (common(surface)) wait_for_group(surface);
    else wait_for_nodes(surface, whole_frames);
}

/// All that show the surface; in a parallel program all there are, because its members keep step on each.
std::vector<NodeIndex> ClientSession::swap_nodes(const ClientSurface& surface) const {
    std::vector<NodeIndex> out;
    if (!common(surface))
        for (const auto& [index, slots] : targets_of(surface.layout, std::nullopt)) out.push_back(index);
    else
        for (const auto& node : nodes_) out.push_back(node->index);
    return out;
}

// A node that is slow for once (a long frame of all nodes alike) is waited for; one that has stopped is left out. If
// all are late, the wall holds the frames or has stopped as a whole: then the program goes at the limit's pace.
void ClientSession::wait_for_nodes(ClientSurface& surface, bool whole_frames) {
    if (surface.frame < kFramesInFlight) return;
    struct Waited {
        Node& node;
        std::shared_ptr<NodeStream> stream;
        std::uint32_t frame;
        NodeProgress progress;
    };
    std::vector<Waited> waited;
    bool all_slow = true;
    {
        std::lock_guard lock(mutex_);
        for (const auto& [index, slots] : targets_of(surface.layout, std::nullopt)) {
            Node& node = node_of(index);
            if (!node.alive()) continue;
            const auto left = node.left_out.find(surface.id);
            const bool left_out = left != node.left_out.end();
            waited.push_back({node,
                              node.stream,
                              left_out ? left->second : surface.frame - (kFramesInFlight - 1),
                              {.left_out = left_out}});
            all_slow = all_slow && node.slow;
        }
    }
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(control_->welcome().swap_timeout_ms);
    bool someone_done = false;
    for (Waited& w : waited) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
        const bool patient = all_slow || !w.node.slow;
        w.progress.done = w.stream->wait_swap(surface.id, w.frame, patient && left > 0 ? static_cast<int>(left) : 0);
        w.progress.queued_bytes = w.stream->queued_bytes();
        someone_done = someone_done || w.progress.done;
    }
    std::lock_guard lock(mutex_);
    for (Waited& w : waited) {
        if (w.node.stream != w.stream) continue;  // another incarnation meanwhile
        w.node.slow = !w.progress.done;
        if (!leave_out(w.progress, someone_done, whole_frames)) w.node.left_out.erase(surface.id);
        else w.node.left_out.try_emplace(surface.id, surface.frame);
    }
}

void ClientSession::flush(Context* context, bool wait) {
    if (context) context->flush_block();
    std::vector<std::pair<std::shared_ptr<NodeStream>, RequestId>> pending;
    {
        std::lock_guard lock(mutex_);
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            if (wait && node->answers()) {
                glapi::pack::Sync(batch(*node, node->batch_context), next_request());
                pending.emplace_back(node->stream, last_request_);
            }
            send(*node);
        }
        if (!pending.empty()) count_round_trip("glFinish");
        // Without a back buffer there is no other end of a frame.
        if (const ClientSurface* surface = context ? context->draw_surface() : nullptr;
            surface && !surface->options.format.double_buffered)
            take_events();
    }
    for (auto& [stream, request] : pending) stream->wait_reply(request, reply_timeout_ms());
}

/// A member of a parallel program may have to wait for the others, however long they take.
int ClientSession::reply_timeout_ms() const { return group_ ? NodeStream::kNoLimit : kReplyTimeoutMs; }

void ClientSession::count_geometry(Node& node, std::size_t bytes) {
    stats().add_node(node.index, NodeCounter::geometry_bytes, bytes);
}
void ClientSession::count_block(Node& node) { stats().add_node(node.index, NodeCounter::blocks, 1); }
void ClientSession::count_objects(Node& node, std::size_t bytes) {
    if (bytes) stats().add_node(node.index, NodeCounter::object_bytes, bytes);
}
void ClientSession::count_state(Node& node, std::size_t bytes) {
    if (bytes) stats().add_node(node.index, NodeCounter::state_bytes, bytes);
}
void ClientSession::count_frame() { stats().end_frame(); }
void ClientSession::count_round_trip(const char* function) { stats().count_round_trip(function); }

void ClientSession::delete_object(Context& context, ClientName object, void (*pack)(wire::PackBuffer&, ClientName)) {
    on_every_node(context, [&](wire::PackBuffer& buffer, Node& node) {
        if (node.object_stamps.erase(object) != 0) pack(buffer, object);
    });
}

void ClientSession::destroy_context(ContextId context) {
    std::lock_guard lock(mutex_);
    before_context_goes(context);
    for (auto& node : nodes_) {
        if (!node->alive() || node->mirrors.erase(context) == 0) continue;
        glapi::pack::ContextDestroy(batch(*node, context), context);
        send(*node);
    }
}

ClientSurface::ClientSurface(SurfaceId own_id, SurfaceOptions own_options)
    : id(own_id), options(std::move(own_options)) {}
ClientSurface::~ClientSurface() = default;

}  // namespace wall::client
