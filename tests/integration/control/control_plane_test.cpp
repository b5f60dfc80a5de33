// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <future>
#include <thread>

#include "common/net/sockets.h"
#include "common/wire/limits.h"
#include "tests/integration/control/walld_process.h"

namespace wall::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

class ControlPlane : public ::testing::Test {
protected:
    Peer connect() { return Peer(walld_.connect()); }
    Output wallctl(const std::string& arguments) {
        return run(std::string(WALLCTL_PROGRAM) + " --walld " + walld_.address().text() + " " + arguments);
    }
    void join_both() {
        left_.join("left");
        right_.join("right");
    }
    Walld walld_;
    Peer left_{walld_.connect()}, right_{walld_.connect()};
};

TEST_F(ControlPlane, AFrameGoesAllTheWay) {
    join_both();
    auto program = connect();
    const auto welcome = program.open();
    ASSERT_EQ(welcome.nodes_size(), 2);
    EXPECT_EQ(welcome.tiles_size(), 2);
    EXPECT_EQ(welcome.canvas_width(), 128u);
    const auto ticket = left_.hear(proto::Envelope::kTicket);
    ASSERT_TRUE(ticket);
    EXPECT_EQ(ticket->ticket().ticket(), welcome.nodes(0).ticket());

    const auto placement = program.open_surface(SurfaceId(1), 100, 40);
    EXPECT_EQ(placement.rect().width(), 100u);
    left_.rendered(SessionId(welcome.session()), SurfaceId(1), 1);
    right_.rendered(SessionId(welcome.session()), SurfaceId(1), 1);
    for (auto* node : {&left_, &right_}) {
        const auto present = node->hear(proto::Envelope::kPresent);
        ASSERT_TRUE(present);
        EXPECT_EQ(present->present().frame(), 1u);
    }
    EXPECT_THAT(wallctl("wait 1 --frame 1").text, "");
    EXPECT_THAT(wallctl("--json sessions").text, HasSubstr("\"frame\": 1"));
}

TEST_F(ControlPlane, ASlowNodeDoesNotHoldTheWall) {
    join_both();
    auto program = connect();
    const auto session = program.open().session();
    program.open_surface(SurfaceId(1), 100, 40);
    left_.rendered(SessionId(session), SurfaceId(1), 1);
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(left_.hear(proto::Envelope::kPresent));
    const auto waited = std::chrono::steady_clock::now() - begin;
    EXPECT_GT(waited, milliseconds(150));
    EXPECT_LT(waited, milliseconds(2000));
}

TEST_F(ControlPlane, AHeldProgramIsStepped) {
    join_both();
    auto program = connect();
    proto::ClientHello hello;
    hello.set_hold(true);
    const auto session = program.open(hello).session();
    program.open_surface(SurfaceId(1), 10, 10);
    left_.rendered(SessionId(session), SurfaceId(1), 1);
    EXPECT_FALSE(left_.hear(proto::Envelope::kPresent, milliseconds(400)));
    EXPECT_EQ(wallctl("step 1").exit_code, 0);
    EXPECT_TRUE(left_.hear(proto::Envelope::kPresent));
    const auto waited = wallctl("wait 1 --frame 2 --timeout 0.2");
    EXPECT_EQ(waited.exit_code, 1);
    EXPECT_THAT(waited.text, HasSubstr("frame 2 was not shown within 200 ms; the last one is 1"));
}

TEST_F(ControlPlane, APictureComesFromTheNodes) {
    join_both();
    const TemporaryFolder folder;
    const auto file = folder.file("wall.png");
    auto shot = std::async(std::launch::async, [&] { return wallctl("screenshot " + file); });
    for (auto* node : {&left_, &right_}) {
        const auto request = node->hear(proto::Envelope::kSnapshotRequest);
        ASSERT_TRUE(request);
        proto::Envelope answer;
        auto& snapshot = *answer.mutable_snapshot();
        snapshot.set_request(request->snapshot_request().request());
        snapshot.set_width(64);
        snapshot.set_height(48);
        snapshot.set_rgb(std::string(64 * 48 * 3, node == &left_ ? '\x40' : '\xc0'));
        node->say(answer);
    }
    EXPECT_EQ(shot.get().exit_code, 0);
    const auto size =
        run("/usr/bin/python3 -c \"import cv2; p = cv2.imread('" + file + "'); print(p.shape, p[0, 0], p[0, 127])\"");
    EXPECT_EQ(size.text, "(48, 128, 3) [64 64 64] [192 192 192]\n");
}

