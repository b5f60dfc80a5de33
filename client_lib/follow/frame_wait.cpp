// SPDX-License-Identifier: MIT
#include "client_lib/follow/frame_wait.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "client_lib/link/pacing.h"
#include "client_lib/process/log.h"
#include "common/base/quoted.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLookMs = 20;  // at one node, while none has drawn a frame

struct Waited {
    Node& node;
    std::shared_ptr<NodeStream> stream;
    NodeProgress progress;
};

/// When the first of those that have drawn its frame in time did, unless it was one that is left out.
std::optional<Clock::time_point> first_done(std::span<const Waited> waited, SurfaceId surface) {
    std::optional<Clock::time_point> first;
    for (const auto& [node, stream, progress] : waited)
        if (progress.done && !progress.left_out && !node.records())
            if (const auto at = stream->last_swap(surface); at && (!first || *at < *first)) first = at;
    return first;
}

/// For those that have not drawn their frame. No longer than a look at one that was late before.
void wait_until(Clock::time_point deadline, std::span<Waited> waited, SurfaceId surface, bool all_slow) {
    for (auto& [node, stream, progress] : waited) {
        if (progress.done) continue;
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        const bool patient = (all_slow || !node.slow) && left > 0;
        progress.done = stream->wait_swap(surface, progress.frame, patient ? static_cast<int>(left) : 0);
    }
}

}  // namespace

// A node that is slow for once (a long frame of all nodes alike) is waited for; one that has stopped is left out. If
// all are late, the wall holds the frames or has stopped as a whole: then the program goes at the limit's pace. They
// are let go on one after the other, or reached again over one link after the other: a node is late if it comes that
// long after another one, and not because the wait happened to end between the two.
void wait_for_nodes(const FrameWait& wait, ClientSurface& surface, bool whole_frames) {
    if (surface.frame < kFramesInFlight) return;
    std::vector<Waited> waited;
    bool all_slow = true;
    {
        std::lock_guard lock(wait.mutex);
        for (const auto& [index, slots] : nodes_touched(surface.layout.layers, std::nullopt)) {
            Node& node = wait.nodes[index];
            if (!node.alive()) continue;
            const auto left = node.left_out.find(surface.id);
            const bool left_out = left != node.left_out.end();
            waited.push_back(
                {node,
                 node.stream,
                 {.frame = left_out ? left->second : surface.frame - (kFramesInFlight - 1), .left_out = left_out}});
            all_slow = all_slow && (node.slow || node.records());  // who records is never late
        }
    }
    const auto deadline = Clock::now() + wait.limit;
    wait_until(deadline, waited, surface.id, all_slow);
    if (const auto first = first_done(waited, surface.id); first && *first + wait.limit > deadline)
        wait_until(*first + wait.limit, waited, surface.id, all_slow);
    std::vector<NodeProgress> progress;
    for (Waited& w : waited) {
        w.progress.queued_bytes = w.stream->queued_bytes();
        if (!w.node.records()) progress.push_back(w.progress);
    }
    const std::uint32_t newest = newest_done(progress);
    std::lock_guard lock(wait.mutex);
    for (const auto& [node, stream, its] : waited) {
        if (node.stream != stream) continue;  // another incarnation meanwhile
        node.slow = !its.done;
        if (!leave_out(its, newest, whole_frames)) node.left_out.erase(surface.id);
        else node.left_out.try_emplace(surface.id, surface.frame);
    }
}

// As long as no node has drawn the frame, a member of the group may be late: however long that takes, it is waited for.
// A node that is late with what others have drawn is not; what is queued for it has a limit.
void wait_for_group(const FrameWait& wait, const ClientSurface& surface) {
    if (surface.frame < kFramesInFlight) return;
    const std::uint32_t frame = surface.frame - (kFramesInFlight - 1);
    std::vector<std::pair<Node*, std::shared_ptr<NodeStream>>> waited;
    {
        std::lock_guard lock(wait.mutex);
        for (auto& node : wait.nodes)
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
    const auto deadline = Clock::now() + wait.limit;
    for (const auto& w : waited) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        const bool done = drawn(w, w.first->slow || left <= 0 ? 0 : static_cast<int>(left));
        std::lock_guard lock(wait.mutex);
        w.first->slow = !done;
        if (done || w.second->queued_bytes() <= kMaxLateBytes || w.first->stream != w.second) continue;
        w.second->give_up("too late with a parallel program's frames");
        log(LogLevel::warn, "event=node_given_up node=%u why=%s", w.first->index.value,
            in_quotes(w.second->failure()).c_str());
        w.first->stream.reset();
    }
}

}  // namespace wall::client
