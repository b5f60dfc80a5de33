// SPDX-License-Identifier: MIT
#include "tileserver/io/node_server.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <utility>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "common/log/refusals.h"

namespace wall::tileserver {
namespace {

/// What wall.toml says, or the same port of all addresses where that would be for this machine alone.
net::Address for_other_machines(const net::Address& listen) {
    if (!listen.local()) return listen;
    return {.path = {}, .host = "0.0.0.0", .port = listen.is_unix() ? net::kDefaultDataPort : listen.port};
}

}  // namespace

NodeServer::~NodeServer() = default;

Result<std::unique_ptr<NodeServer>> NodeServer::open(asio::any_io_executor executor, const config::WallConfig& wall,
                                                     const std::vector<GpuPart>& parts, NodeKeys keys,
                                                     const Described& described) {
    const auto peers = keys.tls ? net::Peers::with_keys : net::Peers::of_this_machine;
    const auto& listen = parts.front().node.listen;
    auto listener = net::Listener::open(executor, keys.joined ? for_other_machines(listen) : listen, peers);
    if (!listener) return tl::unexpected(listener.error());
    std::unique_ptr<NodeServer> server(new NodeServer(executor, std::move(keys)));
    server->listener_.emplace(std::move(*listener));
    const DataPort port{server->address(), server->listener_->wants_keys()};
    for (const auto& [config, compilers] : parts) {
        auto node = GpuNode::open(executor, wall, config, compilers, server->keys_, port, described);
        if (!node) return tl::unexpected(node.error());
        server->hosts_.push_back(node->get());
        server->nodes_.push_back(std::move(*node));
    }
    return server;
}

void NodeServer::start() {
    const auto stopping = [this] { return stopping_; };
    const auto take = [this](net::StreamSocket socket) {
        if (listener_->wants_keys()) net::spawn(executor_, "handshake", take_over_tls(std::move(socket)));
        else take_program(net::Stream(std::move(socket)));
    };
    net::keep_accepting(executor_, *listener_, take, stopping);
    for (const auto& node : nodes_) node->start();
}

void NodeServer::stop() {
    stopping_ = true;
    listener_->close();
    for (const auto& [id, stream] : std::map(arriving_)) stream->close();
    for (const auto& node : nodes_) node->stop();
}

std::chrono::steady_clock::time_point NodeServer::last_sign_of_life() const {
    auto out = nodes_.front()->last_sign_of_life();
    for (const auto& node : nodes_) out = std::min(out, node->last_sign_of_life());
    return out;
}

void NodeServer::set_longest_turn(std::chrono::milliseconds limit) {
    for (const auto& node : nodes_) node->set_longest_turn(limit);
}

std::optional<std::string> NodeServer::failure() const {
    const auto failed = std::ranges::find_if(nodes_, [](const auto& node) { return node->failure().has_value(); });
    return failed == nodes_.end() ? std::nullopt : (*failed)->failure();
}

bool NodeServer::starts_anew() const {
    return std::ranges::any_of(nodes_, [](const auto& node) { return node->starts_anew(); });
}

/// Whoever connects without end keeps only those out who are slower to say who they are: a program shows its ticket in
/// its first bytes, and a connection that does not makes room for it.
void NodeServer::make_room_for_stranger() {
    if (strangers_.size() < most_strangers_) return;
    const StreamId oldest = *strangers_.begin();
    strangers_.erase(strangers_.begin());
    const auto silent = arriving_.find(oldest);
    if (silent == arriving_.end()) return;
    constexpr const char* why = "too many connections that have shown no ticket";
    log::refused(kDataPort, silent->second->from(), why);
    silent->second->fail(why);
}

/// Somebody from anywhere; so many may prove their keys at the same time.
asio::awaitable<void> NodeServer::take_over_tls(net::StreamSocket socket) {
    const auto from = net::peer_text(socket.native_handle());
    if (handshakes_ >= kMaxHandshakes) co_return log::refused(kDataPort, from, "too many handshakes at once");
    ++handshakes_;
    auto connection = co_await net::Stream::accept_tls(std::move(socket), *keys_.tls);
    --handshakes_;
    if (stopping_) co_return;
    if (connection) co_return take_program(std::move(*connection));
    log::refused(kDataPort, from, connection.error().message);
}

void NodeServer::take_program(net::Stream connection) {
    make_room_for_stranger();
    const StreamId id(++last_stream_);
    const auto stream = std::make_shared<DataStream>(static_cast<StreamDoor&>(*this), id, std::move(connection));
    arriving_.emplace(id, stream);
    strangers_.insert(id);
    asio::co_spawn(executor_, stream->run(), [stream](std::exception_ptr failure) {
        if (!failure) return;
        log::error("stream_failed stream={}", stream->id().value);  // out of memory
        stream->close();
        stream->leave();
    });
}

}  // namespace wall::tileserver
