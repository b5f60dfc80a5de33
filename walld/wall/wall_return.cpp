// SPDX-License-Identifier: MIT
// What comes back when walld was started again. It writes nothing down: programs and nodes, which live on, tell it what
// they know, and give back the notes that the walld before had left with them for what only it knew.
//
//   session  its program names it, with the nodes' tickets; the nodes name it, too. Their streams go on.
//   window   its program says where it draws it and where it was wanted; the note has hold, order and the like
//   frames   the nodes say what they have drawn and what they show
//   layout   each node keeps the places that wait for programs
//
// A program of another machine whose link was lost comes back in the same way, to a walld that has lived on.
//
// The notes are worth no more than what the program could ask for anyway: its own windows' place, order and hold.
#include <algorithm>

#include "common/base/assert.h"
#include "common/tls/secret.h"
#include "common/wire/limits.h"
#include "walld/wall/messages.h"
#include "walld/wall/wall.h"

namespace wall::walld {
namespace {

constexpr std::size_t kMaxWaiting = 4096;  // places

std::vector<LayoutEntry> places_of(const proto::WallNote& note, const geom::Rect& canvas) {
    std::vector<LayoutEntry> out;
    for (const auto& place : note.waiting()) {
        const auto rect = from_proto(place.rect());
        if (out.size() >= kMaxWaiting || !check_place(canvas, rect)) continue;
        out.push_back({{place.name(), place.program(), place.title()}, rect, place.scaled(), place.z()});
    }
    return out;
}

}  // namespace

// ---- sessions ----

bool Wall::knows_a_ticket(const proto::Resume& resume, const std::map<NodeIndex, std::string>& tickets) {
    return std::ranges::any_of(resume.tickets(), [&](const proto::Resume::NodeTicket& told) {
        const auto of_node = tickets.find(NodeIndex(told.node()));
        return of_node != tickets.end() && tls::same_secret(of_node->second, told.ticket());
    });
}

/// Sessions of a walld before this one wait for their programs. Others have ended while the node's link was broken.
void Wall::hear_of_sessions(NodeIndex node, const proto::NodeHello& hello, Clock::time_point now) {
    if (!return_until_) return_until_ = now + kReturnLimit;
    end_waiting_for_sessions(now);
    for (const auto& known : hello.sessions()) {
        const SessionId id(known.session());
        if (sessions_.contains(id)) continue;  // with another ticket, it ends by that
        last_session_ = std::max(last_session_, id);
        if (returning_.contains(id) || (!returns_over_ && !ended_.contains(id))) {
            auto& returning = returning_.try_emplace(id, ReturningSession{{}, {}, *return_until_, {}}).first->second;
            returning.tickets[node] = known.ticket();
            returning.left.insert(known.left().begin(), known.left().end());
            continue;
        }
        proto::SessionEnd end;
        end.set_session(id.value);
        out_.to_node(node, make(&proto::Envelope::mutable_session_end, end));
    }
}

std::optional<SessionId> Wall::resumable(const proto::ClientHello& hello) const {
    if (!hello.has_resume()) return std::nullopt;
    const auto found = returning_.find(SessionId(hello.resume().session()));
    if (found == returning_.end() || !knows_a_ticket(hello.resume(), found->second.tickets)) return std::nullopt;
    return found->first;
}

/// Tickets that program and node have in common stay, so that the streams do. A node that is away keeps the program's
/// until it says its own.
void Wall::resume_session(SessionId id, SessionEntry& session, const proto::Resume& resume) {
    auto returning = std::move(returning_.extract(id).mapped());
    for (const auto& told : resume.tickets()) {
        const NodeIndex node(told.node());
        if (!nodes_.contains(node) || told.ticket().size() != kTicketBytes) continue;
        const auto of_node = returning.tickets.find(node);
        const bool known = of_node != returning.tickets.end() && tls::same_secret(of_node->second, told.ticket());
        if (known || !nodes_[node].up) session.tickets[node] = told.ticket();
    }
    session.awaited = resume.windows();
    session.awaited_until = returning.until;
    session.awaited_windows = std::move(returning.windows);
    for (const Rank rank : returning.left)
        if (session.group && rank < session.group->size() && !session.group->here(rank)) session.group->had_left(rank);
}

void Wall::end_waiting_for_sessions(Clock::time_point now) {
    if (return_until_ && now >= *return_until_ && !std::exchange(returns_over_, true)) ended_.clear();
    bool over = std::erase_if(returning_, [&](const auto& entry) {
                    const auto& [id, session] = entry;
                    if (now < session.until) return false;
                    proto::SessionEnd end;
                    end.set_session(id.value);
                    for (const auto& [node, ticket] : session.tickets)
                        out_.to_node(node, make(&proto::Envelope::mutable_session_end, end));
                    return true;
                }) > 0;
    for (auto& [id, session] : sessions_)
        if (session.awaited > 0 && now >= session.awaited_until) {
            session.awaited = 0;
            over = true;
        }
    if (over) send_stacking();
}

bool Wall::is_program_of(SessionId id, const proto::Resume& resume) const {
    const auto found = sessions_.find(id);
    return found != sessions_.end() && id == SessionId(resume.session()) &&
           knows_a_ticket(resume, found->second.tickets);
}

void Wall::await_again(SessionId id, Rank rank, Clock::time_point now) {
    if (auto* session = find(id); session && session->group) {
        if (session->group->here(rank)) session->group->misses(rank, now + kReturnLimit);
        return;
    }
    auto lost = sessions_.extract(id);
    if (lost.empty()) return;
    auto& returning = returning_[id] = {std::move(lost.mapped().tickets), {}, now + kReturnLimit, {}};
    for (const auto& [surface, entry] : lost.mapped().surfaces)
        returning.windows[surface] = {entry.note, entry.place.wanted()};
    std::erase_if(stacking_, [&](const SurfaceKey& key) { return key.session == id; });
    send_stacking();
}

bool Wall::awaits(SessionId id) const {
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? returning_.contains(id) : found->second.awaited > 0;
}

// ---- windows ----

/// Later windows lie above, also above those that an earlier walld has seen: the clock runs as long as the machine.
std::uint64_t Wall::order_at(Clock::time_point now) {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(now.time_since_epoch()).count());
}

