// SPDX-License-Identifier: MIT
// The status page and the API (docs/http-api.md): in plain on this machine, where the kernel says who asks; over TLS
// for others, who sign in with a token. One thread; a coroutine a connection.
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <map>
#include <memory>
#include <span>

#include "common/daemon/changed.h"
#include "common/net/control_connection.h"
#include "walld/control/identity.h"
#include "walld/control/operator_desk.h"
#include "walld/control/who_is_there.h"
#include "walld/http/http_body.h"
#include "walld/http/logins.h"
#include "walld/http/rest.h"
#include "walld/http/web_stream.h"
#include "walld/metrics/metrics.h"
#include "walld/streams/stream_hub.h"
#include "walld/wall/quota.h"
#include "walld/wall/wall.h"

namespace wall::walld {

namespace asio = boost::asio;

class HttpServer {
public:
    static constexpr std::chrono::seconds kIdleLimit{30};
    static constexpr std::chrono::seconds kWrongTokenDelay{1};  ///< before somebody hears that a token is none

    HttpServer(asio::any_io_executor executor, const Wall& wall, const Identities& identities, WhoIsThere& who,
               OperatorDesk& desk, StreamHub& streams, const WallMetrics& metrics, Logins::RandomBytes random,
               std::shared_ptr<const tls::TlsContext> own)
        : executor_(std::move(executor)),
          wall_(wall),
          identities_(identities),
          who_(who),
          desk_(desk),
          streams_(streams),
          metrics_(metrics),
          logins_(std::move(random)),
          own_(std::move(own)) {}

    /// Over TLS where other machines reach an address, which needs a key.
    Result<void> listen(std::span<const net::Address> addresses);
    void stop();
    /// "http://127.0.0.1:7780/", in the order of the addresses, with the ports that the kernel chose.
    std::vector<std::string> urls() const;

private:
    using Request = boost::beast::http::request<boost::beast::http::string_body>;
    using Response = boost::beast::http::response<HttpBody>;
    struct Connection {
        WebStream stream;
        Quota::Place place;
        std::string address;   ///< of the other end, without its port
        Person caller;         ///< known once it is served
        bool foreign = false;  ///< over TLS: nobody knows who it is before they say so

        /// For the log.
        std::string from() const { return caller.kind == Person::Kind::unknown ? address : caller.text(); }
        const char* scheme() const { return foreign ? "https" : "http"; }
    };

    void take(net::StreamSocket accepted, bool foreign);
    asio::awaitable<bool> admit(Connection& connection);
    asio::awaitable<void> serve(std::shared_ptr<Connection> connection);
    asio::awaitable<void> answer_all(std::shared_ptr<Connection> connection);
    asio::awaitable<std::optional<Response>> serve_stream(std::shared_ptr<Connection> connection,
                                                          const Request& request);
    asio::awaitable<std::optional<Response>> answer(const Request& request, const Connection& connection);
    asio::awaitable<Response> log_in(const Request& request, const Connection& connection);
    static Response no(const Request& request, const Connection& connection, int status, const Refusal& why);
    Response log_out(const Request& request, const Connection& connection);
    std::optional<Response> page(const Request& request, const Connection& connection) const;
    Expected<Person, HttpRefusal> person(const Request& request, const Connection& connection);
    Expected<Person, HttpRefusal> watcher(const Request& request, const Connection& connection);
    Expected<Person, Response> viewer(const Request& request, const Connection& connection);
    Expected<Asked, Response> read(const Request& request, const Connection& connection);

    asio::any_io_executor executor_;
    std::vector<std::unique_ptr<net::Listener>> listeners_;
    bool stopping_ = false;
    const Wall& wall_;
    const Identities& identities_;
    WhoIsThere& who_;
    OperatorDesk& desk_;
    StreamHub& streams_;
    const WallMetrics& metrics_;
    Logins logins_;
    std::shared_ptr<const tls::TlsContext> own_;  ///< null: this machine alone is served
    Quota connections_{kHttpConnections}, foreign_{kForeignHttp};
    std::map<Connection*, std::weak_ptr<Connection>> open_;
};

}  // namespace wall::walld
