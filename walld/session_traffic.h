// SPDX-License-Identifier: MIT
// What a program says it has sent to the nodes, about once a second, and how fast it does. Pure; times are parameters.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "proto/control.pb.h"

namespace wall::walld {

/// Bytes of commands, by what they are for.
struct SentBytes {
    std::uint64_t state = 0, object = 0, geometry = 0;
    std::uint64_t all() const { return state + object + geometry; }
    SentBytes& operator+=(const SentBytes& other);
    bool operator==(const SentBytes&) const = default;
};

class SessionTraffic {
public:
    using Clock = std::chrono::steady_clock;

    /// Between the last two reports.
    struct Rates {
        double state = 0, object = 0, geometry = 0;  ///< bytes a second
        double frame_bytes = 0;                      ///< of a frame, the mean
    };

    /// `nodes`: how many the wall has; what is said of others is passed over.
    void note(const proto::ClientStats& report, std::size_t nodes, Clock::time_point now);

    const std::map<std::uint32_t, SentBytes>& by_node() const { return by_node_; }
    const SentBytes& sent() const { return sent_; }  ///< to all nodes
    std::uint64_t frames() const { return frames_; }
    std::uint64_t round_trips() const { return round_trips_; }
    double diff_seconds() const { return diff_seconds_; }
    const Rates& rates() const { return rates_; }

private:
    std::map<std::uint32_t, SentBytes> by_node_;
    SentBytes sent_;
    std::uint64_t frames_ = 0, round_trips_ = 0;
    double diff_seconds_ = 0;
    Rates rates_;
    std::optional<Clock::time_point> noted_;
};

}  // namespace wall::walld
