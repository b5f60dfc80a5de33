// SPDX-License-Identifier: MIT
#include "client_lib/follow/session.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "client_lib/follow/block_sender.h"
#include "client_lib/follow/frame_wait.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/link/pacing.h"
#include "client_lib/process/log.h"
#include "client_lib/process/process.h"

namespace wall::client {
namespace {

constexpr auto kRetryPause =
    std::chrono::seconds(10);  // a program that asks for every frame must not wait for every frame
constexpr std::chrono::milliseconds kStartLimit{2500};  // for all nodes together; each attempt has a limit of its own
constexpr std::chrono::milliseconds kTakeUpLimit{100};  // a node that is there answers sooner; others come later
constexpr int kFinishMs = 500;                          // what is queued when the program ends
constexpr int kLeaveLimitMs = 2000;     // the same for a member of a parallel program: the others wait for it
constexpr int kEndMarginMs = 1500;      // for the rest of the end
constexpr int kReplyTimeoutMs = 10000;  // a readback behind a long frame of a software renderer

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
    if (group_) control_->on_end([this](const std::string& why) { nodes_.give_up_all(why); });
    std::unique_lock lock(mutex_);
    adopt(control_->welcome(), false);
    nodes_.wait_for_attempts(lock, kStartLimit);
}

ClientSession::~ClientSession() { finish(); }

StreamEvents ClientSession::stream_events() {
    const auto opened = [this](Node& node) {
        if (group_) introduce(node);
        if (node.records()) want_window_contents();
        surfaces_.place_off_wall();
        if (!group_) surfaces_.ask_to_redraw();
    };
    const auto can_be_taken = [] {
        const auto session = get_if_open();
        if (!session) return;
        std::lock_guard lock(session->mutex_);  // who waited for it may have taken it by now: nothing is to be redrawn
        const bool waits =
            std::ranges::any_of(session->nodes_, [](const auto& node) { return node->attempt != nullptr; });
        if (waits) session->control_->ask_all_to_redraw();
    };
    const auto stream_failed = [this] {
        if (!group_) control_->ask_all_to_redraw();  // the program's next frame opens the stream again
    };
    return {opened, [this] { surfaces_.place_off_wall(); }, can_be_taken, stream_failed};
}

void ClientSession::finish() {
    if (group_) return leave_group();
    {
        std::lock_guard lock(mutex_);
        for (auto& node : nodes_)
            if (node->alive()) nodes_.send(*node);
    }
    nodes_.drain(kFinishMs);
}

// ---- what walld says ----

// The first welcome, or that of a walld that came back. A node that has the session under the ticket that it has given
// before goes on with its stream; what the others have of it is gone.
void ClientSession::adopt(const Welcome& welcome, bool moved) {
    const bool goes_on = !moved && id_ == welcome.session;
    bool anew = false;
    id_ = welcome.session;
    nodes_.set_session(id_);
    snapping_.allow(welcome.lossy_pixels);
    dealer_.allow_measured(welcome.sort_last_measured);
    if (moved) nodes_.forget_all();
    for (const TileInfo& tile : welcome.tiles) nodes_.at(tile.node);  // also those that are not up
    nodes_.forget_others(welcome);
    for (const NodeInfo& info : welcome.nodes) {
        const bool same = goes_on && nodes_.goes_on(info);
        if (!same) nodes_.connect(info);
        anew = anew || !same;
    }
    if (anew) surfaces_.ask_to_redraw();
    if (!moved) return;
    surfaces_.place_anew();
    want_window_contents();
}

void ClientSession::take_events() {
    auto events = control_->take_events();
    moving_ = moving_ || events.asked_to_move;
    if (events.reconnected) adopt(*events.reconnected, events.moved);
    for (const NodeInfo& info : events.node_changes) {
        if (group_ && info.up) continue;  // comes with a placement
        if (nodes_.goes_on(info)) continue;
        nodes_.connect(info);
        surfaces_.place_off_wall();
    }
    nodes_.keep_connected();
    for (const Placement& placement : events.placements) surfaces_.take(placement);
    surfaces_.adopt_placements();
    if (moving_ && !surfaces_.in_frame()) leave_wall();
}

/// For another one, which has taken the program.
void ClientSession::leave_wall() {
    moving_ = false;
    drawn_.end_all();
    keep_drawn(nodes_);
    for (const auto& [id, surface] : open_surfaces_) windows_.keep(*surface);
    if (control_->go()) return take_events();
    nodes_.kept().clear();
    windows_.forget_all();
}

/// Nodes have come to frames that are drawn over earlier ones.
void ClientSession::want_window_contents() {
    for (const auto& [id, surface] : open_surfaces_) surface->content_wanted = true;
}

// ---- surfaces ----

void ClientSession::open_surface(ClientSurface& surface) {
    std::lock_guard lock(mutex_);
    if (surface.opened) return;
    surfaces_.open(surface);
    if (!surfaces_.common(surface)) return;
    control_->begin_frame(surface.id, surface.frame + 1);
    take_events();
    surfaces_.begin_frame(surface);
}

void ClientSession::close_surface(ClientSurface& surface) {
    std::lock_guard lock(mutex_);
    snapping_.forget(surface.id);
    if (surface.opened) surfaces_.close(surface);
}

void ClientSession::begin_frame(ClientSurface& surface) {
    std::unique_lock lock(mutex_);
    // The lock stays held, as in adopt_agreed().
    if (surfaces_.common(surface)) control_->begin_frame(surface.id, surface.frame + 1);
    take_events();
    nodes_.wait_for_attempts(lock, kTakeUpLimit);
    if (!surface.drawn && nodes_.begin_recordings_again()) want_window_contents();
    surfaces_.begin_frame(surface);
    snapping_.begin_frame(surface);
}

std::vector<geom::View> ClientSession::views_of(const DrawTarget& target) {
    std::lock_guard lock(mutex_);
    std::vector<geom::View> out;
    for (const geom::EyeView& view : target.offered_views())
        if (view.elsewhere) out.push_back(*view.elsewhere);
    return out;
}

bool ClientSession::is_seen_elsewhere(const DrawTarget& target) {
    std::lock_guard lock(mutex_);
    return !target.offered_views().empty();
}

bool ClientSession::may_be_read(const TargetLayer& layer) {
    std::lock_guard lock(mutex_);
    return !nodes_[layer].records();
}

Wholeness ClientSession::wholeness(const ClientSurface& surface) {
    std::lock_guard lock(mutex_);
    return surfaces_.wholeness(surface);
}

bool ClientSession::everywhere(const ClientSurface& surface) {
    std::lock_guard lock(mutex_);
    return surfaces_.everywhere(surface);
}

void ClientSession::draw_whole(ClientSurface& surface) {
    packing([&] {
        dealer_.compose(surface);
        surfaces_.draw_whole(surface);
    });
}

void ClientSession::swap(ContextId context, ClientSurface& surface) {
    bool whole_frames = false;
    {
        std::lock_guard lock(mutex_);
        whole_frames = std::exchange(surface.cleared, false);
        const DrawTarget target(surface);
        windows_.bring(target);
        windows_.forget(surface.id);
        snapping_.settle();
        dealer_.compose(surface);
        dealer_.finish_frame(surface);
        hidden_.finish_frame(surface);
        ++surface.frame;
        surface.drawn = false;
        for (const NodeIndex index : swap_nodes(surface)) {
            Node& node = nodes_[index];
            if (!target.goes_to(node)) continue;
            auto& buffer = nodes_.batch(node, context ? context : node.batch_context);
            target.describe_to(node);
            glapi::pack::Swap(buffer, surface.id, surface.frame);
            nodes_.send(node);
            node.stream->expect_swap(surface.id, surface.frame);
        }
        hidden_.note_frame(surface, whole_frames);
        stats().end_frame();
    }
    const FrameWait wait{mutex_, nodes_, std::chrono::milliseconds(control_->welcome().swap_timeout_ms)};
    const auto begin = std::chrono::steady_clock::now();
    if (surfaces_.common(surface)) wait_for_group(wait, surface);
    else wait_for_nodes(wait, surface, whole_frames);
    const auto end = std::chrono::steady_clock::now();
    std::lock_guard lock(mutex_);
    waited_ += end - begin;
    dealer_.note_frame(end, waited_);
}

/// All that show the surface; in a parallel program all there are, because its members keep step on each.
std::vector<NodeIndex> ClientSession::swap_nodes(const ClientSurface& surface) {
    std::vector<NodeIndex> out;
    if (!surfaces_.common(surface))
        for (const auto& [index, slots] : nodes_touched(surface.layout.layers, std::nullopt)) out.push_back(index);
    else
        for (const auto& node : nodes_) out.push_back(node->index);
    return out;
}

// ---- commands ----

void ClientSession::submit_block(const DrawSource& source, Packer& packer, const glstate::Projection& projection) {
    packing([&] {
        const auto moved = snapping_.before_block(source, packer, projection);
        sort_scratch_->packed = snapping_.packed();
        BlockSender(followers_, source, packer, moved ? *moved : projection, *sort_scratch_).run();
    });
}

void ClientSession::before_clear(const DrawSource& source, std::uint32_t mask, bool wipes) {
    packing([&] {
        hidden_.before_clear(source, mask);
        if (wipes) windows_.before_wiping(source.draw);
    });
}

void ClientSession::before_object_changes(ClientName object) {
    packing([&] {
        hidden_.before_object_changes(object);
        drawn_.before_object_changes(object);
    });
}

void ClientSession::delete_object(ContextId context, ClientName object) {
    packing([&] { drawn_.forget(object); });
    on_every_node(context, [&](wire::PackBuffer& buffer, Node& node) {
        if (node.object_stamps.erase(object) != 0) glapi::pack::ObjectDelete(buffer, object);
        node.hollow.erase(object);
    });
    std::lock_guard lock(mutex_);
    nodes_.kept().forget(object);
}

void ClientSession::destroy_context(ContextId context) {
    std::lock_guard lock(mutex_);
    hidden_.before_context_goes(context);
    for (auto& node : nodes_) {
        if (!node->alive() || node->mirrors.erase(context) == 0) continue;
        glapi::pack::ContextDestroy(nodes_.batch(*node, context), context);
        nodes_.send(*node);
    }
}

void ClientSession::flush(const DrawTarget& target, bool wait) {
    std::vector<std::pair<std::shared_ptr<NodeStream>, RequestId>> pending;
    {
        std::lock_guard lock(mutex_);
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            if (wait && node->answers()) {
                const RequestId request = nodes_.next_request();
                glapi::pack::Sync(nodes_.batch(*node, node->batch_context), request);
                pending.emplace_back(node->stream, request);
            }
            nodes_.send(*node);
        }
        if (!pending.empty()) stats().count_round_trip("glFinish");
        // Without a back buffer there is no other end of a frame.
        if (target && target.shows_at_once()) take_events();
    }
    for (auto& [stream, request] : pending) stream->wait_reply(request, reply_timeout_ms());
}

