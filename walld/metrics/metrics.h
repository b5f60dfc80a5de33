// SPDX-License-Identifier: MIT
// /metrics: the wall as Prometheus reads it (docs/operation.md, "Metrics"). Every answer is made anew from what walld
// knows, so that what has ended has no series. A node's and a program's own counters are passed on as they are told:
// they begin at 0 with the process. Pure but for WallMetrics; one thread.
#pragma once

#include <prometheus/collectable.h>

#include <string>
#include <vector>

#include "walld/metrics/metric_table.h"
#include "walld/metrics/process_figures.h"
#include "walld/streams/stream_hub.h"
#include "walld/wall/wall.h"

namespace wall::walld {

/// What the metrics are made of.
struct Observed {
    const Wall& wall;
    std::vector<StreamView> streams;
    StreamHub::Counters hub;
    std::size_t viewers = 0;
    ProcessFigures process;
    double started = 0;  ///< walld, in seconds since 1970
    std::string version;
    Clock::time_point now;
};

Families metric_families(const Observed& observed);

// The parts of it.
void add_wall_metrics(Families& out, const Observed& observed);
void add_node_metrics(Families& out, const Observed& observed);
void add_session_metrics(Families& out, const Observed& observed);
void add_surface_metrics(Families& out, const Observed& observed);
void add_stream_metrics(Families& out, const Observed& observed);

/// Programs name themselves; Prometheus takes UTF-8 only.
std::string label_text(const std::string& text);

class WallMetrics final : public prometheus::Collectable {
public:
    /// Made when walld starts.
    WallMetrics(const Wall& wall, const StreamHub& streams, std::string version);
    std::vector<prometheus::MetricFamily> Collect() const override;
    /// All metrics in Prometheus' text format 0.0.4.
    std::string text() const;

private:
    const Wall& wall_;
    const StreamHub& streams_;
    std::string version_;
    std::chrono::system_clock::time_point started_;
};

}  // namespace wall::walld
