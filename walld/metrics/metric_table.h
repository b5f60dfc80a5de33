// SPDX-License-Identifier: MIT
// Metrics as tables: a row is a metric's name, its help and how to read it off one subject (a node, a session, ...).
// Pure.
#pragma once

#include <prometheus/metric_family.h>

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace wall::walld {

using Families = std::vector<prometheus::MetricFamily>;
using Labels = std::vector<prometheus::ClientMetric::Label>;

/// Prometheus' unit.
inline double seconds(std::uint64_t nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }

/// How a figure is read off a subject: a lambda without captures that returns any number, or a function.
template <class Subject>
class Reading {
public:
    template <class Read>
    requires std::is_empty_v<Read>
    constexpr Reading(Read) : read_([](const Subject& subject) { return static_cast<double>(Read{}(subject)); }) {}
    constexpr Reading(double (*read)(const Subject&)) : read_(read) {}
    double operator()(const Subject& subject) const { return read_(subject); }

private:
    double (*read_)(const Subject&);
};

/// One series for each subject.
template <class Subject>
struct MetricRow {
    prometheus::MetricType type;  ///< Counter or Gauge
    const char* name;
    const char* help;
    Reading<Subject> value;
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
