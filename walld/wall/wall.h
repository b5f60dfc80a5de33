// SPDX-License-Identifier: MIT
// Everything walld knows: nodes, sessions, surfaces, their stacking. Pure: the daemon's shell tells it what came and
// carries out what it says through an Outbox. Times are parameters. One thread.
//
//   node:    away -> up (hello) -> away (connection lost) -> up, incarnation + 1 if the process is another one
//   session: open (hello, at least one node up) -> ended (connection lost, process gone, closed by an operator)
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/id_vector.h"
#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/config/wall_config.h"
#include "common/wire/weights.h"
#include "proto/control.pb.h"
#include "walld/wall/layout.h"
#include "walld/wall/parallel_group.h"
#include "walld/wall/person.h"
#include "walld/wall/placement_track.h"
#include "walld/wall/session_traffic.h"
#include "walld/wall/swap_coordinator.h"
#include "walld/wall/tile_balance.h"

namespace wall::walld {

/// Where the wall's decisions go. Called from within the wall's functions; must not call back into it.
class Outbox {
public:
    virtual ~Outbox() = default;
    virtual void to_node(NodeIndex node, const proto::Envelope& message) = 0;
    /// To all processes of the session.
    virtual void to_client(SessionId session, const proto::Envelope& message) = 0;
    /// To one process of a parallel program.
    virtual void to_member(SessionId session, Rank rank, const proto::Envelope& message) = 0;
    /// The session's processes are told why, and are cut off.
    virtual void end_session(SessionId session, const std::string& reason) = 0;
};

/// A tile as walld knows it to be shown.
struct TileShown {
    std::uint64_t frames = 0;  ///< of its windows, since walld started
    std::optional<Clock::time_point> last;
};

enum class Duty {
    serves,
    drained,  ///< an operator has taken it off the wall: programs leave it alone, and its tiles stay
    gone,     ///< not in wall.toml any more; its number stays free for it
};

/// What its tiles take of a node's time, as far as it is measured.
struct TileTimes {
    proto::NodeStats first;                 ///< of the window that is measured now
    std::map<std::uint32_t, double> loads;  ///< by slot, 0 to 1, in the last window
    bool known = false;                     ///< since loads were used last
};

/// A tile on its way to another GPU.
struct TileMove {
    std::string tile;
    NodeIndex from, to;
    std::vector<std::uint32_t> slots;  ///< its own, and that of its right eye's picture
    Clock::time_point until;
    bool told = false;  ///< to programs
};

struct Node {
    /// Of the tile in that slot.
    TileShown shown_in(std::uint32_t slot) const {
        const auto found = shown.find(slot);
        return found == shown.end() ? TileShown{} : found->second;
    }

