// SPDX-License-Identifier: MIT
// Everything walld knows: nodes, sessions, surfaces, their stacking. Pure: the daemon's shell tells it what came and
// carries out what it says through an Outbox. Times are parameters. One thread.
//
//   node:    away -> up (hello) -> away (connection lost) -> up, incarnation + 1 if the process is another one
//   session: open (hello, at least one node up) -> ended (connection lost, process gone, closed by an operator)
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/config/wall_config.h"
#include "proto/control.pb.h"
#include "walld/swap_coordinator.h"

namespace wall::walld {

using NodeIndex = std::uint32_t;

/// Where the wall's decisions go. Called from within the wall's functions; must not call back into it.
class Outbox {
public:
    virtual ~Outbox() = default;
    virtual void to_node(NodeIndex node, const proto::Envelope& message) = 0;
    virtual void to_client(SessionId session, const proto::Envelope& message) = 0;
};

struct Node {
    const config::NodeConfig* config = nullptr;
    bool up = false;
    std::uint32_t incarnation = 0;  ///< 0: never seen
    proto::NodeHello hello;         ///< of the last connection
    proto::NodeStats stats;
};

struct SurfaceKey {
    SessionId session;
    SurfaceId surface;
    auto operator<=>(const SurfaceKey&) const = default;
};

struct Surface {
    std::uint32_t width = 0, height = 0;  ///< the program's window
    std::string title;
    geom::Rect rect;                      ///< on the canvas
    bool scaled = false;                  ///< the rectangle was given; else it follows the window's size
    bool wanted_rect = false;             ///< it is the session's WALLGL_RECT window
    std::uint32_t layout_version = 1;
    SwapCoordinator swap;
};

struct Session {
    std::uint32_t pid = 0;
    std::string program, name;
    std::optional<geom::Rect> rect;  ///< asked for; fullscreen: the canvas
    bool held = false;
    std::string fault;               ///< what a node said against its stream
    std::map<NodeIndex, std::string> tickets;
    std::map<SurfaceId, Surface> surfaces;
};

/// What an operator points at: a session, or one of its surfaces.
struct Target {
    SessionId session;
    SurfaceId surface;  ///< none: the session's topmost
    /// "3" or "3.1".
    static Result<Target> parse(std::string_view text);
};

struct Counters {
    std::uint64_t sessions = 0, presents = 0, faults = 0;
};

class Wall {
public:
    static constexpr std::size_t kTicketBytes = 16;
    using RandomBytes = std::function<std::string(std::size_t)>;

    Wall(config::WallConfig config, Outbox& out, RandomBytes random);

    Wall(const Wall&) = delete;
    Wall& operator=(const Wall&) = delete;

    // ---- nodes ----
    Result<NodeIndex> node_joins(const proto::NodeHello& hello, Clock::time_point now);
    void node_leaves(NodeIndex node, Clock::time_point now);
    void node_rendered(NodeIndex node, const proto::Rendered& report, Clock::time_point now);
    void node_faults(NodeIndex node, const proto::SessionFault& report);
    void node_reports(NodeIndex node, const proto::NodeStats& stats) { nodes_[node].stats = stats; }

    // ---- clients ----
    bool any_node_up() const;
    /// Why this program cannot be taken, if so.
    static Result<void> check(const proto::ClientHello& hello);
    /// Needs a node that is up and a hello that was checked. The welcome goes to the session's client; the id is known before any message is sent.
    SessionId open_session(const proto::ClientHello& hello, const std::function<void(SessionId)>& before_welcome);
    void close_session(SessionId id);
    Result<void> open_surface(SessionId id, const proto::SurfaceOpen& message, Clock::time_point now);
    /// Always answered with a Placement.
    void resize_surface(SessionId id, const proto::SurfaceResize& message, Clock::time_point now);
    void close_surface(SessionId id, SurfaceId surface);

    // ---- operators ----
    Result<void> place_surface(const Target& target, const geom::Rect& rect, Clock::time_point now);
    Result<void> raise(const Target& target);
    Result<void> lower(const Target& target);
    Result<void> ask_to_close(const Target& target);
    Result<void> hold(const Target& target, bool on, Clock::time_point now);
    Result<void> step(const Target& target, std::uint32_t frames, Clock::time_point now);
    Result<SurfaceKey> resolve(const Target& target) const;

    // ---- time ----
    std::optional<Clock::time_point> next_deadline() const;
    void tick(Clock::time_point now);

    // ---- views ----
    const config::WallConfig& config() const { return config_; }
    const std::vector<Node>& nodes() const { return nodes_; }
    const std::map<SessionId, Session>& sessions() const { return sessions_; }
    const std::vector<SurfaceKey>& stacking() const { return stacking_; }  ///< bottom first
    const Surface* find(const SurfaceKey& key) const;
    const Counters& counters() const { return counters_; }

private:
    Session* find(SessionId id);
    Surface* find(SurfaceId surface, SessionId session);
    proto::NodeUp node_up_message(NodeIndex node, const std::string& ticket) const;
    void welcome_node(NodeIndex node);
    void welcome_client(SessionId id, const Session& session);
    void hand_out_ticket(SessionId id, Session& session, NodeIndex node);
    std::set<NodeIndex> nodes_under(const geom::Rect& rect) const;
    geom::Rect first_rect(Session& session, Surface& surface, std::uint32_t number) const;
    void move(const SurfaceKey& key, const geom::Rect& rect, Clock::time_point now);
    void present(const SurfaceKey& key, const Presents& presents);
    void send_placement(const SurfaceKey& key, const Surface& surface);
    void send_stacking();
    void to_all_nodes(const proto::Envelope& message);
    proto::Envelope stacking_message(NodeIndex node) const;
    Result<std::vector<SurfaceKey>> surfaces_of(const Target& target) const;
    void for_each_surface(const std::function<void(const SurfaceKey&, Surface&)>& visit);

    config::WallConfig config_;
    Outbox& out_;
    RandomBytes random_;
    std::vector<Node> nodes_;
    std::map<SessionId, Session> sessions_;
    std::vector<SurfaceKey> stacking_;
    std::uint32_t last_session_ = 0;
    std::uint32_t windows_placed_ = 0;  ///< of cascades
    Counters counters_;
};

}  // namespace wall::walld
