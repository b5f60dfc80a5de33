// SPDX-License-Identifier: MIT
// Parallel programs: several processes that are one session.
#include <algorithm>
#include <ranges>
#include <vector>

#include "walld/wall/messages.h"
#include "walld/wall/wall.h"

namespace wall::walld {
namespace {

constexpr std::size_t kMaxVersions = 64;  // of a window's placement, that the members of a returning program tell

}  // namespace

/// One that returns knows its number: another program may have its name meanwhile.
const std::pair<const SessionId, SessionEntry>* Wall::group_of(const proto::ClientHello& hello) const {
    const auto found = std::ranges::find_if(sessions_, [&](const auto& entry) {
        return entry.second.group && entry.second.group->name() == hello.group().name() &&
               (!hello.has_resume() || entry.first.value == hello.resume().session());
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
    return known->second.group->admits(hello.group(), hello.has_resume());
}

/// Not yet: its nodes may still come and tell of it.
Wall::Comeback Wall::comeback(const proto::ClientHello& hello, Clock::time_point now) const {
    if (!hello.has_group() || !hello.has_resume() || resumable(hello)) return Comeback::may_come;
    const auto* known = group_of(hello);
    if (known && knows_a_ticket(hello.resume(), known->second.tickets)) return Comeback::may_come;
    const bool late = returns_over_ || (return_until_ && now >= *return_until_);
    return late ? Comeback::over : Comeback::not_yet;
}

SessionId Wall::join_session(SessionId id, const proto::ClientHello& hello,
                             const std::function<void(SessionId)>& before_welcome) {
    auto& session = *find(id);
    session.group->joins(hello.group().rank(), hello.pid(), hello.resume().windows());
    before_welcome(id);
    welcome_client(id, session, hello.group().rank(), hello.resume());
    all_returned(id);
    return id;
}

void Wall::member_leaves(SessionId id, Rank rank) {
    auto* session = find(id);
    if (!session || !session->group || !session->group->leaves(rank)) return;
    for (const NodeIndex i : nodes_.ids())
        if (nodes_[i].up) hand_out_ticket(id, *session, i);  // a walld that comes after this one hears of it from them
    for (const auto& [surface_id, surface] : session->surfaces) settle({id, surface_id});
    all_returned(id);
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
    if (!session.group) return nodes_under(rect);
    std::set<NodeIndex> out;
    for (const NodeIndex i : nodes_.ids())
        if (nodes_[i].up) out.insert(i);  // also those that only draw for others: all keep step
    return out;
}

void Wall::add_nodes(proto::Placement& placement, const SessionEntry& session) const {
    placement.clear_nodes();
    for (const NodeIndex i : nodes_.ids())
        if (nodes_[i].up) *placement.add_nodes() = node_up_message(i, session);
}

proto::Placement Wall::placement_for_all(const SurfaceKey& key) const {
    const auto& surface = *find(key);
    auto placement = placement_of(key, surface);
    placement.set_width(surface.width);
    placement.set_height(surface.height);
    add_nodes(placement, sessions_.at(key.session));
    return placement;
}

/// From a frame on that no member should have begun.
void Wall::propose(const SurfaceKey& key) {
    auto& surface = *find(key.surface, key.session);
    if (surface.returning) return;
    auto placement = placement_for_all(key);
    surface.agreed.presented(surface.swap.presented());
    placement.set_from_frame(std::max(surface.swap.presented(), surface.agreed.begun()) + AgreedPlacements::kLead);
    surface.agreed.propose(placement);
    out_.to_client(key.session, make(&proto::Envelope::mutable_placement, placement));
}

void Wall::settle(const SurfaceKey& key) {
    auto& surface = *find(key.surface, key.session);
    const auto placement = surface.agreed.settle(*find(key.session)->group);
    if (!placement) return;
    surface.place.adopt(placement->layout_version(), placement->from_frame());
    proto::PlacementAgreed agreed;
    agreed.set_surface(key.surface.value);
    agreed.set_layout_version(placement->layout_version());
    out_.to_client(key.session, make(&proto::Envelope::mutable_placement_agreed, agreed));
}

void Wall::open_for_member(const SurfaceKey& key, const proto::SurfaceOpen& message, Rank rank) {
    auto& surface = *find(key.surface, key.session);
    surface.agreed.opened(rank);
    if (message.has_restore()) restore_for_member(key, message);
    for (const auto& [version, placement] : surface.agreed.versions())
        out_.to_member(key.session, rank, make(&proto::Envelope::mutable_placement, placement));
    if (surface.agreed.proposed())
        out_.to_member(key.session, rank, make(&proto::Envelope::mutable_placement, *surface.agreed.proposed()));
    if (!surface.note.empty())  // of what others have opened before
        out_.to_member(key.session, rank, make(&proto::Envelope::mutable_surface_note, note_of(key, surface)));
    all_returned(key.session);
    const bool other_size = message.width() != surface.width || message.height() != surface.height;
    if (rank != 0 || !other_size) return;
    proto::SurfaceResize resize;
    resize.set_surface(key.surface.value);
    resize.set_width(message.width());
    resize.set_height(message.height());
    resize_surface(key.session, resize);
}

void Wall::placement_noted(SessionId id, Rank rank, const proto::PlacementNoted& message) {
    const SurfaceKey key{id, SurfaceId(message.surface())};
    auto* surface = find(key.surface, id);
    if (!surface) return;
    if (message.begun() != 0) {
        if (surface->agreed.too_late(message.layout_version(), message.begun())) want(key, surface->place.wanted());
        return;
    }
    surface->agreed.noted(rank, message.layout_version());
    settle(key);
}

// ---- of an earlier walld ----

/// What one member knows to be agreed holds for all: whoever has not heard of it has not begun that frame. And the
/// window is wanted where the newest proposal says that any of them has heard, of which their notes tell as well.
void Wall::restore_for_member(const SurfaceKey& key, const proto::SurfaceOpen& message) {
    auto& surface = *find(key.surface, key.session);
    if (!surface.returning) return;
    if (const auto version = message.restore().wanted_version(); version >= surface.wanted_version) {
        surface.wanted_version = version;
        surface.returning = std::max(*surface.returning, version);
        if (proto::WindowRecord record; record.ParseFromString(message.restore().note())) {
            surface.scaled = record.scaled();
            surface.wanted_rect = record.wanted_rect();
        }
        surface.place.want(restored_wish(surface, message, from_proto(message.restore().wanted())));
    }
    for (auto placement : message.restore().agreed()) {
        surface.returning = std::max(*surface.returning, placement.layout_version());
        if (surface.agreed.versions().contains(placement.layout_version()) ||
            surface.agreed.versions().size() >= kMaxVersions ||
            !check_place(config_.canvas(), from_proto(placement.rect())) ||
            !extent_ok(placement.width(), placement.height()))
            continue;
        add_nodes(placement, *find(key.session));
        placement.set_surface(key.surface.value);
        surface.agreed.add(placement);
    }
}

/// Then each is told what some may not know, and where it is wanted is proposed anew: nobody waits any more.
void Wall::all_returned(SessionId id) {
    auto& session = *find(id);
    if (!session.group->all_returned()) return;
    for (auto& [surface_id, surface] : session.surfaces) {
        if (!surface.returning) continue;
        const SurfaceKey key{id, surface_id};
        for (Rank rank = 0; rank < session.group->size(); ++rank)
            if (!surface.agreed.opened_by(rank)) surface.agreed.closed(rank);
        const auto& versions = surface.agreed.versions();
        for (const auto& [version, placement] : versions)
            out_.to_client(id, make(&proto::Envelope::mutable_placement, placement));
        const auto drawn = versions.empty() ? surface.place.drawn() : from_proto(versions.rbegin()->second.rect());
        const auto wanted = surface.place.wanted();
        surface.place = PlacementTrack(drawn, *std::exchange(surface.returning, std::nullopt));
        want(key, wanted);
    }
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
    const auto sessions = sessions_ | std::views::keys;
    for (const SessionId id : std::vector<SessionId>(sessions.begin(), sessions.end())) {
        const auto* session = find(id);
        const auto missed = session->group ? session->group->first_missed() : std::nullopt;
        if (!missed || now < missed->first) continue;
        out_.end_session(id, session->group->text(missed->second) + " has not come again since its link was lost");
        close_session(id);
    }
    for (const auto id : overdue) {
        const auto& group = *sessions_.at(id).group;
        out_.end_session(id, "only " + std::to_string(group.members().size()) + " of " + std::to_string(group.size()) +
                                 " processes of parallel program '" + group.name() + "' have come within " +
                                 std::to_string(kMembersLimit / std::chrono::seconds(1)) + " seconds");
        close_session(id);
    }
}

}  // namespace wall::walld
