// SPDX-License-Identifier: MIT
// Asio's side of a control connection: Envelopes in order, both ways, over a Unix socket, TCP or TLS. One executor, one
// thread: everything is called from coroutines and handlers of the executor that it was made with.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/net/sockets.h"
#include "common/net/stream.h"

namespace wall::net {

/// Accepts stream sockets; removes its Unix socket file in the end. Also what a node listens with for data streams.
class Listener {
public:
    static Result<Listener> open(asio::any_io_executor executor, const Address& address,
                                 Peers peers = Peers::of_this_machine);
    Listener(Listener&&) = default;
    Listener& operator=(Listener&&) = delete;
    ~Listener();

    /// The next connection; waits while descriptors are short. After an error (closed, or broken) no further one comes
    /// until it is opened again.
    asio::awaitable<Result<StreamSocket>> accept();
    void close();
    /// Listens anew on the same address, whatever has become of the socket.
    Result<void> reopen();
    const Address& address() const { return address_; }  ///< with the port that the kernel chose
    /// Other machines reach it: whoever comes has to prove a key (Stream::accept_tls).
    bool wants_keys() const { return !address_.local(); }

private:
    using Acceptor = asio::basic_socket_acceptor<asio::generic::stream_protocol>;
    Listener(Acceptor acceptor, Address address, Peers peers)
        : acceptor_(std::move(acceptor)), address_(std::move(address)), peers_(peers) {}
    Result<void> listen();
    Acceptor acceptor_;
    Address address_;
    Peers peers_;
};

class ControlConnection : public std::enable_shared_from_this<ControlConnection> {
public:
    /// What may wait for a slow reader before the connection is given up.
    static constexpr std::size_t kMaxQueued = std::size_t{256} << 20;  // bytes

    explicit ControlConnection(Stream stream);
    /// `server`: the user whose process must be there, if it is not root's or our own (check_server).
    static asio::awaitable<Result<std::shared_ptr<ControlConnection>>> connect(Address address, std::string server);
    /// To a walld of another machine.
    static asio::awaitable<Result<std::shared_ptr<ControlConnection>>> connect_tls(
        Address address, std::shared_ptr<const tls::TlsContext> own, tls::Fingerprint walld);

    /// The next message. The error says "closed" for an orderly end, else what was wrong; the socket is closed then.
    asio::awaitable<Result<proto::Envelope>> receive();
    /// Queues a message; never waits. Nothing happens after a close. A message that is too large ends the connection,
    /// as does a reader for whom too much waits; receive() tells why.
    void send(const proto::Envelope& envelope);
    /// Waits until nothing is queued; senders call it that may wait rather than queue.
    asio::awaitable<void> drained();
    /// Closes at once; a pending receive() ends.
    void close();
    /// Closes when everything queued has gone out.
    void close_after_sending();

    bool is_open() const { return stream_.is_open() && !closing_; }
    /// It is closed, and not by us: the peer is gone, or the link.
    bool lost() const { return lost_; }
    /// Stream::is_stuck().
    bool is_stuck() { return stream_.is_open() && stream_.is_stuck(); }
    /// The key that a peer on another machine has proven; nothing on this machine.
    const std::optional<tls::Fingerprint>& peer_key() const { return stream_.peer_key(); }
    asio::any_io_executor executor() { return stream_.executor(); }
    /// For peer_of().
    const std::optional<SocketEnds>& ends() const { return ends_; }
    /// As peer_text(); also when it is closed.
    std::string address() const { return peer_text(ends_); }
    /// What is known at once: of a Unix socket's peer.
    std::optional<Peer> peer() const { return ends_ ? ends_->credentials : std::nullopt; }

private:
    asio::awaitable<void> write_queue();
    void give_up(Error why);

    Stream stream_;
    std::optional<SocketEnds> ends_;
    Unframer unframer_;
    std::string queue_;
    std::size_t queued_bytes_ = 0;
    std::optional<Error> failure_;  // why we closed it, if somebody should know
    asio::steady_timer drained_;    // cancelled when the queue is empty
    bool writing_ = false;
    bool closing_ = false;
    bool lost_ = false;
};

}  // namespace wall::net