/// False: it was at no place that this wall has. (A parallel program, which goes on drawing where it did, gets another
/// place.)
bool Wall::restore_surface(const SurfaceKey& key, const proto::SurfaceOpen& message, Clock::time_point now, Rank rank) {
    auto& session = *find(key.session);
    if (session.awaited > 0) --session.awaited;
    auto drawn = from_proto(message.restore().drawn());
    const auto known = session.awaited_windows.extract(key.surface);
    proto::WindowRecord record;
    if (!record.ParseFromString(known ? known.mapped().note : message.restore().note())) return false;
    const bool there = check_place(config_.canvas(), drawn).has_value();
    if (!there && !session.group) return false;
    session.held = record.session_held();
    if (record.session_weight() != 0 && record.session_weight() <= wire::kMostWeight &&
        record.session_weight() != session.weight)
        (void)set_weight({key.session, {}}, record.session_weight());
    session.stereo = record.has_session_stereo() ? checked(record.session_stereo()) : std::nullopt;
    auto& surface = add_surface(key, message);
    surface.scaled = record.scaled();
    surface.wanted_rect = record.wanted_rect();
    surface.place = PlacementTrack(there ? drawn
                                         : geom::Rect{0, 0, static_cast<std::int32_t>(message.width()),
                                                      static_cast<std::int32_t>(message.height())});
    if (!there) surface.place = PlacementTrack(drawn = place_after_change(session, surface));
    surface.order = std::min(record.order(), order_at(now));
    if (record.has_layout_z()) surface.layout_z = record.layout_z();
    surface.swap = SwapCoordinator(config_.swap_timeout, record.held());
    const auto above = [&](const SurfaceKey& other) { return find(other)->order > surface.order; };
    stacking_.insert(std::ranges::find_if(stacking_, above), key);
    present(key, surface.swap.set_nodes(nodes_of(session, drawn), now), now);
    if (session.group) {
        surface.returning = 1;
        open_for_member(key, message, rank);
    } else if (const auto wanted = restored_wish(
                   surface, message, known ? known.mapped().wanted : from_proto(message.restore().wanted()));
               wanted != drawn) {
        want(key, wanted);
    } else {
        send_placement(key, surface);
    }
    send_stacking();
    ask_for_frames(key.session);
    return true;
}

