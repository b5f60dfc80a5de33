// SPDX-License-Identifier: MIT
// The I/O side of a node: the link to walld (made again for ever), the listener for clients, and the bridge to and from
// the render thread. I/O thread; the render thread's reports are posted over.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "common/config/wall_config.h"
#include "common/daemon/keep_running.h"
#include "common/net/control_connection.h"
#include "tileserver/io/burst_watch.h"
#include "tileserver/io/data_stream.h"
#include "tileserver/io/part_sender.h"
#include "tileserver/io/peer_links.h"
#include "tileserver/io/shut_out.h"
#include "tileserver/io/tile_streams.h"
#include "tileserver/io/walld_watch.h"
#include "tileserver/render/render_thread.h"
#include "tileserver/render/turn_watch.h"

namespace wall::tileserver {

/// A walld of another machine.
struct JoinedWall {
    net::Address walld;
    tls::Fingerprint walld_key;
};

/// What a node has for links between machines; nothing: it lives on walld's.
struct NodeKeys {
    std::shared_ptr<const tls::TlsContext> tls;  ///< null: nobody beyond this machine is let in
    std::optional<JoinedWall> joined;            ///< none: the first address of [control]; needs `tls`
};

/// Told what walld goes by, a wall.toml. True: this node is described otherwise now, and is to start anew.
using Described = std::function<bool(const std::string& wall_toml)>;

class NodeServer final : private StreamHost, private NodeEvents {
public:
    /// Opens the driver and the listener; the error says what stands in the way. `compilers`, which outlives it, for
    /// trials of shaders; null: they are compiled without limits.
    static Result<std::unique_ptr<NodeServer>> open(asio::any_io_executor executor, const config::WallConfig& wall,
                                                    const config::NodeConfig& node,
                                                    const CompilerHost* compilers = nullptr, NodeKeys keys = {},
                                                    Described described = {});
    ~NodeServer() override;

    /// Starts to accept clients and to look for walld.
    void start();
    /// Closes everything; the executor runs out of work soon.
    void stop();

    const net::Address& address() const { return listener_->address(); }
    /// When the render thread last said something; it does about once a second.
    std::chrono::steady_clock::time_point last_sign_of_life() const { return last_stats_; }
    /// How long one turn of a stream may take, that is, one call of the driver; then its session is ended. Before
    /// start().
    void set_longest_turn(std::chrono::milliseconds limit) { turn_watch_ = TurnWatch(limit); }
    /// How many connections may be there that have shown no ticket; the oldest of more is closed. Before start().
    void set_most_strangers(std::size_t most) { most_strangers_ = most; }
    /// Why the node cannot go on; none: it can.
    const std::optional<std::string>& failure() const { return failure_; }
    /// It is described otherwise now.
    bool starts_anew() const { return starts_anew_; }

private:
    static constexpr std::size_t kMaxHandshakes = 256;  ///< at the same time

    NodeServer(asio::any_io_executor executor, const config::WallConfig& wall, std::string name, NodeKeys keys,
               Described described);

    // StreamHost
    const Admission* admission(SessionId session) const override;
    std::optional<std::chrono::seconds> shut_out(SessionId session) const override {
        return shut_out_.wait(session, ShutOut::Clock::now());
    }
    RenderThread& render() override { return *render_; }
    void stream_bytes(std::size_t bytes) override { bytes_received_ += bytes; }
    void stream_open(StreamId stream) override { strangers_.erase(stream); }
    DataStream* stream(StreamId id) override;
    void end_earlier(const DataStream& stream) override;
    DataStream* program_stream(SessionId session) override;
    asio::awaitable<void> hand_on(SessionId session, NodeIndex to, std::uint32_t number, RawBytes piece) override {
        return peer_links_.hand_on(session, to, number, std::move(piece));
    }
    void lose_parcels(SessionId session, NodeIndex from) override;
    void stream_closed(StreamId stream) override {
        strangers_.erase(stream);
        streams_.erase(stream);
    }
    // NodeEvents: from the render thread
    void reply(StreamId stream, RequestId request, std::vector<std::byte> answer) override;
    void drawn(StreamId stream, SurfaceId surface, std::uint32_t frame) override;
    void rendered(SessionId session, SurfaceId surface, std::uint32_t frame) override;
    void frames(SessionId session, SurfaceId surface, std::uint32_t drawn, std::uint32_t shown) override;
    void failed(StreamId stream, SessionId session, std::string reason) override;
    void ended(StreamId stream, std::string reason) override;
    void picture(Picture picture) override;
    void partial(SessionId session, NodeIndex to, std::vector<std::byte> message) override;
    void tiles_taken(std::uint32_t version) override;
    void stats(const RenderStats& stats) override;
    void scaled(const ScaledTile& tile) override;
    void monitor(const MonitorNews& news) override;
    void output_lost(std::string reason) override;