TEST_F(ControlPlane, AClosedProgramIsTakenFromTheWall) {
    join_both();
    std::uint32_t session = 0;
    {
        auto program = connect();
        session = program.open().session();
    }
    const auto end = left_.hear(proto::Envelope::kSessionEnd, seconds(2));
    ASSERT_TRUE(end);
    EXPECT_EQ(end->session_end().session(), session);
}

TEST_F(ControlPlane, AKilledProgramIsNoticedThoughItsChildKeepsTheConnection) {
    join_both();
    int started[2];
    ASSERT_EQ(::pipe(started), 0);
    const pid_t process = ::fork();
    if (process == 0) {
        Peer program(walld_.connect());
        program.open();
        const pid_t child = ::fork();
        if (child != 0) [[maybe_unused]]
            const auto written = ::write(started[1], &child, sizeof child);
        for (;;) ::pause();
    }
    pid_t child = -1;
    ASSERT_EQ(::read(started[0], &child, sizeof child), static_cast<ssize_t>(sizeof child));
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    EXPECT_TRUE(left_.hear(proto::Envelope::kSessionEnd, seconds(2)));
    ::kill(child, SIGKILL);
}

TEST_F(ControlPlane, ANodeThatRestartsIsToldToTheProgram) {
    join_both();
    auto program = connect();
    program.open();
    { const auto gone = std::move(left_); }
    ASSERT_TRUE(program.hear(proto::Envelope::kNodeDown));
    auto again = connect();
    again.join("left", 2);
    const auto up = program.hear(proto::Envelope::kNodeUp);
    ASSERT_TRUE(up);
    EXPECT_EQ(up->node_up().node(), 0u);
    EXPECT_EQ(up->node_up().incarnation(), 2u);
    const auto ticket = again.hear(proto::Envelope::kTicket);
    ASSERT_TRUE(ticket);
    EXPECT_EQ(ticket->ticket().ticket(), up->node_up().ticket());
}

TEST_F(ControlPlane, ANodeThatWasStartedAgainTakesThePlaceOfItsDeadLink) {
    join_both();
    auto program = connect();
    program.open();
    auto again = connect();  // while `left_` is still there, as far as walld can see
    again.join("left", 2, 1000);
    EXPECT_EQ(left_.hear(proto::Envelope::kRefused)->refused().reason(), "process 2 is this node now");
    EXPECT_TRUE(left_.closed());
    ASSERT_TRUE(program.hear(proto::Envelope::kNodeDown));
    EXPECT_EQ(program.hear(proto::Envelope::kNodeUp)->node_up().incarnation(), 2u);
    EXPECT_TRUE(again.hear(proto::Envelope::kTicket));
    auto older = connect();
    proto::Envelope hello;
    hello.mutable_node_hello()->set_version(wire::kProtocolVersion);
    hello.mutable_node_hello()->set_name("left");
    hello.mutable_node_hello()->set_pid(3);
    older.say(hello);
    EXPECT_THAT(older.hear(proto::Envelope::kRefused)->refused().reason(), HasSubstr("already here, as process 2"));
    EXPECT_EQ(wallctl("nodes").exit_code, 0);
    EXPECT_THAT(wallctl("--json nodes").text, HasSubstr("\"pid\": 2"));
}

TEST_F(ControlPlane, ANodeThatSaysNothingIsAway) {
    join_both();
    auto program = connect();
    program.open();
    for (int second = 0; second < 20; ++second) {
        proto::Envelope ping;
        ping.mutable_ping();
        left_.say(ping);
        ASSERT_TRUE(left_.hear(proto::Envelope::kPong));
        if (program.hear(proto::Envelope::kNodeDown, seconds(1))) break;
        if (second == 4) {
            EXPECT_THAT(wallctl("nodes").text, HasSubstr("silent"));
        }
        ASSERT_LT(second, 19) << "its link may be dead";
    }
    EXPECT_TRUE(right_.closed());
    EXPECT_THAT(wallctl("nodes").text, HasSubstr("left"));
    right_ = connect();
    right_.join("right");
    EXPECT_TRUE(program.hear(proto::Envelope::kNodeUp));
}