    std::shared_ptr<const config::NodeConfig> config;
    Duty duty = Duty::serves;
    bool up = false;                  ///< programs may use it
    bool silent = false;              ///< its link may be dead
    bool described_anew = false;      ///< since it came last: what it has of sessions is for other tiles
    std::uint32_t tiles_version = 0;  ///< of the tiles that it was told last
    std::uint32_t incarnation = 0;    ///< 0: never seen
    proto::NodeHello hello;           ///< of the last connection
    proto::NodeStats stats;           ///< the last that this process has told
    std::optional<std::chrono::milliseconds> clock_ahead;  ///< of walld's, when they came
    TileTimes times;
    std::map<std::uint32_t, TileShown> shown;  ///< by slot; none: it has shown nothing yet
};

struct SurfaceKey {
    SessionId session;
    SurfaceId surface;
    auto operator<=>(const SurfaceKey&) const = default;
};

struct SurfaceEntry {
    std::uint32_t width = 0, height = 0;  ///< the program's window
    std::string title;
    std::optional<proto::NativeWindow> native;                  ///< the program's own
    PlacementTrack place;                                       ///< on the canvas
    enum class Views { none, seen, flat } views = Views::none;  ///< how tiles show it that look elsewhere
    bool scaled = false;                  ///< the rectangle was given; else it follows the window's size
    bool wanted_rect = false;             ///< it is the session's WALLGL_RECT window
    bool cannot_close = false;            ///< its program has no way to be asked
    std::uint64_t order = 0;              ///< in the stacking: what has a higher one lies above
    std::string note;                     ///< what its program keeps of it for the next walld
    std::optional<std::size_t> layout_z;  ///< its place in the stacking of the layout that placed it
    AgreedPlacements agreed;              ///< of a parallel program
    /// Of one that an earlier walld had, until all processes are back: the newest version that they know.
    std::optional<std::uint32_t> returning;
    std::uint32_t wanted_version = 0;  ///< then: of where it was wanted, as far as they have told
    SwapCoordinator swap;
};

/// A window as this walld knew it when the link to its program was lost: what was asked for since then, and may have
/// gone with the link, is in it.
struct LastKnown {
    std::string note;
    geom::Rect wanted;
};

/// Who keeps a session's commands in a file.
struct Recorder {
    NodeIndex node;  ///< its program's name for it
    std::uint32_t incarnation = 0;
    std::string address, ticket;
};

struct SessionEntry {
    std::uint32_t pid = 0;  ///< of a parallel program's first member
    std::string program, name;
    std::optional<ParallelGroup> group;
    std::map<NodeIndex, std::uint32_t> group_nodes;  ///< the members connect to at first: incarnations
    Clock::time_point opened;
    Person owner;
    std::optional<geom::Rect> rect;  ///< asked for; fullscreen: the canvas
    bool fullscreen = false;
    bool held = false;
    bool sort_last = false;  ///< its geometry may be dealt to nodes
    float lossy_pixels = 0;  ///< how far its vertices may lie from where they belong
    std::string fault;       ///< what a node said against its stream
    std::uint32_t weight = wire::kUsualWeight;
    std::optional<proto::Stereo> stereo;  ///< of its pictures for two eyes; none: both see the same
    bool silent = false;                  ///< its link may be dead, or somebody has stopped it
    std::uint32_t awaited = 0;            ///< windows that it still has to announce, of a session that goes on
    Clock::time_point awaited_until;
    std::map<SurfaceId, LastKnown> awaited_windows;  ///< those of them that this walld knows
    std::map<NodeIndex, std::string> tickets;
    std::map<SurfaceId, SurfaceEntry> surfaces;
    SessionTraffic traffic;
    std::optional<Recorder> recorder;  ///< it is recorded as commands
    std::uint32_t recordings = 0;      ///< so far
};

/// What an operator points at: a session, or one of its surfaces.
struct Target {
    SessionId session;
    SurfaceId surface;  ///< none: the session's topmost
    /// "3" or "3.1".
    static Outcome<Target> parse(std::string_view text);
};

struct Counters {
    std::uint64_t sessions = 0, presents = 0, faults = 0;
};

/// Whose program may come again: of an earlier walld, by what the nodes tell of it, or one whose link was lost.
struct ReturningSession {
    std::map<NodeIndex, std::string> tickets;
    std::set<Rank> left;  ///< of a parallel program
    Clock::time_point until;
    std::map<SurfaceId, LastKnown> windows;  ///< of one whose link was lost
};

class Wall {
public:
    static constexpr std::size_t kTicketBytes = 16;
    /// Programs that have not come again by then have lost their session: those of an earlier walld from the first
    /// node on, others from the loss of their link on.
    static constexpr std::chrono::seconds kReturnLimit{10};
    /// For a node whose link was lost to come on another one.
    static constexpr std::chrono::milliseconds kMissedLimit{1500};
    static constexpr std::chrono::seconds kMembersLimit{60};  ///< for all processes of a parallel program to come
    using RandomBytes = std::function<std::string(std::size_t)>;

    Wall(config::WallConfig config, Outbox& out, RandomBytes random);

    Wall(const Wall&) = delete;
    Wall& operator=(const Wall&) = delete;

    // ---- nodes ----
    /// Why this process cannot be one of the wall's nodes now, if so. One that is up gives way to itself on another
    /// link, and to a process that was started later.
    Result<NodeIndex> check_node(const proto::NodeHello& hello) const;
    Result<NodeIndex> node_joins(const proto::NodeHello& hello, Clock::time_point now);
    /// `link_lost`: that is all that is known of it. Programs that draw there go on if it is back soon.
    void node_leaves(NodeIndex node, Clock::time_point now, bool link_lost = false);
    void node_rendered(NodeIndex node, const proto::Rendered& report, Clock::time_point now);
    void node_faults(NodeIndex node, const proto::SessionFault& report);
    /// Those of which nothing has been heard for a while, all of them. Gives those that are new among them.
    std::vector<NodeIndex> note_silent(const std::set<NodeIndex>& quiet);
    std::vector<SessionId> note_silent(const std::set<SessionId>& quiet);
    /// Programs may end, if somebody has too much there. `here`: what walld's clock says.
    void node_reports(NodeIndex node, const proto::NodeStats& stats, std::chrono::system_clock::time_point here = {},
                      Clock::time_point now = {});

