// SPDX-License-Identifier: MIT
// The swap group of one surface: frame n is shown on all its nodes at once. Nodes report `rendered(n)`; once every node
// that is waited for has, the group gets `present(n)`. A node that misses the limit is left out until it has caught up.
// Pure: events in, Presents out; the time is a parameter.
//
//               rendered(f >= presented)
//   +--------+ <-------------------------- +------+
//   | waited |                             | late |   <- a node that joins a running surface
//   +--------+ --------------------------> +------+
//        limit over, or removed
//
// held: nothing beyond `allowed` is presented, and no limit runs; step() raises it (for tests that look at each frame).
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace wall::walld {

using Clock = std::chrono::steady_clock;

struct PresentTo {
    std::uint32_t node = 0;
    std::uint32_t frame = 0;
    bool operator==(const PresentTo&) const = default;
};
using Presents = std::vector<PresentTo>;

class SwapCoordinator {
public:
    SwapCoordinator(Clock::duration limit, bool held) : limit_(limit), held_(held) {}

    /// The live nodes that show the surface now.
    Presents set_nodes(const std::set<std::uint32_t>& nodes, Clock::time_point now);
    /// A node has rendered `frame` (and all before it). Reports of other nodes are ignored.
    Presents rendered(std::uint32_t node, std::uint32_t frame, Clock::time_point now);
    Presents tick(Clock::time_point now);

    Presents hold(Clock::time_point now);
    Presents step(std::uint32_t frames, Clock::time_point now);
    /// Ends holding.
    Presents release(Clock::time_point now);

    /// When tick() is needed next.
    std::optional<Clock::time_point> deadline() const { return deadline_; }
    /// Last frame that the group was told to show; 0 = none.
    std::uint32_t presented() const { return presented_; }
    /// Every node shows `frame` or a later one.
    bool shown(std::uint32_t frame) const;
    bool held() const { return held_; }
    std::uint64_t timeouts() const { return timeouts_; }

private:
    struct Member {
        std::uint32_t rendered = 0;
        std::uint32_t told = 0;  ///< last frame it was told to show
        bool waited = true;
    };
    Presents advance(Clock::time_point now);
    std::uint32_t agreed() const;
    bool someone_ahead() const;
    std::uint32_t ceiling() const;

    Clock::duration limit_;
    std::map<std::uint32_t, Member> members_;
    std::uint32_t presented_ = 0;
    std::optional<Clock::time_point> deadline_;
    bool held_;
    std::uint32_t allowed_ = 0;
    std::uint64_t timeouts_ = 0;
};

}  // namespace wall::walld
