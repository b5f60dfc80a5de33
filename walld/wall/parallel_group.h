// SPDX-License-Identifier: MIT
// The processes of a parallel program, which are one session (docs/parallel-programs.md). Pure; times are parameters.
//
//   absent --hello--> here --leaves--> left          here --its process ends--> the session ends
//                     here --link lost--> missed --hello--> here          missed --not in time--> the session ends
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "proto/control.pb.h"
#include "walld/wall/refusal.h"

namespace wall::walld {

using Rank = std::uint32_t;  ///< of a member, from 0

class ParallelGroup {
public:
    using Clock = std::chrono::steady_clock;
    struct Member {
        std::uint32_t pid = 0;
        bool left = false;
        std::uint32_t awaited = 0;  ///< windows that it had with an earlier walld and has not announced yet
        std::optional<Clock::time_point> missed{};  ///< its link is lost, and it may come again until then
    };

    ParallelGroup(std::string name, std::uint32_t size) : name_(std::move(name)), size_(size) {}

    /// A group in itself: a name, a rank that there is, a size that there may be.
    static Outcome<void> check(const proto::Group& hello);
    /// Whether this member may come to the others. `again`: it says that it was here before.
    Outcome<void> admits(const proto::Group& hello, bool again) const;

    /// `windows`: that it will announce at once.
    void joins(Rank rank, std::uint32_t pid, std::uint32_t windows = 0) { members_[rank] = {pid, false, windows, {}}; }
    /// It had left when an earlier walld was there.
    void had_left(Rank rank) { members_[rank] = {0, true, 0, {}}; }
    /// Its link is lost.
    void misses(Rank rank, Clock::time_point until) { members_.at(rank).missed = until; }
    /// The first that has not come again by then.
    std::optional<std::pair<Clock::time_point, Rank>> first_missed() const;
    /// It has announced a window.
    void announced(Rank rank);
    /// False: it is not here.
    bool leaves(Rank rank);

    const std::string& name() const { return name_; }
    std::uint32_t size() const { return size_; }
    const std::map<Rank, Member>& members() const { return members_; }
    bool here(Rank rank) const;
    bool all_came() const { return members_.size() == size_; }
    bool all_left() const { return all_came() && left().size() == size_; }
    /// All have come, and have announced all that they had with an earlier walld.
    bool all_returned() const;
    std::set<Rank> left() const;
    /// "rank 2 (process 4711) of parallel program NAME".
    std::string text(Rank rank) const;

private:
    std::string name_;
    std::uint32_t size_;
    std::map<Rank, Member> members_;  ///< that have come
};

/// What the members of a group know of one window: versions of its placement with the frame from which each holds. The
/// newest is proposed first. A member answers that it knows it, and then begins that frame only when it is agreed; or
/// that it has begun it, and then another one is proposed. So all draw every frame at one place, whoever is slow or
/// away.
class AgreedPlacements {
public:
    /// Frames from the last presented one to that from which a proposal holds. A member can have begun the third: it
    /// draws two ahead of a node, which draws one ahead of what is presented. One more is presented while they are
    /// told.
    static constexpr std::uint32_t kLead = 5;

    /// It holds without having been proposed: the first one, or what members say that an earlier walld had agreed with
    /// them.
    void add(const proto::Placement& placement);
    /// It takes the place of an earlier proposal.
    void propose(const proto::Placement& placement) { proposed_ = placement; }
    /// What was proposed, if all know it now: it is agreed.
    std::optional<proto::Placement> settle(const ParallelGroup& group);

    /// The members' frames up to this one are on show: what held before is forgotten.
    void presented(std::uint32_t frame);
    /// The placements in order: the one that holds, and those that will.
    const std::map<std::uint32_t, proto::Placement>& versions() const { return versions_; }
    const std::optional<proto::Placement>& proposed() const { return proposed_; }
    /// The last frame that a member is known to have begun.
    std::uint32_t begun() const { return begun_; }

    void opened(Rank rank);
    void closed(Rank rank);
    void noted(Rank rank, std::uint32_t version);
    /// A member has begun that frame. True: it was told the proposal too late.
    bool too_late(std::uint32_t version, std::uint32_t begun);
    bool closed_by(Rank rank) const { return closed_.contains(rank); }
    bool opened_by(Rank rank) const { return noted_.contains(rank); }

private:
    bool all_noted(const ParallelGroup& group, std::uint32_t version) const;

    std::map<std::uint32_t, proto::Placement> versions_;
    std::optional<proto::Placement> proposed_;
    std::map<Rank, std::uint32_t> noted_;  ///< newest version that a member has received since it opened the window
    std::set<Rank> closed_;
    std::uint32_t begun_ = 0;
};

}  // namespace wall::walld
