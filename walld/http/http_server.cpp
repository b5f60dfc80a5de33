// SPDX-License-Identifier: MIT
#include "walld/http/http_server.h"

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "gen/walld/http/page.gen.h"
#include "walld/http/rest.h"
#include "walld/streams/stream_session.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

namespace http = boost::beast::http;
constexpr auto kTuple = asio::as_tuple(asio::use_awaitable);
constexpr std::uint32_t kMaxHeader = 8 << 10, kMaxBody = 64 << 10;  // bytes

constexpr const char* kJson = "application/json";
constexpr const char* kVia = "http";
constexpr const char* kRetryAfter = "1";  // seconds
constexpr unsigned kVersion = 11;         // HTTP/1.1
constexpr const char* kNotKnownYet = "somebody whose name is being looked up";

/// The page uses nothing but its own files, and is no part of another page.
constexpr const char* kPolicy = "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

http::response<HttpBody> reply(unsigned version, http::status status, std::string_view type,
                               HttpBody::value_type body) {
    http::response<HttpBody> out(status, version);
    out.set(http::field::content_type, {type.data(), type.size()});
    out.set(http::field::cache_control, "no-store");
    out.set("X-Content-Type-Options", "nosniff");
    out.set("Content-Security-Policy", kPolicy);
    out.body() = std::move(body);
    return out;
}

http::response<HttpBody> reply(unsigned version, http::status status, std::string_view type, std::string text) {
    return reply(version, status, type, HttpBody::value_type{std::move(text), nullptr});
}

http::response<HttpBody> refusal(unsigned version, int status, const Refusal& why) {
    auto out = reply(version, static_cast<http::status>(status), kJson, dump(error_json(why)));
    if (why.kind == RefusalKind::busy) out.set(http::field::retry_after, kRetryAfter);
    return out;
}

/// What a connection gets that is one too many: its socket is fresh, and has room for so few bytes.
void turn_away(asio::ip::tcp::socket& socket, const Refusal& why) {
    log::warn("http_full reason={}", log::quoted(why.message));
    auto answer = refusal(kVersion, http_status(why.kind), why);
    answer.keep_alive(false);
    answer.prepare_payload();
    std::ostringstream text;
    text << answer.base() << answer.body().bytes();
    boost::system::error_code ignored;
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(text.str()), ignored);
}

std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

template <class Request>
bool reads(const Request& request) {
    return request.method() == http::verb::get || request.method() == http::verb::head;
}

template <class Request>
std::string_view path_of(const Request& request) {
    return view(request.target()).substr(0, request.target().find('?'));
}

template <class Request>
std::string_view query_of(const Request& request) {
    const auto path = path_of(request);
    return path.size() < request.target().size() ? view(request.target()).substr(path.size() + 1) : std::string_view();
}

/// A browser that was led here under a foreign name (DNS rebinding) must not read the wall.
bool host_ok(std::string_view host) {
    if (host.empty()) return true;
    const bool bare = host.find(':') == std::string_view::npos || host.ends_with(']');
    const auto address = net::Address::parse(bare ? std::string(host) + ":80" : std::string(host));
    return address && !address->is_unix() && address->local();
}

std::string decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned value = 0;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::sscanf(std::string(text.substr(i + 1, 2)).c_str(), "%2x", &value) == 1) {
            out += static_cast<char>(value);
            i += 2;
        } else {
            out += text[i] == '+' ? ' ' : text[i];
        }
    }
    return out;
}

std::string query_value(std::string_view query, std::string_view key) {
    while (!query.empty()) {
        const auto part = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), part.size() + 1));
        if (part.starts_with(key) && part.substr(key.size()).starts_with('='))
            return decoded(part.substr(key.size() + 1));
    }
    return {};
}

}  // namespace

Result<void> HttpServer::listen(const net::Address& address) {
    auto listener = net::Listener::open(executor_, address);
    if (!listener) return tl::unexpected(listener.error());
    listener_.emplace(std::move(*listener));
    log::info("http_listening url={}", log::quoted("http://" + listener_->address().text() + "/"));
    net::keep_accepting(
        executor_, *listener_, [this](net::StreamSocket socket) { take(std::move(socket)); },
        [this] { return stopping_; });
    return {};
}

