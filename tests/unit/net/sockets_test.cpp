// SPDX-License-Identifier: MIT
#include "common/net/sockets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <filesystem>
#include <thread>
#include <vector>

#include "common/base/trusted_server.h"
#include "common/net/control_client.h"
#include "common/net/control_connection.h"
#include "tests/support/temporary_folder.h"

namespace wall::net {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::TemporaryFolder;

class TcpPeer : public ::testing::Test {
protected:
    UniqueFd connect() { return std::move(*connect_to(bound_address(listener_.get(), asked_), seconds(5))); }
    UniqueFd accept() {
        for (int tries = 0; tries < 500; ++tries, ::usleep(10'000)) {
            if (const int fd = ::accept(listener_.get(), nullptr, nullptr); fd >= 0) return UniqueFd(fd);
        }
        return UniqueFd();
    }
    const Address asked_{.path = {}, .host = "127.0.0.1", .port = 0};
    UniqueFd listener_ = std::move(*listen_on(asked_));
};

TEST_F(TcpPeer, OfThisMachineHasAUser) {
    const auto mine = connect();
    const auto accepted = accept();
    const auto peer = peer_of(accepted.get());
    ASSERT_TRUE(peer);
    EXPECT_EQ(peer->user, ::geteuid());
}

TEST_F(TcpPeer, ThatHasShutDownItsSideStillHasOne) {
    const auto mine = connect();
    ::shutdown(mine.get(), SHUT_WR);
    const auto accepted = accept();
    EXPECT_TRUE(peer_of(accepted.get()));
}

TEST_F(TcpPeer, ThatHasClosedItsSocketIsNobodyRatherThanRoot) {
    connect().reset();
    const auto accepted = accept();
    EXPECT_FALSE(peer_of(accepted.get()));
}

/// A Unix socket whose queue is full, of programs that all start at once.
class FullQueue : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(::listen(listener_.get(), 1), 0);  // fewer than before
        while (auto more = connect_to(address_, milliseconds(1))) waiting_.push_back(*std::move(more));
    }
    const TemporaryFolder folder_;
    const Address address_ = *Address::parse("unix:" + folder_.file("socket"));
    UniqueFd listener_ = std::move(*listen_on(address_));
    std::vector<UniqueFd> waiting_;
};

