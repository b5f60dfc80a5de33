// SPDX-License-Identifier: MIT
// The real walld and what is too much of something: it says so, and goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <future>
#include <random>

#include "common/net/sockets.h"
#include "common/wire/limits.h"
#include "tests/integration/control/walld_process.h"
#include "walld/wall/quota.h"

namespace wall::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint32_t kWidth = 4800, kHeight = 4800;  // 69 MB without alpha; a message has at most 64 MiB
constexpr const char* kLargeTile =
    "[[node]]\nname = \"large\"\n[[node.tile]]\nname = \"big\"\nrect = [0, 48, 4800, 4800]\n";

proto::Envelope request(std::uint32_t number, const std::string& verb, const std::string& json) {
    proto::Envelope out;
    auto& request = *out.mutable_operator_request();
    request.set_request(number);
    request.set_verb(verb);
    request.set_json(json);
    return out;
}

class Limits : public ::testing::Test {
protected:
    Peer connect() { return Peer(walld_.connect()); }
    proto::OperatorReply ask(Peer& peer, const std::string& verb, const std::string& json = "") {
        peer.say(request(1, verb, json));
        const auto reply = peer.hear(proto::Envelope::kOperatorReply);
        EXPECT_TRUE(reply) << "no answer to " << verb;
        return reply ? reply->operator_reply() : proto::OperatorReply();
    }
    /// Until walld has accepted it, for which it may need time.
    UniqueFd open(const net::Address& address) {
        for (const auto until = std::chrono::steady_clock::now() + kSoon;;) {
            auto fd = net::connect_to(address, seconds(1));
            if (fd || std::chrono::steady_clock::now() > until) return fd ? std::move(*fd) : UniqueFd();
            ::usleep(1000);
        }
    }
    Walld walld_{kLargeTile};
};

/// What a node sends of a tile full of noise, so that no codec makes it small.
class NoisyTile {
public:
    NoisyTile() : rgb_(std::size_t{3} * kWidth * kHeight, '\0') {
        std::minstd_rand random(1);
        for (char& c : rgb_) c = static_cast<char>(random() >> 8);
    }
    void send(Peer& node, std::uint32_t request) const {
        for (std::size_t at = 0; at < rgb_.size(); at += wire::kControlPart) {
            proto::Envelope message;
            auto& part = *message.mutable_snapshot();
            part.set_request(request);
            part.set_width(kWidth);
            part.set_height(kHeight);
            part.set_offset(at);
            part.set_rgb(rgb_.substr(at, wire::kControlPart));
            node.say(message);
        }
    }
    const std::string& rgb() const { return rgb_; }

private:
    std::string rgb_;
};

TEST_F(Limits, APictureThatIsLargerThanAMessageComesWhole) {
    auto node = connect();
    node.join("large");
    const TemporaryFolder folder;
    const auto file = folder.file("big.png"), raw = folder.file("raw");
    auto shot = std::async(std::launch::async, [&] {
        return run(std::string(WALLCTL_PROGRAM) + " --walld " + walld_.address().text() + " screenshot --tile big " +
                   file);
    });
    const auto asked = node.hear(proto::Envelope::kSnapshotRequest);
    ASSERT_TRUE(asked);
    const NoisyTile tile;
    tile.send(node, asked->snapshot_request().request());
    const auto done = shot.get();
    ASSERT_EQ(done.exit_code, 0) << done.text;
    std::ofstream(raw, std::ios::binary) << tile.rgb();
    const auto same =
        run("/usr/bin/python3 -c \"import cv2, os, numpy; p = cv2.imread('" + file +
            "')[:, :, ::-1]; r = numpy.fromfile('" + raw +
            "', numpy.uint8).reshape(p.shape); print((p == r).all(), os.path.getsize('" + file + "') > 64 << 20)\"");
    EXPECT_EQ(same.text, "True True\n");
}

