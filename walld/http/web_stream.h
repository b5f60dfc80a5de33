// SPDX-License-Identifier: MIT
// A browser's connection: plain on this machine, TLS from others. It is what Boost.Beast reads and writes; whose turn
// it is need not know which. One executor, one thread; one read and one write may wait at a time.
#pragma once

#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "common/base/result.h"
#include "common/tls/tls_context.h"

namespace wall::walld {

namespace asio = boost::asio;

class WebStream {
public:
    using Socket = asio::ip::tcp::socket;
    using executor_type = Socket::executor_type;
    static constexpr std::chrono::seconds kHandshakeLimit{5};

    explicit WebStream(Socket socket) : socket_(std::move(socket)) {}

    /// Nothing is said in plain afterwards. Closed when the limit is over.
    asio::awaitable<Result<void>> shake_hands(const tls::TlsContext& own);
    void close();

    Socket& socket() { return socket_; }
    executor_type get_executor() { return socket_.get_executor(); }

    template <class Buffers, class Token>
    auto async_read_some(const Buffers& buffers, Token&& token) {
        return asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
            [this](auto handler, const Buffers& into) {
                if (tls_) tls_->async_read_some(into, std::move(handler));
                else socket_.async_read_some(into, std::move(handler));
            },
            token, buffers);
    }
    template <class Buffers, class Token>
    auto async_write_some(const Buffers& buffers, Token&& token) {
        return asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
            [this](auto handler, const Buffers& from) {
                if (tls_) tls_->async_write_some(from, std::move(handler));
                else socket_.async_write_some(from, std::move(handler));
            },
            token, buffers);
    }

private:
    Socket socket_;
    std::optional<asio::ssl::stream<Socket&>> tls_;  // none: plain
};

}  // namespace wall::walld
