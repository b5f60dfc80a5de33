// SPDX-License-Identifier: MIT
// Parallel programs: several processes that are one session.
#include <algorithm>

#include "walld/wall/messages.h"
#include "walld/wall/wall.h"

namespace wall::walld {

const std::pair<const SessionId, SessionEntry>* Wall::group_of(const proto::ClientHello& hello) const {
    const auto found = std::ranges::find_if(sessions_, [&](const auto& entry) {
        return entry.second.group && entry.second.group->name() == hello.group().name();
    });
    return hello.has_group() && found != sessions_.end() ? &*found : nullptr;
}

Outcome<void> Wall::check_member(const proto::ClientHello& hello, const Person& who) const {
    if (!hello.has_group()) return {};
    if (auto good = ParallelGroup::check(hello.group()); !good) return good;
    const auto* known = group_of(hello);
    if (!known) return {};
    if (!known->second.owner.same_as(who))
        return refuse(RefusalKind::forbidden,
                      "parallel program '" + hello.group().name() + "' belongs to " + known->second.owner.text());
    return known->second.group->admits(hello.group());
}

SessionId Wall::join_session(SessionId id, const proto::ClientHello& hello,
                             const std::function<void(SessionId)>& before_welcome) {
    auto& session = *find(id);
    session.group->joins(hello.group().rank(), hello.pid());
    before_welcome(id);
    welcome_client(id, session, hello.group().rank());
    return id;
}

void Wall::member_leaves(SessionId id, Rank rank, Clock::time_point now) {
    auto* session = find(id);
    if (!session || !session->group || !session->group->leaves(rank)) return;
    for (auto& [surface_id, surface] : session->surfaces) limit_frames({id, surface_id}, now);
}

std::string Wall::member_gone(SessionId id, Rank rank) {
    auto* session = find(id);
    if (!session) return "over";
    if (session->group && !session->group->here(rank)) {
        if (session->group->all_left()) close_session(id);
        return "left";
    }
    const auto reason = session->group ? session->group->text(rank) + " ended without leaving" : "closed";
    if (session->group) out_.end_session(id, reason);
    close_session(id);
    return reason;
}

// ---- placements ----

/// All nodes of the wall take part in every frame, wherever the window lies: the members keep step on each.
std::set<NodeIndex> Wall::nodes_of(const SessionEntry& session, const geom::Rect& rect) const {
    return session.group ? nodes_under(config_.canvas()) : nodes_under(rect);
}

/// A version that holds from a frame on that no member can have begun.
void Wall::agree(const SurfaceKey& key, Clock::time_point now) {
    auto& session = *find(key.session);
    auto& surface = *find(key.surface, key.session);
    auto placement = placement_of(key, surface);
    const bool first = surface.agreed.versions().empty();
    placement.set_from_frame(first ? 0 : surface.swap.presented() + AgreedPlacements::kLead);
    placement.set_width(surface.width);
    placement.set_height(surface.height);
    for (const NodeIndex i : nodes_.ids()) {
        if (nodes_[i].up) *placement.add_nodes() = node_up_message(i, session.tickets.at(i));
    }
    surface.agreed.presented(surface.swap.presented());
    surface.agreed.add(placement);
    surface.place.adopt(placement.layout_version(), placement.from_frame());
    limit_frames(key, now);
    if (!first) out_.to_client(key.session, make(&proto::Envelope::mutable_placement, placement));
}

void Wall::open_for_member(const SurfaceKey& key, const proto::SurfaceOpen& message, Rank rank, Clock::time_point now) {
    auto& surface = *find(key.surface, key.session);
    surface.agreed.opened(rank);
    const bool other_size = message.width() != surface.width || message.height() != surface.height;
    for (const auto& [version, placement] : surface.agreed.versions())
        out_.to_member(key.session, rank, make(&proto::Envelope::mutable_placement, placement));
    if (rank != 0 || !other_size) return;
    proto::SurfaceResize resize;
    resize.set_surface(key.surface.value);
    resize.set_width(message.width());
    resize.set_height(message.height());
    resize_surface(key.session, resize, now);
}

void Wall::placement_noted(SessionId id, Rank rank, const proto::PlacementNoted& message, Clock::time_point now) {
    const SurfaceKey key{id, SurfaceId(message.surface())};
    auto* surface = find(key.surface, id);
    if (!surface) return;
    surface->agreed.noted(rank, message.layout_version());
    limit_frames(key, now);
}

void Wall::limit_frames(const SurfaceKey& key, Clock::time_point now) {
    const auto& group = find(key.session)->group;
    if (group) present(key, find(key.surface, key.session)->swap.limit(find(key)->agreed.limit(*group), now), now);
}

/// False: others still have it.
bool Wall::closed_by_all(SessionEntry& session, SurfaceEntry& surface, Rank rank) {
    if (!session.group) return true;
    surface.agreed.closed(rank);
    for (Rank other = 0; other < session.group->size(); ++other) {
        const bool gone = session.group->members().contains(other) && !session.group->here(other);
        if (!gone && !surface.agreed.closed_by(other)) return false;
    }
    return true;
}

void Wall::end_overdue_groups(Clock::time_point now) {
    std::vector<SessionId> overdue;
    for (const auto& [id, session] : sessions_)
        if (session.group && !session.group->all_came() && now >= session.opened + kMembersLimit) overdue.push_back(id);
    for (const auto id : overdue) {
        const auto& group = *sessions_.at(id).group;
        out_.end_session(id, "only " + std::to_string(group.members().size()) + " of " + std::to_string(group.size()) +
                                 " processes of parallel program '" + group.name() + "' have come within " +
                                 std::to_string(kMembersLimit / std::chrono::seconds(1)) + " seconds");
        close_session(id);
    }
}

}  // namespace wall::walld