TEST_F(Limits, ARawStreamOfALargeTileComesWhole) {
    auto node = connect(), viewer = connect();
    node.join("large");
    viewer.say(request(5, "watch", R"({"watch": [{"tile": "big", "codec": "raw"}]})"));
    const auto start = node.hear(proto::Envelope::kStreamStart);
    ASSERT_TRUE(start);
    const std::string packet(std::size_t{4} * kWidth * kHeight, 'p');
    for (std::size_t at = 0; at < packet.size(); at += wire::kControlPart) {
        proto::Envelope message;
        auto& part = *message.mutable_stream_frame();
        part.set_stream(start->stream_start().stream());
        if (at == 0) {
            part.set_key(true);
            part.set_width(kWidth);
            part.set_height(kHeight);
        }
        part.set_packet_bytes(packet.size());
        part.set_offset(at);
        part.set_packet(packet.substr(at, wire::kControlPart));
        node.say(message);
    }
    for (;;) {
        const auto reply = viewer.hear(proto::Envelope::kOperatorReply);
        ASSERT_TRUE(reply);
        const auto& blob = reply->operator_reply().blob();
        if (blob.empty()) continue;  // what the stream is
        EXPECT_EQ(blob.size(), 24 + packet.size());
        EXPECT_TRUE(std::string_view(blob).substr(24) == packet);
        break;
    }
}

