// SPDX-License-Identifier: MIT
#include "bench/simulate/counting_wall.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstring>
#include <utility>

#include "common/daemon/keep_running.h"
#include "common/net/as_tuple.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"
#include "tileserver/io/frame_source.h"

namespace wall::simulate {
namespace {

constexpr std::uint32_t kMostHello = 4 << 10;  // bytes
constexpr std::chrono::seconds kPingInterval{1};

}  // namespace

/// A stream of a program's process.
struct CountingWall::Peer {
    Peer(net::StreamSocket socket)
        : stream(std::move(socket)), source(stream, kMostHello, [this](std::size_t came) { bytes += came; }) {}
    net::Stream stream;
    std::uint64_t bytes = 0;  ///< that have come since the last frame
    tileserver::FrameSource source;
    std::vector<std::byte> to_say;
    bool writing = false;
};

CountingWall::~CountingWall() = default;

CountingWall::CountingWall(asio::any_io_executor executor, net::Address walld, net::Listener listener,
                           std::vector<std::string> names, proto::GlCaps caps, Events events)
    : executor_(std::move(executor)),
      walld_(std::move(walld)),
      listener_(std::move(listener)),
      caps_(std::move(caps)),
      events_(std::move(events)) {
    for (auto& name : names) nodes_.push_back({std::move(name), nullptr});
}

Result<std::unique_ptr<CountingWall>> CountingWall::open(asio::any_io_executor executor, const net::Address& walld,
                                                         const net::Address& listen, std::vector<std::string> names,
                                                         proto::GlCaps caps, Events events) {
    auto listener = net::Listener::open(executor, listen);
    if (!listener) return tl::unexpected(listener.error());
    return std::unique_ptr<CountingWall>(
        new CountingWall(executor, walld, std::move(*listener), std::move(names), std::move(caps), std::move(events)));
}

void CountingWall::start() {
    const auto take = [this](net::StreamSocket socket) {
        net::spawn(executor_, "stream", serve(std::make_shared<Peer>(std::move(socket))));
    };
    net::keep_accepting(executor_, listener_, take, [this] { return stopping_; });
    net::spawn(executor_, "connect", connect());
    net::spawn(executor_, "ping", ping());
}

void CountingWall::stop() {
    stopping_ = true;
    listener_.close();
    for (const Node& node : nodes_)
        if (node.link) node.link->close();
    for (const auto& peer : peers_) peer->stream.close();
}

// ---- walld ----

proto::Envelope CountingWall::hello(const std::string& name) const {
    proto::Envelope envelope;
    auto& hello = *envelope.mutable_node_hello();
    hello.set_version(wire::kProtocolVersion);
    hello.set_name(name);
    hello.set_address(listener_.address().text());
    hello.set_backend("counting");
    hello.set_pid(static_cast<std::uint32_t>(::getpid()));
    hello.set_started_us(1);
    *hello.mutable_caps() = caps_;
    return envelope;
}

/// One after the other, as quickly as walld takes them: who waits long to be heard there makes room for others.
asio::awaitable<void> CountingWall::connect() {
    for (const NodeIndex node : nodes_.ids()) {
        if (stopping_) co_return;
        auto link = co_await net::ControlConnection::connect(walld_, "*");
        if (!link) co_return events_.failed("no walld: " + link.error().message);
        (*link)->send(hello(nodes_[node].name));
        const auto welcome = co_await (*link)->receive();
        if (!welcome) co_return events_.failed(nodes_[node].name + " has lost walld: " + welcome.error().message);
        nodes_[node].link = *link;
        take(node, *welcome);
        net::spawn(executor_, "link", hear(node));
    }
}

asio::awaitable<void> CountingWall::hear(NodeIndex node) {
    const auto link = nodes_[node].link;
    while (!stopping_) {
        const auto envelope = co_await link->receive();
        if (envelope) take(node, *envelope);
        else if (!stopping_)
            co_return events_.failed(nodes_[node].name + " has lost walld: " + envelope.error().message);
    }
}

void CountingWall::take(NodeIndex node, const proto::Envelope& envelope) {
    switch (envelope.message_case()) {
        case proto::Envelope::kNodeWelcome: {
            proto::Envelope taken;
            taken.mutable_tiles_taken()->set_tiles_version(envelope.node_welcome().tiles_version());
            return nodes_[node].link->send(taken);
        }
        case proto::Envelope::kTicket:
            tickets_[envelope.ticket().ticket()] = {node, SessionId(envelope.ticket().session()),
                                                    std::max(1u, envelope.ticket().members())};
            return;
        case proto::Envelope::kSessionEnd:
            std::erase_if(tickets_, [&](const auto& known) {
                return known.second.node == node && known.second.session.value == envelope.session_end().session();
            });
            return;
        case proto::Envelope::kRefused:
            return events_.failed(nodes_[node].name + " is refused: " + envelope.refused().reason());
        default: return;  // what to show does not matter
    }
}

/// walld takes a node that says nothing for one that hangs.
asio::awaitable<void> CountingWall::ping() {
    proto::Envelope envelope;
    envelope.mutable_ping();
    asio::steady_timer timer(executor_);
    while (!stopping_) {
        for (const Node& node : nodes_)
            if (node.link && node.link->is_open()) node.link->send(envelope);
        timer.expires_after(kPingInterval);
        co_await timer.async_wait(net::kTuple);
    }
}

// ---- programs ----

void CountingWall::say(const std::shared_ptr<Peer>& peer, wire::FrameKind kind, std::span<const std::byte> payload) {
    const auto frame = wire::whole_frame(kind, payload);
    peer->to_say.insert(peer->to_say.end(), frame.begin(), frame.end());
    if (!std::exchange(peer->writing, true)) net::spawn(executor_, "write", write(peer));
}

asio::awaitable<void> CountingWall::write(std::shared_ptr<Peer> peer) {
    while (!peer->to_say.empty()) {
        const auto now = std::exchange(peer->to_say, {});
        const auto [error, sent] = co_await peer->stream.write(asio::buffer(now));
        if (error) co_return;
    }
    peer->writing = false;
}

asio::awaitable<Result<CountingWall::Admitted>> CountingWall::greet(Peer& peer, std::uint32_t& rank) {
    const auto frame = co_await peer.source.next();
    proto::DataHello hello;
    if (!frame || frame->kind != wire::FrameKind::hello ||
        !hello.ParseFromArray(frame->payload.data(), static_cast<int>(frame->payload.size())) ||
        hello.version() != glapi::kStreamVersion)
        co_return wall::fail("a stream without a hello of this version");
    const auto ticket = tickets_.find(hello.ticket());
    if (ticket == tickets_.end()) co_return wall::fail("a stream without a ticket");
    rank = hello.rank();
    peer.source.set_limits(wire::kMaxFramePayload, wire::kMaxBatchPayload);
    peer.bytes = 0;
    co_return ticket->second;
}

asio::awaitable<void> CountingWall::serve(std::shared_ptr<Peer> peer) {
    peers_.insert(peer);
    FrameTraffic now;
    const auto admitted = co_await greet(*peer, now.rank);
    if (!admitted) co_return events_.failed(admitted.error().message);
    now.session = admitted->session;
    now.node = admitted->node;
    const std::uint32_t ends_with_connection = 0;  // and no ring: all comes over the socket
    say(peer, wire::FrameKind::welcome, std::as_bytes(std::span(&ends_with_connection, 1)));
    TrafficCount count;
    for (;;) {
        const auto frame = co_await peer->source.next();
        if (!frame) break;
        if (frame->kind != wire::FrameKind::batch) continue;
        const auto seen = count.look(frame->payload);
        if (!seen) {
            events_.failed(nodes_[now.node].name + ": " + seen.error().message);
            break;
        }
        now.traffic += seen->traffic;
        for (const auto& question : seen->questions) {
            events_.question(question.name);
            say(peer, wire::FrameKind::reply, std::as_bytes(std::span(&question.request, 1)));
        }
        for (const auto& swap : seen->swaps) {
            now.surface = swap.surface;
            now.frame = swap.frame;
            now.link_bytes = std::exchange(peer->bytes, 0);
            events_.frame(now);
            now.traffic = {};
            ended(peer, {now.node, now.session, now.surface, now.frame}, admitted->members);
        }
    }
    peers_.erase(peer);
}

void CountingWall::ended(const std::shared_ptr<Peer>& peer, const FrameOfGroup& frame, std::uint32_t members) {
    auto& waiting = waiting_[frame];
    waiting.push_back(peer);
    if (waiting.size() < members) return;
    const std::uint32_t words[] = {frame.surface.value, frame.frame};
    for (const auto& member : waiting) say(member, wire::FrameKind::swap_done, std::as_bytes(std::span(words)));
    waiting_.erase(frame);
    proto::Envelope envelope;
    auto& rendered = *envelope.mutable_rendered();
    rendered.set_session(frame.session.value);
    rendered.set_surface(frame.surface.value);
    rendered.set_frame(frame.frame);
    if (const auto& link = nodes_[frame.node].link) link->send(envelope);
}

}  // namespace wall::simulate