    // ---- another description (wall_describe.cpp) ----
    /// Nodes of which the wall would have another description.
    std::vector<NodeIndex> described_otherwise(const config::WallConfig& next) const;
    /// The wall is described so from now on. Those nodes must have left. Windows whose place is gone get another one.
    void describe(config::WallConfig next);
    /// It draws for those tiles now: once all nodes do, programs are told.
    void node_took_tiles(NodeIndex node, std::uint32_t version);
    /// It must have left, unless it is away.
    void set_duty(NodeIndex node, Duty duty) { nodes_[node].duty = duty; }
    std::optional<NodeIndex> find_node(std::string_view name) const;
    /// The node of this name, or all of the tileserver of this name, as far as wall.toml has them.
    std::vector<NodeIndex> nodes_called(std::string_view name) const;

    // ---- clients ----
    bool any_node_up() const;
    /// Why this program cannot be taken now, if so.
    Outcome<void> check(const proto::ClientHello& hello) const;
    Outcome<void> check_lossy(float pixels) const;
    /// Why it cannot be taken as this person's process of a parallel program, if so.
    Outcome<void> check_member(const proto::ClientHello& hello, const Person& who) const;
    /// Why this person may have no other program now, if so (wall_quota.cpp).
    Outcome<void> check_quota(const proto::ClientHello& hello, const Person& who) const;
    /// Of a process of a parallel program that an earlier walld had; any other one simply comes.
    enum class Comeback { may_come, not_yet, over };
    Comeback comeback(const proto::ClientHello& hello, Clock::time_point now) const;
    /// Needs a node that is up and a hello that was checked. The welcome goes to the session's client; the id is known
    /// before any message is sent. A parallel program's first member opens it, the others get the same one.
    SessionId open_session(const proto::ClientHello& hello, Person owner, Clock::time_point now,
                           const std::function<void(SessionId)>& before_welcome);
    void close_session(SessionId id);
    /// A process is gone. The session is closed with its last one, and with one that has not left its parallel program:
    /// then the others are cut off. Gives what became of it, for the log.
    std::string member_gone(SessionId id, Rank rank);
    /// Its link is lost, and it may be well: its windows stay in sight until it comes again, or for kReturnLimit
    /// (wall_return.cpp). A program alone is not on the wall meanwhile; a parallel one ends if its process stays away.
    void await_again(SessionId id, Rank rank, Clock::time_point now);
    /// Its program, or a window of it, is not here, and may come again.
    bool awaits(SessionId id) const;
    /// Whether it says that it is this session's program, and knows its ticket.
    bool is_program_of(SessionId id, const proto::Resume& resume) const;
    void member_leaves(SessionId id, Rank rank);
    Result<void> open_surface(SessionId id, const proto::SurfaceOpen& message, Clock::time_point now, Rank rank = 0);
    /// Always answered with a Placement. In a parallel program rank 0 says how large a window is.
    void resize_surface(SessionId id, const proto::SurfaceResize& message, Rank rank = 0);
    void close_surface(SessionId id, SurfaceId surface, Rank rank = 0);
    void placement_noted(SessionId id, Rank rank, const proto::PlacementNoted& message);

    /// The program draws with a placement from a frame on.
    void adopt_placement(SessionId id, const proto::SurfaceAdopted& message, Clock::time_point now);
    void cannot_close(SessionId id, SurfaceId surface);
    void client_reports(SessionId id, Rank rank, const proto::ClientStats& stats, Clock::time_point now);

    // ---- programs that move to other walls (wall_operate.cpp) ----
    /// `address`: of the other wall's control socket, as the program's machine knows it. What it answers is said by
    /// take_move_answer() as soon as it is there: empty when the program has gone.
    Outcome<void> ask_to_move(const Target& target, const std::string& address);
    void move_answered(SessionId id, const proto::MoveAnswer& answer);
    std::optional<std::string> take_move_answer(SessionId id);

    // ---- recordings (wall_recording.cpp) ----
    /// The session's program is to send its commands to this address (common/base/address.h), too, as to a node. Gives
    /// the ticket (kTicketBytes) that it will show there.
    Outcome<std::string> begin_recording(SessionId id, const std::string& address);
    /// Whether that one goes on: its session is there, and no node has come in its place.
    bool is_recorded(SessionId id, const std::string& ticket) const;
    void end_recording(SessionId id, const std::string& ticket);

