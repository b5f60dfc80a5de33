// SPDX-License-Identifier: MIT
// Metrics of programs and their windows.
#include <spdlog/fmt/fmt.h>

#include "walld/metrics/metrics.h"
#include "walld/wall/session_stats.h"

namespace wall::walld {
namespace {

using enum prometheus::MetricType;
using SessionRef = const SessionEntry*;
using OnNode = proto::SessionStats;
using SurfaceRef = const SurfaceEntry*;
using Age = double;  // seconds
using Bytes = std::uint64_t;

double bytes_of(const Bytes& bytes) { return static_cast<double>(bytes); }

constexpr MetricRow<SessionRef> kSessionInfo[] = {
    {Gauge, "wallgl_session_info", "Always 1; which program it is and whose.", [](const SessionRef&) { return 1.0; }},
};
constexpr MetricRow<SessionRef> kSessions[] = {
    {Gauge, "wallgl_session_fault", "1 if a node gave up on the program's stream, else 0.",
     [](const SessionRef& s) { return s->fault.empty() ? 0.0 : 1.0; }},
    {Gauge, "wallgl_session_held", "1 while frames are shown only when stepped, else 0.",
     [](const SessionRef& s) { return s->held ? 1.0 : 0.0; }},
    {Counter, "wallgl_session_frames_total", "Frames that the program has ended.",
     [](const SessionRef& s) { return s->traffic.frames(); }},
    {Counter, "wallgl_session_round_trips_total", "Times that the program waited for an answer of a node.",
     [](const SessionRef& s) { return s->traffic.round_trips(); }},
    {Counter, "wallgl_session_lossy_vertices_total", "Vertices that were sent a little off, as the wall allows.",
     [](const SessionRef& s) { return s->traffic.lossy_vertices(); }},
    {Counter, "wallgl_session_diff_seconds_total",
     "Time of the program in comparing contexts with what nodes hold; an estimate from samples.",
     [](const SessionRef& s) { return s->traffic.diff_seconds(); }},
};
constexpr MetricRow<Bytes> kSent[] = {
    {Counter, "wallgl_session_sent_bytes_total",
     "Bytes of commands that the program has packed for the node, by what they are for.", bytes_of},
};
constexpr MetricRow<Bytes> kLinks[] = {
    {Counter, "wallgl_session_link_bytes_total",
     "Bytes that the program has sent to the node for these, coded where its link asks for it.", bytes_of},
};
constexpr MetricRow<Bytes> kReceived[] = {
    {Counter, "wallgl_session_received_bytes_total",
     "Bytes of commands that the node has executed for the program, by what they are for; object: all that is neither "
     "state nor geometry.",
     bytes_of},
};
constexpr MetricRow<OnNode> kOnNodes[] = {
    {Counter, "wallgl_session_rendered_frames_total", "Frames of the program that the node has drawn.",
     [](const OnNode& s) { return s.frames(); }},
    {Counter, "wallgl_session_commands_total", "Commands that the node has executed for the program.",
     [](const OnNode& s) { return s.commands(); }},
    {Counter, "wallgl_session_gl_errors_total", "OpenGL errors of the node's driver in the program's commands.",
     [](const OnNode& s) { return s.gl_errors(); }},
    {Counter, "wallgl_session_context_switches_total",
     "Blocks of the program that found another context in the node's driver.",
     [](const OnNode& s) { return s.context_switches(); }},
    {Counter, "wallgl_session_decode_seconds_total",
     "Time of the node's render thread in taking the program's batches apart and calling the driver.",
     [](const OnNode& s) { return seconds(s.decode_ns()); }},
    {Counter, "wallgl_session_render_seconds_total",
     "Time of the node's render thread in waiting for the driver to end the program's frames and answers.",
     [](const OnNode& s) { return seconds(s.render_ns()); }},
    {Counter, "wallgl_session_partial_bytes_total",
     "Bytes of pictures that the node has drawn for the tiles of others, of a program whose geometry is dealt to "
     "nodes.",
     [](const OnNode& s) { return s.partial_bytes(); }},
    {Counter, "wallgl_session_partials_merged_total",
     "Pictures of other nodes that the node has merged into its tiles.",
     [](const OnNode& s) { return s.partials_merged(); }},
    {Counter, "wallgl_session_partials_missed_total", "Pictures of other nodes that did not come within five seconds.",
     [](const OnNode& s) { return s.partials_missed(); }},
    {Gauge, "wallgl_session_queue_bytes",
     "Bytes that the node has received from the program and not executed yet; at 64 MiB the program waits.",
     [](const OnNode& s) { return s.queued_bytes(); }},
    {Gauge, "wallgl_session_memory_bytes",
     "Bytes of the node's driver that the program's objects take, by estimate; [quota] may limit them.",
     [](const OnNode& s) { return s.memory_bytes(); }},
    {Gauge, "wallgl_session_objects", "Objects that the program has on the node.",
     [](const OnNode& s) { return s.objects(); }},
};
constexpr MetricRow<SurfaceRef> kSurfaces[] = {
    {Counter, "wallgl_surface_presented_frames_total", "Number of the window's last frame that the wall shows.",
     [](const SurfaceRef& s) { return s->swap.presented(); }},
    {Counter, "wallgl_surface_swap_timeouts_total", "Frames of the window that did not wait for a slow node.",
     [](const SurfaceRef& s) { return s->swap.timeouts(); }},
    {Gauge, "wallgl_surface_frame_interval_seconds",
     "Time from one shown frame of the window to the next, the mean of about the last 16.",
     [](const SurfaceRef& s) { return 1e-3 * s->swap.frame_interval().count(); }},
};

constexpr MetricRow<Age> kAges[] = {
    {Gauge, "wallgl_surface_frame_age_seconds", "Time since the window's last frame was shown.",
     [](const Age& age) { return age; }},
};

template <class Add>
void by_kind(const Labels& labels, Bytes state, Bytes object, Bytes geometry, Add&& add) {
    const std::pair<const char*, Bytes> kinds[] = {{"state", state}, {"object", object}, {"geometry", geometry}};
    for (const auto& [kind, bytes] : kinds) {
        auto with_kind = labels;
        with_kind.push_back({"kind", kind});
        add(std::move(with_kind), bytes);
    }
}

/// What each node that is up says of the programs that are still here.
std::vector<Labelled<OnNode>> on_nodes(const Wall& wall) {
    std::vector<Labelled<OnNode>> out;
    for (const auto& node : wall.nodes()) {
        if (!node.up) continue;
        for (auto& [id, stats] : stats_by_session(node.stats))
            if (wall.sessions().contains(id))
                out.push_back({{{"session", std::to_string(id.value)}, {"node", node.config->name}}, stats});
    }
    return out;
}

std::vector<Labelled<Bytes>> sent(const Wall& wall) {
    std::vector<Labelled<Bytes>> out;
    for (const auto& [id, session] : wall.sessions())
        for (const auto& [node, bytes] : session.traffic.by_node())
            by_kind({{"session", std::to_string(id.value)}, {"node", wall.nodes()[node].config->name}}, bytes.state,
                    bytes.object, bytes.geometry, [&](Labels labels, Bytes n) {
                        out.push_back({std::move(labels), n});
                    });
    return out;
}

std::vector<Labelled<Bytes>> on_links(const Wall& wall) {
    std::vector<Labelled<Bytes>> out;
    for (const auto& [id, session] : wall.sessions())
        for (const auto& [node, bytes] : session.traffic.by_node())
            out.push_back(
                {{{"session", std::to_string(id.value)}, {"node", wall.nodes()[node].config->name}}, bytes.link});
    return out;
}

Labels surface_labels(const SurfaceKey& key) {
    return {{"session", std::to_string(key.session.value)},
            {"surface", fmt::format("{}.{}", key.session.value, key.surface.value)}};
}

prometheus::ClientMetric::Histogram histogram(const Spread& spread) {
    prometheus::ClientMetric::Histogram out{spread.frames(), 1e-3 * spread.sum().count(), {}};
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < Spread::kBoundsMs.size(); ++i)
        out.bucket.push_back({below += spread.histogram()[i], 1e-3 * Spread::kBoundsMs[i]});
    return out;
}

void add_skew(Families& out, const Wall& wall, const char* name, const char* help,
              const Spread& (SwapCoordinator::*spread)() const) {
    auto& family = out.emplace_back(prometheus::MetricFamily{name, help, Histogram, {}});
    for (const auto& key : wall.stacking()) {
        auto& series = family.metric.emplace_back();
        series.label = surface_labels(key);
        series.histogram = histogram((wall.find(key)->swap.*spread)());
    }
}

}  // namespace

