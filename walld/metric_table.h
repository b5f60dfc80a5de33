// SPDX-License-Identifier: MIT
// Metrics as tables: a row is a metric's name, its help and how to read it off one subject (a node, a session, ...).
// Pure.
#pragma once

#include <prometheus/metric_family.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace wall::walld {

using Families = std::vector<prometheus::MetricFamily>;
using Labels = std::vector<prometheus::ClientMetric::Label>;

/// One series for each subject.
template <class Subject>
struct MetricRow {
    prometheus::MetricType type;  ///< Counter or Gauge
    const char* name;
    const char* help;
    double (*value)(const Subject&);
};

/// What the series of one subject are told apart by.
template <class Subject>
struct Labelled {
    Labels labels;
    Subject subject;
};

/// A family for each row, with a series for each subject; Prometheus wants the series of a family together.
template <class Subject, std::size_t kRows>
void add_table(Families& out, const MetricRow<Subject> (&rows)[kRows], const std::vector<Labelled<Subject>>& subjects) {
    for (const auto& row : rows) {
        auto& family = out.emplace_back(prometheus::MetricFamily{row.name, row.help, row.type, {}});
        for (const auto& [labels, subject] : subjects) {
            auto& series = family.metric.emplace_back();
            series.label = labels;
            (row.type == prometheus::MetricType::Counter ? series.counter.value : series.gauge.value) =
                row.value(subject);
        }
    }
}

}  // namespace wall::walld
