// SPDX-License-Identifier: MIT
#include "walld/http/stream_session.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>

#include "common/daemon/keep_running.h"
#include "common/net/as_tuple.h"

namespace wall::walld {

// How Boost.Beast ends a WebSocket: its closing was said within, so the connection just goes. It finds these by name.
inline void beast_close_socket(WebStream& stream) { stream.close(); }
template <class Handler>
void async_teardown(boost::beast::role_type, WebStream& stream, Handler&& handler) {
    stream.close();
    asio::post(stream.get_executor(),
               boost::beast::bind_front_handler(std::forward<Handler>(handler), boost::system::error_code()));
}

namespace {

namespace websocket = boost::beast::websocket;
constexpr std::size_t kMaxMessage = 64 << 10;  // bytes, from a viewer
constexpr int kSendBuffer = 256 << 10;         // bytes in the kernel: what is there is old before a slow viewer gets it
constexpr std::chrono::seconds kHandshakeLimit{10}, kIdleLimit{30};
constexpr const char* kNoMore = "you may watch no more";

struct Connection {
    Connection(std::shared_ptr<WebStream> from, StreamHub& the_hub, std::shared_ptr<StreamHub::Viewer> who,
               StillMay still_may)
        : socket(std::move(from)), stream(*socket), hub(the_hub), viewer(std::move(who)), still(std::move(still_may)) {}
    ~Connection() { hub.remove_viewer(*viewer); }
    Connection(const Connection&) = delete;

    std::shared_ptr<WebStream> socket;
    websocket::stream<WebStream&> stream;
    StreamHub& hub;
    std::shared_ptr<StreamHub::Viewer> viewer;
    StillMay still;
    bool open = true;

    void close() {
        open = false;
        socket->close();
        viewer->news().notify();
    }
};

asio::awaitable<void> send_all(std::shared_ptr<Connection> connection) {
    while (connection->open) {
        if (const auto& may = connection->still.at(StillMay::Clock::now()); !may) {
            const websocket::close_reason why(websocket::close_code::policy_error, kNoMore);
            co_await connection->stream.async_close(why, net::kTuple);
            co_return connection->close();
        }
        const auto message = connection->hub.next(*connection->viewer);
        if (!message) {
            co_await connection->viewer->news().wait(connection->still.next());
            continue;
        }
        static const std::string nothing;
        const std::string& packet = message->packet ? *message->packet : nothing;
        const std::array<asio::const_buffer, 2> buffers{asio::buffer(message->head), asio::buffer(packet)};
        connection->stream.binary(message->binary);
        const auto [error, sent] = co_await connection->stream.async_write(buffers, net::kTuple);
        if (error) connection->close();
    }
}

}  // namespace

asio::awaitable<Outcome<void>> serve_viewer(std::shared_ptr<WebStream> socket,
                                            boost::beast::http::request<boost::beast::http::string_body> request,
                                            StreamHub& hub, std::shared_ptr<StreamHub::Viewer> viewer, StillMay still) {
    boost::system::error_code ignored;
    socket->socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    socket->socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    const auto connection = std::make_shared<Connection>(std::move(socket), hub, std::move(viewer), std::move(still));
    auto& stream = connection->stream;
    stream.set_option(websocket::stream_base::timeout{kHandshakeLimit, kIdleLimit, true});
    stream.read_message_max(kMaxMessage);
    const auto [refused] = co_await stream.async_accept(request, net::kTuple);
    if (refused) co_return Outcome<void>();
    net::spawn(stream.get_executor(), "viewer", send_all(connection));
    boost::beast::flat_buffer buffer;
    while (connection->open) {
        const auto [error, bytes] = co_await stream.async_read(buffer, net::kTuple);
        if (error) break;
        const auto text = buffer.data();
        const auto requests = WatchRequest::parse({static_cast<const char*>(text.data()), text.size()});
        const auto done =
            requests ? hub.watch(*connection->viewer, *requests) : Result<void>(tl::unexpected(requests.error()));
        if (!done) connection->viewer->tell_error(done.error().message);
        buffer.clear();
    }
    connection->close();
    co_return connection->still.last();
}

}  // namespace wall::walld
