// SPDX-License-Identifier: MIT
#include "common/net/control_connection.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <filesystem>

#include "common/net/sockets.h"
#include "tests/support/temporary_folder.h"

namespace wall::net {
namespace {

Address socket_in(const test::TemporaryFolder& folder) { return {.path = folder.file("socket")}; }

/// Answers every Rendered with a Present of the same frame until the peer closes.
asio::awaitable<void> echo_once(Listener& listener, std::optional<Peer>& peer) {
    auto socket = co_await listener.accept();
    const auto connection = std::make_shared<ControlConnection>(Stream(std::move(*socket)));
    peer = peer_of(*connection->ends());
    for (;;) {
        auto message = co_await connection->receive();
        if (!message) break;
        proto::Envelope reply;
        reply.mutable_present()->set_frame(message->rendered().frame());
        connection->send(reply);
    }
}

asio::awaitable<void> ask(Address address, std::uint32_t count, std::uint32_t& answered, std::string& end) {
    auto connected = co_await ControlConnection::connect(address, "wallgl");
    const auto connection = *connected;
    for (std::uint32_t i = 1; i <= count; ++i) {
        proto::Envelope message;
        message.mutable_rendered()->set_frame(i);
        connection->send(message);
    }
    for (std::uint32_t i = 1; i <= count; ++i) {
        auto message = co_await connection->receive();
        if (message && message->present().frame() == i) ++answered;
    }
    connection->close();
    end = (co_await connection->receive()).error().message;
}

void round_trip(const Address& address) {
    asio::io_context io(1);
    auto listener = Listener::open(io.get_executor(), address);
    ASSERT_TRUE(listener) << listener.error().message;
    std::uint32_t answered = 0;
    std::string end;
    std::optional<Peer> peer;
    asio::co_spawn(io, echo_once(*listener, peer), asio::detached);
    asio::co_spawn(io, ask(listener->address(), 1000, answered, end), asio::detached);
    io.run();
    EXPECT_EQ(answered, 1000u);
    EXPECT_EQ(end, "closed");
    ASSERT_TRUE(peer);
    EXPECT_EQ(peer->user, ::getuid());
}

TEST(ControlConnection, CarriesMessagesOverUnixSockets) {
    const test::TemporaryFolder folder;
    round_trip(socket_in(folder));
    EXPECT_FALSE(std::filesystem::exists(socket_in(folder).path)) << "the listener removes its socket";
}

TEST(ControlConnection, CarriesMessagesOverTcpAndKnowsThePeersUser) { round_trip(*Address::parse("127.0.0.1:0")); }

/// Either end closes: whose doing it was. `reads`: the other way of noticing is that a write fails.
void closes(bool the_peer, bool reads) {
    const test::TemporaryFolder folder;
    asio::io_context io;
    auto listener = Listener::open(io.get_executor(), socket_in(folder));
    ASSERT_TRUE(listener);
    std::shared_ptr<ControlConnection> here, there;
    const auto accept = [&]() -> asio::awaitable<void> {
        auto socket = co_await listener->accept();
        there = std::make_shared<ControlConnection>(Stream(std::move(*socket)));
    };
    const auto connect = [&]() -> asio::awaitable<void> {
        auto connected = co_await ControlConnection::connect(listener->address(), "wallgl");
        here = *connected;
    };
    asio::co_spawn(io, accept(), asio::detached);
    asio::co_spawn(io, connect(), asio::detached);
    io.run();
    ASSERT_TRUE(here && there);
    io.restart();
    (the_peer ? there : here)->close();
    const auto notice = [&]() -> asio::awaitable<void> {
        if (!reads) {
            proto::Envelope ping;
            ping.mutable_ping();
            here->send(ping);
            co_await here->drained();
        }
        const auto message = co_await here->receive();
        EXPECT_FALSE(message);
    };
    asio::co_spawn(io, notice(), asio::detached);
    io.run();
    EXPECT_EQ(here->lost(), the_peer);
}

TEST(ControlConnection, KnowsWhetherItWasClosedFromTheOtherEnd) {
    for (const bool reads : {true, false}) {
        closes(true, reads);
        closes(false, reads);
    }
}

TEST(Sockets, ReplaceAStaleSocketButNotALiveOne) {
    const test::TemporaryFolder folder;
    { const auto dead = listen_on(socket_in(folder)); }
    const auto live = listen_on(socket_in(folder));
    ASSERT_TRUE(live) << live.error().message;
    EXPECT_FALSE(listen_on(socket_in(folder)));
}

TEST(Sockets, AnErrorNamesTheAddress) {
    const auto failed = connect_to(*Address::parse("unix:/nowhere/walld.sock"), std::chrono::seconds(1));
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "unix:/nowhere/walld.sock: cannot connect: No such file or directory");
}

}  // namespace
}  // namespace wall::net
