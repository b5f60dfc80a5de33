// SPDX-License-Identifier: MIT
#include "tileserver/io/node_stats.h"

namespace wall::tileserver {
namespace {

std::uint64_t nanoseconds(Work::Clock::duration time) {
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(time).count());
}

/// What the node's total and a session's figures have in common.
template <class Out>
void fill_work(const Work& work, Out& out) {
    out.set_frames(work.frames);
    out.set_commands(work.commands);
    out.set_gl_errors(work.gl_errors);
    out.set_array_elements(work.array_elements);
    out.set_context_switches(work.context_switches);
    out.set_decode_ns(nanoseconds(work.decode));
    out.set_render_ns(nanoseconds(work.render));
}

void fill_objects(const DriverObjects& objects, proto::DriverObjects& out) {
    const auto count = [](std::int64_t alive) { return static_cast<std::uint64_t>(alive); };
    out.set_textures(count(objects.textures));
    out.set_buffers(count(objects.buffers));
    out.set_lists(count(objects.lists));
    out.set_programs(count(objects.programs));
    out.set_shaders(count(objects.shaders));
    out.set_framebuffers(count(objects.framebuffers));
    out.set_renderbuffers(count(objects.renderbuffers));
    out.set_queries(count(objects.queries));
}

}  // namespace

void fill_stats(const RenderStats& stats, proto::NodeStats& out) {
    fill_work(stats.work, out);
    out.set_sessions(static_cast<std::uint32_t>(stats.sessions.size()));
    for (const auto& session : stats.sessions) {
        auto& row = *out.add_session_stats();
        row.set_session(session.session.value);
        row.set_rank(session.rank);
        fill_work(session.work, row);
        row.set_state_bytes(session.work.state_bytes);
        row.set_object_bytes(session.work.object_bytes);
        row.set_geometry_bytes(session.work.geometry_bytes);
        row.set_queued_bytes(session.queued_bytes);
        row.set_memory_bytes(session.memory_bytes);
        row.set_objects(session.objects);
        row.set_partial_bytes(session.work.partial_bytes);
        row.set_partials_merged(session.work.partials_merged);
        row.set_partials_missed(session.work.partials_missed);
        row.set_partial_ns(nanoseconds(session.work.partial));
        row.set_partial_wait_ns(nanoseconds(session.work.partial_wait));
    }
    fill_objects(stats.objects, *out.mutable_objects());
    for (const auto& [slot, time] : stats.tiles) {
        auto& row = *out.add_tile_times();
        row.set_slot(slot);
        row.set_ns(static_cast<std::uint64_t>(time.count()));
    }
}

}  // namespace wall::tileserver
