// SPDX-License-Identifier: MIT
#include "tileserver/io/peer_links.h"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <span>
#include <utility>

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
constexpr auto kKnownSoon = 1s;  // walld's word may come later than the program's
constexpr auto kKnownPoll = 10ms;

}  // namespace

/// One message at a time, in order.
class PeerLinks::Link : public std::enable_shared_from_this<Link> {
public:
    /// `missed` is called when parcels that were sent may not have come to the peer.
    Link(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> tls, SessionId session, Peer peer,
         Brings brings, std::string codec, std::function<void()> missed)
        : timer_(executor),
          room_(executor),
          tls_(std::move(tls)),
          session_(session),
          peer_(std::move(peer)),
          brings_(brings),
          codec_(std::move(codec)),
          missed_(std::move(missed)) {}

    /// `number`: of the parcel; 0: it is none.
    void send(RawBytes message, std::uint32_t number) {
        if (closed_ || (number != 0 && number <= missed_number_)) return;  // its beginning may not have come
        number_ = std::max(number_, number);
        queued_ += message.size();
        queue_.push_back(std::move(message));
        if (!std::exchange(running_, true)) asio::co_spawn(timer_.get_executor(), run(), asio::detached);
    }
    std::size_t queued() const { return queued_; }
    /// Until less than that waits.
    asio::awaitable<void> wait_for_room(std::size_t most) {
        const auto self = shared_from_this();
        while (!closed_ && queued_ >= most) {
            room_.expires_after(1s);
            co_await room_.async_wait(net::kTuple);
        }
    }
    const Peer& peer() const { return peer_; }
    void end_if_stuck() {
        if (!stream_ || !stream_->is_open() || !stream_->is_stuck()) return;
        stream_->close();
        if (!running_) lost("nothing comes back");  // else run() sees it
    }
    void close() {
        closed_ = true;
        timer_.cancel();
        room_.cancel();
        if (stream_) stream_->close();
        miss();
        missed_ = nullptr;  // whom it tells may be gone before run() is
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
            const RawBytes message = std::move(queue_.front());
            queue_.pop_front();
            queued_ -= message.size();
            room_.cancel();
            if (!co_await write(message) || !stream_->is_open()) lost("closed");
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
        stream_ = std::make_shared<net::Stream>(std::move(*stream));
        const auto hello = hello_frame();
        const auto [error, written] = co_await stream_->write(asio::buffer(hello));
        if (error) lost(error.message());
        else asio::co_spawn(timer_.get_executor(), watch(stream_), asio::detached);
        co_return !error;
    }
    /// The peer says nothing, or why it closes the stream. What was written last may be nowhere then.
    asio::awaitable<void> watch(std::shared_ptr<net::Stream> stream) {
        const auto self = shared_from_this();
        std::array<std::byte, 256> room;
        for (bool open = true; open;) {
            const auto [error, bytes] = co_await stream->read_some(asio::buffer(room));
            open = !error;
        }
        stream->close();
        if (stream_ != stream || running_) co_return;  // run() sees it
        if (!closed_) log::info("peer_link_closed session={} to={}", session_.value, log::quoted(peer_.address.text()));
        stream_.reset();
        miss();
    }
    std::vector<std::byte> hello_frame() const {
        proto::DataHello hello;
        hello.set_version(glapi::kStreamVersion);
        hello.set_session(session_.value);
        hello.set_ticket(peer_.ticket);
        hello.set_partials(brings_ == Brings::partials);
        hello.set_parcels(brings_ == Brings::parcels);
        const std::string text = hello.SerializeAsString();
        return wire::whole_frame(wire::FrameKind::hello, std::as_bytes(std::span(text)));
    }
    asio::awaitable<Result<net::Stream>> open() {
        if (peer_.key) co_return co_await net::Stream::connect_tls(peer_.address, *tls_, *peer_.key);
        co_return co_await net::Stream::connect(peer_.address);
    }
    asio::awaitable<bool> write(std::span<const std::byte> payload) {
        std::vector<std::byte> coded;
        if (brings_ == Brings::partials && peer_.key) {  // between machines the link is what takes longest
            coded = recode_partial(payload, codec_);
            payload = coded;
        }
        const auto header = wire::encode_frame_header(
            {static_cast<std::uint32_t>(payload.size()),
             brings_ == Brings::partials ? wire::FrameKind::partial : wire::FrameKind::parcel});
        const std::array<asio::const_buffer, 2> frame{asio::buffer(header),
                                                      asio::buffer(payload.data(), payload.size())};
        const auto stream = stream_;
        for (const auto& part : frame) {
            const auto [error, written] = co_await stream->write(part);
            if (error) co_return false;
        }
        co_return true;
    }
    void lost(const std::string& why) {
        if (!closed_)
            log::warn("peer_link_lost session={} to={} reason={}", session_.value, log::quoted(peer_.address.text()),
                      log::quoted(why));
        stream_.reset();
        miss();
    }
    /// What was written may be on its way still, or nowhere.
    void miss() {
        if (number_ == 0 || std::exchange(missed_number_, number_) == number_) return;
        queue_.clear();
        queued_ = 0;
        if (missed_) missed_();
    }

