// SPDX-License-Identifier: MIT
#include "common/net/stream.h"

#include <gtest/gtest.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <fstream>
#include <sstream>

#include "common/net/control_connection.h"
#include "common/net/sockets.h"

namespace wall::net {
namespace {

std::shared_ptr<const tls::TlsContext> new_machine() {
    return std::make_shared<const tls::TlsContext>(*tls::TlsContext::make(*tls::Identity::make()));
}

/// A machine that listens over TLS and sends back what it gets, and one that connects to it.
class TwoMachines : public testing::Test {
protected:
    void SetUp() override {
        auto listener = Listener::open(io_.get_executor(), *Address::parse("127.0.0.1:0"));
        ASSERT_TRUE(listener) << listener.error().message;
        listener_.emplace(std::move(*listener));
    }
    void run(asio::awaitable<void> client) {
        asio::co_spawn(io_, serve(), asio::detached);
        asio::co_spawn(io_, std::move(client), asio::detached);
        io_.run();
    }
    asio::awaitable<void> serve() {
        auto socket = co_await listener_->accept();
        auto stream = co_await Stream::accept_tls(std::move(*socket), *server_);
        if (!stream) {
            refusal_ = stream.error().message;
            co_return;
        }
        seen_ = stream->peer_key();
        std::string bytes(64 << 10, '\0');
        for (;;) {
            const auto [error, count] = co_await stream->read_some(asio::buffer(bytes));
            if (error) break;
            const auto [failed, written] = co_await stream->write(asio::buffer(bytes.data(), count));
            if (failed) break;
        }
    }
    asio::awaitable<void> send_and_receive(std::string sent) {
        auto stream = co_await Stream::connect_tls(listener_->address(), *client_, server_->fingerprint());
        if (!stream) {
            error_ = stream.error().message;
            co_return;
        }
        EXPECT_EQ(stream->peer_key(), server_->fingerprint());
        std::size_t done = 0;
        std::string room(16 << 10, '\0');
        asio::co_spawn(io_, write_all(*stream, sent), asio::detached);
        while (done < sent.size()) {
            const auto [error, count] = co_await stream->read_some(asio::buffer(room));
            if (error) break;
            got_.append(room, 0, count);
            done += count;
        }
        stream->close();
    }
    asio::awaitable<void> write_all(Stream& stream, std::string bytes) {
        const auto [error, count] = co_await stream.write(asio::buffer(bytes));
        EXPECT_FALSE(error) << error.message();
    }
    asio::awaitable<void> connect_to(tls::Fingerprint expected) {
        auto stream = co_await Stream::connect_tls(listener_->address(), *client_, expected);
        if (!stream) error_ = stream.error().message;
    }
    asio::awaitable<void> say_plainly(std::string text) {
        auto stream = co_await Stream::connect(listener_->address());
        const auto [error, count] = co_await stream->write(asio::buffer(text));
        EXPECT_FALSE(error);
        std::string room(1024, '\0');
        for (;;) {
            const auto [end, bytes] = co_await stream->read_some(asio::buffer(room));
            if (end) break;
        }
    }
    asio::awaitable<void> say_nothing() {
        auto stream = co_await Stream::connect(listener_->address());
        std::string room(16, '\0');
        const auto [end, bytes] = co_await stream->read_some(asio::buffer(room));
        EXPECT_TRUE(end);
    }

