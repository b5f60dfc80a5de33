// SPDX-License-Identifier: MIT
#include "walld/http_server.h"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <nlohmann/json.hpp>

#include "common/net/sockets.h"
#include "gen/walld/page.gen.h"
#include "walld/status.h"

namespace wall::walld {
namespace {

namespace http = boost::beast::http;
constexpr auto kTuple = asio::as_tuple(asio::use_awaitable);
constexpr std::uint32_t kMaxHeader = 8 << 10, kMaxBody = 64 << 10;  // bytes

struct Page {
    const char* path;
    const char* type;
    std::string (*content)(const Wall&);
};

constexpr Page kPages[] = {
    {"/", "text/html; charset=utf-8", [](const Wall&) { return std::string(kPage); }},
    {"/api/v1/status", "application/json", [](const Wall& wall) { return dump(status_json(wall)); }},
    {"/api/v1/sessions", "application/json", [](const Wall& wall) { return dump(sessions_json(wall)); }},
    {"/metrics", "text/plain; version=0.0.4", [](const Wall& wall) { return metrics_text(wall); }},
    {"/healthz", "text/plain", [](const Wall& wall) { return std::string(wall.any_node_up() ? "ok\n" : "no node is up\n"); }},
};

http::response<http::string_body> reply(unsigned version, http::status status, const char* type, std::string body) {
    http::response<http::string_body> out(status, version);
    out.set(http::field::content_type, type);
    out.set(http::field::cache_control, "no-store");
    out.set("X-Content-Type-Options", "nosniff");
    out.set("Content-Security-Policy", "default-src 'self'; style-src 'self' 'unsafe-inline'; script-src 'self' 'unsafe-inline'; img-src 'self' blob:");
    out.body() = std::move(body);
    return out;
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
        if (text[i] == '%' && i + 2 < text.size() && std::sscanf(std::string(text.substr(i + 1, 2)).c_str(), "%2x", &value) == 1) {
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
        if (part.starts_with(key) && part.substr(key.size()).starts_with('=')) return decoded(part.substr(key.size() + 1));
    }
    return {};
}

}  // namespace

Result<void> HttpServer::listen(const net::Address& address) {
    if (!address.local()) return fail(net::non_local_refusal(address));
    auto fd = net::listen_on(address);
    if (!fd) return tl::unexpected(fd.error());
    const auto to = net::resolve(address);
    if (!to) return tl::unexpected(to.error());
    boost::system::error_code error;
    acceptor_.assign(to->family() == AF_INET6 ? asio::ip::tcp::v6() : asio::ip::tcp::v4(), fd->get(), error);
    if (error) return fail(address.text() + ": " + error.message());
    address_ = net::bound_address(fd->release(), address);
    spdlog::info("http_listening url=http://{}/", address_.text());
    spawn(acceptor_.get_executor(), "http_accept", accept());
    return {};
}

void HttpServer::stop() {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    for (auto& [key, socket] : std::exchange(open_, {})) {
        if (const auto open = socket.lock()) open->close(ignored);
    }
}

asio::awaitable<void> HttpServer::accept() {
    while (acceptor_.is_open()) {
        auto [error, accepted] = co_await acceptor_.async_accept(kTuple);
        if (error) {
            asio::steady_timer pause(acceptor_.get_executor(), std::chrono::milliseconds(100));
            co_await pause.async_wait(kTuple);
            continue;
        }
        if (open_.size() >= kMaxConnections) continue;
        auto socket = std::make_shared<Socket>(std::move(accepted));
        open_[socket.get()] = socket;
        spawn(acceptor_.get_executor(), "http", serve(std::move(socket)));
    }
}

asio::awaitable<void> HttpServer::serve(std::shared_ptr<Socket> socket) {
    boost::beast::flat_buffer buffer;
    asio::steady_timer idle(socket->get_executor());
    for (bool go_on = true; go_on;) {
        idle.expires_after(kIdleLimit);
        idle.async_wait([weak = std::weak_ptr(socket)](const boost::system::error_code& cancelled) {
            boost::system::error_code ignored;
            if (const auto open = weak.lock(); open && !cancelled) open->close(ignored);
        });
        http::request_parser<http::string_body> parser;
        parser.header_limit(kMaxHeader);
        parser.body_limit(kMaxBody);
        auto [read_error, read] = co_await http::async_read(*socket, buffer, parser, kTuple);
        if (read_error) break;
        auto response = co_await answer(parser.get());
        response.keep_alive(parser.get().keep_alive());
        response.prepare_payload();
        if (parser.get().method() == http::verb::head) response.body().clear();
        auto [write_error, written] = co_await http::async_write(*socket, response, kTuple);
        go_on = !write_error && response.keep_alive() && acceptor_.is_open();
    }
    open_.erase(socket.get());
    boost::system::error_code ignored;
    socket->shutdown(Socket::shutdown_both, ignored);
    socket->close(ignored);
}

asio::awaitable<HttpServer::Response> HttpServer::answer(const Request& request) {
    const auto version = request.version();
    const std::string_view target(request.target().data(), request.target().size());
    const auto path = target.substr(0, target.find('?'));
    const auto query = path.size() < target.size() ? target.substr(path.size() + 1) : std::string_view();
    const auto host = request[http::field::host];
    if (!host_ok({host.data(), host.size()})) co_return reply(version, http::status::misdirected_request, "text/plain", "this wall answers to local names only\n");
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        co_return reply(version, http::status::method_not_allowed, "text/plain", "GET only\n");
    }
    for (const auto& page : kPages) {
        if (path != page.path) continue;
        const bool well = path != "/healthz" || wall_.any_node_up();
        co_return reply(version, well ? http::status::ok : http::status::service_unavailable, page.type, page.content(wall_));
    }
    if (path == "/api/v1/snapshot.png") co_return co_await snapshot(request, query_value(query, "tile"));
    co_return reply(version, http::status::not_found, "text/plain", "not found\n");
}

asio::awaitable<HttpServer::Response> HttpServer::snapshot(const Request& request, const std::string& tile) {
    SnapshotQuery query{.tile = tile, .target = {}};  // a name of its own: GCC 12 destroys such a temporary twice
    auto png = co_await snapshots_.take(std::move(query));
    if (!png) co_return reply(request.version(), http::status::not_found, "text/plain", png.error().message + "\n");
    co_return reply(request.version(), http::status::ok, "image/png", std::move(*png));
}

}  // namespace wall::walld
