// SPDX-License-Identifier: MIT
#include "walld/http/web_stream.h"

#include <boost/asio/steady_timer.hpp>
#include <memory>

#include "common/net/as_tuple.h"

namespace wall::walld {

asio::awaitable<Result<void>> WebStream::shake_hands(const tls::TlsContext& own) {
    SSL* connection = SSL_new(own.pages());
    if (!connection) co_return fail("TLS: " + tls::openssl_error());
    tls_.emplace(socket_, connection);  // whose it is from now on
    asio::steady_timer limit(get_executor(), kHandshakeLimit);
    const auto armed = std::make_shared<bool>(true), late = std::make_shared<bool>(false);
    const std::shared_ptr<void> over(nullptr, [armed](void*) { *armed = false; });  // however this ends
    limit.async_wait([this, armed, late](const boost::system::error_code& cancelled) {
        if (cancelled || !*armed) return;
        *late = true;
        close();
    });
    auto [error] = co_await tls_->async_handshake(asio::ssl::stream_base::server, net::kTuple);
    if (*late) co_return fail("the TLS handshake took longer than " + std::to_string(kHandshakeLimit.count()) + " s");
    if (error) co_return fail("the TLS handshake failed: " + error.message());
    co_return Result<void>{};
}

void WebStream::close() {
    boost::system::error_code ignored;
    if (!socket_.is_open()) return;
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
}

}  // namespace wall::walld