TEST_F(Limits, NoDepthOfACommandEndsWalld) {
    auto peer = connect();
    const std::string deep = std::string(400'000, '[') + std::string(400'000, ']');
    for (const auto& json : {deep, std::string(60, '[') + std::string(60, ']'), R"({"id": )" + deep + "}"}) {
        const auto reply = ask(peer, "place", json);
        EXPECT_FALSE(reply.ok());
        EXPECT_EQ(reply.code(), "invalid");
        EXPECT_THAT(reply.error(), StartsWith("arguments: JSON: expected at most"));
    }
    EXPECT_FALSE(ask(peer, "watch", deep).ok());
    EXPECT_TRUE(ask(peer, "status").ok());
}

TEST_F(Limits, ANameWithALineFeedWritesNoLineOfTheLog) {
    auto node = connect();
    node.join("large");
    auto program = connect();
    proto::ClientHello hello;
    hello.set_program("gears\"\naudit who=\"root\" role=operator via=control what=close");
    program.open(hello);
    walld_.signal(SIGTERM);
    const auto log = walld_.wait().said;
    EXPECT_THAT(log, HasSubstr(R"(program="gears\"\naudit who=\"root\")"));
    EXPECT_THAT(log, ::testing::Not(HasSubstr("\naudit")));
}

TEST_F(Limits, RequestsThatWaitForAnAnswerHaveALimit) {
    auto node = connect();
    node.join("large");
    auto program = connect();
    program.open();
    auto peer = connect();
    std::uint32_t number = 0;
    for (; number <= walld::kRequests.of_one; ++number)
        peer.say(request(number, "wait", R"({"id": 1, "frame": 1000, "timeout_ms": 60000})"));
    const auto busy = peer.hear(proto::Envelope::kOperatorReply);
    ASSERT_TRUE(busy);
    EXPECT_EQ(busy->operator_reply().request(), number - 1) << "all others wait";
    EXPECT_EQ(busy->operator_reply().code(), "busy");
    EXPECT_THAT(busy->operator_reply().error(), HasSubstr(" has 128 requests to this wall that wait for an answer"));
}

TEST_F(Limits, APeerHasOnlySoManyConnections) {
    auto first = connect();
    std::vector<UniqueFd> idle;
    for (std::size_t i = 1; i < walld::kPeerConnections.of_one; ++i) idle.push_back(open(walld_.address()));
    auto late = connect();
    const auto refused = late.hear(proto::Envelope::kRefused);
    ASSERT_TRUE(refused);
    EXPECT_THAT(refused->refused().reason(), HasSubstr(" has 512 connections to this wall"));
    EXPECT_TRUE(ask(first, "status").ok()) << "those that are there go on";
    idle.clear();
    for (const auto until = std::chrono::steady_clock::now() + kSoon; std::chrono::steady_clock::now() < until;) {
        auto again = connect();
        again.say(request(1, "status", ""));
        if (again.hear(proto::Envelope::kOperatorReply)) return;
    }
    FAIL() << "connections that were closed still count";
}

TEST_F(Limits, ProgramsDoNotCountAsConnections) {
    auto node = connect();
    node.join("large");
    std::vector<Peer> programs;
    for (int i = 0; i < 64; ++i) {
        programs.push_back(connect());
        programs.back().open();
    }
    EXPECT_THAT(walld_.http_get("/metrics"), HasSubstr("\nwallgl_sessions 64\n"));
    std::vector<UniqueFd> idle;
    for (std::size_t i = 1; i + 1 < walld::kPeerConnections.of_one; ++i) idle.push_back(open(walld_.address()));
    auto last = connect();
    EXPECT_TRUE(ask(last, "status").ok());
}

TEST_F(Limits, APeerHasOnlySoManyHttpConnections) {
    walld_.connect();  // it is ready then
    std::vector<UniqueFd> idle;
    for (std::size_t i = 0; i < walld::kHttpConnections.of_one; ++i) idle.push_back(open(walld_.http()));
    const auto late = open(walld_.http());
    std::string answer;
    char bytes[4096];
    for (ssize_t n; (n = ::read(late.get(), bytes, sizeof bytes)) > 0;)
        answer.append(bytes, static_cast<std::size_t>(n));
    EXPECT_THAT(answer, AllOf(StartsWith("HTTP/1.1 429 "), HasSubstr("\r\nRetry-After: 1\r\n"),
                              HasSubstr("\"code\":\"busy\""), HasSubstr(" has 512 HTTP connections to this wall")));
}

TEST_F(Limits, PipelinedRequestsAreAnsweredInTurn) {
    walld_.connect();
    const auto fd = open(walld_.http());
    const std::string one = "GET /api/v1/whoami HTTP/1.1\r\nHost: localhost\r\n\r\n";
    std::string many;
    for (int i = 0; i < 4000; ++i) many += one;
    many += "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    auto sent = std::async(std::launch::async, [&] {
        std::size_t at = 0;
        for (ssize_t n;
             at < many.size() && (n = ::send(fd.get(), many.data() + at, many.size() - at, MSG_NOSIGNAL)) > 0;)
            at += static_cast<std::size_t>(n);
        return at;
    });
    std::string answers;
    char bytes[65536];
    for (ssize_t n; (n = ::read(fd.get(), bytes, sizeof bytes)) > 0;)
        answers.append(bytes, static_cast<std::size_t>(n));
    EXPECT_EQ(sent.get(), many.size());
    std::size_t good = 0;
    for (auto at = answers.find("HTTP/1.1 200"); at != std::string::npos; at = answers.find("HTTP/1.1 200", at + 1))
        ++good;
    EXPECT_EQ(good, 4000u);
    EXPECT_THAT(answers.substr(answers.rfind("HTTP/1.1")), StartsWith("HTTP/1.1 503")) << "no node is up";
}

/// A chunk's first line has no length that says when it will end, and its parser looks for its end only.
TEST_F(Limits, ALineOfARequestThatNeverEndsIsNotKept) {
    constexpr std::size_t kMuch = 64 << 20;  // far more than the kernel keeps of a connection
    walld_.connect();
    const auto fd = open(walld_.http());
    std::string piece = "POST /api/v1/blank HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n1;";
    std::size_t sent = 0;
    for (ssize_t n; sent < kMuch && (n = ::send(fd.get(), piece.data(), piece.size(), MSG_NOSIGNAL)) > 0;) {
        sent += static_cast<std::size_t>(n);
        piece.assign(1 << 16, 'x');
    }
    EXPECT_LT(sent, kMuch) << "walld closes the connection";
    auto peer = connect();
    EXPECT_TRUE(ask(peer, "status").ok());
}

}  // namespace
}  // namespace wall::test
