// SPDX-License-Identifier: MIT
#include "common/net/sockets.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace wall::net {
namespace {

using std::chrono::seconds;

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

}  // namespace
}  // namespace wall::net
