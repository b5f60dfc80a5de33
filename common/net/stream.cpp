// SPDX-License-Identifier: MIT
#include "common/net/stream.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <list>
#include <memory>

#include "common/base/descriptor_message.h"
#include "common/net/as_tuple.h"

namespace wall::net {
namespace {

constexpr unsigned kStuckRetransmits = 2, kStuckMs = 700;
using Tls = asio::ssl::stream<StreamSocket&>;

/// Closes the socket when the time is over, unless it goes first.
class Deadline {
public:
    Deadline(StreamSocket& socket, std::chrono::milliseconds limit) : timer_(socket.get_executor(), limit) {
        timer_.async_wait([&socket, armed = armed_](const boost::system::error_code& cancelled) {
            boost::system::error_code ignored;
            if (!cancelled && *armed) socket.close(ignored);
        });
    }
    ~Deadline() { *armed_ = false; }  // the timer goes with us, but its handler may be on its way

private:
    std::shared_ptr<bool> armed_ = std::make_shared<bool>(true);
    asio::steady_timer timer_;
};

/// Connects, and asks anew now and then while there is no answer, with each question on a socket of its own: whoever is
/// reached first counts. TCP itself asks a second time after a second only, and again ever more rarely, so that a link
/// that is whole again would be found late. A refusal ends it.
class Asking : public std::enable_shared_from_this<Asking> {
public:
    using Endpoint = asio::generic::stream_protocol::endpoint;

    Asking(const asio::any_io_executor& executor, Endpoint to)
        : to_(std::move(to)), again_(executor), answered_(executor, asio::steady_timer::time_point::max()) {}

    asio::awaitable<boost::system::error_code> ask(std::chrono::milliseconds limit, StreamSocket& connected) {
        const auto until = std::chrono::steady_clock::now() + limit;
        answered_.expires_at(until);
        ask_again(until);
        co_await answered_.async_wait(kTuple);
        again_.cancel();
        for (auto& question : questions_) {
            boost::system::error_code ignored;
            if (&question != reached_) question.close(ignored);
        }
        if (reached_ == nullptr) co_return error_ ? error_ : make_error_code(asio::error::timed_out);
        connected = std::move(*reached_);
        co_return boost::system::error_code();
    }

private:
    void ask_again(asio::steady_timer::time_point until) {
        auto& question = questions_.emplace_back(again_.get_executor());
        question.async_connect(to_, [self = shared_from_this(), &question](const boost::system::error_code& error) {
            if (self->reached_ != nullptr || self->error_ || error == asio::error::operation_aborted) return;
            if (error) self->error_ = error;
            else self->reached_ = &question;
            self->answered_.cancel();
        });
        if (std::chrono::steady_clock::now() + kAgain >= until) return;
        again_.expires_after(kAgain);
        again_.async_wait([self = shared_from_this(), until](const boost::system::error_code& cancelled) {
            if (!cancelled && self->reached_ == nullptr && !self->error_) self->ask_again(until);
        });
    }

    static constexpr std::chrono::milliseconds kAgain{250};
    Endpoint to_;
    asio::steady_timer again_, answered_;
    std::list<StreamSocket> questions_;
    StreamSocket* reached_ = nullptr;  // among them
    boost::system::error_code error_;
};

/// What went wrong in a handshake, for people.
std::string reason_of(const boost::system::error_code& error) {
    if (error == asio::error::operation_aborted || error == asio::error::bad_descriptor)
        return "the TLS handshake took longer than " + std::to_string(Stream::kHandshakeLimit.count()) + " s";
    return "the TLS handshake failed: " + error.message();
}

}  // namespace

struct Stream::Parts {
    explicit Parts(StreamSocket s) : socket(std::move(s)) {}
    /// Within the limit; `peer` is known then.
    asio::awaitable<Result<void>> shake_hands(const tls::TlsContext& own, asio::ssl::stream_base::handshake_type as);

