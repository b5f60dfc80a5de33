// SPDX-License-Identifier: MIT
#include "walld/http/http_server.h"

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/daemon/keep_running.h"
#include "common/json/parse_json.h"
#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/net/as_tuple.h"
#include "gen/walld/http/page.gen.h"
#include "walld/http/stream_session.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

namespace http = boost::beast::http;
constexpr std::uint32_t kMaxHeader = 8 << 10, kMaxBody = 64 << 10;  // bytes

constexpr const char* kJson = "application/json";
constexpr const char* kVia = "http";      // also where it was, of what is refused
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
void turn_away(WebStream::Socket& socket, const Refusal& why) {
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

/// Of the browser that has signed in; with TLS in a name that nothing in plain can set (RFC 6265bis, 4.1.3).
const char* cookie_name(bool foreign) { return foreign ? "__Host-wallgl" : "wallgl"; }

/// No script of a page reads it, and no page of another site sends it.
std::string cookie(bool foreign, const std::string& secret, std::chrono::seconds lifetime) {
    return std::string(cookie_name(foreign)) + "=" + secret +
           "; Path=/; HttpOnly; SameSite=Strict; Max-Age=" + std::to_string(lifetime.count()) +
           (foreign ? "; Secure" : "");
}

std::string address_of(WebStream::Socket& socket) {
    boost::system::error_code failed;
    const auto peer = socket.remote_endpoint(failed);
    return failed ? "somewhere" : peer.address().to_string();
}

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

template <class Request, class Connection>
RestRequest of(const Request& request, const Connection& connection) {
    return {view(request.method_string()),
            path_of(request),
            request.body(),
            view(request[http::field::content_type]),
            view(request[http::field::host]),
            view(request[http::field::origin]),
            view(request["Sec-Fetch-Site"]),
            connection.scheme()};
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

Result<void> HttpServer::listen(std::span<const net::Address> addresses) {
    listeners_.clear();  // of an attempt before, which one of the addresses has ended
    for (const auto& address : addresses) {
        auto listener =
            net::Listener::open(executor_, address, own_ ? net::Peers::with_keys : net::Peers::of_this_machine);
        if (!listener) return tl::unexpected(listener.error());
        listeners_.push_back(std::make_unique<net::Listener>(std::move(*listener)));
    }
    for (auto& listener : listeners_) {
        const bool foreign = listener->wants_keys();
        net::keep_accepting(
            executor_, *listener, [this, foreign](net::StreamSocket socket) { take(std::move(socket), foreign); },
            [this] { return stopping_; });
    }
    for (const auto& url : urls())
        log::info("http_listening url={} certificate={}", log::quoted(url),
                  log::quoted(url.starts_with("https") ? own_->certificate_digest() : ""));
    return {};
}

std::vector<std::string> HttpServer::urls() const {
    std::vector<std::string> out;
    for (const auto& listener : listeners_)
        out.push_back((listener->address().local() ? "http://" : "https://") + listener->address().text() + "/");
    return out;
}

void HttpServer::stop() {
    stopping_ = true;
    for (auto& listener : listeners_) listener->close();
    for (auto& [key, connection] : std::exchange(open_, {})) {
        if (const auto open = connection.lock()) open->stream.close();
    }
}

void HttpServer::take(net::StreamSocket accepted, bool foreign) {
    boost::system::error_code ignored;
    const auto protocol = accepted.local_endpoint(ignored).protocol();
    WebStream::Socket socket(executor_);
    socket.assign(protocol.family() == AF_INET6 ? asio::ip::tcp::v6() : asio::ip::tcp::v4(), accepted.release(),
                  ignored);
    const auto from = address_of(socket);
    auto place = foreign ? foreign_.take("somebody at " + from) : connections_.take(kNotKnownYet);
    if (!place) {
        log::refused(kVia, from, place.error().message);
        if (!foreign) turn_away(socket, place.error());  // in plain; nothing is said so to another machine
        return;
    }
    auto connection =
        std::make_shared<Connection>(WebStream(std::move(socket)), std::move(*place), from, Person{}, foreign);
    open_[connection.get()] = connection;
    net::spawn(executor_, "http", serve(std::move(connection)));
}

/// Whose connection it is may take its time to find out; of another machine's nobody knows.
asio::awaitable<bool> HttpServer::admit(Connection& connection) {
    if (connection.foreign) {
        const auto done = co_await connection.stream.shake_hands(*own_);
        if (!done) log::refused(kVia, connection.from(), done.error().message);
        co_return done.has_value();
    }
    connection.caller = co_await who_.at(ends_of(connection.stream.socket().native_handle()));
    connection.place.leave();
    auto place = connections_.take(connection.caller.text());
    if (place) {
        connection.place = std::move(*place);
        co_return true;
    }
    log::refused(kVia, connection.from(), place.error().message);
    turn_away(connection.stream.socket(), place.error());
    co_return false;
}

asio::awaitable<void> HttpServer::serve(std::shared_ptr<Connection> connection) {
    const bool admitted = co_await admit(*connection);
    if (admitted) co_await answer_all(connection);
    open_.erase(connection.get());
    connection->stream.close();
}

// GCC 12 inlines Asio's allocation of this coroutine's frame, but not its release, and takes them for a mismatch.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
asio::awaitable<void> HttpServer::answer_all(std::shared_ptr<Connection> connection) {
    WebStream& stream = connection->stream;
    // Requests that come while one is answered wait in the kernel, but for what the last reading brought of them.
    boost::beast::flat_buffer buffer(kMaxHeader + kMaxBody);
    asio::steady_timer idle(stream.get_executor());
    const auto limit = [&] {
        idle.expires_after(kIdleLimit);
        idle.async_wait([weak = std::weak_ptr(connection)](const boost::system::error_code& cancelled) {
            if (const auto open = weak.lock(); open && !cancelled) open->stream.close();
        });
    };
    for (bool go_on = true; go_on;) {
        limit();
        http::request_parser<http::string_body> parser;
        parser.header_limit(kMaxHeader);
        parser.body_limit(kMaxBody);
        auto [read_error, read] = co_await http::async_read(stream, buffer, parser, net::kTuple);
        if (read_error) break;
        idle.cancel();                     // a program that is asked to close may take its time
        std::optional<Response> response;  // none: there was a viewer, and all is said
        if (path_of(parser.get()) == kStreamPath) response = co_await serve_stream(connection, parser.get());
        else response = co_await answer(parser.get(), *connection);
        if (!response) break;
        response->keep_alive(parser.get().keep_alive());
        response->prepare_payload();
        if (parser.get().method() == http::verb::head) response->body() = {};
        limit();
        auto [write_error, written] = co_await http::async_write(stream, *response, net::kTuple);
        go_on = !write_error && response->keep_alive() && !stopping_;
    }
}
#pragma GCC diagnostic pop

/// Until the viewer has gone; an answer for one who may not watch.
asio::awaitable<std::optional<HttpServer::Response>> HttpServer::serve_stream(std::shared_ptr<Connection> connection,
                                                                              const Request& request) {
    const auto who = viewer(request, *connection);
    if (!who) co_return who.error();
    auto place = streams_.add_viewer(*who);
    if (!place) co_return no(request, *connection, http_status(place.error().kind), place.error());
    StillMay still([this, request, at = connection.get()] {
        return watcher(request, *at).map([](auto&&) {}).map_error([](const HttpRefusal& why) { return why.why; });
    });
    std::shared_ptr<WebStream> stream(connection, &connection->stream);
    const auto may = co_await serve_viewer(std::move(stream), request, streams_, std::move(*place), std::move(still));
    if (!may) log::refused(kVia, connection->from(), may.error().message);
    co_return std::nullopt;
}

asio::awaitable<std::optional<HttpServer::Response>> HttpServer::answer(const Request& request,
                                                                        const Connection& connection) {
    if (auto answer = page(request, connection)) co_return std::move(*answer);
    if (request.method() == http::verb::post && path_of(request) == kLogin)
        co_return co_await log_in(request, connection);
    if (request.method() == http::verb::post && path_of(request) == kLogout) co_return log_out(request, connection);
    auto asked = read(request, connection);
    if (!asked) co_return std::move(asked.error());
    auto answer = co_await desk_.carry_out(std::move(*asked));
    if (!answer)
        co_return refusal(request.version(), http_status(answer.error().kind), answer.error());  // the desk has said so
    if (answer->blob)
        co_return reply(request.version(), http::status::ok, "image/png",
                        HttpBody::value_type{{}, std::move(answer->blob)});
    co_return reply(request.version(), http::status::ok, kJson, dump(answer->json));
}

/// A token for a cookie. Whoever has none hears so after a while, and on this connection nothing else meanwhile.
asio::awaitable<HttpServer::Response> HttpServer::log_in(const Request& request, const Connection& connection) {
    const auto asked = of(request, connection);
    if (!asked.same_site())
        co_return no(request, connection, 403,
                     {RefusalKind::forbidden, "a page of another site may not sign in at this wall"});
    if (!asked.is_json())
        co_return no(request, connection, 415, {RefusalKind::invalid, "expected 'Content-Type: application/json'"});
    const auto body = parse_json(request.body(), kRequestJson);
    const bool told = body && body->is_object() && body->contains("token") && body->at("token").is_string();
    if (!told || body->at("token").get<std::string>().empty())
        co_return no(request, connection, 400, {RefusalKind::invalid, R"(expected {"token": "..."})"});
    const auto secret = SecretDigest::of(body->at("token").get<std::string>());
    const auto who = identities_.tokens().find(secret);
    if (!who) {
        asio::steady_timer wait(executor_, kWrongTokenDelay);
        co_await wait.async_wait(net::kTuple);
        co_return no(request, connection, 401, who.error());
    }
    log::info("login who={} from={}", log::quoted(who->text()), log::quoted(connection.from()));
    auto answer = reply(request.version(), http::status::ok, kJson, dump(person_json(*who)));
    answer.set(http::field::set_cookie,
               cookie(connection.foreign, logins_.open(secret, Logins::Clock::now()), Logins::kLifetime));
    co_return answer;
}

HttpServer::Response HttpServer::log_out(const Request& request, const Connection& connection) {
    if (!of(request, connection).same_site())
        return no(request, connection, 403,
                  {RefusalKind::forbidden, "a page of another site may not sign anybody out of this wall"});
    logins_.close(cookie_value(view(request[http::field::cookie]), cookie_name(connection.foreign)));
    auto answer = reply(request.version(), http::status::ok, kJson, std::string("{}"));
    answer.set(http::field::set_cookie, cookie(connection.foreign, "", std::chrono::seconds(0)));
    return answer;
}

/// What anybody gets who reaches us, on this machine under a local name, and the answer for those who do not. Over TLS
/// the name does not matter: a browser that was led here under another one has no cookie of ours under it.
std::optional<HttpServer::Response> HttpServer::page(const Request& request, const Connection& connection) const {
    const auto version = request.version();
    if (!connection.foreign && !host_ok(view(request[http::field::host]))) {
        constexpr const char* why = "this wall answers to local names only";
        log::refused(kVia, connection.from(), why);
        return reply(version, http::status::misdirected_request, "text/plain", std::string(why) + "\n");
    }
    if (!reads(request)) return std::nullopt;
    const auto* file = std::ranges::find(kPageFiles, path_of(request), &PageFile::path);
    if (file != std::end(kPageFiles)) return reply(version, http::status::ok, file->type, std::string(file->content));
    if (path_of(request) != kHealthPath) return std::nullopt;
    const bool well = wall_.any_node_up();
    return reply(version, well ? http::status::ok : http::status::service_unavailable, "text/plain",
                 well ? "ok\n" : "no node is up\n");
}

/// Who asks: whose token it is, who has signed in, or as whom the kernel names.
Expected<Person, HttpRefusal> HttpServer::person(const Request& request, const Connection& connection) {
    const auto authorization = view(request[http::field::authorization]);
    const auto secret = cookie_value(view(request[http::field::cookie]), cookie_name(connection.foreign));
    if (authorization.empty() && !secret.empty())
        if (const auto token = logins_.find(secret, Logins::Clock::now()))
            if (auto known = identities_.tokens().find(*token)) return std::move(*known);
    const auto unknown = [](const Refusal& why) { return tl::unexpected<HttpRefusal>({401, why}); };
    if (connection.foreign && authorization.empty())
        return unknown(
            {RefusalKind::forbidden, "sign in with a token: at the page, or by 'Authorization: Bearer TOKEN'"});
    auto who = identities_.over_http(connection.caller, authorization, !connection.foreign);
    if (!who) return unknown(who.error());
    return std::move(*who);
}

Expected<Person, HttpRefusal> HttpServer::watcher(const Request& request, const Connection& connection) {
    auto who = person(request, connection);
    if (!who) return who;
    if (const auto permitted = may(*who, Need::look, "watch the wall", nullptr); !permitted)
        return tl::unexpected<HttpRefusal>({http_status(permitted.error().kind), permitted.error()});
    return who;
}

/// Who wants to watch, or the answer for one who may not.
Expected<Person, HttpServer::Response> HttpServer::viewer(const Request& request, const Connection& connection) {
    const auto version = request.version();
    if (!connection.foreign && !host_ok(view(request[http::field::host])))
        return tl::unexpected<Response>(*page(request, connection));
    if (!boost::beast::websocket::is_upgrade(request))
        return tl::unexpected<Response>(
            reply(version, http::status::upgrade_required, "text/plain", "expected a WebSocket (docs/streams.md)\n"));
    auto who = watcher(request, connection);
    if (!who) return tl::unexpected<Response>(no(request, connection, who.error().status, who.error().why));
    if (!of(request, connection).same_site())
        return tl::unexpected<Response>(
            no(request, connection, 403, {RefusalKind::forbidden, "a page of another site may not watch this wall"}));
    return std::move(*who);
}

/// An answer that says no. Who may not, or is one too many, is in the log; who has made a mistake is not.
HttpServer::Response HttpServer::no(const Request& request, const Connection& connection, int status,
                                    const Refusal& why) {
    if (why.kind == RefusalKind::forbidden || why.kind == RefusalKind::busy)
        log::refused(kVia, connection.from(), why.message);
    return refusal(request.version(), status, why);
}

/// What is asked of the desk, or the answer if nothing is.
Expected<Asked, HttpServer::Response> HttpServer::read(const Request& request, const Connection& connection) {
    const auto denied = [&](int status, const Refusal& why) {
        return tl::unexpected<Response>(no(request, connection, status, why));
    };
    auto who = person(request, connection);
    if (!who) return denied(who.error().status, who.error().why);
    const auto path = path_of(request);
    if (reads(request) && path == kMetricsPath) {
        if (const auto permitted = may(*who, Need::look, "read the metrics", nullptr); !permitted)
            return denied(http_status(permitted.error().kind), permitted.error());
        return tl::unexpected<Response>(
            reply(request.version(), http::status::ok, "text/plain; version=0.0.4", metrics_.text()));
    }
    if (reads(request) && path == kSnapshotPath)
        return Asked{"screenshot",
                     {{"tile", query_value(query_of(request), "tile")},
                      {"output", query_value(query_of(request), "output") == "1"}},
                     std::move(*who),
                     kVia};
    auto command = rest_command(of(request, connection));
    if (!command) return denied(command.error().status, command.error().why);
    return Asked{std::move(command->verb), std::move(command->arguments), std::move(*who), kVia};
}

}  // namespace wall::walld
