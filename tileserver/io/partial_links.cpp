// SPDX-License-Identifier: MIT
#include "tileserver/io/partial_links.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <span>

#include "common/log/log.h"
#include "common/net/as_tuple.h"
#include "common/net/stream.h"
#include "common/wire/frame.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"
#include "tileserver/partials/partial_format.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
constexpr auto kTryAgain = 250ms;

std::vector<std::byte> hello_frame(SessionId session, const std::string& ticket) {
    proto::DataHello hello;
    hello.set_version(glapi::kStreamVersion);
    hello.set_session(session.value);
    hello.set_ticket(ticket);
    hello.set_partials(true);
    const std::string text = hello.SerializeAsString();
    return wire::whole_frame(wire::FrameKind::hello, std::as_bytes(std::span(text)));
}

}  // namespace

class PartialLinks::Link : public std::enable_shared_from_this<Link> {
public:
    Link(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> tls, SessionId session,
         PartialPeer peer, std::string codec)
        : timer_(executor), tls_(std::move(tls)), session_(session), peer_(std::move(peer)), codec_(std::move(codec)) {}

    void send(std::vector<std::byte> message) {
        if (queued_ + message.size() > kMostQueued) return;
        queued_ += message.size();
        queue_.push_back(std::move(message));
        if (!std::exchange(running_, true)) asio::co_spawn(timer_.get_executor(), run(), asio::detached);
    }
    const PartialPeer& peer() const { return peer_; }
    void close() {
        closed_ = true;
        timer_.cancel();
        if (stream_) stream_->close();
    }

private:
    /// As long as there is something to send.
    asio::awaitable<void> run() {
        const auto self = shared_from_this();
        while (!closed_ && !queue_.empty()) {
            if (!stream_ && !co_await connect()) {
                queue_.clear();
                queued_ = 0;
                timer_.expires_after(kTryAgain);
                co_await timer_.async_wait(net::kTuple);
                continue;
            }
            const auto message = std::move(queue_.front());
            queue_.pop_front();
            queued_ -= message.size();
            if (!co_await write(wire::FrameKind::partial, coded(message))) lost("closed");
        }
        running_ = false;
    }
    asio::awaitable<bool> connect() {
        if (peer_.key && !tls_) {
            lost("it is on another machine, and this node has no key");
            co_return false;
        }
        auto stream = co_await open();
        if (!stream) {
            lost(stream.error().message);
            co_return false;
        }
        stream_.emplace(std::move(*stream));
        const auto hello = hello_frame(session_, peer_.ticket);
        const auto [error, written] = co_await stream_->write(asio::buffer(hello));
        if (error) lost(error.message());
        co_return !error;
    }
    asio::awaitable<Result<net::Stream>> open() {
        if (peer_.key) co_return co_await net::Stream::connect_tls(peer_.address, *tls_, *peer_.key);
        co_return co_await net::Stream::connect(peer_.address);
    }
    asio::awaitable<bool> write(wire::FrameKind kind, std::vector<std::byte> payload) {
        const auto frame = wire::whole_frame(kind, payload);
        const auto [error, written] = co_await stream_->write(asio::buffer(frame));
        co_return !error;
    }
    /// Between machines the link is what takes longest.
    std::vector<std::byte> coded(const std::vector<std::byte>& message) const {
        return peer_.key ? recode_partial(message, codec_) : message;
    }
    void lost(const std::string& why) {
        if (!closed_)
            log::warn("partial_link_lost session={} to={} reason={}", session_.value, log::quoted(peer_.address.text()),
                      log::quoted(why));
        stream_.reset();
    }

    asio::steady_timer timer_;
    std::shared_ptr<const tls::TlsContext> tls_;
    const SessionId session_;
    const PartialPeer peer_;
    const std::string codec_;
    std::optional<net::Stream> stream_;
    std::deque<std::vector<std::byte>> queue_;
    std::size_t queued_ = 0;
    bool running_ = false, closed_ = false;
};

PartialLinks::PartialLinks(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> tls)
    : executor_(std::move(executor)), tls_(std::move(tls)) {}

PartialLinks::~PartialLinks() { close(); }

void PartialLinks::set_peers(SessionId session, std::map<NodeIndex, PartialPeer> peers) {
    std::erase_if(peers_, [&](const auto& entry) { return entry.first.first == session; });
    for (auto& [node, peer] : peers) peers_.insert_or_assign(Key(session, node), peer);
    std::erase_if(links_, [&](const auto& entry) {
        const auto& [key, link] = entry;
        if (key.first != session) return false;
        const auto known = peers_.find(key);
        const bool same = known != peers_.end() && link->peer() == known->second;
        if (!same) link->close();
        return !same;
    });
}

void PartialLinks::forget(SessionId session) { set_peers(session, {}); }

void PartialLinks::send(SessionId session, NodeIndex to, std::vector<std::byte> message) {
    const Key key(session, to);
    const auto peer = peers_.find(key);
    if (peer == peers_.end()) return;
    auto& link = links_[key];
    if (!link) link = std::make_shared<Link>(executor_, tls_, session, peer->second, codec_);
    link->send(std::move(message));
}

void PartialLinks::close() {
    for (const auto& [key, link] : links_) link->close();
    links_.clear();
}

}  // namespace wall::tileserver