    StreamSocket socket;
    std::optional<Tls> tls;  // none: plain
    std::optional<tls::Fingerprint> peer;
};

asio::awaitable<Result<void>> Stream::Parts::shake_hands(const tls::TlsContext& own,
                                                         asio::ssl::stream_base::handshake_type as) {
    SSL* connection = SSL_new(own.links());
    if (!connection) co_return fail("TLS: " + tls::openssl_error());
    tls.emplace(socket, connection);  // whose it is from now on
    const Deadline limit(socket, Stream::kHandshakeLimit);
    auto [error] = co_await tls->async_handshake(as, kTuple);
    if (error) co_return fail(reason_of(error));
    auto key = tls::peer_of(connection);
    if (!key) co_return tl::unexpected(key.error());
    peer = *key;
    co_return Result<void>{};
}

Stream::Stream(StreamSocket socket) : parts_(std::make_unique<Parts>(std::move(socket))) {}
Stream::Stream(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;
Stream::~Stream() = default;

asio::awaitable<Result<Stream>> Stream::accept_tls(StreamSocket socket, const tls::TlsContext& own) {
    auto parts = std::make_unique<Parts>(std::move(socket));
    if (auto done = co_await parts->shake_hands(own, asio::ssl::stream_base::server); !done)
        co_return tl::unexpected(done.error());
    co_return Stream(std::move(parts));
}

asio::awaitable<Result<Stream>> Stream::connect(const Address& address) {
    auto to = resolve(address);
    if (!to) co_return tl::unexpected(to.error());
    StreamSocket socket(co_await asio::this_coro::executor);
    const asio::generic::stream_protocol::endpoint endpoint(to->get(), to->length,
                                                            protocol_of(address, to->family()).protocol());
    const auto asking = std::make_shared<Asking>(socket.get_executor(), endpoint);
    const auto error = co_await asking->ask(kConnectLimit, socket);
    if (error == asio::error::timed_out)
        co_return fail(address.text() + ": cannot connect: no answer within " + std::to_string(kConnectLimit.count()) +
                       " ms");
    if (error) co_return fail(address.text() + ": cannot connect: " + error.message());
    boost::system::error_code ignored;
    if (!address.is_unix()) socket.set_option(asio::ip::tcp::no_delay(true), ignored);
    co_return Stream(std::move(socket));
}

asio::awaitable<Result<Stream>> Stream::connect_tls(const Address& address, const tls::TlsContext& own,
                                                    const tls::Fingerprint& server) {
    auto plain = co_await connect(address);
    if (!plain) co_return plain;
    auto& parts = *plain->parts_;
    if (auto done = co_await parts.shake_hands(own, asio::ssl::stream_base::client); !done)
        co_return fail(address.text() + ": " + done.error().message);
    if (parts.peer != server)
        co_return fail(address.text() + ": another machine answers there: its key is " + parts.peer->text() + ", not " +
                       server.text());
    co_return std::move(*plain);
}

asio::awaitable<Stream::Transferred> Stream::read_some(asio::mutable_buffer room) {
    if (!parts_->tls) co_return co_await parts_->socket.async_read_some(room, kTuple);
    auto [error, bytes] = co_await parts_->tls->async_read_some(room, kTuple);
    // Whoever speaks to us says how much is to come, so that nothing can be cut off unseen.
    if (error == asio::ssl::error::stream_truncated) error = asio::error::eof;
    co_return Transferred(error, bytes);
}

asio::awaitable<Stream::Transferred> Stream::read_some_with(asio::mutable_buffer room, UniqueFd& with) {
    if (parts_->tls || !parts_->socket.is_open()) co_return co_await read_some(room);
    for (;;) {
        const ssize_t bytes = receive_with_descriptor(
            parts_->socket.native_handle(), {static_cast<std::byte*>(room.data()), room.size()}, with, MSG_DONTWAIT);
        if (bytes > 0) co_return Transferred(boost::system::error_code(), static_cast<std::size_t>(bytes));
        if (bytes == 0) co_return Transferred(asio::error::eof, 0);
        if (errno == EINTR) continue;
        if (errno != EAGAIN && errno != EWOULDBLOCK)
            co_return Transferred(boost::system::error_code(errno, boost::system::system_category()), 0);
        auto [error] = co_await parts_->socket.async_wait(StreamSocket::wait_read, kTuple);
        if (error) co_return Transferred(error, 0);
    }
}

asio::awaitable<Stream::Transferred> Stream::write(asio::const_buffer bytes) {
    if (parts_->tls) co_return co_await asio::async_write(*parts_->tls, bytes, kTuple);
    co_return co_await asio::async_write(parts_->socket, bytes, kTuple);
}

void Stream::shut_reading() {
    boost::system::error_code ignored;
    parts_->socket.shutdown(StreamSocket::shutdown_receive, ignored);
}

void Stream::close() {
    boost::system::error_code ignored;
    if (!parts_->socket.is_open()) return;
    parts_->socket.shutdown(StreamSocket::shutdown_both, ignored);
    parts_->socket.close(ignored);
}

bool Stream::is_open() const { return parts_->socket.is_open(); }

const std::optional<tls::Fingerprint>& Stream::peer_key() const { return parts_->peer; }

const char* Stream::transport() {
    if (parts_->tls) return "tls";
    int family = AF_UNSPEC;
    socklen_t length = sizeof family;
    ::getsockopt(descriptor(), SOL_SOCKET, SO_DOMAIN, &family, &length);
    return family == AF_UNIX ? "unix" : "tcp";
}

bool Stream::is_stuck() {
    tcp_info info{};
    socklen_t length = sizeof info;
    if (::getsockopt(descriptor(), IPPROTO_TCP, TCP_INFO, &info, &length) != 0) return false;
    const unsigned in_vain = std::max(info.tcpi_retransmits, info.tcpi_probes);
    return in_vain >= kStuckRetransmits && info.tcpi_last_ack_recv >= kStuckMs;
}

asio::any_io_executor Stream::executor() { return parts_->socket.get_executor(); }

int Stream::descriptor() { return parts_->socket.native_handle(); }

}  // namespace wall::net
