// SPDX-License-Identifier: MIT
#include "common/net/control_connection.h"

#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/base/trusted_server.h"
#include "common/net/as_tuple.h"

namespace wall::net {
namespace {

constexpr auto kAcceptRetry = std::chrono::milliseconds(100);  // while descriptors are short

/// The listener itself is well.
bool passes(const boost::system::error_code& error) {
    namespace errc = boost::system::errc;
    return error == errc::too_many_files_open || error == errc::too_many_files_open_in_system ||
           error == errc::connection_aborted || error == errc::no_buffer_space || error == errc::not_enough_memory ||
           error == errc::protocol_error || error == errc::interrupted;
}

}  // namespace

Result<Listener> Listener::open(asio::any_io_executor executor, const Address& address, Peers peers) {
    Listener listener(Acceptor(executor), address, peers);
    if (auto listening = listener.listen(); !listening) return tl::unexpected(listening.error());
    return listener;
}

Result<void> Listener::listen() {
    auto fd = listen_on(address_, peers_);
    if (!fd) return tl::unexpected(fd.error());
    auto to = resolve(address_);
    if (!to) return tl::unexpected(to.error());
    boost::system::error_code error;
    acceptor_.assign(protocol_of(address_, to->family()), fd->get(), error);
    if (error) return fail(address_.text() + ": " + error.message());
    address_ = bound_address(fd->release(), address_);
    return {};
}

Result<void> Listener::reopen() {
    boost::system::error_code ignored;
    acceptor_.close(
        ignored);  // a Unix socket's file may be another one's by now: listen() removes it only if it is stale
    return listen();
}

Listener::~Listener() {
    if (acceptor_.is_open()) close();
}

void Listener::close() {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    if (address_.is_unix()) ::unlink(address_.path.c_str());
}

asio::awaitable<Result<StreamSocket>> Listener::accept() {
    for (;;) {
        auto [error, socket] = co_await acceptor_.async_accept(kTuple);
        if (!error) co_return std::move(socket);
        if (!passes(error)) co_return fail(address_.text() + ": " + error.message());
        asio::steady_timer pause(acceptor_.get_executor(), kAcceptRetry);
        co_await pause.async_wait(kTuple);
    }
}

ControlConnection::ControlConnection(Stream stream)
    : stream_(std::move(stream)),
      ends_(ends_of(stream_.descriptor())),
      drained_(stream_.executor(), asio::steady_timer::time_point::max()) {}

asio::awaitable<Result<std::shared_ptr<ControlConnection>>> ControlConnection::connect(Address address,
                                                                                       std::string server) {
    auto stream = co_await Stream::connect(address);
    if (!stream) co_return tl::unexpected(stream.error());
    if (const auto trusted = check_server(stream->descriptor(), server); !trusted)
        co_return fail(address.text() + ": this is not walld: " + trusted.error().message);
    co_return std::make_shared<ControlConnection>(std::move(*stream));
}

asio::awaitable<Result<std::shared_ptr<ControlConnection>>> ControlConnection::connect_tls(
    Address address, std::shared_ptr<const tls::TlsContext> own, tls::Fingerprint walld) {
    auto stream = co_await Stream::connect_tls(address, *own, walld);
    if (!stream) co_return tl::unexpected(stream.error());
    co_return std::make_shared<ControlConnection>(std::move(*stream));
}

asio::awaitable<Result<proto::Envelope>> ControlConnection::receive() {
    const auto self = shared_from_this();
    for (;;) {
        auto message = unframer_.next();
        if (!message) {
            close();
            co_return tl::unexpected(message.error());
        }
        if (*message) co_return std::move(**message);
        const auto room = unframer_.prepare();
        auto [error, bytes] = co_await stream_.read_some(asio::buffer(room.data(), room.size()));
        if (error) {
            const bool ours = !stream_.is_open();
            lost_ = lost_ || !closing_;
            const bool orderly = error == asio::error::eof && unframer_.at_boundary();
            close();
            if (failure_) co_return tl::unexpected(*failure_);
            co_return fail(ours || orderly ? "closed" : "control: " + error.message());
        }
        unframer_.commit(bytes);
    }
}

void ControlConnection::send(const proto::Envelope& envelope) {
    if (!is_open()) return;
    auto bytes = frame(envelope);
    if (!bytes) return give_up(std::move(bytes.error()));
    queue_ += *bytes;
    queued_bytes_ += bytes->size();
    if (queued_bytes_ > kMaxQueued)
        return give_up({"control: " + std::to_string(queued_bytes_) + " bytes wait that the peer does not read"});
    if (writing_) return;
    writing_ = true;
    asio::co_spawn(
        stream_.executor(), [self = shared_from_this()] { return self->write_queue(); }, asio::detached);
}

asio::awaitable<void> ControlConnection::write_queue() {
    // All at once: what belongs together is with the peer before anybody is told that it is done.
    while (!queue_.empty() && stream_.is_open()) {
        const std::string now = std::exchange(queue_, {});
        const auto [error, bytes] = co_await stream_.write(asio::buffer(now));
        if (error) {
            lost_ = lost_ || !closing_;
            close();
        }
        queued_bytes_ -= now.size();
    }
    writing_ = false;
    drained_.cancel();
    if (closing_) close();
}

asio::awaitable<void> ControlConnection::drained() {
    const auto self = shared_from_this();
    while (writing_) co_await drained_.async_wait(kTuple);
}

void ControlConnection::give_up(Error why) {
    failure_ = std::move(why);
    close();
}

void ControlConnection::close() {
    closing_ = true;
    stream_.close();
}

void ControlConnection::close_after_sending() {
    closing_ = true;
    if (!writing_) close();
}

}  // namespace wall::net
