// SPDX-License-Identifier: MIT
#include "walld/wall/parallel_group.h"

#include <algorithm>
#include <utility>

#include "common/wire/limits.h"

namespace wall::walld {
namespace {

constexpr std::size_t kMaxName = 256;  // bytes

}  // namespace

// ---- members ----

Outcome<void> ParallelGroup::check(const proto::Group& hello) {
    if (hello.name().empty() || hello.name().size() > kMaxName)
        return refuse(RefusalKind::invalid,
                      "a parallel program needs a name of 1 to " + std::to_string(kMaxName) + " bytes");
    if (hello.members() == 0 || hello.members() > wire::kMaxMembers || hello.rank() >= hello.members())
        return refuse(RefusalKind::invalid, "rank " + std::to_string(hello.rank()) + " of " +
                                                std::to_string(hello.members()) + " processes: expected at most " +
                                                std::to_string(wire::kMaxMembers) + ", and ranks from 0");
    return {};
}

Outcome<void> ParallelGroup::admits(const proto::Group& hello, bool again) const {
    if (hello.members() != size_)
        return refuse(RefusalKind::conflict, "parallel program '" + name_ + "' has " + std::to_string(size_) +
                                                 " processes, not " + std::to_string(hello.members()));
    const auto known = members_.find(hello.rank());
    if (known == members_.end() || (again && known->second.missed)) return {};
    return refuse(RefusalKind::conflict,
                  text(hello.rank()) + (known->second.left ? " has ended already" : " is here already"));
}

bool ParallelGroup::leaves(Rank rank) {
    if (!here(rank)) return false;
    return members_.at(rank).left = true;
}

bool ParallelGroup::here(Rank rank) const {
    const auto found = members_.find(rank);
    return found != members_.end() && !found->second.left;
}

std::set<Rank> ParallelGroup::left() const {
    std::set<Rank> out;
    for (const auto& [rank, member] : members_)
        if (member.left) out.insert(rank);
    return out;
}

std::string ParallelGroup::text(Rank rank) const {
    const auto found = members_.find(rank);
    const auto process =
        found == members_.end() ? std::string() : " (process " + std::to_string(found->second.pid) + ")";
    return "rank " + std::to_string(rank) + process + " of parallel program '" + name_ + "'";
}

std::optional<std::pair<ParallelGroup::Clock::time_point, Rank>> ParallelGroup::first_missed() const {
    std::optional<std::pair<Clock::time_point, Rank>> first;
    for (const auto& [rank, member] : members_)
        if (member.missed && (!first || *member.missed < first->first)) first.emplace(*member.missed, rank);
    return first;
}

void ParallelGroup::announced(Rank rank) {
    const auto found = members_.find(rank);
    if (found != members_.end() && found->second.awaited > 0) --found->second.awaited;
}

bool ParallelGroup::all_returned() const {
    return all_came() && std::ranges::all_of(members_, [](const auto& each) { return each.second.awaited == 0; });
}

// ---- placements ----

void AgreedPlacements::add(const proto::Placement& placement) {
    // What would hold later than it never does.
    std::erase_if(versions_, [&](const auto& old) {
        return old.first < placement.layout_version() && old.second.from_frame() >= placement.from_frame();
    });
    versions_[placement.layout_version()] = placement;
    versions_[placement.layout_version()].set_agreed(true);
}

std::optional<proto::Placement> AgreedPlacements::settle(const ParallelGroup& group) {
    if (!proposed_ || !all_noted(group, proposed_->layout_version())) return std::nullopt;
    const auto agreed = *std::exchange(proposed_, std::nullopt);
    add(agreed);
    return agreed;
}

void AgreedPlacements::presented(std::uint32_t frame) {
    while (versions_.size() > 1 && std::next(versions_.begin())->second.from_frame() <= frame)
        versions_.erase(versions_.begin());
}

void AgreedPlacements::opened(Rank rank) {
    noted_.try_emplace(rank, 0);
    closed_.erase(rank);
}

void AgreedPlacements::closed(Rank rank) {
    noted_.erase(rank);
    closed_.insert(rank);
}

void AgreedPlacements::noted(Rank rank, std::uint32_t version) {
    if (const auto found = noted_.find(rank); found != noted_.end()) found->second = std::max(found->second, version);
}

bool AgreedPlacements::too_late(std::uint32_t version, std::uint32_t begun) {
    begun_ = std::max(begun_, begun);
    return proposed_ && proposed_->layout_version() == version;
}

bool AgreedPlacements::all_noted(const ParallelGroup& group, std::uint32_t version) const {
    for (Rank rank = 0; rank < group.size(); ++rank) {
        const auto found = noted_.find(rank);
        if (closed_.contains(rank) || (group.members().contains(rank) && !group.here(rank))) continue;
        if (found == noted_.end() || found->second < version) return false;
    }
    return true;
}

}  // namespace wall::walld
