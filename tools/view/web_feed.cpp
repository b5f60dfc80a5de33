// SPDX-License-Identifier: MIT
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>

#include "common/json/parse_json.h"
#include "tools/view/feed.h"

namespace wall::view {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;

constexpr std::chrono::seconds kConnectLimit{3}, kIdleLimit{30};
constexpr std::size_t kMaxMessage = std::size_t{512}
                                    << 20;  // bytes; a raw frame of codec::kMaxPixels and what comes before it
constexpr std::string_view kScheme = "http://";

tl::unexpected<Failure> no(const char* code, std::string message) {
    return tl::unexpected<Failure>({code, std::move(message)});
}

Outcome<net::Address> address_of(const std::string& url) {
    if (!url.starts_with(kScheme)) return no("invalid", "'" + url + "': expected http://HOST[:PORT]");
    auto host = url.substr(kScheme.size());
    host = host.substr(0, host.find('/'));
    const bool has_port = host.find(':', host.find(']') == std::string::npos ? 0 : host.find(']')) != std::string::npos;
    auto address = net::Address::parse(has_port ? host : host + ":80");
    if (!address || address->is_unix()) return no("invalid", "'" + url + "': expected http://HOST[:PORT]");
    return std::move(*address);
}

/// walld's error, or all of the body if that is something else.
std::string reason_in(const std::string& body) {
    const auto answer = parse_json(body, kAnswerJson);
    const nlohmann::json::json_pointer message("/error/message");
    return answer && answer->is_object() && answer->contains(message) && answer->at(message).is_string()
               ? answer->at(message).get<std::string>()
               : body;
}

class WebFeed : public Feed {
public:
    ~WebFeed() override {
        error_code ignored;
        stream_.next_layer().close(ignored);
        io_.restart();
        io_.poll();  // the read that is left ends before what it reads into does
    }

    Outcome<void> open(const net::Address& address, const std::string& token, const nlohmann::json& watch) {
        tcp::resolver resolver(io_);
        error_code error;
        const auto where = resolver.resolve(address.host, std::to_string(address.port), error);
        if (!error && !finish(
                          [&](auto done) {
                              asio::async_connect(stream_.next_layer(), where,
                                                  [done](error_code e, const auto&) { done(e); });
                          },
                          error, kConnectLimit))
            error = asio::error::timed_out;
        if (error) return no("unavailable", "walld cannot be reached at " + address.text() + ": " + error.message());
        stream_.set_option(websocket::stream_base::timeout{kConnectLimit, kIdleLimit, true});
        stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
            if (!token.empty()) request.set("Authorization", "Bearer " + token);
        }));
        stream_.read_message_max(kMaxMessage);
        websocket::response_type answer;
        if (!finish([&](auto done) { stream_.async_handshake(answer, address.text(), "/api/v1/stream", done); }, error,
                    kConnectLimit))
            error = asio::error::timed_out;
        if (answer.result() == boost::beast::http::status::unauthorized ||
            answer.result() == boost::beast::http::status::forbidden)
            return no("forbidden", "walld refused: " + reason_in(answer.body()));
        if (error) return no("unavailable", "no stream from " + address.text() + ": " + error.message());
        stream_.write(asio::buffer(nlohmann::json{{"watch", watch}}.dump()), error);
        if (error) return no("unavailable", address.text() + ": " + error.message());
        return {};
    }

    Result<std::optional<FeedMessage>> next(std::chrono::milliseconds limit) override {
        if (!reading_) stream_.async_read(buffer_, [this](error_code error, std::size_t) { read_ = error; });
        reading_ = true;
        run_until([this] { return read_.has_value(); }, limit);
        if (!read_) return std::nullopt;
        if (*read_) return fail("the stream ended: " + read_->message());
        FeedMessage message{stream_.got_binary(), boost::beast::buffers_to_string(buffer_.data())};
        buffer_.clear();
        read_.reset();
        reading_ = false;
        return message;
    }

private:
    void run_until(const auto& done, std::chrono::milliseconds limit) {
        const auto end = std::chrono::steady_clock::now() + limit;
        io_.restart();
        while (!done() && io_.run_one_until(end) != 0) {
        }
    }
    /// Starts something asynchronous and waits for it; false: it took too long.
    bool finish(const auto& start, error_code& error, std::chrono::milliseconds limit) {
        std::optional<error_code> result;
        start([&result](error_code e) { result = e; });
        run_until([&] { return result.has_value(); }, limit);
        if (!result) {
            error_code ignored;
            stream_.next_layer().close(ignored);
            run_until([&] { return result.has_value(); }, limit);
            return false;
        }
        error = *result;
        return true;
    }

    asio::io_context io_;
    websocket::stream<tcp::socket> stream_{io_};
    boost::beast::flat_buffer buffer_;
    bool reading_ = false;
    std::optional<error_code> read_;  ///< how the read ended
};

}  // namespace

Outcome<std::unique_ptr<Feed>> open_web_feed(const std::string& url, const std::string& token_file,
                                             const nlohmann::json& watch) {
    const auto address = address_of(url);
    if (!address) return tl::unexpected(address.error());
    const auto token = request::read_token(token_file);
    if (!token) return tl::unexpected(token.error());
    auto feed = std::make_unique<WebFeed>();
    if (const auto open = feed->open(*address, *token, watch); !open) return tl::unexpected(open.error());
    return feed;
}

}  // namespace wall::view
