// SPDX-License-Identifier: MIT
// What is different when the process is one of a parallel program: its members do everything that concerns the common
// windows at the same frame, on the same nodes, without asking each other.
#include <algorithm>
#include <chrono>

#include "client_lib/context/context.h"
#include "client_lib/follow/session.h"
#include "client_lib/link/pacing.h"
#include "client_lib/process/log.h"

namespace wall::client {
namespace {

constexpr int kLookMs = 20;  // at one node, while none has drawn a frame

}  // namespace

/// What the members have agreed on so far, then the wait until all have come.
void ClientSession::introduce(Node& node) {
    wire::PackBuffer& buffer = batch(node, ContextId());
    for (const auto& [name, count] : sync_.barriers()) glapi::pack::BarrierCreate(buffer, name, count);
    for (const auto& [name, semaphore] : sync_.semaphores())
        glapi::pack::SemaphoreCreate(buffer, name, semaphore.count, semaphore.moved);
    glapi::pack::Join(buffer);
    send(node);
}

void ClientSession::adopt_agreed(ClientSurface& surface) {
    auto& coming = surface.coming;
    while (!coming.empty() && coming.front().from_frame <= surface.frame + 1) {
        const Placement placement = std::move(coming.front());
        coming.pop_front();
        for (const NodeInfo& info : placement.nodes) use_node(info);
        const bool moved = placement.rect != surface.layout.rect;
        surface.layout.width = placement.width;
        surface.layout.height = placement.height;
        apply_layout(surface, placement);
        surface.layout.version = placement.layout_version;
        if (moved && surface.frame > 0) control_->ask_to_redraw(surface.id);
    }
    if (!coming.empty())
        control_->ask_to_redraw(surface.id);  // a program that draws only when asked comes to that frame, too
}

/// A node that is connected stays as it is: the others have it like that, too.
void ClientSession::use_node(const NodeInfo& info) {
    const bool known = info.node.value < nodes_.size() && node_of(info.node).alive() &&
                       node_of(info.node).info.incarnation == info.incarnation;
    if (known) return;
    Node& node = node_slot(info);
    connect(node);
    if (!node.attempt) return;
    node.attempt->wait_until(std::chrono::steady_clock::time_point::max());
    take_attempt(node);
}

/// The window is as large as rank 0 has it.
void ClientSession::report_window(ClientSurface& surface) {
    const auto size = surface.options.query_size ? surface.options.query_size() : std::nullopt;
    if (group_->rank != 0 || !size || !size->width || !size->height ||
        (size->width == surface.window.width && size->height == surface.window.height))
        return;
    surface.window = *size;
    control_->surface_resize(surface.id, size->width, size->height);
}

// As long as no node has drawn the frame, a member of the group may be late: however long that takes, it is waited for.
// A node that is late with what others have drawn is not; what is queued for it has a limit.
void ClientSession::wait_for_group(ClientSurface& surface) {
    if (surface.frame < kFramesInFlight) return;
    const std::uint32_t frame = surface.frame - (kFramesInFlight - 1);
    std::vector<std::pair<Node*, std::shared_ptr<NodeStream>>> waited;
    {
        std::lock_guard lock(mutex_);
        for (auto& node : nodes_)
            if (node->alive()) waited.emplace_back(node.get(), node->stream);
        std::ranges::stable_sort(waited, {}, [](const auto& w) { return w.first->slow; });
    }
    const auto drawn = [&](const auto& w, int timeout_ms) {
        return w.second->wait_swap(surface.id, frame, timeout_ms);
    };
    const auto some_drawn = [&] {
        return std::ranges::any_of(waited, [&](const auto& w) { return drawn(w, kLookMs); });
    };
    const auto all_failed = [&] {
        return std::ranges::all_of(waited, [](const auto& w) { return w.second->failed(); });
    };
    while (!some_drawn() && !all_failed()) continue;
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(control_->welcome().swap_timeout_ms);
    for (const auto& w : waited) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
        const bool done = drawn(w, w.first->slow || left <= 0 ? 0 : static_cast<int>(left));
        std::lock_guard lock(mutex_);
        w.first->slow = !done;
        if (done || w.second->queued_bytes() <= kMaxLateBytes || w.first->stream != w.second) continue;
        w.second->give_up("too late with a parallel program's frames");
        log_warning("event=node_given_up node=" + std::to_string(w.first->index.value) + " why=\"" +
                    w.second->failure() + "\"");
        w.first->stream.reset();
    }
}

/// The others go on without this process from here on.
void ClientSession::leave_group() {
    {
        std::lock_guard lock(mutex_);
        for (auto& node : nodes_) {
            if (!node->alive()) continue;
            glapi::pack::Leave(batch(*node, node->batch_context));
            send(*node);
        }
    }
    transport_.drain(kLeaveLimitMs);
    control_->leave();
}

}  // namespace wall::client
