// SPDX-License-Identifier: MIT
// A connected stream: plain within a machine, TLS between machines. Whoever reads and writes need not know which. One
// executor, one thread; one read and one write may wait at a time.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "common/base/result.h"
#include "common/base/socket_peer.h"
#include "common/base/unique_fd.h"
#include "common/net/address.h"
#include "common/tls/fingerprint.h"
#include "common/tls/tls_context.h"

namespace wall::net {

namespace asio = boost::asio;

/// Unix or TCP, decided when it is opened.
using StreamSocket = asio::generic::stream_protocol::socket;

class Stream {
public:
    static constexpr std::chrono::seconds kHandshakeLimit{5};  ///< that a peer has for TLS's handshake
    /// To answer a connection attempt, which asks anew several times until then.
    static constexpr std::chrono::milliseconds kConnectLimit{1500};

    using Transferred = std::tuple<boost::system::error_code, std::size_t>;

    explicit Stream(StreamSocket socket);  ///< plain
    Stream(Stream&&) noexcept;
    Stream& operator=(Stream&&) noexcept;
    ~Stream();

    /// Whoever has connected to us proves a key within kHandshakeLimit; whose it is, peer_key() says.
    static asio::awaitable<Result<Stream>> accept_tls(StreamSocket socket, const tls::TlsContext& own);
    /// Plain; within kConnectLimit.
    static asio::awaitable<Result<Stream>> connect(const Address& address);
    /// To whoever proves the key `server`; nothing is said to anybody else. kConnectLimit and
    /// kHandshakeLimit at most.
    static asio::awaitable<Result<Stream>> connect_tls(const Address& address, const tls::TlsContext& own,
                                                       const tls::Fingerprint& server);

    /// Some bytes; asio::error::eof at an orderly end.
    asio::awaitable<Transferred> read_some(asio::mutable_buffer room);
    /// The same; a descriptor that comes with the bytes, from a peer on this machine, goes to `with`.
    asio::awaitable<Transferred> read_some_with(asio::mutable_buffer room, UniqueFd& with);
    /// All of them.
    asio::awaitable<Transferred> write(asio::const_buffer bytes);
    /// No more is read, or written; what waits ends. Never waits.
    void shut_reading();
    void close();

    bool is_open() const;
    /// What brings the bytes: "unix", "tcp" or "tls".
    const char* transport();
    /// Both ends are on this machine, as the kernel knows.
    bool is_local() { return transport() == std::string_view("unix"); }
    /// The other end has acknowledged nothing for a while, though it was asked again: TCP will go on asking ever more
    /// rarely, and be late when the link is back.
    bool is_stuck();
    static constexpr std::chrono::milliseconds kLookForStuck{250};  ///< how often to ask for that
    /// Nothing: the stream is plain.
    const std::optional<tls::Fingerprint>& peer_key() const;
    asio::any_io_executor executor();
    int descriptor();

private:
    struct Parts;
    explicit Stream(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

}  // namespace wall::net