    asio::steady_timer timer_, room_;
    std::shared_ptr<const tls::TlsContext> tls_;
    const SessionId session_;
    const Peer peer_;
    const Brings brings_;
    const std::string codec_;
    std::function<void()> missed_;
    std::shared_ptr<net::Stream> stream_;  ///< null: there is no connection
    std::deque<RawBytes> queue_;
    std::size_t queued_ = 0;
    std::uint32_t number_ = 0, missed_number_ = 0;  // of the latest parcel, and of that when some were missed
    bool running_ = false, closed_ = false;
};

PeerLinks::PeerLinks(asio::any_io_executor executor, std::shared_ptr<const tls::TlsContext> tls,
                     NotHandedOn not_handed_on)
    : executor_(executor), tls_(std::move(tls)), not_handed_on_(std::move(not_handed_on)) {}

PeerLinks::~PeerLinks() { close(); }

void PeerLinks::set_peers(SessionId session, std::map<NodeIndex, Peer> peers) {
    std::erase_if(peers_, [&](const auto& entry) { return entry.first.first == session; });
    std::erase_if(unknown_, [&](const auto& entry) { return entry.first.first == session; });
    for (auto& [node, peer] : peers) peers_.insert_or_assign({session, node}, peer);
    std::vector<std::shared_ptr<Link>> gone;
    std::erase_if(links_, [&](const auto& entry) {
        const auto& [of, to, brings] = entry.first;
        if (of != session) return false;
        const auto known = peers_.find({of, to});
        const bool same = known != peers_.end() && entry.second->peer() == known->second;
        if (!same) gone.push_back(entry.second);
        return !same;
    });
    for (const auto& link : gone) link->close();
}

void PeerLinks::forget(SessionId session) { set_peers(session, {}); }

std::shared_ptr<PeerLinks::Link> PeerLinks::link(SessionId session, NodeIndex to, Brings brings) {
    const auto peer = peers_.find({session, to});
    if (peer == peers_.end()) return nullptr;
    auto& link = links_[{session, to, brings}];
    if (!link)
        link = std::make_shared<Link>(executor_, tls_, session, peer->second, brings, codec_,
                                      [this, session, to] { tell(session, to); });
    return link;
}

void PeerLinks::send_partial(SessionId session, NodeIndex to, std::vector<std::byte> message) {
    const auto way = link(session, to, Brings::partials);
    if (way && way->queued() + message.size() <= kMostQueued) way->send({message.begin(), message.end()}, 0);
}

asio::awaitable<void> PeerLinks::hand_on(SessionId session, NodeIndex to, std::uint32_t number, RawBytes piece) {
    asio::steady_timer timer(executor_);
    const auto until = std::chrono::steady_clock::now() + kKnownSoon;
    auto way = link(session, to, Brings::parcels);
    while (!way && !closed_ && !unknown_.contains({session, to}) && std::chrono::steady_clock::now() < until) {
        timer.expires_after(kKnownPoll);
        co_await timer.async_wait(net::kTuple);
        way = link(session, to, Brings::parcels);
    }
    if (!way) {
        if (std::exchange(unknown_[{session, to}], number) != number) tell(session, to);
        co_return;
    }
    bytes_handed_on_ += piece.size();
    way->send(std::move(piece), number);
    co_await way->wait_for_room(kMostPieces);
}

void PeerLinks::end_stuck() {
    for (const auto& [key, link] : links_) link->end_if_stuck();
}

void PeerLinks::tell(SessionId session, NodeIndex to) {
    if (!closed_) not_handed_on_(session, to);
}

void PeerLinks::close() {
    closed_ = true;
    for (const auto& [key, link] : links_) link->close();
    links_.clear();
}

}  // namespace wall::tileserver
