// SPDX-License-Identifier: MIT
// What a program says it has sent to the nodes, about once a second, and how fast it does. Pure; times are parameters.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "common/base/ids.h"
#include "proto/control.pb.h"

namespace wall::walld {

/// Bytes of commands, by what they are for, and how many went out over the links for all of them.
struct SentBytes {
    std::uint64_t state = 0, object = 0, geometry = 0, link = 0;
    std::uint64_t all() const { return state + object + geometry; }
    SentBytes& operator+=(const SentBytes& other);
    bool operator==(const SentBytes&) const = default;
};

class SessionTraffic {
public:
    using Clock = std::chrono::steady_clock;

    /// The rates between the last two reports.
    struct Rates {
        double state = 0, object = 0, geometry = 0, link = 0;  ///< bytes a second
        double frame_bytes = 0;                                ///< of a frame, the mean
    };

    /// `rank`: of the process in a parallel program; each tells its own. `nodes`: how many the wall has; what is said
    /// of others is passed over.
    void note(std::uint32_t rank, const proto::ClientStats& report, std::size_t nodes, Clock::time_point now);

    // The sums over all processes, which count the same frames.
    std::map<NodeIndex, SentBytes> by_node() const;
    SentBytes sent() const;  ///< to all nodes
    std::uint64_t frames() const;
    std::uint64_t round_trips() const;
    std::uint64_t lossy_vertices() const;
    double diff_seconds() const;
    Rates rates() const;

private:
    struct Process {
        std::map<NodeIndex, SentBytes> by_node;
        SentBytes sent;
        std::uint64_t frames = 0, round_trips = 0, lossy_vertices = 0;
        double diff_seconds = 0;
        Rates rates;
        std::optional<Clock::time_point> noted;
    };
    std::map<std::uint32_t, Process> processes_;
};

}  // namespace wall::walld