TEST_F(ControlPlane, WithoutNodesAProgramIsRefusedInTime) {
    auto program = connect();
    proto::Envelope hello;
    hello.mutable_client_hello()->set_version(wire::kProtocolVersion);
    program.say(hello);
    const auto refused = program.hear(proto::Envelope::kRefused, seconds(5));
    ASSERT_TRUE(refused);
    EXPECT_THAT(refused->refused().reason(), HasSubstr("no node of the wall is up"));
    EXPECT_TRUE(program.closed());
}

TEST_F(ControlPlane, AProgramWaitsForANodeThatComesSoon) {
    auto program = connect();
    auto welcome = std::async(std::launch::async, [&] { return program.open(); });
    std::this_thread::sleep_for(milliseconds(200));
    join_both();
    EXPECT_EQ(welcome.get().nodes_size(), 2);
}

TEST_F(ControlPlane, ForeignBytesEndTheirConnectionOnly) {
    join_both();
    for (const std::string& bytes : {std::string("GET / HTTP/1.1\r\n\r\n"), std::string(64, '\xff'),
                                     std::string("\x04\0\0\0????", 8), std::string("\x02\0\0\0\xa2\x01", 6)}) {
        const auto fd = net::connect_to(walld_.address(), kSoon);
        ASSERT_TRUE(fd);
        ::send(fd->get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        ::shutdown(fd->get(), SHUT_WR);
        char sink[1024];
        while (::read(fd->get(), sink, sizeof sink) > 0) {
        }
    }
    auto program = connect();
    EXPECT_EQ(program.open().nodes_size(), 2);
}

TEST_F(ControlPlane, AMessageOfTheWrongRoleEndsThatPeer) {
    join_both();
    auto program = connect();
    program.open();
    program.rendered(SessionId(1), SurfaceId(1), 1);
    EXPECT_TRUE(program.hear(proto::Envelope::kRefused));
    EXPECT_TRUE(program.closed());
    EXPECT_TRUE(left_.hear(proto::Envelope::kSessionEnd));
}

TEST_F(ControlPlane, CloseAsksThenCutsOff) {
    join_both();
    auto program = connect();
    program.open();
    program.open_surface(SurfaceId(1), 10, 10);
    auto closing = std::async(std::launch::async, [&] { return wallctl("--json close 1"); });
    EXPECT_TRUE(program.hear(proto::Envelope::kCloseRequest));
    EXPECT_TRUE(program.closed());
    EXPECT_THAT(closing.get().text, HasSubstr("by walld"));
}

TEST_F(ControlPlane, ServesThePageAndTheApi) {
    join_both();
    EXPECT_THAT(walld_.http_get("/"), HasSubstr("<title>WallGL</title>"));
    EXPECT_THAT(walld_.http_get("/api/v1/status"), HasSubstr("\"name\":\"left\""));
    EXPECT_EQ(walld_.http_get("/api/v1/sessions"), "[]");
    EXPECT_THAT(walld_.http_get("/metrics"), HasSubstr("wallgl_node_up{node=\"left\"} 1"));
    EXPECT_EQ(walld_.http_get("/healthz"), "ok\n");
    EXPECT_EQ(walld_.http_get("/nothing"), "");
}

TEST_F(ControlPlane, SignalsEndItInOrder) {
    join_both();
    walld_.signal(SIGTERM);
    const auto ended = walld_.wait(milliseconds(900));  // less than it gives what hangs
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_THAT(ended.said, HasSubstr("stopped"));
    EXPECT_NE(::access(walld_.address().path.c_str(), F_OK), 0) << "the socket is removed";
    EXPECT_TRUE(left_.closed());
}

TEST(WalldStart, RefusesAnAddressThatOthersCanReach) {
    Walld walld("[control]\nlisten = [\"0.0.0.0:7770\"]\n");
    const auto ended = walld.wait();
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.said, HasSubstr("0.0.0.0:7770 can be reached from other machines"));
}

TEST(WalldStart, SaysWhatIsWrongInTheDescription) {
    Walld walld("[wall]\ncolour = 1\n");
    const auto ended = walld.wait();
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.said, HasSubstr("wall.toml:6: unknown key 'colour'"));
}

}  // namespace
}  // namespace wall::test