void HttpServer::stop() {
    stopping_ = true;
    if (listener_) listener_->close();
    boost::system::error_code ignored;
    for (auto& [key, connection] : std::exchange(open_, {})) {
        if (const auto open = connection.lock()) open->socket.close(ignored);
    }
}

void HttpServer::take(net::StreamSocket accepted) {
    boost::system::error_code ignored;
    const auto protocol = accepted.local_endpoint(ignored).protocol();
    Socket socket(executor_);
    socket.assign(protocol.family() == AF_INET6 ? asio::ip::tcp::v6() : asio::ip::tcp::v4(), accepted.release(),
                  ignored);
    auto place = connections_.take(kNotKnownYet);
    if (!place) return turn_away(socket, place.error());
    auto connection = std::make_shared<Connection>(std::move(socket), std::move(*place), Person{});
    open_[connection.get()] = connection;
    net::spawn(executor_, "http", serve(std::move(connection)));
}

/// Whose connection it is may take its time to find out.
asio::awaitable<void> HttpServer::serve(std::shared_ptr<Connection> connection) {
    connection->caller = co_await who_.at(ends_of(connection->socket.native_handle()));
    connection->place.leave();
    auto place = connections_.take(connection->caller.text());
    if (place) {
        connection->place = std::move(*place);
        co_await answer_all(connection);
    } else {
        turn_away(connection->socket, place.error());
    }
    open_.erase(connection.get());
    boost::system::error_code ignored;
    connection->socket.shutdown(Socket::shutdown_both, ignored);
    connection->socket.close(ignored);
}

// GCC 12 inlines Asio's allocation of this coroutine's frame, but not its release, and takes them for a mismatch.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
asio::awaitable<void> HttpServer::answer_all(std::shared_ptr<Connection> connection) {
    Socket& socket = connection->socket;
    // Requests that come while one is answered wait in the kernel, but for what the last reading brought of them.
    boost::beast::flat_buffer buffer(kMaxHeader + kMaxBody);
    asio::steady_timer idle(socket.get_executor());
    const auto limit = [&] {
        idle.expires_after(kIdleLimit);
        idle.async_wait([weak = std::weak_ptr(connection)](const boost::system::error_code& cancelled) {
            boost::system::error_code ignored;
            if (const auto open = weak.lock(); open && !cancelled) open->socket.close(ignored);
        });
    };
    for (bool go_on = true; go_on;) {
        limit();
        http::request_parser<http::string_body> parser;
        parser.header_limit(kMaxHeader);
        parser.body_limit(kMaxBody);
        auto [read_error, read] = co_await http::async_read(socket, buffer, parser, kTuple);
        if (read_error) break;
        idle.cancel();                     // a program that is asked to close may take its time
        std::optional<Response> response;  // none: there was a viewer, and all is said
        if (path_of(parser.get()) == kStreamPath) response = co_await serve_stream(connection, parser.get());
        else response = co_await answer(parser.get(), connection->caller);
        if (!response) break;
        response->keep_alive(parser.get().keep_alive());
        response->prepare_payload();
        if (parser.get().method() == http::verb::head) response->body() = {};
        limit();
        auto [write_error, written] = co_await http::async_write(socket, *response, kTuple);
        go_on = !write_error && response->keep_alive() && !stopping_;
    }
}
#pragma GCC diagnostic pop

/// Until the viewer has gone; an answer for one who may not watch.
asio::awaitable<std::optional<HttpServer::Response>> HttpServer::serve_stream(std::shared_ptr<Connection> connection,
                                                                              const Request& request) {
    const auto who = viewer(request, connection->caller);
    if (!who) co_return who.error();
    auto place = streams_.add_viewer(*who);
    if (!place) co_return refusal(request.version(), http_status(place.error().kind), place.error());
    std::shared_ptr<Socket> socket(connection, &connection->socket);
    co_await serve_viewer(std::move(socket), request, streams_, std::move(*place));
    co_return std::nullopt;
}