TEST_F(FullQueue, IsWaitedFor) {
    std::thread accepts([&] {
        ::usleep(50'000);
        UniqueFd(::accept(listener_.get(), nullptr, nullptr)).reset();
    });
    EXPECT_TRUE(connect_to(address_, seconds(5)));
    accepts.join();
}

TEST_F(FullQueue, IsWaitedForNoLongerThanTold) {
    const auto connected = connect_to(address_, milliseconds(30));
    ASSERT_FALSE(connected);
    EXPECT_NE(connected.error().message.find("cannot connect: no answer"), std::string::npos)
        << connected.error().message;
}

TEST(Listening, IsForThisMachineOnlyWhoeverAsks) {
    for (const char* text : {"0.0.0.0:0", "[::]:0", "192.0.2.1:0", "[::ffff:127.0.0.1]:0", "wall.example:0"}) {
        const auto listener = listen_on(*Address::parse(text));
        ASSERT_FALSE(listener) << text;
        EXPECT_NE(listener.error().message.find("can be reached from other machines"), std::string::npos)
            << listener.error().message;
    }
    for (const char* text : {"127.0.0.1:0", "127.9.9.9:0", "localhost:0", "[::1]:0"})
        EXPECT_TRUE(listen_on(*Address::parse(text))) << text;
}

TEST_F(TcpPeer, ThatListensIsKnownBeforeItAccepts) {
    const auto mine = connect();
    const auto waiting = server_of(mine.get());
    ASSERT_TRUE(waiting);
    EXPECT_EQ(waiting->user, ::geteuid());
    const auto accepted = accept();
    const auto server = server_of(mine.get());
    ASSERT_TRUE(server);
    EXPECT_EQ(server->user, ::geteuid());
}

TEST_F(TcpPeer, IsFoundAmongManySockets) {
    std::vector<UniqueFd> others;
    for (int i = 0; i < 50; ++i) {
        others.push_back(connect());
        others.push_back(accept());
    }
    const auto mine = connect();
    const auto accepted = accept();
    EXPECT_TRUE(peer_of(accepted.get()));
}

constexpr uid_t kStranger = 54321;

/// A process of another user that has taken an address. It accepts if it is told to.
class AStrangersServer {
public:
    AStrangersServer(const Address& address, bool accepts) {
        int told[2];
        EXPECT_EQ(::pipe(told), 0);
        process_ = ::fork();
        if (process_ == 0) {
            if (::setresuid(kStranger, kStranger, kStranger) != 0) ::_exit(1);
            auto listener = listen_on(address);
            const std::uint16_t port = listener ? bound_address(listener->get(), address).port : 0;
            [[maybe_unused]] const auto n = ::write(told[1], &port, sizeof port);
            for (;;) {
                if (accepts && ::accept(listener->get(), nullptr, nullptr) >= 0) continue;
                ::usleep(1000);
            }
        }
        address_ = address;
        EXPECT_EQ(::read(told[0], &address_.port, sizeof address_.port), static_cast<ssize_t>(sizeof address_.port));
        ::close(told[0]);
        ::close(told[1]);
    }
    ~AStrangersServer() {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    AStrangersServer(const AStrangersServer&) = delete;
    const Address& address() const { return address_; }

private:
    pid_t process_ = -1;
    Address address_;
};

class TrustedServer : public ::testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "only root can be somebody else";
        std::string path = "/tmp/wallgl-stranger-XXXXXX";
        folder_ = ::mkdtemp(path.data());
        ASSERT_EQ(::chown(folder_.c_str(), kStranger, kStranger), 0);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string folder_;
};

TEST_F(TrustedServer, IsNoneOfAnotherUser) {
    for (const bool accepts : {false, true}) {
        for (const Address& address : {Address{.path = {}, .host = "127.0.0.1", .port = 0},
                                       Address{.path = folder_ + (accepts ? "/a" : "/b"), .host = {}, .port = 0}}) {
            const AStrangersServer stranger(address, accepts);
            const auto fd = connect_to(stranger.address(), seconds(5));
            ASSERT_TRUE(fd) << fd.error().message;
            if (accepts) ::usleep(100'000);
            const auto trusted = check_server(fd->get(), "wallgl");
            ASSERT_FALSE(trusted) << stranger.address().text();
            EXPECT_THAT(trusted.error().message, ::testing::HasSubstr("a process of user 54321"));
            EXPECT_TRUE(check_server(fd->get(), std::to_string(kStranger))) << "unless that is walld's user";
            EXPECT_TRUE(check_server(fd->get(), "*"));
        }
    }
}

TEST_F(TrustedServer, IsAskedForByToolsBeforeTheySpeak) {
    const AStrangersServer stranger({.path = {}, .host = "127.0.0.1", .port = 0}, true);
    const auto tool = ControlClient::connect(stranger.address(), seconds(5));
    ASSERT_FALSE(tool);
    EXPECT_THAT(tool.error().message, ::testing::HasSubstr("this is not walld: it is a process of user 54321"));
}

TEST_F(TrustedServer, IsAskedForByNodesBeforeTheySpeak) {
    const AStrangersServer stranger({.path = {}, .host = "127.0.0.1", .port = 0}, true);
    const auto connect = [&](std::string walld) {
        asio::io_context io(1);
        Result<std::shared_ptr<ControlConnection>> node = fail("it does not come to an end");
        asio::co_spawn(
            io,
            [&]() -> asio::awaitable<void> {
                node = co_await ControlConnection::connect(stranger.address(), walld);
                if (node) (*node)->close();
            },
            asio::detached);
        io.run();
        return node ? "connected" : node.error().message;
    };
    EXPECT_THAT(connect(kWallUser), ::testing::HasSubstr("this is not walld: it is a process of user 54321"));
    EXPECT_EQ(connect(std::to_string(kStranger)), "connected") << "unless that is walld's user";
}

TEST_F(TcpPeer, OfOurOwnUserIsTrusted) { EXPECT_TRUE(check_server(connect().get(), "nobody-of-that-name")); }

}  // namespace
}  // namespace wall::net
