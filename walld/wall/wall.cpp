// SPDX-License-Identifier: MIT
#include "walld/wall/wall.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "common/base/assert.h"
#include "common/base/lossy_pixels.h"
#include "common/wire/limits.h"
#include "common/wire/parcel.h"
#include "walld/wall/caps.h"
#include "walld/wall/messages.h"
#include "walld/wall/placement.h"

namespace wall::walld {
namespace {

constexpr std::uint32_t kMaxSurfaces = 256;  // of a session
constexpr std::size_t kMaxText = 256;        // bytes of a program's name or a window's title that are kept

/// The same process, perhaps on another link.
bool same_process(const proto::NodeHello& a, const proto::NodeHello& b) {
    return a.pid() == b.pid() && a.started_us() == b.started_us();
}

/// The node has the session from an earlier link, under that ticket.
bool has_ticket(const proto::NodeHello& hello, SessionId id, const std::string& ticket) {
    return std::ranges::any_of(hello.sessions(), [&](const proto::Ticket& known) {
        return known.session() == id.value && known.ticket() == ticket;
    });
}

std::optional<proto::NativeWindow> native_of(const proto::SurfaceOpen& message) {
    if (!message.has_native() || message.native().display().size() > kMaxText) return std::nullopt;
    return message.native();
}

}  // namespace

Wall::Wall(config::WallConfig config, Outbox& out, RandomBytes random)
    : config_(std::move(config)), out_(out), random_(std::move(random)) {
    take_nodes();
}

// ---- nodes ----

Result<NodeIndex> Wall::check_node(const proto::NodeHello& hello) const {
    const auto index = find_node(hello.name());
    if (hello.version() != wire::kProtocolVersion)
        return fail("this walld speaks protocol version " + std::to_string(wire::kProtocolVersion) + ", the node " +
                    std::to_string(hello.version()));
    if (!index || nodes_[*index].duty == Duty::gone) return fail("node '" + hello.name() + "' is not in wall.toml");
    const Node& node = nodes_[*index];
    if (node.up && !same_process(node.hello, hello) && hello.started_us() <= node.hello.started_us())
        return fail("node '" + hello.name() + "' is already here, as process " + std::to_string(node.hello.pid()));
    return *index;
}

Result<NodeIndex> Wall::node_joins(const proto::NodeHello& hello, Clock::time_point now) {
    const auto good = check_node(hello);
    if (!good) return good;
    const auto index = *good;
    auto& node = nodes_[index];
    if (node.up) node_leaves(index, now);
    const bool anew = std::exchange(node.described_anew, false);
    const bool same = !anew && node.incarnation > 0 && same_process(node.hello, hello);
    if (!same) {
        if (missed_.contains(index)) tell_gone(index);
        ++node.incarnation;
        node.stats.Clear();
    }
    missed_.erase(index);
    node.up = node.duty == Duty::serves;
    node.hello = hello;
    welcome_node(index);
    if (!node.up) {
        send_away(hello, index);
        return index;
    }
    hear_wall_note(index, hello.wall_note());
    hear_of_sessions(index, hello, now);
    for (auto& [id, session] : sessions_) {
        if (anew || (!same && !has_ticket(hello, id, session.tickets[index]))) session.tickets.erase(index);
        hand_out_ticket(id, session, index);
        out_.to_client(id, make(&proto::Envelope::mutable_node_up, node_up_message(index, session)));
        tell_peers(id, session);
    }
    out_.to_node(index, stacking_message(index));
    for_each_surface([&](const SurfaceKey& key, SurfaceEntry& surface) {
        const auto& session = *find(key.session);
        present(key, surface.swap.set_nodes(nodes_of(session, surface.place.drawn()), now), now);
        if (session.group) want(key, surface.place.wanted());  // the members come to the node at the same frame
    });
    return index;
}

void Wall::node_leaves(NodeIndex node, Clock::time_point now, bool link_lost) {
    nodes_[node].up = false;
    taking_tiles_.erase(node);
    if (moving_ && (moving_->from == node || moving_->to == node)) end_move(false, now);
    tell_tiles();
    for (const auto& [id, session] : sessions_) list_peers(id, session);
    if (link_lost) missed_[node] = now + kMissedLimit;
    else tell_gone(node);
    for_each_surface(
        [&](const SurfaceKey& key, SurfaceEntry& surface) { present(key, surface.swap.lose(node, now), now); });
}

void Wall::tell_gone(NodeIndex node) {
    missed_.erase(node);
    proto::NodeDown down;
    down.set_node(node.value);
    for (const auto& [id, session] : sessions_) out_.to_client(id, make(&proto::Envelope::mutable_node_down, down));
}

void Wall::node_rendered(NodeIndex node, const proto::Rendered& report, Clock::time_point now) {
    const SurfaceKey key{SessionId(report.session()), SurfaceId(report.surface())};
    auto* surface = find(key.surface, key.session);
    if (!surface) return;
    auto& swap = surface->swap;
    present(key,
            report.has_shown() ? swap.resume(node, report.frame(), report.shown(), now)
                               : swap.rendered(node, report.frame(), now),
            now);
}

void Wall::node_faults(NodeIndex node, const proto::SessionFault& report) {
    ++counters_.faults;
    const SessionId id(report.session());
    auto* session = find(id);
    if (!session) return;
    session->fault = nodes_[node].config->name + ": " + report.reason();
    if (!session->group && !report.ends()) return;
    out_.end_session(id, session->fault);
    close_session(id);
}

std::vector<NodeIndex> Wall::note_silent(const std::set<NodeIndex>& quiet) {
    std::vector<NodeIndex> out;
    for (const NodeIndex i : nodes_.ids())
        if (!std::exchange(nodes_[i].silent, quiet.contains(i)) && quiet.contains(i)) out.push_back(i);
    return out;
}

std::vector<SessionId> Wall::note_silent(const std::set<SessionId>& quiet) {
    std::vector<SessionId> out;
    for (auto& [id, session] : sessions_)
        if (!std::exchange(session.silent, quiet.contains(id)) && quiet.contains(id)) out.push_back(id);
    return out;
}

void Wall::welcome_node(NodeIndex node) {
    proto::NodeWelcome welcome;
    welcome.set_node(node.value);
    welcome.set_background(config_.background);
    welcome.set_tiles_version(nodes_[node].tiles_version);
    welcome.set_measure_tiles(may_be_balanced(node));
    for (const auto& tile : nodes_[node].config->tiles) {
        auto* entry = welcome.add_tiles();
        entry->set_slot(tile.slot);
        entry->set_name(tile.name);
        *entry->mutable_rect() = to_proto(tile.rect);
        entry->set_eye(static_cast<std::uint32_t>(tile.eye));
        if (!geom::is_plain(tile.output, tile.rect)) *entry->mutable_output() = to_proto(tile.output);
    }
    out_.to_node(node, make(&proto::Envelope::mutable_node_welcome, welcome));
    for (const auto& tile : nodes_[node].config->tiles)
        if (const auto found = patterns_.find(tile.name); found != patterns_.end())
            tell_pattern(node, tile.slot, found->second);
}

/// One that has a ticket of the session.
proto::NodeUp Wall::node_up_message(NodeIndex node, const SessionEntry& session) const {
    proto::NodeUp up;
    up.set_node(node.value);
    up.set_address(nodes_[node].hello.address());
    up.set_ticket(session.tickets.at(node));
    up.set_incarnation(nodes_[node].incarnation);
    up.set_key(nodes_[node].hello.key());
    up.set_renders(nodes_[node].config->roles.render && nodes_reach_each_other());
    up.set_composes(nodes_[node].config->roles.compose && nodes_reach_each_other());
    up.set_hands_on(!nodes_[node].hello.key().empty() && nodes_hand_on(session));
    return up;
}

std::set<NodeIndex> Wall::nodes_under(const geom::Rect& rect) const {
    std::set<NodeIndex> out;
    for (const NodeIndex i : nodes_.ids()) {
        const bool shows = std::ranges::any_of(nodes_[i].config->tiles,
                                               [&](const auto& tile) { return geom::overlaps(tile.rect, rect); });
        if (nodes_[i].up && shows) out.insert(i);
    }
    return out;
}

// ---- clients ----

bool Wall::any_node_up() const { return std::ranges::any_of(nodes_, &Node::up); }

/// Whether the wall lets a program ask for so much.
Outcome<void> Wall::check_lossy(float pixels) const {
    if (!is_lossy_bound(static_cast<double>(pixels)))
        return walld::refuse(RefusalKind::invalid, "expected 0 to 16 lossy pixels");
    if (pixels <= config_.lossy_pixels) return {};
    std::ostringstream text;
    text << "the program asks for vertices that lie up to " << pixels << " pixels off, and the wall allows "
         << config_.lossy_pixels
         << "; expected at most that ('--lossy-pixels' of wallrun), or more in 'lossy_pixels' in [wall] of wall.toml";
    return walld::refuse(RefusalKind::forbidden, text.str());
}

Outcome<void> Wall::check(const proto::ClientHello& hello) const {
    if (hello.version() != wire::kProtocolVersion) {
        return walld::refuse(RefusalKind::invalid,
                             "walld speaks protocol version " + std::to_string(wire::kProtocolVersion) +
                                 ", the program's WallGL library " + std::to_string(hello.version()));
    }
    if (sessions_.size() >= config_.max_sessions && !group_of(hello)) {
        return walld::refuse(RefusalKind::unavailable,
                             "the wall is full: " + std::to_string(config_.max_sessions) +
                                 " programs are on it ('max_sessions' in [wall] of wall.toml)");
    }
    // One that comes back is not lost where less is allowed by now: its library keeps to what the welcome says.
    if (auto allowed = check_lossy(hello.lossy_pixels()); !allowed)
        if (!hello.has_resume() || allowed.error().kind == RefusalKind::invalid) return allowed;
    if (hello.has_rect()) {
        if (auto possible = check_place(config_.canvas(), from_proto(hello.rect())); !possible)
            return tl::unexpected(possible.error());
    }
    return {};
}

SessionId Wall::open_session(const proto::ClientHello& hello, Person owner, Clock::time_point now,
                             const std::function<void(SessionId)>& before_welcome) {
    if (const auto* known = group_of(hello); known && !resumable(hello))
        return join_session(known->first, hello, before_welcome);
    WALL_ASSERT(any_node_up());
    const auto back = resumable(hello);
    const SessionId id = back ? *back : next_session();
    auto& session = sessions_[id];
    if (hello.has_group()) {
        session.group.emplace(hello.group().name(), hello.group().members());
        session.group->joins(hello.group().rank(), hello.pid(), hello.resume().windows());
    }
    if (back) resume_session(id, session, hello.resume());
    session.pid = hello.pid();
    session.program = hello.program().substr(0, kMaxText);
    session.name = hello.name().substr(0, kMaxText);
    session.owner = std::move(owner);
    session.held = hello.hold();
    session.sort_last = hello.sort_last() || (config_.sort_last_measured && !session.group);
    session.lossy_pixels = config_.lossy_pixels;
    if (hello.has_lossy_pixels()) session.lossy_pixels = std::min(session.lossy_pixels, hello.lossy_pixels());
    if (hello.has_stereo() && !session.group) session.stereo = checked(hello.stereo());
    if (hello.has_rect()) session.rect = from_proto(hello.rect());
    session.fullscreen = hello.fullscreen();
    if (session.fullscreen) session.rect = config_.canvas();
    session.opened = now;
    ++counters_.sessions;
    before_welcome(id);
    for (const NodeIndex i : nodes_.ids()) {
        if (!nodes_[i].up) continue;
        // To a node that does not know a returning program its members go with a placement.
        if (!back || session.tickets.contains(i)) session.group_nodes[i] = nodes_[i].incarnation;
        hand_out_ticket(id, session, i);
    }
    welcome_client(id, session, hello.group().rank());
    tell_peers(id, session);
    return id;
}

/// One that neither a program nor a node knows as another session's.
SessionId Wall::next_session() {
    do ++last_session_.value;
    while (!last_session_ || sessions_.contains(last_session_) || returning_.contains(last_session_));
    return last_session_;
}

void Wall::hand_out_ticket(SessionId id, SessionEntry& session, NodeIndex node) {
    auto& ticket = session.tickets[node];
    if (ticket.empty()) ticket = random_(kTicketBytes);
    proto::Ticket message;
    message.set_session(id.value);
    message.set_ticket(ticket);
    message.set_weight(session.weight);
    *message.mutable_quota() = quota_of_programs();
    if (!session.group) message.set_key(session.owner.machine);  // a group's members may be at several
    if (session.group) {
        message.set_members(session.group->size());
        for (const Rank rank : session.group->left()) message.add_left(rank);
    }
    if (have_peers(session))
        for (const Node& peer : nodes_)
            if (peer.up && !peer.hello.key().empty()) message.add_peer_keys(peer.hello.key());
    out_.to_node(node, make(&proto::Envelope::mutable_ticket, message));
}

/// They are all on this machine, or all have keys and ports for others.
bool Wall::nodes_reach_each_other() const {
    const auto has_key = [](const Node& node) { return !node.hello.key().empty(); };
    const auto up = std::ranges::count_if(nodes_, &Node::up);
    const auto keys = std::ranges::count_if(nodes_, [&](const Node& node) { return node.up && has_key(node); });
    return keys == 0 || keys == up;
}

/// What goes to several nodes on other machines is best handed on from one to the next. But members of a parallel
/// program wait for each other on each node, and so may not make nodes wait for each other.
bool Wall::nodes_hand_on(const SessionEntry& session) const {
    const auto has_key = [](const Node& node) { return node.up && !node.hello.key().empty(); };
    const auto keys = std::ranges::count_if(nodes_, has_key);
    return keys > 1 && keys <= static_cast<std::ptrdiff_t>(wire::kMostHandedTo) && !session.group;
}

bool Wall::have_peers(const SessionEntry& session) const { return session.sort_last || nodes_hand_on(session); }

/// Whoever brings others something is told where they are, and they, by their tickets, who may come. The program hears
/// whether they can.
void Wall::tell_peers(SessionId id, SessionEntry& session) {
    if (!have_peers(session)) return;
    for (const NodeIndex i : nodes_.ids()) {
        if (!nodes_[i].up || !session.tickets.contains(i)) continue;
        hand_out_ticket(id, session, i);
        out_.to_client(id, make(&proto::Envelope::mutable_node_up, node_up_message(i, session)));
    }
    list_peers(id, session);
}

/// Who brings others something hears where they are; who gets it, whether they are there.
void Wall::list_peers(SessionId id, const SessionEntry& session) {
    if (!have_peers(session)) return;
    proto::Peers peers;
    peers.set_session(id.value);
    const auto has_it = [&](NodeIndex i) { return nodes_[i].up && session.tickets.contains(i); };
    for (const NodeIndex i : nodes_.ids())
        if (has_it(i)) *peers.add_nodes() = node_up_message(i, session);
    for (const NodeIndex i : nodes_.ids())
        if (has_it(i)) out_.to_node(i, make(&proto::Envelope::mutable_peers, peers));
}

void Wall::welcome_client(SessionId id, const SessionEntry& session, Rank rank, const proto::Resume& again) {
    proto::ClientWelcome welcome;
    const auto canvas = config_.canvas();
    welcome.set_session(id.value);
    welcome.set_canvas_width(static_cast<std::uint32_t>(canvas.width));
    welcome.set_canvas_height(static_cast<std::uint32_t>(canvas.height));
    add_tiles(*welcome.mutable_tiles());
    std::vector<const proto::GlCaps*> caps;
    for (const NodeIndex i : nodes_.ids()) {
        if (!nodes_[i].up) continue;
        const auto at_first = session.group_nodes.find(i);
        const bool same_for_all =
            !session.group || (at_first != session.group_nodes.end() && at_first->second == nodes_[i].incarnation);
        const bool has_it = std::ranges::any_of(again.tickets(), [&](const proto::Resume::NodeTicket& told) {
            return told.node() == i.value && told.ticket() == session.tickets.at(i);
        });
        if (same_for_all || has_it) *welcome.add_nodes() = node_up_message(i, session);
        caps.push_back(&nodes_[i].hello.caps());
    }
    *welcome.mutable_caps() = common_caps(caps);
    welcome.set_lossy_pixels(config_.lossy_pixels);
    welcome.set_sort_last_measured(session.sort_last && config_.sort_last_measured);
    welcome.set_swap_timeout_ms(static_cast<std::uint32_t>(config_.swap_timeout / std::chrono::milliseconds(1)));
    out_.to_member(id, rank, make(&proto::Envelope::mutable_client_welcome, welcome));
}

void Wall::close_session(SessionId id) {
    if (sessions_.erase(id) == 0) return;
    if (!returns_over_) ended_.insert(id);
    std::erase_if(stacking_, [&](const SurfaceKey& key) { return key.session == id; });
    proto::SessionEnd end;
    end.set_session(id.value);
    to_all_nodes(make(&proto::Envelope::mutable_session_end, end));
    send_stacking();
}

Result<void> Wall::open_surface(SessionId id, const proto::SurfaceOpen& message, Clock::time_point now, Rank rank) {
    auto* session = find(id);
    const SurfaceKey key{id, SurfaceId(message.surface())};
    const bool known = session && session->surfaces.contains(key.surface);
    if (!session || !key.surface || (known && !session->group))
        return fail("surface " + std::to_string(message.surface()) + " cannot be opened: expected a new number");
    if (!extent_ok(message.width(), message.height()))
        return fail("surface of " + std::to_string(message.width()) + "x" + std::to_string(message.height()) +
                    " pixels: expected 1 to " + std::to_string(wire::kMaxSurfaceExtent) + " a side");
    if (message.has_restore() && session->group) session->group->announced(rank);
    if (known) {
        open_for_member(key, message, rank);
        return {};
    }
    if (const auto most = config_.quota.program_windows.value_or(kMaxSurfaces); session->surfaces.size() >= most)
        return fail("more than " + std::to_string(most) + " windows ('program_windows' in [quota] of wall.toml)");
    if (message.has_restore() && restore_surface(key, message, now, rank)) return {};
    auto& surface = add_surface(key, message);
    surface.place = PlacementTrack(first_rect(*session, surface, windows_placed_++));
    surface.order = order_at(now);
    stack(key);
    present(key, surface.swap.set_nodes(nodes_of(*session, surface.place.drawn()), now), now);
    if (session->group) {
        surface.agreed.add(placement_for_all(key));
        open_for_member(key, message, rank);
    } else {
        send_placement(key, surface);
    }
    send_stacking();
    return {};
}

/// Not placed yet.
SurfaceEntry& Wall::add_surface(const SurfaceKey& key, const proto::SurfaceOpen& message) {
    auto& session = *find(key.session);
    SurfaceEntry surface{.width = message.width(),
                         .height = message.height(),
                         .title = message.title().substr(0, kMaxText),
                         .native = native_of(message),
                         .place = PlacementTrack(),
                         .note = {},
                         .agreed = {},
                         .returning = {},
                         .swap = SwapCoordinator(config_.swap_timeout, session.held)};
    return session.surfaces.emplace(key.surface, std::move(surface)).first->second;
}

/// The session's wanted rectangle goes to one window at a time; every other one gets its place in the layout that was
/// loaded, or one where there is room.
geom::Rect Wall::first_rect(SessionEntry& session, SurfaceEntry& surface, std::uint32_t number) {
    const bool given =
        std::ranges::any_of(session.surfaces, [](const auto& entry) { return entry.second.wanted_rect; });
    if (session.rect && !given) {
        surface.scaled = surface.wanted_rect = true;
        return *session.rect;
    }
    if (const auto free = take_place(free_places_, {session.name, session.program, surface.title})) {
        surface.scaled = free->scaled;
        surface.layout_z = free->z;
        waiting_places_changed();
        return free->scaled ? free->rect
                            : geom::Rect{free->rect.x, free->rect.y, static_cast<std::int32_t>(surface.width),
                                         static_cast<std::int32_t>(surface.height)};
    }
    std::vector<geom::Rect> taken;
    for (const auto& key : stacking_) taken.push_back(find(key)->place.wanted());
    return place(config_.canvas(), taken, static_cast<std::int32_t>(surface.width),
                 static_cast<std::int32_t>(surface.height), number);
}

/// On top, but below what lies above it in the layout that has placed it.
void Wall::stack(const SurfaceKey& key) {
    const auto z = find(key)->layout_z;
    const auto above = [&](const SurfaceKey& other) { return z && find(other)->layout_z.value_or(0) > *z; };
    stacking_.insert(std::ranges::find_if(stacking_, above), key);
}

void Wall::resize_surface(SessionId id, const proto::SurfaceResize& message, Rank rank) {
    const SurfaceKey key{id, SurfaceId(message.surface())};
    auto* surface = find(key.surface, id);
    if (!surface || rank != 0 || !extent_ok(message.width(), message.height())) return;
    surface->width = message.width();
    surface->height = message.height();
    auto rect = surface->place.wanted();
    if (!surface->scaled) {
        rect.width = static_cast<std::int32_t>(message.width());
        rect.height = static_cast<std::int32_t>(message.height());
    }
    want(key, rect);
}

void Wall::adopt_placement(SessionId id, const proto::SurfaceAdopted& message, Clock::time_point now) {
    const SurfaceKey key{id, SurfaceId(message.surface())};
    auto* surface = find(key.surface, id);
    if (!surface) return;
    proto::AdoptionNoted noted;
    noted.set_surface(message.surface());
    noted.set_layout_version(message.layout_version());
    out_.to_client(id, make(&proto::Envelope::mutable_adoption_noted, noted));
    if (!surface->place.adopt(message.layout_version(), message.frame())) return;
    const auto nodes = nodes_under(surface->place.drawn());
    const auto presents = surface->swap.move(nodes, message.frame(), now);
    // Before the first frame there is nothing to keep in sight; a program without a back buffer never swaps. Where no
    // node shows it, no frame will be presented.
    const bool at_once = message.frame() <= 1 || nodes.empty();
    if (at_once && surface->place.presented(message.frame())) send_stacking();
    present(key, presents, now);
}

void Wall::cannot_close(SessionId id, SurfaceId surface) {
    if (auto* found = find(surface, id)) found->cannot_close = true;
}

void Wall::client_reports(SessionId id, Rank rank, const proto::ClientStats& stats, Clock::time_point now) {
    auto* session = find(id);
    if (!session) return;
    session->traffic.note(rank, stats, nodes_.size(), now);
    const auto among = [](const auto& ids, SurfaceId surface) { return std::ranges::count(ids, surface.value) > 0; };
    for (auto& [surface, entry] : session->surfaces)
        entry.views = among(stats.seen(), surface)   ? SurfaceEntry::Views::seen
                      : among(stats.flat(), surface) ? SurfaceEntry::Views::flat
                                                     : SurfaceEntry::Views::none;
}

void Wall::close_surface(SessionId id, SurfaceId surface, Rank rank) {
    auto* session = find(id);
    auto* found = find(surface, id);
    if (!found) return;
    if (!closed_by_all(*session, *found, rank)) return settle({id, surface});
    session->surfaces.erase(surface);
    std::erase(stacking_, SurfaceKey{id, surface});
    send_stacking();
}

// ---- time ----

std::optional<Clock::time_point> Wall::next_deadline() const {
    std::optional<Clock::time_point> out;
    const auto consider = [&](std::optional<Clock::time_point> deadline) {
        if (deadline && (!out || *deadline < *out)) out = deadline;
    };
    for (const auto& [id, session] : sessions_) {
        if (session.group && !session.group->all_came()) consider(session.opened + kMembersLimit);
        if (session.awaited > 0) consider(session.awaited_until);
        if (const auto missed = session.group ? session.group->first_missed() : std::nullopt) consider(missed->first);
        for (const auto& [surface_id, surface] : session.surfaces) consider(surface.swap.deadline());
    }
    for (const auto& [id, session] : returning_) consider(session.until);
    for (const auto& [node, until] : missed_) consider(until);
    if (moving_) consider(moving_->until);
    return out;
}

void Wall::tick(Clock::time_point now) {
    for_each_surface([&](const SurfaceKey& key, SurfaceEntry& surface) { present(key, surface.swap.tick(now), now); });
    end_overdue_groups(now);
    for (const auto& [node, until] : std::map(missed_))
        if (now >= until) tell_gone(node);
    end_waiting_for_sessions(now);
    go_on_moving(now);
}

// ---- inside ----

SessionEntry* Wall::find(SessionId id) {
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? nullptr : &found->second;
}

SurfaceEntry* Wall::find(SurfaceId surface, SessionId session) {
    return const_cast<SurfaceEntry*>(find(SurfaceKey{session, surface}));
}

const SurfaceEntry* Wall::find(const SurfaceKey& key) const {
    const auto session = sessions_.find(key.session);
    if (session == sessions_.end()) return nullptr;
    const auto found = session->second.surfaces.find(key.surface);
    return found == session->second.surfaces.end() ? nullptr : &found->second;
}

void Wall::want(const SurfaceKey& key, const geom::Rect& rect) {
    auto& surface = *find(key.surface, key.session);
    surface.place.want(rect);
    tell_note(key);
    if (find(key.session)->group) propose(key);
    else send_placement(key, surface);
}

void Wall::present(const SurfaceKey& key, const Presents& presents, Clock::time_point now) {
    // The nodes that it comes to stack it before they show its first frame there, those that it leaves take it away.
    auto& surface = *find(key.surface, key.session);
    if (surface.place.presented(surface.swap.presented())) send_stacking();
    for (const auto& [node, frame] : presents) {
        proto::Present message;
        message.set_session(key.session.value);
        message.set_surface(key.surface.value);
        message.set_frame(frame);
        out_.to_node(node, make(&proto::Envelope::mutable_present, message));
        ++counters_.presents;
        for (const auto& tile : nodes_[node].config->tiles) {
            if (!geom::overlaps(tile.rect, surface.place.shown())) continue;
            TileShown& shown = nodes_[node].shown[tile.slot];
            ++shown.frames;
            shown.last = now;
        }
    }
    go_on_moving(now);
}

std::optional<NodeIndex> Wall::node_of_tile(std::string_view name) const {
    for (const NodeIndex i : nodes_.ids())
        for (const auto& tile : nodes_[i].config->tiles)
            if (tile.name == name && !tile.arriving) return i;
    return std::nullopt;
}

std::uint32_t Wall::tile_lag(NodeIndex node, const config::TileConfig& tile) const {
    std::uint32_t most = 0;
    for (const auto& key : stacking_) {
        const auto& surface = *find(key);
        if (geom::overlaps(tile.rect, surface.place.shown())) most = std::max(most, surface.swap.behind(node));
    }
    return most;
}

proto::Placement Wall::placement_of(const SurfaceKey& key, const SurfaceEntry& surface) const {
    proto::Placement placement;
    placement.set_surface(key.surface.value);
    placement.set_layout_version(surface.place.version());
    *placement.mutable_rect() = to_proto(surface.place.wanted());
    if (const auto& stereo = sessions_.at(key.session).stereo) *placement.mutable_stereo() = *stereo;
    return placement;
}

void Wall::send_placement(const SurfaceKey& key, const SurfaceEntry& surface) {
    out_.to_client(key.session, make(&proto::Envelope::mutable_placement, placement_of(key, surface)));
}

/// Only what lies on the node: it must not show a window that has moved away, of which it gets no further frame.
proto::Envelope Wall::stacking_message(NodeIndex node) const {
    proto::Stacking stacking;
    for (const auto& key : stacking_) {
        if (!nodes_under(find(key)->place.shown()).contains(node)) continue;
        auto* entry = stacking.add_entries();
        entry->set_session(key.session.value);
        entry->set_surface(key.surface.value);
        entry->set_held(find(key)->swap.held());
    }
    for (const auto& [id, session] : returning_) stacking.add_returning(id.value);
    for (const auto& [id, session] : sessions_)
        if (session.awaited > 0) stacking.add_returning(id.value);
    return make(&proto::Envelope::mutable_stacking, stacking);
}

void Wall::send_stacking() {
    number_stacking();
    for (const NodeIndex i : nodes_.ids()) {
        if (nodes_[i].up) out_.to_node(i, stacking_message(i));
    }
}

void Wall::to_all_nodes(const proto::Envelope& message) {
    for (const NodeIndex i : nodes_.ids()) {
        if (nodes_[i].up) out_.to_node(i, message);
    }
}

void Wall::for_each_surface(const std::function<void(const SurfaceKey&, SurfaceEntry&)>& visit) {
    for (auto& [id, session] : sessions_) {
        for (auto& [surface_id, surface] : session.surfaces) visit({id, surface_id}, surface);
    }
}

}  // namespace wall::walld