    // ---- operators (wall_operate.cpp) ----
    Outcome<void> place_surface(const Target& target, const geom::Rect& rect);
    Outcome<void> raise(const Target& target);
    Outcome<void> lower(const Target& target);
    /// Gives the windows that were asked.
    Outcome<std::vector<SurfaceKey>> ask_to_close(const Target& target);
    Outcome<void> hold(const Target& target, bool on, Clock::time_point now);
    Outcome<void> step(const Target& target, std::uint32_t frames, Clock::time_point now);
    /// Of the whole session: 1 to wire::kMostWeight.
    Outcome<void> set_weight(const Target& target, std::uint32_t weight);
    /// How tiles of one eye show the session; nothing: as those of both. A parallel program has one picture.
    Outcome<void> set_stereo(const Target& target, const std::optional<proto::Stereo>& stereo);
    /// What the tile shows instead of programs, also when its node comes anew; of kind NONE: programs again.
    Outcome<void> set_pattern(const std::string& tile, const proto::TilePattern& pattern);
    /// By the tiles' names.
    const std::map<std::string, proto::TilePattern>& patterns() const { return patterns_; }
    Outcome<SurfaceKey> resolve(const Target& target) const;
    /// The one surface named, or all of the session (possibly none), bottom first.
    Outcome<std::vector<SurfaceKey>> surfaces_of(const Target& target) const;
    Layout current_layout() const;
    /// Places and stacks the windows that match, at once; programs that start later get the places left over, until
    /// another layout is loaded. Gives the number of windows placed.
    std::size_t load_layout(const Layout& layout);

    // ---- time ----
    std::optional<Clock::time_point> next_deadline() const;
    void tick(Clock::time_point now);