asio::awaitable<std::optional<HttpServer::Response>> HttpServer::answer(const Request& request, const Person& caller) {
    if (auto page = local_page(request)) co_return std::move(*page);
    auto asked = read(request, caller);
    if (!asked) co_return std::move(asked.error());
    auto answer = co_await desk_.carry_out(std::move(*asked));
    if (!answer) co_return refusal(request.version(), http_status(answer.error().kind), answer.error());
    if (answer->blob)
        co_return reply(request.version(), http::status::ok, "image/png",
                        HttpBody::value_type{{}, std::move(answer->blob)});
    co_return reply(request.version(), http::status::ok, kJson, dump(answer->json));
}

/// What anybody who reaches us under a local name gets, and the answer for those who do not.
std::optional<HttpServer::Response> HttpServer::local_page(const Request& request) const {
    const auto version = request.version();
    if (!host_ok(view(request[http::field::host])))
        return reply(version, http::status::misdirected_request, "text/plain",
                     "this wall answers to local names only\n");
    if (!reads(request)) return std::nullopt;
    const auto* file = std::ranges::find(kPageFiles, path_of(request), &PageFile::path);
    if (file != std::end(kPageFiles)) return reply(version, http::status::ok, file->type, std::string(file->content));
    if (path_of(request) != kHealthPath) return std::nullopt;
    const bool well = wall_.any_node_up();
    return reply(version, well ? http::status::ok : http::status::service_unavailable, "text/plain",
                 well ? "ok\n" : "no node is up\n");
}

/// Who wants to watch, or the answer for one who may not.
Expected<Person, HttpServer::Response> HttpServer::viewer(const Request& request, const Person& caller) const {
    const auto version = request.version();
    const auto no = [](Response answer) { return tl::unexpected<Response>(std::move(answer)); };
    if (!host_ok(view(request[http::field::host]))) return no(*local_page(request));
    if (!boost::beast::websocket::is_upgrade(request))
        return no(
            reply(version, http::status::upgrade_required, "text/plain", "expected a WebSocket (docs/streams.md)\n"));
    auto who = identities_.over_http(caller, view(request[http::field::authorization]));
    if (!who) return no(refusal(version, 401, who.error()));
    if (const auto permitted = may(*who, Need::look, "watch the wall", nullptr); !permitted)
        return no(refusal(version, http_status(permitted.error().kind), permitted.error()));
    const auto origin = view(request[http::field::origin]);
    if (!origin.empty() && origin != "http://" + std::string(view(request[http::field::host])))
        return no(refusal(version, 403, {RefusalKind::forbidden, "a page of another site may not watch this wall"}));
    return std::move(*who);
}

/// What is asked of the desk, or the answer if nothing is.
Expected<Asked, HttpServer::Response> HttpServer::read(const Request& request, const Person& caller) const {
    const auto no = [&](int status, const Refusal& why) {
        return tl::unexpected<Response>(refusal(request.version(), status, why));
    };
    auto who = identities_.over_http(caller, view(request[http::field::authorization]));
    if (!who) return no(401, who.error());
    const auto path = path_of(request);
    if (reads(request) && path == kMetricsPath) {
        if (const auto permitted = may(*who, Need::look, "read the metrics", nullptr); !permitted)
            return no(http_status(permitted.error().kind), permitted.error());
        return tl::unexpected<Response>(
            reply(request.version(), http::status::ok, "text/plain; version=0.0.4", metrics_.text()));
    }
    if (reads(request) && path == kSnapshotPath)
        return Asked{"screenshot", {{"tile", query_value(query_of(request), "tile")}}, std::move(*who), kVia};
    auto command = rest_command({view(request.method_string()), path, request.body(),
                                 view(request[http::field::content_type]), view(request[http::field::host]),
                                 view(request[http::field::origin]), view(request["Sec-Fetch-Site"])});
    if (!command) return no(command.error().status, command.error().why);
    return Asked{std::move(command->verb), std::move(command->arguments), std::move(*who), kVia};
}

}  // namespace wall::walld
