// SPDX-License-Identifier: MIT
// The shell around the wall: control connections of nodes, clients and operators. What a peer is, its first message
// says. One thread; a coroutine a connection.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "common/daemon/changed.h"
#include "common/net/control_connection.h"
#include "common/net/reply_parts.h"
#include "walld/control/description_desk.h"
#include "walld/control/identity.h"
#include "walld/control/machine_desk.h"
#include "walld/control/operator_desk.h"
#include "walld/control/who_is_there.h"
#include "walld/streams/snapshot_desk.h"
#include "walld/streams/stream_hub.h"
#include "walld/wall/quota.h"
#include "walld/wall/wall.h"

namespace wall::walld {

namespace asio = boost::asio;

class ControlServer : public Outbox, public MachineLinks, public NodeLinks {
public:
    static constexpr std::chrono::seconds kHelloLimit{5};  ///< a peer that has not said what it is by then is cut off
    static constexpr std::chrono::seconds kNodeLimit{4};   ///< how long a program waits for nodes while the wall starts
    /// A killed program whose connection lives on in a child is noticed, and a node that has fallen silent.
    static constexpr std::chrono::seconds kPidCheck{1};
    /// A node says something many times a second; one that has not for so many checks is away. They are counted, so
    /// that a walld that stood still itself has missed nothing.
    static constexpr unsigned kSilentChecks = 15;
    /// So many without a word, and operators see that the link may be dead: nodes say something each second at least,
    /// programs each two.
    static constexpr unsigned kQuietNode = 2, kQuietProgram = 3;

    /// `description`: what `file` says now. `state`: where layouts are kept; empty: nowhere.
    ControlServer(asio::any_io_executor executor, Description description, WallFile file, Identities identities,
                  WalldKeys keys, const std::string& state);

    /// Starts to listen everywhere that the configuration says.
    Result<void> listen();
    /// Closes everything.
    void stop();

    const Wall& wall() const { return wall_; }
    const Identities& identities() const { return identities_; }
    WhoIsThere& who_is_there() { return who_; }
    OperatorDesk& operators() { return operators_; }
    DescriptionDesk& description() { return description_; }
    StreamHub& streams() { return streams_; }
    std::vector<net::Address> addresses() const;

    void to_node(NodeIndex node, const proto::Envelope& message) override;
    void to_client(SessionId session, const proto::Envelope& message) override;
    void to_member(SessionId session, Rank rank, const proto::Envelope& message) override;
    void end_session(SessionId session, const std::string& reason) override;

    std::set<tls::Fingerprint> connected() const override;
    void cut(const tls::Fingerprint& key, const std::string& reason) override;
    void let_go(NodeIndex node, const std::string& reason) override;

private:
    using Connection = std::shared_ptr<net::ControlConnection>;

    struct NodeLink {
        Connection connection;
        Person who;
        unsigned silent_checks = 0;  ///< since its last message
    };
    void keep(const char* name, asio::awaitable<void> (ControlServer::*work)());
    void take(net::Stream stream);
    asio::awaitable<void> take_over_tls(net::StreamSocket socket);
    asio::awaitable<void> serve(Connection connection);
    void turn_away(const Connection& connection, const Person& who, const std::string& reason);
    asio::awaitable<void> serve_first(Connection connection, proto::Envelope first, Person who, Quota::Place place);
    asio::awaitable<void> serve_machine(Connection connection, Quota::Place place);
    asio::awaitable<void> serve_node(Connection connection, proto::NodeHello hello, const Person& who,
                                     Quota::Place place);
    Result<NodeIndex> admit_node(const Connection& connection, const proto::NodeHello& hello, const Person& who);
    void drop_node(NodeIndex node, const std::string& reason, bool link_lost = false);
    bool serves(NodeIndex node, const Connection& connection) const;
    asio::awaitable<void> serve_client(Connection connection, proto::ClientHello hello, Person who, Quota::Place place);
    asio::awaitable<void> serve_operator(Connection connection, proto::Envelope first, Person who);
    asio::awaitable<void> answer_operator(Connection connection, proto::OperatorRequest request, Person who,
                                          Quota::Place place);
    asio::awaitable<void> serve_watch(Connection connection, proto::OperatorRequest request, Person who);
    asio::awaitable<void> serve_recording(Connection connection, proto::OperatorRequest request, Asked asked,
                                          Answer begun);
    asio::awaitable<void> send_answer(Connection connection, std::uint32_t number, Outcome<Answer> answer);
    asio::awaitable<void> send_parts(Connection connection, net::ReplyParts parts);
    Clock::time_point next_deadline() const;
    asio::awaitable<void> run_deadlines();
    asio::awaitable<void> watch_peers();
    void watch_nodes();
    void watch_programs();
    asio::awaitable<Result<proto::Envelope>> first_message(Connection connection, std::string from);
    asio::awaitable<void> wait_for_nodes();

    Outcome<void> welcome(const proto::ClientHello& hello, Person& who) const;
    Outcome<Person> may_watch(const Person& who, const std::string& token) const;
    Result<void> node_says(NodeIndex node, proto::Envelope& message);
    using ClientId = std::pair<SessionId, Rank>;  // rank 0 without a parallel program

    Result<void> client_says(const ClientId& client, const proto::Envelope& message);
    bool serves(const ClientId& client, const Connection& connection) const;
    void give_way(const proto::Resume& resume, Rank rank);
    /// `over`: a session that was to go on never will.
    void refuse(const Connection& connection, const std::string& reason, bool over = false);
    void something_changed();

    asio::any_io_executor executor_;
    net::Changed changed_;
    Quota peers_{kPeerConnections}, requests_{kRequests};
    Quota handshakes_{kHandshakes};
    Identities identities_;
    WhoIsThere who_;
    Wall wall_;
    MachineDesk machines_;
    SnapshotDesk snapshots_;
    StreamHub streams_;
    DescriptionDesk description_;
    OperatorDesk operators_;
    std::vector<std::unique_ptr<net::Listener>> listeners_;
    std::map<NodeIndex, NodeLink> nodes_;
    struct ClientLink {
        Connection connection;
        unsigned silent_checks = 0;
    };
    std::map<ClientId, ClientLink> clients_;
    std::map<net::ControlConnection*, std::weak_ptr<net::ControlConnection>> all_;
    asio::steady_timer deadline_timer_;
    std::uint64_t tiles_moved_ = 0;  // of wall_, as streams know it
    asio::steady_timer process_timer_;
    Clock::time_point started_ = Clock::now();
    bool stopping_ = false;
};

}  // namespace wall::walld