void add_session_metrics(Families& out, const Observed& observed) {
    std::vector<Labelled<SessionRef>> sessions, info;
    for (const auto& [id, session] : observed.wall.sessions()) {
        sessions.push_back({{{"session", std::to_string(id.value)}}, &session});
        info.push_back({{{"session", std::to_string(id.value)},
                         {"program", label_text(session.program)},
                         {"name", label_text(session.name)},
                         {"owner", label_text(session.owner.name)}},
                        &session});
    }
    const auto working = on_nodes(observed.wall);
    std::vector<Labelled<Bytes>> received;
    for (const auto& [labels, stats] : working)
        by_kind(labels, stats.state_bytes(), stats.object_bytes(), stats.geometry_bytes(),
                [&](Labels with_kind, Bytes n) {
                    received.push_back({std::move(with_kind), n});
                });
    add_table(out, kSessionInfo, info);
    add_table(out, kSessions, sessions);
    add_table(out, kSent, sent(observed.wall));
    add_table(out, kLinks, on_links(observed.wall));
    add_table(out, kReceived, received);
    add_table(out, kOnNodes, working);
}

void add_surface_metrics(Families& out, const Observed& observed) {
    std::vector<Labelled<SurfaceRef>> surfaces;
    std::vector<Labelled<Age>> shown;
    for (const auto& key : observed.wall.stacking()) {
        const auto* surface = observed.wall.find(key);
        surfaces.push_back({surface_labels(key), surface});
        if (const auto last = surface->swap.last_present())
            shown.push_back({surface_labels(key), std::chrono::duration<double>(observed.now - *last).count()});
    }
    add_table(out, kSurfaces, surfaces);
    add_table(out, kAges, shown);
    add_skew(out, observed.wall, "wallgl_surface_rendered_skew_seconds",
             "Time from the first node's report of a frame of the window to the last one's.",
             &SwapCoordinator::rendered_spread);
    add_skew(out, observed.wall, "wallgl_surface_presented_skew_seconds",
             "Time from telling the first node to show a frame of the window to telling the last.",
             &SwapCoordinator::presented_spread);
}

}  // namespace wall::walld
