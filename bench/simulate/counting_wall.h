// SPDX-License-Identifier: MIT
// Any number of a wall's nodes in one process, which draw nothing: they take programs' streams as nodes do, count what
// comes, and say at once that each frame is drawn. walld, the client library and the program see a wall of that many
// nodes, so what is counted is what the real router sends. One executor, one thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bench/simulate/traffic_count.h"
#include "common/base/id_vector.h"
#include "common/net/control_connection.h"
#include "common/wire/frame.h"
#include "proto/control.pb.h"

namespace wall::simulate {

namespace asio = boost::asio;

/// What one process of a program has sent one node for one frame.
struct FrameTraffic {
    SessionId session;
    std::uint32_t rank = 0;
    NodeIndex node;
    SurfaceId surface;
    std::uint32_t frame = 0;
    std::uint64_t link_bytes = 0;  ///< all that came over the stream, coded or not
    Traffic traffic;
};

class CountingWall {
public:
    struct Events {
        std::function<void(const FrameTraffic&)> frame;
        /// Somebody waits for an answer, which is an empty one: for a program that needs it the count is of no use.
        std::function<void(const std::string& command)> question;
        std::function<void(const std::string& why)> failed;  ///< what is counted from here on is of no use
    };

    /// Nodes of these names. All have one socket for streams, `listen`; tickets tell whose a stream is.
    static Result<std::unique_ptr<CountingWall>> open(asio::any_io_executor executor, const net::Address& walld,
                                                      const net::Address& listen, std::vector<std::string> names,
                                                      proto::GlCaps caps, Events events);
    ~CountingWall();
    void start();
    void stop();

private:
    struct Node {
        std::string name;
        std::shared_ptr<net::ControlConnection> link;
    };
    struct Admitted {
        NodeIndex node;
        SessionId session;
        std::uint32_t members = 1;  ///< of a parallel program
    };
    struct Peer;
    /// A frame of one node that some members of a parallel program have ended.
    struct FrameOfGroup {
        NodeIndex node;
        SessionId session;
        SurfaceId surface;
        std::uint32_t frame = 0;
        auto operator<=>(const FrameOfGroup&) const = default;
    };
    CountingWall(asio::any_io_executor executor, net::Address walld, net::Listener listener,
                 std::vector<std::string> names, proto::GlCaps caps, Events events);
    asio::awaitable<void> connect();
    asio::awaitable<void> hear(NodeIndex node);
    asio::awaitable<void> ping();
    asio::awaitable<void> serve(std::shared_ptr<Peer> peer);
    asio::awaitable<Result<Admitted>> greet(Peer& peer, std::uint32_t& rank);
    /// The member that `peer` is has ended it; all hear of it when the last one has.
    void ended(const std::shared_ptr<Peer>& peer, const FrameOfGroup& frame, std::uint32_t members);
    void say(const std::shared_ptr<Peer>& peer, wire::FrameKind kind, std::span<const std::byte> payload);
    asio::awaitable<void> write(std::shared_ptr<Peer> peer);
    proto::Envelope hello(const std::string& name) const;
    void take(NodeIndex node, const proto::Envelope& envelope);

    asio::any_io_executor executor_;
    const net::Address walld_;
    net::Listener listener_;
    IdVector<NodeIndex, Node> nodes_;
    const proto::GlCaps caps_;
    const Events events_;
    std::map<std::string, Admitted> tickets_;
    std::set<std::shared_ptr<Peer>> peers_;
    std::map<FrameOfGroup, std::vector<std::shared_ptr<Peer>>> waiting_;
    bool stopping_ = false;
};

}  // namespace wall::simulate