    // ---- views ----
    const config::WallConfig& config() const { return config_; }
    const IdVector<NodeIndex, Node>& nodes() const { return nodes_; }
    const std::map<SessionId, SessionEntry>& sessions() const { return sessions_; }
    const std::vector<SurfaceKey>& stacking() const { return stacking_; }  ///< bottom first
    const SurfaceEntry* find(const SurfaceKey& key) const;
    const Counters& counters() const { return counters_; }
    /// Grows when another node shows a tile.
    std::uint64_t tiles_moved() const { return tiles_moved_; }
    /// The node that shows it.
    std::optional<NodeIndex> node_of_tile(std::string_view name) const;
    /// The most frames that a node is behind a window on this tile.
    std::uint32_t tile_lag(NodeIndex node, const config::TileConfig& tile) const;

private:
    SessionEntry* find(SessionId id);
    SurfaceEntry* find(SurfaceId surface, SessionId session);
    SurfaceEntry& add_surface(const SurfaceKey& key, const proto::SurfaceOpen& message);
    proto::NodeUp node_up_message(NodeIndex node, const SessionEntry& session) const;
    bool take_nodes();
    void end_crossed_recordings();
    void tell_pattern(NodeIndex node, std::uint32_t slot, const proto::TilePattern& pattern);
    bool take_rest(NodeIndex node, const config::NodeConfig& config);
    void tell_tiles();
    // of several GPUs (wall_balance.cpp)
    bool may_be_balanced(NodeIndex node) const;
    void take_tile_times(NodeIndex node);
    void balance(NodeIndex reporting, Clock::time_point now);
    void describe_node(NodeIndex node, config::NodeConfig config);
    void begin_move(const BetterPlace& better, Clock::time_point now);
    bool move_is_settled() const;
    void go_on_moving(Clock::time_point now);
    void end_move(bool there, Clock::time_point now);
    void add_tiles(google::protobuf::RepeatedPtrField<proto::TileInfo>& out) const;
    geom::Rect place_after_change(const SessionEntry& session, const SurfaceEntry& surface);
    void send_away(const proto::NodeHello& hello, NodeIndex node);
    void welcome_node(NodeIndex node);
    /// `again`: what a member of a parallel program says that comes again.
    void welcome_client(SessionId id, const SessionEntry& session, Rank rank, const proto::Resume& again = {});
    void hand_out_ticket(SessionId id, SessionEntry& session, NodeIndex node);
    bool nodes_reach_each_other() const;
    bool nodes_hand_on(const SessionEntry& session) const;
    bool have_peers(const SessionEntry& session) const;
    void tell_peers(SessionId id, SessionEntry& session);
    void list_peers(SessionId id, const SessionEntry& session);
    proto::Quota quota_of_programs() const;
    void end_who_has_too_much(NodeIndex node);
    std::set<NodeIndex> nodes_under(const geom::Rect& rect) const;
    geom::Rect first_rect(SessionEntry& session, SurfaceEntry& surface, std::uint32_t number);
    SessionId next_session();
    // of a walld that was started again (wall_return.cpp)
    /// The program has been told one of these, which nodes have come with.
    static bool knows_a_ticket(const proto::Resume& resume, const std::map<NodeIndex, std::string>& tickets);
    std::optional<SessionId> resumable(const proto::ClientHello& hello) const;
    void resume_session(SessionId id, SessionEntry& session, const proto::Resume& resume);
    static std::uint64_t order_at(Clock::time_point now);
    bool restore_surface(const SurfaceKey& key, const proto::SurfaceOpen& message, Clock::time_point now, Rank rank);
    geom::Rect restored_wish(const SurfaceEntry& surface, const proto::SurfaceOpen& message, geom::Rect wanted) const;
    void hear_of_sessions(NodeIndex node, const proto::NodeHello& hello, Clock::time_point now);
    void end_waiting_for_sessions(Clock::time_point now);
    void hear_wall_note(NodeIndex node, const proto::WallNote& note);
    void waiting_places_changed();
    proto::Envelope wall_note() const;
    void number_stacking();
    void tell_note(const SurfaceKey& key);
    static proto::SurfaceNote note_of(const SurfaceKey& key, const SurfaceEntry& surface);
    void ask_for_frames(SessionId session);
    WindowName name_of(const SurfaceKey& key) const;
    void stack(const SurfaceKey& key);
    void want(const SurfaceKey& key, const geom::Rect& rect);
    proto::Placement placement_of(const SurfaceKey& key, const SurfaceEntry& surface) const;
    // of parallel programs (wall_group.cpp)
    const std::pair<const SessionId, SessionEntry>* group_of(const proto::ClientHello& hello) const;
    SessionId join_session(SessionId id, const proto::ClientHello& hello,
                           const std::function<void(SessionId)>& before_welcome);
    std::set<NodeIndex> nodes_of(const SessionEntry& session, const geom::Rect& rect) const;
    proto::Placement placement_for_all(const SurfaceKey& key) const;
    void propose(const SurfaceKey& key);
    void settle(const SurfaceKey& key);
    void restore_for_member(const SurfaceKey& key, const proto::SurfaceOpen& message);
    void all_returned(SessionId session);
    void add_nodes(proto::Placement& placement, const SessionEntry& session) const;
    void open_for_member(const SurfaceKey& key, const proto::SurfaceOpen& message, Rank rank);
    static bool closed_by_all(SessionEntry& session, SurfaceEntry& surface, Rank rank);
    void end_overdue_groups(Clock::time_point now);
    void tell_gone(NodeIndex node);
    void present(const SurfaceKey& key, const Presents& presents, Clock::time_point now);
    void send_placement(const SurfaceKey& key, const SurfaceEntry& surface);
    void send_stacking();
    void to_all_nodes(const proto::Envelope& message);
    proto::Envelope stacking_message(NodeIndex node) const;
    void for_each_surface(const std::function<void(const SurfaceKey&, SurfaceEntry&)>& visit);

    config::WallConfig config_;
    std::map<std::string, proto::TilePattern> patterns_;  // by the tiles' names
    Outbox& out_;
    RandomBytes random_;
    IdVector<NodeIndex, Node> nodes_;
    std::map<NodeIndex, Clock::time_point> missed_;  // whose link is lost: programs are not told before then
    std::set<NodeIndex> taking_tiles_;  // have been told of other tiles, and have not said that they draw for them
    bool tiles_untold_ = false;         // to programs
    std::optional<TileMove> moving_;
    std::map<std::string, Clock::time_point> resting_;  // tiles by name: until when they stay where they are
    std::uint64_t tiles_moved_ = 0;
    std::map<SessionId, SessionEntry> sessions_;
    std::vector<SurfaceKey> stacking_;
    SessionId last_session_;
    std::uint32_t windows_placed_ = 0;      ///< of cascades
    std::vector<LayoutEntry> free_places_;  ///< of the layout loaded last
    std::uint64_t places_version_ = 0;      ///< of free_places_
    bool layout_loaded_ = false;            ///< since walld was started
    std::map<SessionId, ReturningSession> returning_;
    std::optional<Clock::time_point> return_until_;  ///< none: no node has come yet
    bool returns_over_ = false;                      ///< nobody is waited for any more
    std::map<SessionId, std::string> move_answers_;  ///< of programs that were asked to move; empty: gone
    std::set<SessionId> ended_;                      ///< until then: sessions that nodes may still have
    Counters counters_;
};

}  // namespace wall::walld