geom::Rect Wall::restored_wish(const SurfaceEntry& surface, const proto::SurfaceOpen& message,
                               geom::Rect wanted) const {
    if (!check_place(config_.canvas(), wanted)) wanted = surface.place.drawn();
    if (!surface.scaled) {
        wanted.width = static_cast<std::int32_t>(message.width());
        wanted.height = static_cast<std::int32_t>(message.height());
    }
    return wanted;
}

void Wall::ask_for_frames(SessionId session) {
    proto::FramesRequest request;
    request.set_session(session.value);
    to_all_nodes(make(&proto::Envelope::mutable_frames_request, request));
}

/// Bottom first, from what was the order before: only what was moved gets another number.
void Wall::number_stacking() {
    std::uint64_t last = 0;
    for (const auto& key : stacking_) {
        auto& order = find(key.surface, key.session)->order;
        if (order <= last) order = last + 1;
        last = order;
        tell_note(key);
    }
}

void Wall::tell_note(const SurfaceKey& key) {
    const auto& session = *find(key.session);
    auto& surface = *find(key.surface, key.session);
    proto::WindowRecord record;
    record.set_scaled(surface.scaled);
    record.set_wanted_rect(surface.wanted_rect);
    record.set_held(surface.swap.held());
    record.set_session_held(session.held);
    record.set_session_weight(session.weight);
    if (session.stereo) *record.mutable_session_stereo() = *session.stereo;
    record.set_order(surface.order);
    if (surface.layout_z) record.set_layout_z(*surface.layout_z);
    auto text = record.SerializeAsString();
    if (text == surface.note) return;
    surface.note = std::move(text);
    out_.to_client(key.session, make(&proto::Envelope::mutable_surface_note, note_of(key, surface)));
}

proto::SurfaceNote Wall::note_of(const SurfaceKey& key, const SurfaceEntry& surface) {
    proto::SurfaceNote note;
    note.set_surface(key.surface.value);
    note.set_note(surface.note);
    return note;
}

// ---- the layout that waits ----

proto::Envelope Wall::wall_note() const {
    proto::WallNote note;
    note.set_version(places_version_);
    for (const auto& entry : free_places_) {
        auto& place = *note.add_waiting();
        place.set_name(entry.window.name);
        place.set_program(entry.window.program);
        place.set_title(entry.window.title);
        *place.mutable_rect() = to_proto(entry.rect);
        place.set_scaled(entry.scaled);
        place.set_z(entry.z);
    }
    return make(&proto::Envelope::mutable_wall_note, note);
}

void Wall::waiting_places_changed() {
    ++places_version_;
    to_all_nodes(wall_note());
}

/// The newest one counts, unless a layout was loaded since: then that one is the newest from now on.
void Wall::hear_wall_note(NodeIndex node, const proto::WallNote& note) {
    const auto ours = wall_note();
    if (note.version() < places_version_) return out_.to_node(node, ours);
    if (note.SerializeAsString() == ours.wall_note().SerializeAsString()) return;
    if (layout_loaded_ || note.version() == places_version_) {
        places_version_ = note.version() + 1;
    } else {
        places_version_ = note.version();
        free_places_ = places_of(note, config_.canvas());
    }
    to_all_nodes(wall_note());
}

}  // namespace wall::walld
