// SPDX-License-Identifier: MIT
#include "walld/wall/session_stats.h"

#include <algorithm>

namespace wall::walld {
namespace {

void add(proto::SessionStats& sum, const proto::SessionStats& more) {
    sum.set_frames(sum.frames() + more.frames());
    sum.set_commands(sum.commands() + more.commands());
    sum.set_gl_errors(sum.gl_errors() + more.gl_errors());
    sum.set_state_bytes(sum.state_bytes() + more.state_bytes());
    sum.set_object_bytes(sum.object_bytes() + more.object_bytes());
    sum.set_geometry_bytes(sum.geometry_bytes() + more.geometry_bytes());
    sum.set_context_switches(sum.context_switches() + more.context_switches());
    sum.set_decode_ns(sum.decode_ns() + more.decode_ns());
    sum.set_render_ns(sum.render_ns() + more.render_ns());
    sum.set_queued_bytes(sum.queued_bytes() + more.queued_bytes());
    sum.set_memory_bytes(sum.memory_bytes() + more.memory_bytes());
    sum.set_objects(sum.objects() + more.objects());
    sum.set_partial_bytes(sum.partial_bytes() + more.partial_bytes());
    sum.set_partials_merged(sum.partials_merged() + more.partials_merged());
    sum.set_partials_missed(sum.partials_missed() + more.partials_missed());
    sum.set_partial_ns(sum.partial_ns() + more.partial_ns());
    sum.set_partial_wait_ns(sum.partial_wait_ns() + more.partial_wait_ns());
}

}  // namespace

std::map<SessionId, proto::SessionStats> stats_by_session(const proto::NodeStats& stats) {
    std::map<std::pair<SessionId, Rank>, const proto::SessionStats*> newest;
    for (const auto& session : stats.session_stats()) newest[{SessionId(session.session()), session.rank()}] = &session;
    std::map<SessionId, proto::SessionStats> out;
    for (const auto& [process, its] : newest) add(out[process.first], *its);
    return out;
}

std::map<SessionId, HeldOnNodes> held_on_nodes(const Wall& wall) {
    constexpr double kNanosecond = 1e-9;
    std::map<SessionId, HeldOnNodes> out;
    for (const auto& node : wall.nodes()) {
        if (!node.up) continue;
        for (const auto& [session, stats] : stats_by_session(node.stats)) {
            auto& held = out[session];
            held.memory_bytes = std::max(held.memory_bytes, stats.memory_bytes());
            held.objects = std::max(held.objects, stats.objects());
            held.partials.bytes += stats.partial_bytes();
            held.partials.merged += stats.partials_merged();
            held.partials.missed += stats.partials_missed();
            held.partials.seconds += kNanosecond * static_cast<double>(stats.partial_ns());
            held.partials.wait_seconds += kNanosecond * static_cast<double>(stats.partial_wait_ns());
        }
    }
    return out;
}

}  // namespace wall::walld
