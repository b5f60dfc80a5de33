// SPDX-License-Identifier: MIT
// The processes of a parallel program, which are one session (docs/parallel-programs.md). Pure; times are parameters.
//
//   absent --hello--> here --leaves--> left          here --connection lost--> the session ends
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
    struct Member {
        std::uint32_t pid = 0;
        bool left = false;
    };

    ParallelGroup(std::string name, std::uint32_t size) : name_(std::move(name)), size_(size) {}

    /// A group in itself: a name, a rank that there is, a size that there may be.
    static Outcome<void> check(const proto::Group& hello);
    /// Whether this member may come to the others.
    Outcome<void> admits(const proto::Group& hello) const;

    void joins(Rank rank, std::uint32_t pid) { members_[rank] = {pid, false}; }
    /// False: it is not here.
    bool leaves(Rank rank);

    const std::string& name() const { return name_; }
    std::uint32_t size() const { return size_; }
    const std::map<Rank, Member>& members() const { return members_; }
    bool here(Rank rank) const;
    bool all_came() const { return members_.size() == size_; }
    bool all_left() const { return all_came() && left().size() == size_; }
    std::set<Rank> left() const;
    /// "rank 2 (process 4711) of parallel program NAME".
    std::string text(Rank rank) const;

private:
    std::string name_;
    std::uint32_t size_;
    std::map<Rank, Member> members_;  ///< that have come
};

/// What the members of a group know of one window: versions of its placement with the frame from which each holds. A
/// version's frame comes only when all members know of it.
class AgreedPlacements {
public:
    /// Frames from the last presented one to that from which a new version holds. A member can have begun the third: it
    /// draws two ahead of a node, which draws one ahead of what is presented. One more is presented while they are
    /// told.
    static constexpr std::uint32_t kLead = 5;

    void add(const proto::Placement& placement);
    /// The members' frames up to this one are on show: what held before is forgotten.
    void presented(std::uint32_t frame);
    /// The placements in order: the one that holds, and those that will.
    const std::map<std::uint32_t, proto::Placement>& versions() const { return versions_; }

    void opened(Rank rank) { noted_.try_emplace(rank, 0); }
    void closed(Rank rank);
    void noted(Rank rank, std::uint32_t version);
    bool closed_by(Rank rank) const { return closed_.contains(rank); }
    /// The last frame that may be presented now. `group`: its members that have left know nothing and draw nothing.
    std::uint32_t limit(const ParallelGroup& group) const;

private:
    bool all_noted(const ParallelGroup& group, std::uint32_t version) const;

    std::map<std::uint32_t, proto::Placement> versions_;
    std::map<Rank, std::uint32_t> noted_;  ///< newest version that a member has received since it opened the window
    std::set<Rank> closed_;
};

}  // namespace wall::walld