    void keep(const char* name, asio::awaitable<void> (NodeServer::*work)());
    asio::awaitable<void> take_over_tls(net::StreamSocket socket);
    void take_client(net::Stream connection);
    void make_room_for_stranger();
    asio::awaitable<Result<std::shared_ptr<net::ControlConnection>>> connect();
    asio::awaitable<void> keep_link();
    asio::awaitable<void> watch_turns();
    void blame(const RunningTurn& turn);
    /// `ends`: the session shall go, not only the stream.
    void fault(StreamId stream, SessionId session, const std::string& reason, bool ends);
    asio::awaitable<void> watch_walld();
    asio::awaitable<void> use_link(std::shared_ptr<net::ControlConnection> link);
    void drop_link();
    proto::Envelope hello() const;
    void handle(const proto::Envelope& envelope);
    void set_stacking(const proto::Stacking& stacking);
    void walld_answers();
    void welcome(const proto::NodeWelcome& welcome);
    void admit(const proto::Ticket& ticket);
    void set_peers(const proto::Peers& peers);
    void not_handed_on(SessionId session, NodeIndex to);
    void end_session(SessionId session);
    void to_walld(const proto::Envelope& envelope);
    void post(std::function<void()> task);
    void give_memory_back();

    asio::any_io_executor executor_;
    NodeKeys keys_;
    std::size_t handshakes_ = 0;
    net::Address walld_;
    std::string walld_user_;
    std::string name_;
    std::optional<net::Listener> listener_;
    std::shared_ptr<net::ControlConnection> link_;  // null: walld is away
    asio::steady_timer retry_, turn_timer_;
    TurnWatch turn_watch_{std::chrono::seconds(10)};
    ShutOut shut_out_;
    bool stopping_ = false, said_unreachable_ = false;
    asio::steady_timer watch_timer_;
    WalldWatch watch_;
    bool welcomed_ = false;  // by the walld of this link
    std::uint64_t started_us_;
    struct Stacked {
        StackEntry window;
        bool held = false;
    };
    std::vector<Stacked> stacking_;  // bottom first
    proto::WallNote wall_note_;      // kept for the walld that comes after this one
    std::unordered_map<SessionId, Admission> admissions_;
    std::map<StreamId, std::shared_ptr<DataStream>> streams_;
    std::set<StreamId> strangers_;  // those of them that have shown no ticket; ids grow
    std::size_t most_strangers_ = 1024;
    std::uint32_t last_stream_ = 0;
    std::uint64_t bytes_received_ = 0;
    BurstWatch burst_;
    std::optional<std::string> failure_;
    Described described_;
    bool starts_anew_ = false;
    bool refused_ = false;  // by walld, on this link
    std::chrono::steady_clock::time_point last_stats_ = std::chrono::steady_clock::now();
    PartSender parts_;
    PeerLinks peer_links_;
    std::map<SessionId, std::set<NodeIndex>> peers_told_;  // by the walld of this link
    TileStreams tile_streams_;
    std::unique_ptr<RenderThread> render_;  // last: it is gone before what it reports to
};

}  // namespace wall::tileserver
