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
// A surface that moves changes the group at a frame: nodes that it leaves take part up to the frame before, nodes that
// it comes to from that frame on.
//
// held: nothing beyond `allowed` is presented, and no limit runs; step() raises it (for tests that look at each frame).
// A node that was left out of the frame that is held, and has drawn a later one since, can show nothing before that
// one: then the group goes on to it, so that what is held is one picture.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/base/ids.h"
#include "walld/wall/spread.h"

namespace wall::walld {

using Clock = std::chrono::steady_clock;

struct PresentTo {
    NodeIndex node;
    std::uint32_t frame = 0;
    bool operator==(const PresentTo&) const = default;
};
using Presents = std::vector<PresentTo>;

class SwapCoordinator {
public:
    SwapCoordinator(Clock::duration limit, bool held) : limit_(limit), held_(held) {}

    /// The live nodes that show the surface now; those that it is leaving stay until they have.
    Presents set_nodes(const std::set<NodeIndex>& nodes, Clock::time_point now);
    /// From `frame` on the surface lies on these nodes.
    Presents move(const std::set<NodeIndex>& nodes, std::uint32_t frame, Clock::time_point now);
    /// A node is dead.
    Presents lose(NodeIndex node, Clock::time_point now);
    /// A node has rendered `frame`; those between it and the one before it were not sent to it. Reports of other nodes
    /// are ignored.
    Presents rendered(NodeIndex node, std::uint32_t frame, Clock::time_point now);
    /// A node that was not told what to show, or was told by somebody else, shows `shown` and has rendered `frame`.
    Presents resume(NodeIndex node, std::uint32_t frame, std::uint32_t shown, Clock::time_point now);
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
    /// Nothing before the first frame.
    std::optional<Clock::time_point> last_present() const { return last_present_; }
    /// Presented frames that the node takes part in and was not told to show yet.
    std::uint32_t behind(NodeIndex node) const;
    bool held() const { return held_; }
    std::uint64_t timeouts() const { return timeouts_; }

    /// The time between the first node's report of a frame and the last one's.
    const Spread& rendered_spread() const { return rendered_spread_; }
    /// The time between telling the first node to show a frame and the last one; more than nothing only where a node
    /// was late.
    const Spread& presented_spread() const { return presented_spread_; }
    /// The time from one presented frame to the next, the mean of about the last 16.
    Spread::Milliseconds frame_interval() const { return interval_; }

private:
    /// The frames that a node takes part in, from the first to the last one.
    struct Stay {
        std::uint32_t from = 0, until = UINT32_MAX;
    };
    struct Member {
        std::uint32_t rendered = 0;
        std::uint32_t told = 0;  ///< last frame it was told to show
        bool waited = true;
        std::uint32_t missed_from = 0, missed_until = 0;  ///< those before `rendered` that it has not; until: excluded
        std::deque<Stay> stays{Stay{}};  ///< in order; a surface may come back before its last frame here is shown

        bool leaving() const { return stays.back().until != UINT32_MAX; }
        bool takes_part(std::uint32_t frame) const;
        /// The last frame that it does not hold back.
        std::uint32_t cap() const;
        void draw(std::uint32_t last, std::uint32_t frame);
        bool missed(std::uint32_t frame) const { return frame >= missed_from && frame < missed_until; }
        /// What it can show while the group shows `frame`.
        std::uint32_t shows(std::uint32_t frame) const;
    };
    /// It keeps the group from the next frame.
    bool blocks(const Member& member) const { return member.waited && member.cap() <= presented_; }
    Presents advance(Clock::time_point now);
    void allow_what_all_can_show();
    void forget_past();
    void count_frame(Clock::time_point now);
    void tell(Presents& out, NodeIndex node, Member& member, std::uint32_t frame, Clock::time_point now);
    std::size_t group_of(std::uint32_t frame);
    std::size_t count_group(std::uint32_t frame) const;
    std::uint32_t agreed() const;
    bool someone_ahead() const;
    std::uint32_t ceiling() const;

    Clock::duration limit_;  ///< for a late node
    std::map<NodeIndex, Member> members_;
    std::size_t blocking_ = 0;  ///< members that do, as of the last advance() or report
    struct Group {
        std::uint32_t frame = 0;
        std::size_t size = 0;  ///< 0: not known
    };
    std::array<Group, 8> groups_{};  ///< of the frames that were asked for last, since members_ was another one
    std::uint32_t presented_ = 0;
    std::optional<Clock::time_point> deadline_;
    bool held_;
    std::uint32_t allowed_ = 0;
    std::uint64_t timeouts_ = 0;
    Spread rendered_spread_, presented_spread_;
    Spread::Milliseconds interval_{};
    std::optional<Clock::time_point> last_present_;
};

}  // namespace wall::walld