    asio::io_context io_{1};
    std::optional<Listener> listener_;
    std::shared_ptr<const tls::TlsContext> server_ = new_machine(), client_ = new_machine();
    std::optional<tls::Fingerprint> seen_;
    std::string refusal_, error_, got_;
};

TEST_F(TwoMachines, ProveTheirKeysToEachOther) {
    run(send_and_receive("hello"));
    EXPECT_EQ(error_, "");
    EXPECT_EQ(seen_, client_->fingerprint());
    EXPECT_EQ(got_, "hello");
}

TEST_F(TwoMachines, ReadAndWriteAtTheSameTime) {
    std::string much;
    for (int i = 0; i < 3 << 20; ++i) much += static_cast<char>(i * 31 >> 3);
    run(send_and_receive(much));
    EXPECT_TRUE(got_ == much) << got_.size();
}

TEST_F(TwoMachines, AnotherKeyThanExpectedIsToldNothing) {
    run(connect_to(client_->fingerprint()));
    EXPECT_NE(error_.find("another machine answers there"), std::string::npos) << error_;
    EXPECT_NE(error_.find(server_->fingerprint().text()), std::string::npos) << error_;
}

TEST_F(TwoMachines, PlainTextIsNoHandshake) {
    run(say_plainly("GET / HTTP/1.1\r\nHost: wall\r\n\r\n"));
    EXPECT_NE(refusal_.find("the TLS handshake failed"), std::string::npos) << refusal_;
    EXPECT_FALSE(seen_);
}

TEST_F(TwoMachines, WhoeverStallsInTheHandshakeIsCutOff) {
    const auto begin = std::chrono::steady_clock::now();
    run(say_nothing());
    EXPECT_NE(refusal_.find("took longer than"), std::string::npos) << refusal_;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 4 * Stream::kHandshakeLimit);
}

/// Connections that the kernel has dropped because a queue of this network was full.
std::uint64_t dropped() {
    std::ifstream file("/proc/net/netstat");
    for (std::string names, values; std::getline(file, names) && std::getline(file, values);) {
        std::istringstream name(names), value(values);
        for (std::string n, v; name >> n && value >> v;)
            if (n == "ListenOverflows") return std::stoull(v);
    }
    return 0;
}

asio::awaitable<void> try_to_connect(Address address, Result<Stream>& result) {
    result = co_await Stream::connect(address);
}

/// TCP asks after a second, and then after three: too late for kConnectLimit.
TEST(Stream, AsksAnewWhileThereIsNoAnswer) {
    asio::io_context io;
    asio::ip::tcp::acceptor listener(io, {asio::ip::address_v4::loopback(), 0});
    listener.listen(0);  // a queue of one
    asio::ip::tcp::socket first(io);
    first.connect(listener.local_endpoint());
    const auto address = *Address::parse("127.0.0.1:" + std::to_string(listener.local_endpoint().port()));
    Result<Stream> result = wall::fail("nothing yet");
    asio::co_spawn(io, try_to_connect(address, result), asio::detached);
    const auto before = dropped();
    for (bool full = true; !io.stopped(); io.run_one_for(std::chrono::milliseconds(10)))
        if (full && dropped() >= before + 2) {
            full = false;
            listener.accept();  // makes room
        }
    EXPECT_TRUE(result) << result.error().message;
}

TEST(Stream, WithoutKeyIsPlain) {
    asio::io_context io(1);
    Stream stream{StreamSocket(io)};
    EXPECT_FALSE(stream.peer_key());
    EXPECT_FALSE(stream.is_open());
}

TEST(ReachableAt, IsWhereAPeerHasComeFromIfItListensEverywhere) {
    SocketEnds ends;
    ends.there.ss_family = AF_INET;
    reinterpret_cast<sockaddr_in&>(ends.there).sin_addr.s_addr = htonl(0x0a4d0003);
    EXPECT_EQ(reachable_at("0.0.0.0:7790", ends), "10.77.0.3:7790");
    EXPECT_EQ(reachable_at("[::]:7790", ends), "10.77.0.3:7790");
    EXPECT_EQ(reachable_at("10.1.1.1:7790", ends), "10.1.1.1:7790");
    EXPECT_EQ(reachable_at("unix:/run/node.sock", ends), "unix:/run/node.sock");
    EXPECT_EQ(reachable_at("0.0.0.0:7790", std::nullopt), "0.0.0.0:7790");
}

}  // namespace
}  // namespace wall::net
