// SPDX-License-Identifier: MIT
// The status page and the API (docs/http-api.md). One thread; a coroutine a connection.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <map>
#include <memory>

#include "common/daemon/changed.h"
#include "common/net/control_connection.h"
#include "walld/control/identity.h"
#include "walld/control/operator_desk.h"
#include "walld/control/who_is_there.h"
#include "walld/http/http_body.h"
#include "walld/metrics/metrics.h"
#include "walld/streams/stream_hub.h"
#include "walld/wall/quota.h"
#include "walld/wall/wall.h"

namespace wall::walld {

namespace asio = boost::asio;

class HttpServer {
public:
    static constexpr std::chrono::seconds kIdleLimit{30};

    HttpServer(asio::any_io_executor executor, const Wall& wall, const Identities& identities, WhoIsThere& who,
               OperatorDesk& desk, StreamHub& streams, const WallMetrics& metrics)
        : executor_(std::move(executor)),
          wall_(wall),
          identities_(identities),
          who_(who),
          desk_(desk),
          streams_(streams),
          metrics_(metrics) {}

    Result<void> listen(const net::Address& address);
    void stop();
    /// The address listened on, with the port that the kernel chose.
    const net::Address& address() const { return listener_->address(); }

private:
    using Request = boost::beast::http::request<boost::beast::http::string_body>;
    using Response = boost::beast::http::response<HttpBody>;
    using Socket = asio::ip::tcp::socket;
    struct Connection {
        Socket socket;
        Quota::Place place;
        Person caller;  ///< known once it is served
    };

    void take(net::StreamSocket accepted);
    asio::awaitable<void> serve(std::shared_ptr<Connection> connection);
    asio::awaitable<void> answer_all(std::shared_ptr<Connection> connection);
    asio::awaitable<std::optional<Response>> serve_stream(std::shared_ptr<Connection> connection,
                                                          const Request& request);
    asio::awaitable<std::optional<Response>> answer(const Request& request, const Person& caller);
    std::optional<Response> local_page(const Request& request) const;
    Expected<Person, Response> viewer(const Request& request, const Person& caller) const;
    Expected<Asked, Response> read(const Request& request, const Person& caller) const;

    asio::any_io_executor executor_;
    std::optional<net::Listener> listener_;
    bool stopping_ = false;
    const Wall& wall_;
    const Identities& identities_;
    WhoIsThere& who_;
    OperatorDesk& desk_;
    StreamHub& streams_;
    const WallMetrics& metrics_;
    Quota connections_{kHttpConnections};
    std::map<Connection*, std::weak_ptr<Connection>> open_;
};

}  // namespace wall::walld
