// SPDX-License-Identifier: MIT
// The status page and the read-only API (docs/http-api.md). One thread; a coroutine a connection.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <map>
#include <memory>

#include "common/net/address.h"
#include "walld/changed.h"
#include "walld/snapshot_desk.h"
#include "walld/wall.h"

namespace wall::walld {

class HttpServer {
public:
    static constexpr std::chrono::seconds kIdleLimit{30};
    static constexpr std::size_t kMaxConnections = 64;

    HttpServer(asio::any_io_executor executor, const Wall& wall, SnapshotDesk& snapshots) : acceptor_(executor), wall_(wall), snapshots_(snapshots) {}

    Result<void> listen(const net::Address& address);
    void stop();
    /// With the port that the kernel chose.
    const net::Address& address() const { return address_; }

private:
    using Request = boost::beast::http::request<boost::beast::http::string_body>;
    using Response = boost::beast::http::response<boost::beast::http::string_body>;
    using Socket = asio::ip::tcp::socket;

    asio::awaitable<void> accept();
    asio::awaitable<void> serve(std::shared_ptr<Socket> socket);
    asio::awaitable<Response> answer(const Request& request);
    asio::awaitable<Response> snapshot(const Request& request, const std::string& tile);

    asio::ip::tcp::acceptor acceptor_;
    const Wall& wall_;
    SnapshotDesk& snapshots_;
    net::Address address_;
    std::map<Socket*, std::weak_ptr<Socket>> open_;
};

}  // namespace wall::walld