Fence ClientSession::fence() {
    return ask_later([](wire::PackBuffer& buffer, RequestId request) { glapi::pack::Sync(buffer, request); });
}

bool ClientSession::wait_for(const Fence& fence, Fence::Clock::time_point deadline, const char* function) {
    if (fence.done()) return true;
    flush({}, false);
    stats().count_round_trip(function);
    const auto now = Fence::Clock::now();
    const auto limit = std::chrono::milliseconds(reply_timeout_ms());
    const bool patient = group_ || deadline - now <= limit;
    return fence.wait_until(patient ? deadline : now + limit) || !patient;
}

/// A member of a parallel program may have to wait for the others, however long they take.
int ClientSession::reply_timeout_ms() const { return group_ ? NodeStream::kNoLimit : kReplyTimeoutMs; }

// ---- of a parallel program ----

/// What the members have agreed on so far, then the wait until all have come.
void ClientSession::introduce(Node& node) {
    wire::PackBuffer& buffer = nodes_.batch(node, ContextId());
    for (const auto& [name, count] : sync_.barriers()) glapi::pack::BarrierCreate(buffer, name, count);
    for (const auto& [name, semaphore] : sync_.semaphores())
        glapi::pack::SemaphoreCreate(buffer, name, semaphore.count, semaphore.moved);
    glapi::pack::Join(buffer);
    nodes_.send(node);
}

GLenum ClientSession::take_semaphore(ContextId context, std::uint32_t name) {
    return packing([&] {
        const GLenum error = sync_.semaphore_p(name);
        if (error != GL_NO_ERROR || !group_) return error;
        for (const auto& [id, surface] : open_surfaces_) dealer_.compose(*surface);
        dealer_.take_semaphore(open_surfaces_, context, name);
        return error;
    });
}

/// The others go on without this process from here on.
void ClientSession::leave_group() {
    {
        std::lock_guard lock(mutex_);
        dealer_.take_held_semaphores();
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            glapi::pack::Leave(nodes_.batch(*node, node->batch_context));
            nodes_.send(*node);
        }
    }
    nodes_.drain(kLeaveLimitMs);
    control_->leave();
}

}  // namespace wall::client
