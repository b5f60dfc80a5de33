// SPDX-License-Identifier: MIT
#include "walld/metrics/metrics.h"

#include <prometheus/text_serializer.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/json/parse_json.h"

namespace wall::walld {
namespace {

using enum prometheus::MetricType;

constexpr MetricRow<const Observed*> kWallRows[] = {
    {Gauge, "wallgl_sessions", "Programs on the wall.",
     [](const Observed* const& o) { return o->wall.sessions().size(); }},
    {Gauge, "wallgl_sessions_limit", "Programs that may be on the wall at once.",
     [](const Observed* const& o) { return o->wall.config().max_sessions; }},
    {Gauge, "wallgl_surfaces", "Windows on the wall.",
     [](const Observed* const& o) { return o->wall.stacking().size(); }},
    {Counter, "wallgl_sessions_opened_total", "Programs that have come since walld started.",
     [](const Observed* const& o) { return o->wall.counters().sessions; }},
    {Counter, "wallgl_session_faults_total", "Programs' streams that a node gave up on since walld started.",
     [](const Observed* const& o) { return o->wall.counters().faults; }},
    {Counter, "wallgl_presents_total", "Times that a node was told to show a frame of a window.",
     [](const Observed* const& o) { return o->wall.counters().presents; }},
    {Gauge, "process_start_time_seconds", "When walld started, in seconds since 1970.",
     [](const Observed* const& o) { return o->started; }},
    {Counter, "process_cpu_seconds_total", "CPU time of walld.",
     [](const Observed* const& o) { return o->process.cpu_seconds; }},
    {Gauge, "process_resident_memory_bytes", "Resident memory of walld.",
     [](const Observed* const& o) { return o->process.resident_bytes; }},
    {Gauge, "process_open_fds", "Open file descriptors of walld.",
     [](const Observed* const& o) { return o->process.open_files; }},
};

double one(const bool&) { return 1; }
constexpr MetricRow<bool> kBuildRow[] = {{Gauge, "wallgl_build_info", "Always 1; the version of walld.", one}};
constexpr MetricRow<bool> kWallInfoRow[] = {
    {Gauge, "wallgl_wall_info", "Always 1; the wall's name and the canvas in pixels.", one}};
constexpr MetricRow<std::ptrdiff_t> kNodesRow[] = {{Gauge, "wallgl_nodes", "Nodes of the wall by state.",
                                                    [](const std::ptrdiff_t& n) { return static_cast<double>(n); }}};

}  // namespace

std::string label_text(const std::string& text) {
    const auto replaced = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const auto text_again = parse_json(replaced, kAnswerJson);
    return text_again ? text_again->get<std::string>() : std::string();
}

void add_wall_metrics(Families& out, const Observed& observed) {
    const auto& wall = observed.wall;
    const auto canvas = wall.config().canvas();
    add_table(out, kBuildRow, {{{{"version", observed.version}}, true}});
    add_table(out, kWallInfoRow,
              {{{{"wall", label_text(wall.config().name)},
                 {"width", std::to_string(canvas.width)},
                 {"height", std::to_string(canvas.height)}},
                true}});
    add_table(out, kWallRows, {{{}, &observed}});
    const auto up = std::ranges::count_if(wall.nodes(), &Node::up);
    add_table(out, kNodesRow, {{{{"state", "up"}}, up}, {{{"state", "away"}}, std::ssize(wall.nodes()) - up}});
}

Families metric_families(const Observed& observed) {
    Families out;
    for (const auto add :
         {add_wall_metrics, add_node_metrics, add_session_metrics, add_surface_metrics, add_stream_metrics})
        add(out, observed);
    return out;
}

WallMetrics::WallMetrics(const Wall& wall, const StreamHub& streams, std::string version)
    : wall_(wall), streams_(streams), version_(std::move(version)), started_(std::chrono::system_clock::now()) {}

std::vector<prometheus::MetricFamily> WallMetrics::Collect() const {
    const double started = std::chrono::duration<double>(started_.time_since_epoch()).count();
    return metric_families({wall_, streams_.views(), streams_.counters(), streams_.viewers(), ProcessFigures::now(),
                            started, version_, Clock::now()});
}

std::string WallMetrics::text() const { return prometheus::TextSerializer().Serialize(Collect()); }

}  // namespace wall::walld
